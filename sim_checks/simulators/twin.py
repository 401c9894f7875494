"""A URDF's collision-only twin: the same physics without visuals, on which loaders may fail."""

from __future__ import annotations

import shutil
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..description import DescriptionError
from ..read.document import find_file, parse_document
from ..read.references import SRDF

#: What MuJoCo must be told so that it neither fuses links nor forgets folders.
MUJOCO_COMPILER = {"fusestatic": "false", "strippath": "false", "discardvisual": "true"}


@contextmanager
def twin_of(urdf: Path, *, for_mujoco: bool = False) -> Iterator[str]:
    """Write a URDF without visuals and materials, mesh paths absolute; removed when left.

    Its SRDF goes beside it; for MuJoCo, its compiler's settings are added.

    Raises:
        ValueError: if the file is not XML with a ``robot`` at its root (:class:`DescriptionError`
            is one).
    """
    root = parse_document(urdf)
    if root.tag != "robot":
        raise ValueError(f"{urdf.name} starts with <{root.tag}>, a URDF starts with <robot>")
    for material in root.findall("material"):
        root.remove(material)
    for link in root.findall("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    for mesh in root.iter("mesh"):
        mesh.set("filename", str(resolve(mesh.get("filename", ""), urdf.parent)))
    if for_mujoco:
        mujoco = root.find("mujoco")
        mujoco = ET.SubElement(root, "mujoco") if mujoco is None else mujoco
        compiler = mujoco.find("compiler")
        compiler = ET.SubElement(mujoco, "compiler") if compiler is None else compiler
        compiler.attrib.pop("meshdir", None)
        compiler.attrib.update(MUJOCO_COMPILER)
    with tempfile.TemporaryDirectory(prefix="twin-") as folder:
        target = Path(folder) / "twin.urdf"
        ET.ElementTree(root).write(target, encoding="unicode")
        srdf = urdf.with_suffix(SRDF)
        if srdf.is_file():
            shutil.copyfile(srdf, target.with_suffix(SRDF))
        yield str(target)


def resolve(reference: str, folder: Path) -> Path:
    """Return the mesh that a URDF in ``folder`` means, or the plain path, for engines to refuse."""
    try:
        return find_file(reference, folder)
    except DescriptionError:
        return (folder / reference).absolute()
