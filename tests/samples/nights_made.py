"""Made-up attempts and nights."""

from asset_factory.factory.jobs.nightly.attempt import Attempt
from asset_factory.factory.jobs.nightly.night import Night, tally


def attempt(name, status="passed", *, digest="aaaaaaaaaa", reason=None, **more):
    """An attempt at ``meshes/<name>.glb``; what did not pass has a reason and a sentence."""
    reason = (
        reason
        if reason is not None
        else {"passed": "", "rejected": "jammed", "unjudged": "build_crashed"}[status]
    )
    said = f"{name} is {reason}" if reason else ""
    more.setdefault("message", said)
    return Attempt(f"{name}-{digest}", f"meshes/{name}.glb", status, reason, **more)


def night(name, attempts=(), **more):
    """The figures of a night with these attempts."""
    more.setdefault(
        "started",
        f"2026-11-{int(name):02d}T01:00:00Z" if name.isdecimal() else "2026-11-01T01:00:00Z",
    )
    return Night(name, found=len(attempts), **{**tally(attempts), **more})
