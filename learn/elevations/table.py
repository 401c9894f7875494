"""Judges as a table of figures."""

from __future__ import annotations

from collections.abc import Mapping

from asset_factory.factory.articulate.seams import features
from asset_factory.factory.articulate.seams.learned import LearnedJudge
from asset_factory.factory.mesh import FloatArray

NAMES = {"panel": features.NAMES, "motion": features.MOTION_NAMES}
HEAD = """# What the articulator of one-piece meshes learned from pictures of {objects} generated
# objects (see articulate/seams/learned.py). Made by:
# python -m asset_factory.learn.elevations judge configs/seams.toml --kept FOLDER
"""


def table_of(judges: Mapping[str, LearnedJudge], objects: int) -> str:
    """TOML text of judges."""
    lines = [HEAD.format(objects=objects)]
    for name, judge in judges.items():
        quoted = ", ".join(f'"{each}"' for each in NAMES[name])
        lines += [f"[{name}]", f"features = [{quoted}]"]
        lines += [f"mean = {_row(judge.mean)}", f"scale = {_row(judge.scale)}"]
        for key, values in (("hidden", judge.hidden), ("out", judge.out)):
            lines.append(f"{key} = [")
            lines += [f"    {_row(row)}," for row in values]
            lines.append("]")
        lines.append("")
    return "\n".join(lines)


def _row(values: FloatArray) -> str:
    return "[" + ", ".join(f"{float(value):.4g}" for value in values) + "]"
