"""Tables of results: what a person wrote of them stays, what was measured is renewed."""

from __future__ import annotations

import datetime
import json
import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

RESULTS = Path(__file__).resolve().parent / "results"


def renew(name: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Write commit, date, columns and rows of a file of results anew, and keep the rest of it."""
    path = RESULTS / f"{name}.toml"
    head = ["git", "rev-parse", "--short=7", "HEAD"]
    commit = subprocess.run(head, cwd=RESULTS, check=True, capture_output=True, text=True).stdout
    kept = re.sub(r"^columns = .*", "", path.read_text(), flags=re.DOTALL | re.MULTILINE)
    kept = re.sub(r"^commit = .*$", f'commit = "{commit.strip()}"', kept, flags=re.MULTILINE)
    today = datetime.datetime.now(datetime.UTC).date()
    kept = re.sub(r"^date = .*$", f"date = {today}", kept, flags=re.MULTILINE)
    lines = [f"    {json.dumps(list(row), ensure_ascii=False)}," for row in rows]
    table = "\n".join((f"columns = {json.dumps(list(columns))}", "rows = [", *lines, "]", ""))
    path.write_text(kept + table)
