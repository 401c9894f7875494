"""A small cabinet as a URDF of boxes, and a list that names it."""

from asset_factory.factory.runtime.store import digest_file
from asset_factory.learn.evaluate.listing import COLUMNS, half_of

URDF = """<robot name="{name}">
  <link name="body"><visual><origin xyz="0 0 0.5"/>
    <geometry><box size="0.4 0.6 1.0"/></geometry></visual></link>
  <link name="door"><visual><origin xyz="0.01 0.29 0"/>
    <geometry><box size="0.02 0.58 {height}"/></geometry></visual></link>
  <link name="drawer"><visual><geometry><box size="0.02 0.58 0.2"/></geometry></visual></link>
  <joint name="hinge" type="revolute"><parent link="body"/><child link="door"/>
    <origin xyz="0.2 -0.29 0.65"/><axis xyz="0 0 -1"/>
    <limit lower="0" upper="1.5" effort="1" velocity="1"/></joint>
  <joint name="rail" type="prismatic"><parent link="body"/><child link="drawer"/>
    <origin xyz="0.21 0 0.15"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.3" effort="1" velocity="1"/></joint>
</robot>
"""


def write_cabinets(folder):
    """Cabinets with their fronts at +X, and ``list.csv``; returns that."""
    lines = [",".join(COLUMNS)]
    for number, name in enumerate(("one", "two")):
        path = folder / "made" / name / f"{name}.urdf"
        path.parent.mkdir(parents=True)
        path.write_text(URDF.format(name=name, height=0.6 - 0.1 * number))
        relative = path.relative_to(folder).as_posix()
        values = relative, "made", "cabinet", digest_file(path), relative, half_of(relative), "-90"
        lines.append(",".join(values))
    target = folder / "list.csv"
    target.write_text("\n".join(lines) + "\n")
    return target
