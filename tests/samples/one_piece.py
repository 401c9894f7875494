"""Meshes as image-to-3D gives them: one closed surface, seams as grooves, handles fused on."""

from dataclasses import replace

import numpy as np
import trimesh
from manifold3d import CrossSection, Manifold
from stated_parts import block

from asset_factory.factory.mesh import Material, Mesh

#: Depth and width of an engraved seam, as generated meshes have them [m, on objects of a metre].
GROOVE = 0.006
#: No longer edge, so that meshes are dense [m].
EDGE = 0.05


def _engraved(solid, *lines):
    """Grooves in the plane y = 0; lines run from (x, z) to (x, z) along an axis."""
    half = GROOVE / 2.0
    for (x0, z0), (x1, z1) in lines:
        groove = block((x0 - half, -1.0, z0 - half), (x1 + half, GROOVE, z1 + half))
        solid -= groove
    return solid


def frame(x0, z0, x1, z1):
    """The four sides of a rectangle."""
    return (((x0, z0), (x1, z0)), ((x0, z1), (x1, z1)), ((x0, z0), (x0, z1)), ((x1, z0), (x1, z1)))


def bar(low, high, off=0.03):
    """A bar handle that touches the front y = 0 over its whole length."""
    return block((low[0], -off, low[1]), (high[0], 0.001, high[1]))


def _knob(x, z, off=0.035):
    knob = Manifold.cylinder(off + 0.001, 0.02, circular_segments=24)
    return knob.rotate([90.0, 0.0, 0.0]).translate([x, 0.001, z])


def mesh_of(solid, edge):
    """Its surface, with no edge longer than that [m], as dense meshes have."""
    raw = solid.refine_to_length(edge).to_mesh()
    vertices = np.asarray(raw.vert_properties, dtype=float)[:, :3]
    return Mesh.from_triangles(vertices, raw.tri_verts, Material("plain", (0.5, 0.5, 0.5, 1.0)))


def fridge(edge=EDGE):
    """Two doors above each other, bars on the left, so hinged on the right."""
    solid = block((0.0, 0.0, 0.0), (0.6, 0.6, 1.6))
    solid = _engraved(solid, ((0.0, 1.1), (0.6, 1.1)))
    solid += bar((0.05, 1.15), (0.075, 1.4)) + bar((0.05, 0.75), (0.075, 1.05))
    return mesh_of(solid, edge)


def drawers(edge=EDGE):
    """Three drawers in a frame, a bar on each."""
    solid = block((0.0, 0.0, 0.0), (0.8, 0.5, 0.9))
    for low, high in ((0.06, 0.32), (0.34, 0.6), (0.62, 0.86)):
        solid = _engraved(solid, *frame(0.04, low, 0.76, high))
        middle = (low + high) / 2.0
        solid += bar((0.3, middle - 0.012), (0.5, middle + 0.012))
    return mesh_of(solid, edge)


def doors(edge=EDGE):
    """A pair of doors with upright bars beside the middle."""
    solid = block((0.0, 0.0, 0.0), (0.9, 0.5, 1.0))
    for low, high in ((0.03, 0.448), (0.452, 0.87)):
        solid = _engraved(solid, *frame(low, 0.04, high, 0.96))
    solid += bar((0.39, 0.45), (0.41, 0.7)) + bar((0.49, 0.45), (0.51, 0.7))
    return mesh_of(solid, edge)


def bin_with_lid(edge=EDGE):
    """A tapered bin with an overhanging lid that bulges."""
    body = CrossSection.square([0.5, 0.6], center=True).extrude(0.8, scale_top=[1.15, 1.15])
    rim = block((-0.31, -0.37, 0.8), (0.31, 0.37, 0.86))
    dome = CrossSection.square([0.6, 0.72], center=True).extrude(0.1, scale_top=[0.7, 0.7])
    solid = body + rim + dome.translate([0.0, 0.0, 0.86])
    return mesh_of(solid, edge)


def stove(edge=EDGE):
    """A cooktop that overhangs, three knobs in a row, and an oven door with a bar on top."""
    solid = block((0.0, 0.0, 0.0), (0.7, 0.6, 0.86)) + block((-0.01, -0.01, 0.86), (0.71, 0.6, 0.9))
    solid = _engraved(solid, *frame(0.02, 0.12, 0.68, 0.7))
    for x in (0.28, 0.35, 0.42):
        solid += _knob(x, 0.78)
    solid += bar((0.1, 0.63), (0.6, 0.655))
    return mesh_of(solid, edge)


def thick_doors(edge=EDGE):
    """Two doors over the whole front, 0.1 m thick, as a groove on the sides and on top shows."""
    solid = block((0.0, 0.0, 0.0), (0.9, 0.7, 1.6))
    solid = _engraved(solid, ((0.45, 0.0), (0.45, 1.6)))
    half = GROOVE / 2.0
    around = block((-1.0, 0.1 - half, -1.0), (2.0, 0.1 + half, 2.0))
    solid -= around - block((GROOVE, -1.0, -1.0), (0.9 - GROOVE, 1.0, 1.6 - GROOVE))
    solid += bar((0.39, 0.6), (0.41, 1.1)) + bar((0.49, 0.6), (0.51, 1.1))
    return mesh_of(solid, edge)


def tall_drawers(edge=EDGE):
    """Three drawers over the whole width, each with a bar at its top, the lowest tall."""
    solid = block((0.0, 0.0, 0.0), (0.5, 0.5, 0.9))
    for low, high in ((0.02, 0.42), (0.43, 0.71), (0.72, 0.88)):
        solid = _engraved(solid, *frame(0.02, low, 0.48, high))
        solid += bar((0.15, high - 0.05), (0.35, high - 0.03))
    return mesh_of(solid, edge)


def bars_that_meet(edge=EDGE):
    """Two panels above two, each with a long bar at the seam between the rows."""
    solid = block((0.0, 0.0, 0.0), (0.9, 0.4, 0.9))
    for left, right in ((0.03, 0.445), (0.455, 0.87)):
        for low, high, at in ((0.03, 0.445, 0.4), (0.455, 0.87, 0.5)):
            solid = _engraved(solid, *frame(left, low, right, high))
            solid += bar((left + 0.05, at - 0.01), (right - 0.05, at + 0.01))
    return mesh_of(solid, edge)


def filing_cabinet(edge=EDGE):
    """Five drawers above each other, a bar on each: handles, no controls."""
    solid = block((0.0, 0.0, 0.0), (0.5, 0.6, 1.3))
    for low in (0.03, 0.28, 0.53, 0.78, 1.03):
        solid = _engraved(solid, *frame(0.02, low, 0.48, low + 0.24))
        solid += bar((0.15, low + 0.18), (0.35, low + 0.2))
    return mesh_of(solid, edge)


def cooktop(edge=EDGE):
    """A flat box under a plate that overhangs, with four knobs in a row on it."""
    solid = block((0.0, 0.0, 0.0), (0.8, 0.5, 0.08)) + block(
        (-0.02, -0.02, 0.08), (0.82, 0.52, 0.1)
    )
    for x in (0.2, 0.3, 0.4, 0.5):
        knob = Manifold.cylinder(0.03, 0.02, circular_segments=24)
        solid += knob.translate([x, 0.06, 0.099])
    return mesh_of(solid, edge)


def microwave(edge=EDGE):
    """A door without a handle beside three knobs, one above the other."""
    solid = block((0.0, 0.0, 0.0), (0.6, 0.4, 0.35))
    solid = _engraved(solid, *frame(0.015, 0.015, 0.45, 0.335))
    for z in (0.1, 0.16, 0.22):
        solid += _knob(0.525, z)
    return mesh_of(solid, edge)


def doors_with_grown_knobs(edge=EDGE):
    """A pair of doors whose knobs touch over the seam between them."""
    solid = block((0.0, 0.0, 0.0), (0.9, 0.5, 0.8))
    for low, high in ((0.03, 0.45), (0.45, 0.87)):
        solid = _engraved(solid, *frame(low, 0.04, high, 0.76))
    solid += _knob(0.43, 0.5) + _knob(0.47, 0.5)
    return mesh_of(solid, edge)


def buttons(edge=EDGE):
    """A box with four low round buttons in a row: pressed, not turned."""
    solid = block((0.0, 0.0, 0.0), (0.6, 0.5, 0.9))
    for x in (0.2, 0.26, 0.32, 0.38):
        solid += _knob(x, 0.8, off=0.008)
    return mesh_of(solid, edge)


def bar_across(edge=EDGE):
    """An oven: its door is all of the front but a strip above, with a bar from side to side."""
    solid = block((0.0, 0.0, 0.0), (0.7, 0.6, 0.85))
    solid = _engraved(solid, ((0.0, 0.7), (0.7, 0.7)))
    solid += block((0.0, -0.04, 0.62), (0.7, 0.001, 0.645))
    return mesh_of(solid, edge)


def moulding(edge=EDGE):
    """A box with a flat ledge across its front: no handle."""
    solid = block((0.0, 0.0, 0.0), (0.7, 0.6, 0.85))
    solid = _engraved(solid, ((0.0, 0.7), (0.7, 0.7)))
    solid += block((0.0, -0.01, 0.6), (0.7, 0.001, 0.645))
    return mesh_of(solid, edge)


def proud_drawers(edge=EDGE):
    """A low desk's two drawers, whose fronts stand before the frame, a small bar on each."""
    solid = block((0.0, 0.0, 0.0), (1.4, 0.6, 0.75)) - block((0.06, -1.0, -1.0), (1.34, 1.0, 0.6))
    for low in (0.1, 0.72):
        solid += block((low, -0.01, 0.63), (low + 0.58, 0.001, 0.72))
        solid += bar((low + 0.25, 0.67), (low + 0.33, 0.685), off=0.035)
    return mesh_of(solid, edge)


def bumpy(mesh):
    """The same with every vertex a little off, as image-to-3D tools give it."""
    rng = np.random.default_rng(0)
    off = rng.normal(0.0, 7e-4 * mesh.extents.max(), mesh.vertices.shape)
    return replace(mesh, vertices=mesh.vertices + off)


def plain_box(edge=EDGE):
    """Nothing opens."""
    return mesh_of(block((0.0, 0.0, 0.0), (0.6, 0.5, 0.9)), edge)


def write_oven(folder):
    """A plain box as GLB, a dishwasher without a seam: rejected as it is; returns the file."""
    mesh = plain_box()
    path = folder / "oven.glb"
    # z up to glTF's y up.
    y_up = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
    trimesh.Trimesh(mesh.vertices @ y_up, mesh.faces, process=False).export(path)
    return path


def table(edge=EDGE):
    """Four legs under a slab: nothing opens."""
    solid = block((0.0, 0.0, 0.7), (1.2, 0.7, 0.75))
    for x in (0.03, 1.11):
        for y in (0.03, 0.61):
            solid += block((x, y, 0.0), (x + 0.06, y + 0.06, 0.71))
    return mesh_of(solid, edge)
