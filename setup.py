"""Give the package README as its description, with links that hold away from the repository."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from setuptools import setup

ROOT = Path(__file__).resolve().parent
LINK = re.compile(r"(!?)\[([^\]]*)\]\((?!\w+:|#)([^)]+)\)")


def absolute(text: str, source: str) -> str:
    """Return Markdown whose relative links lead to the files of a repository at an address."""

    def lead(link: re.Match[str]) -> str:
        return f"{link[1]}[{link[2]}]({source}/{'raw' if link[1] else 'blob'}/main/{link[3]})"

    return LINK.sub(lead, text)


if __name__ == "__main__":
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    setup(
        long_description=absolute(
            (ROOT / "README.md").read_text(encoding="utf-8"), project["urls"]["Source"]
        ),
        long_description_content_type="text/markdown",
    )
