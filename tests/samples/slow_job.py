"""A job in a process of its own that somebody may kill.

slow_job.py INPUTS OUTPUT [--wind-up] [--one] [--max-s SECONDS]
"""

import sys
from pathlib import Path

from job_samples import PLAIN, pretend

from asset_factory.factory.jobs import Budget, LocalExecutor
from asset_factory.factory.jobs import job as job_module
from asset_factory.factory.jobs.signals import Terminated, interruptible


def main() -> int:
    """Exit codes as the command's."""
    inputs = tuple(sorted(Path(sys.argv[1]).glob("*.stl")))
    job_module.build_here = pretend
    job_module.modules_for = lambda config: ("job_samples",)
    budget = Budget(max_s=float(sys.argv[-1]) if "--max-s" in sys.argv else None)
    executor = LocalExecutor(1 if "--one" in sys.argv else 2)
    job = job_module.Job(inputs, Path(sys.argv[2]), PLAIN, executor, budget)
    first = job.wind_up if "--wind-up" in sys.argv else None
    try:
        with interruptible(first):
            for result in job.run():
                print(result.entry.status, flush=True)
    except KeyboardInterrupt as stopped:
        print(job.state, job.left, flush=True)
        return 143 if isinstance(stopped, Terminated) else 130
    print(job.state, job.left, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
