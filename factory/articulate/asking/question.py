"""All that somebody is shown and told of one input."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ...config import BuildConfig
from ...intake.source import Source
from ...intake.stated import Hinge, StatedKind
from ...mesh import Mesh
from .sheet import sheet_of

_TEXT = """\
You see one object, from a file named {name!r}: the side that shows most large, coloured and shaded,
an oblique view, and below the other sides and the top, each coloured and shaded. FRONT is only
where the file has its front: name the side on which you see a part. Left and right are those of
somebody who stands before FRONT. Over each side lies a blue grid of tenths: x runs from 0 at the
left end of the object on that side to 1 at its right end, y from 0 at the bottom to 1 at the top
(on TOP the back is up). Dark lines are steps in depth, grooves and creases.

Say which parts of the real object would open, slide or turn, as one JSON object:

{{"parts": [{{"kind": ..., "side": ..., "box": [left, bottom, right, top], "hinge": ...}}, ...]}}

- kind: one of {kinds}.
- side: the side that shows it: front, back, left, right or top.
- box: its outline there, to a hundredth: the part that moves with its frame, not its handle alone.
  Follow the outermost dark line of its gap; where none is drawn, say where it would be. Boxes of
  two parts of one side do not overlap, unless one carries the other, as a door its dial.
- hinge: one of {hinges}. Of a door, a flap or a lever the
  edge of its box where it is hinged; of a lid the edge of the object. Leave it out for what slides
  or turns about its middle, and where nothing shows it.
- A lid on top: the box on an upright side whose lower edge is the seam; all above it opens. A
  hatch, a seat or a sloping lid that is best seen from above: side top.
- "also": [{{"side": ..., "box": [...]}}] where a second side bounds how deep it is: for a seat
  before a tank, a wheel between forks.
- "drawn": degrees or millimetres that it stands open in these pictures, or "open".
- "alternatives": [{{"kind": ...}}, {{"hinge": ...}}] where it may be otherwise.
- Knobs, buttons and wheels only if they are parts of their own here, and turn or give way on the
  real object. No hinges, no door handles, no feet, nothing that merely lies there.
- If nothing opens: {{"opens": false}}.

Example, a fridge with two doors hinged on its right: {{"parts": [
{{"kind": "door", "side": "front", "box": [0.0, 0.64, 1.0, 1.0], "hinge": "right"}},
{{"kind": "door", "side": "front", "box": [0.0, 0.08, 1.0, 0.63], "hinge": "right"}}]}}

Answer with the JSON object alone.
"""


@dataclass(frozen=True)
class Question:
    """The question about one input.

    Attributes:
        sheet: a PNG of its sides.
        instruction: how to answer.
    """

    sheet: bytes
    instruction: str


def question_of(mesh: Mesh, name: str) -> Question:
    """Return the question about a mesh [m], z up, of a file of that name."""
    shown = "".join(letter if letter.isprintable() else " " for letter in name)[:80]
    text = _TEXT.format(name=shown, kinds=", ".join(StatedKind), hinges=", ".join(Hinge))
    return Question(sheet_of(mesh), text)


def question_about(source: Path, config: BuildConfig) -> Question:
    """Return the question about one input.

    Args:
        source: a mesh file.
        config: how to load it.
    """
    intake = Source(source, config).load()
    return question_of(intake.mesh, intake.provenance.input)
