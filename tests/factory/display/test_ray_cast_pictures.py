"""Pictures show what they say: the open door is where it swings, the fault where it is."""

import hashlib
import io
import os
import sys
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from command_line import ran
from export_samples import cabinet
from PIL import Image
from repository import SAMPLES

from asset_factory.factory.display.camera import Viewpoint
from asset_factory.factory.display.casting import Caster, Shot
from asset_factory.factory.display.made import plain_surface, scene_of
from asset_factory.factory.display.pictures import FRAMES, HEIGHT, WIDTH, Fault, pictures_of
from asset_factory.factory.display.scene import SceneGraph, SceneJoint
from asset_factory.factory.display.shading import still
from asset_factory.factory.display.sheet import MOST, SheetCell, contact_sheet

FAULT = Fault({"hinge": 0.8}, (0.1, -0.3, 0.25))


@pytest.fixture(scope="module")
def scene():
    return scene_of(cabinet())


@pytest.fixture(scope="module")
def pictures(scene):
    return pictures_of(scene, FAULT)


def pixels(data):
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGBA")).astype(int)


def test_the_same_scene_gives_the_same_bytes_here_and_in_another_process(scene, pictures):
    assert pictures_of(scene, FAULT) == pictures
    told = (
        "import hashlib; from export_samples import cabinet\n"
        "from asset_factory.factory.display.made import scene_of\n"
        "from asset_factory.factory.display.pictures import Fault, pictures_of\n"
        f"made = pictures_of(scene_of(cabinet()), {FAULT})\n"
        "print(hashlib.sha256(repr(made).encode()).hexdigest())\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(SAMPLES), *sys.path])}
    there = ran(sys.executable, "-c", told, env=environment)
    assert there.strip() == hashlib.sha256(repr(pictures).encode()).hexdigest()


def test_the_door_is_where_it_swings(scene):
    camera = Viewpoint(scene).camera(WIDTH, HEIGHT)
    caster = Caster(scene, scene.visuals)
    closed, opened = (scene.opened(amount) for amount in (0.0, 1.0))
    shots = [Shot(caster, camera, values) for values in (closed, opened)]
    before, after = (shot.see().link.reshape(HEIGHT, WIDTH) for shot in shots)
    one, other = (still(shot).astype(int) for shot in shots)
    differs = np.abs(one - other).max(axis=2) > 24
    assert differs[(after == 1) & (before == -1)].mean() > 0.95
    assert differs[(after == 0) & (before == 0)].mean() < 0.05


def test_everything_is_in_the_picture_and_seen_from_the_front(scene):
    camera = Viewpoint(scene).camera(WIDTH, HEIGHT)
    assert camera.eye[1] < -1.0
    assert camera.eye[2] > 0.4
    for amount in (0.0, 0.5, 1.0):
        hits = Shot(Caster(scene, scene.visuals), camera, scene.opened(amount)).see()
        seen = (hits.link >= 0).reshape(HEIGHT, WIDTH)
        assert seen.any()
        border = seen[[0, -1]].any() or seen[:, [0, -1]].any()
        assert not border


def test_a_lid_is_seen_from_where_it_lets_one_in():
    def box(link, low, high):
        shape = trimesh.creation.box(bounds=(low, high))
        return plain_surface(link, shape.vertices, shape.faces)

    back = np.eye(4)
    back[:3, 3] = (0.0, 0.2, 0.4)
    hinge = SceneJoint("hinge", "revolute", 0, 1, back, np.array([-1.0, 0.0, 0.0]), 0.0, 1.6)
    body = box(0, (-0.3, -0.2, 0.0), (0.3, 0.2, 0.4))
    lid = box(1, (-0.3, -0.4, 0.0), (0.3, 0.0, 0.02))
    chest = SceneGraph("chest", ("body", "lid"), (hinge,), (body, lid))
    assert Viewpoint(chest).camera(WIDTH, HEIGHT).eye[1] < -1.0


def test_rays_and_projection_agree(scene):
    camera = Viewpoint(scene).camera(WIDTH, HEIGHT)
    places = np.array([[10.5, 20.5], [300.5, 200.5]])
    points = camera.eye + 3.0 * camera.rays(places)
    assert camera.places(points)[:, :2] == pytest.approx(places)


def test_the_fault_is_marked_where_it_is(scene, pictures):
    camera = Viewpoint(scene).camera(WIDTH, HEIGHT, {**scene.opened(0.0), **FAULT.values})
    column, row, _ = camera.places(np.array([FAULT.point]))[0]
    picture = pixels(pictures.fault)
    around = picture[int(row) - 22 : int(row) + 23, int(column) - 22 : int(column) + 23]
    red = (around[..., 0] > 170) & (around[..., 1] < 110) & (around[..., 3] > 200)
    assert red.sum() > 60
    assert pictures_of(scene).fault == b""


def test_the_animation_goes_there_and_back_and_what_is_fixed_has_none(scene, pictures):
    with Image.open(io.BytesIO(pictures.moving)) as moving:
        assert moving.n_frames == 2 * FRAMES - 2
    fixed = tuple(replace(j, kind="fixed", lower=0.0, upper=0.0) for j in scene.joints)
    assert pictures_of(replace(scene, joints=fixed)).moving == b""


def test_hulls_have_a_colour_each(pictures):
    seen = pixels(pictures.hulls)
    colors = seen[seen[..., 3] == 255][:, :3]
    hue = np.argmax(colors, axis=1)
    assert len(np.unique(hue)) == 3


def test_a_scene_without_surfaces_is_an_empty_picture(scene):
    assert pixels(pictures_of(replace(scene, visuals=(), hulls=())).closed)[..., 3].max() == 0


def test_a_contact_sheet_holds_all_and_is_bounded(pictures):
    told = ("passed", "\u202e<b>x</b>")
    cells = [SheetCell(pictures.closed, f"cabinet-{n}" * 9, *told) for n in range(8)]
    sheet = contact_sheet(cells)
    assert sheet == contact_sheet(cells)
    with Image.open(io.BytesIO(sheet)) as opened:
        assert opened.format == "PNG"
        width, height = opened.size
    assert width > height
    with Image.open(io.BytesIO(contact_sheet([SheetCell(b"", "x", "unjudged")] * 1000))) as many:
        assert many.size[1] < (MOST / 6 + 1) * 230
