"""Parts in, hulls out; bad parts end in hulls with a sentence or a rejection, within limits."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from manufactured import decomposed
from plain_solids import parted
from refusing import refusal

from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.config import DecomposeConfig
from asset_factory.factory.errors import Unjudged
from asset_factory.factory.manufacture.decompose import ladder, methods
from asset_factory.factory.manufacture.decompose.convex import depth_below, hull_of, surface_points
from asset_factory.factory.manufacture.decompose.cut import halve
from asset_factory.factory.manufacture.decompose.methods import SolidPieces, split_closely
from asset_factory.factory.manufacture.decompose.outside import uncovered
from asset_factory.factory.manufacture.decompose.room import NOWHERE
from asset_factory.factory.manufacture.decompose.solids import (
    manifold_of,
    manifold_of_hull,
    triangles_of,
    union,
)
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.runtime.store import Store
from asset_factory.sim_checks.processes.isolation import Failure, Limits, Outcome, run_isolated

CONFIG = DecomposeConfig(resolution=300, iterations=20, nodes=5)


def one_part(vertices, faces):
    mesh = Mesh.from_triangles(vertices, faces)
    return Articulation(mesh, (Part("body", np.arange(len(mesh.faces))),), (), "rigid")


def boxes(*specs):
    made = [trimesh.creation.box(size).apply_translation(at) for size, at in specs]
    whole = trimesh.util.concatenate(made)
    return np.array(whole.vertices), np.array(whole.faces)


def only(vertices, faces, config=CONFIG):
    return decomposed(one_part(vertices, faces), config)[0]


def cover_volume(result):
    return float(union([manifold_of_hull(hull) for hull in result.hulls]).volume())


def torus():
    made = trimesh.creation.torus(0.1, 0.03, major_sections=24, minor_sections=12)
    return np.array(made.vertices), np.array(made.faces)


def torus_solid():
    solid = manifold_of(*torus())
    assert solid is not None
    return solid


def test_boards_that_touch_are_one_hull_each_and_keep_their_cavity():
    sides = [((0.02, 0.4, 0.8), (x, 0, 0)) for x in (-0.29, 0.29)]
    back, top = ((0.6, 0.02, 0.8), (0, 0.2, 0)), ((0.56, 0.38, 0.02), (0, 0, 0.39))
    result = only(*boxes(back, *sides, top))
    assert (result.method, len(result.hulls)) == ("exact", 4)
    inside = np.random.default_rng(0).uniform(-1, 1, (500, 3)) * [0.27, 0.18, 0.37]
    assert max(depth_below(hull, inside).max() for hull in result.hulls) < 0.0


@pytest.mark.parametrize("step", [1, -1], ids=["proper", "inside_out"])
def test_a_hollow_body_keeps_its_cavity(step):
    outer = boxes(((0.4, 0.4, 0.4), (0, 0, 0)))
    inner = boxes(((0.36, 0.36, 0.36), (0, 0, 0)))
    faces = np.concatenate([outer[1], inner[1][:, ::-1] + len(outer[0])])
    result = only(np.concatenate([outer[0], inner[0]]), faces[:, ::step])
    assert result.method == "exact"
    assert cover_volume(result) == pytest.approx(0.4**3 - 0.36**3)


def test_a_part_that_is_nearly_convex_is_one_hull():
    result = only(*boxes(((0.4, 0.3, 0.2), (0, 0, 0)), ((0.4, 0.3, 0.2), (0.002, 0.002, 0.0))))
    assert (result.method, len(result.hulls)) == ("single", 1)


def test_a_carrier_has_no_hulls():
    vertices, faces = boxes(((0.4, 0.3, 0.2), (0, 0, 0)))
    mesh = Mesh.from_triangles(vertices, faces)
    joint = Joint("slide", JointKind.PRISMATIC, 0, 1, np.array([0, 0, 1.0]), np.zeros(3), 0.0, 0.1)
    results = decomposed(parted({"body": [mesh], "carrier": []}, joint), CONFIG)
    assert results[1] == SolidPieces((), "none")


def test_coacd_covers_a_curved_solid_keeps_its_hole_and_repeats_itself():
    first, again = (ladder.search(torus_solid(), 0.01, CONFIG) for _ in range(2))
    assert (first.method, first.degraded) == ("coacd", ())
    assert uncovered(first.hulls, surface_points(*torus())) < 0.002
    assert max(depth_below(hull, np.zeros((1, 3))).max() for hull in first.hulls) < -0.03
    one, other = ([hull.vertices.tobytes() for hull in each.hulls] for each in (first, again))
    assert one == other


def test_a_curved_part_is_covered_and_a_cache_hit_equals_a_miss(tmp_path, monkeypatch):
    articulation = one_part(*torus())
    store = Store(tmp_path)
    config = replace(CONFIG, error_m=0.015)
    first, anew = (decomposed(articulation, config, place)[0] for place in (store, None))
    assert all(len(hull.vertices) <= config.max_vertices for hull in first.hulls)
    assert uncovered(first.hulls, surface_points(*torus())) < 0.003
    monkeypatch.setattr("asset_factory.factory.manufacture.decompose.decompose.split_part", None)
    kept = decomposed(articulation, replace(config, wall_s=1.0), store)[0]
    for other in (kept, anew):
        assert (other.method, other.degraded) == (first.method, first.degraded)
        for a, b in zip(first.hulls, other.hulls, strict=True):
            assert a.vertices.tobytes() == b.vertices.tobytes()
            assert a.faces.tobytes() == b.faces.tobytes()
    with pytest.raises(TypeError):
        decomposed(articulation, replace(config, error_m=0.001), store)


CUBE = boxes(((0.2, 0.2, 0.2), (0, 0, 0)))


@pytest.mark.parametrize(
    ("name", "vertices", "faces", "volume"),
    [
        ("duplicated faces", CUBE[0], np.concatenate([CUBE[1], CUBE[1]]), 0.008),
        ("double-sided faces", CUBE[0], np.concatenate([CUBE[1], CUBE[1][:, ::-1]]), 0.008),
        ("inverted", CUBE[0], CUBE[1][:, ::-1], 0.008),
        ("wound both ways", CUBE[0], np.concatenate([CUBE[1][::2, ::-1], CUBE[1][1::2]]), 0.008),
        ("overlapping bodies", *boxes(*(((0.2, 0.2, 0.2), [at] * 3) for at in (0, 0.1))), 0.015),
        ("unreferenced vertices", np.concatenate([CUBE[0], [[9.0, 9.0, 9.0]]]), CUBE[1], 0.008),
        ("far away", CUBE[0] + 1e4, CUBE[1], 0.008),
    ],
)
def test_inputs_that_break_coacd_come_out_exact(name, vertices, faces, volume):
    result = only(vertices, faces)
    assert (result.method, result.degraded) == ("exact", ()), name
    assert cover_volume(result) == pytest.approx(volume, rel=1e-6)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        ([[0, 0, 0], [0.3, 0, 0], [0.3, 0.2, 0], [0, 0.2, 0]], [[0, 1, 2], [0, 2, 3]]),
        ([[0, 0, 0], [0.3, 0, 0], [0, 0.2, 0]], [[0, 1, 2]]),
        (CUBE[0], CUBE[1][2:]),
    ],
)
def test_open_surfaces_become_thin_slabs(vertices, faces):
    vertices = np.asarray(vertices, dtype=float)
    faces = np.asarray(faces)
    result = only(vertices, faces)
    assert result.method == "sheets"
    assert uncovered(result.hulls, surface_points(vertices, faces)) < 1e-9
    area = trimesh.Trimesh(vertices, faces, process=False).area
    assert cover_volume(result) <= 1.01 * area * CONFIG.shell_m


def test_a_wide_pipe_with_a_hidden_end_is_closed_unless_it_is_said_to_be_hollow():
    closed = trimesh.creation.cylinder(0.04, 0.8, sections=24)
    lying = closed.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0]))
    open_end = lying.triangles_center[:, 0] > 0.4 - 1e-6
    pipe = np.array(lying.vertices), np.array(lying.faces[~open_end])
    middle = np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]])

    def filled(result):
        return max(float(depth_below(hull, middle).max()) for hull in result.hulls) > 0.0

    assert filled(only(*pipe))
    walls = decomposed(one_part(*pipe), CONFIG, hollow={"body"})[0]
    assert not filled(walls)
    assert uncovered(walls.hulls, surface_points(*pipe)) < CONFIG.error_m


def test_a_part_of_dust_is_rejected():
    dust = np.array([[0, 0, 0], [1e-7, 0, 0], [0, 1e-7, 0]])
    found = refusal(only, dust, np.array([[0, 1, 2]]))
    assert (found.code, "body" in found.message) == ("decomposition_failed", True)


def test_a_crashing_engine_costs_a_found_and_leaves_a_sentence(monkeypatch):
    asked = []

    def broken(function, *args, limits):
        asked.append(function)
        return Outcome(None, Failure.CRASHED, "killed by SIGSEGV", "", 0.1)

    monkeypatch.setattr(ladder, "run_isolated", broken)
    found = ladder.search(torus_solid(), 0.01, CONFIG)
    assert (found.method, "SIGSEGV" in found.degraded[0]) == ("halved", True)
    # A crash is believed when it comes again.
    assert asked == [ladder.coacd_pieces] * 2
    rough = ladder.search(torus_solid(), 1e-5, CONFIG)
    assert (rough.method, len(rough.hulls), len(rough.degraded)) == ("hull", 1, 3)


@pytest.mark.parametrize("outside", [0.004, 0.001])
def test_halves_cover_a_solid_and_stand_out_of_it_no_further_than_asked(outside):
    solid = torus_solid()
    halves = halve(solid, outside, 64)
    cover = union([manifold_of_hull(hull) for hull in halves])
    assert 1 < len(halves) < 64
    assert (solid - cover).volume() == pytest.approx(0.0, abs=1e-6 * solid.volume())
    assert (cover - solid).volume() <= outside * solid.surface_area()
    assert len(halve(solid, 0.0, 5)) in (5, 6)


@pytest.mark.parametrize(
    ("outcome", "code"),
    [
        (Outcome(None, Failure.TIMEOUT, "no answer within 60 s", "", 60.0), "timeout"),
        (Outcome(None, Failure.CRASHED, "killed by SIGKILL", "", 0.1, killed=True), "killed"),
    ],
)
def test_what_a_clock_or_somebody_stopped_is_unjudged_and_not_kept(
    monkeypatch, tmp_path, outcome, code
):
    monkeypatch.setattr(ladder, "run_isolated", lambda *_, limits: outcome)
    monkeypatch.setattr(methods, "METHODS", (ladder.search,))
    with pytest.raises(Unjudged) as caught:
        decomposed(one_part(*torus()), CONFIG, Store(tmp_path))
    assert caught.value.finding.code == f"decomposition_{code}"
    assert caught.value.finding.stopped
    assert outcome.detail in str(caught.value)
    assert not list(tmp_path.rglob("*.npz"))


def blob(segments, at=0.0):
    """A ball with dents deeper than any error, too many to become a few convex pieces."""
    ball = trimesh.creation.uv_sphere(radius=1.0, count=[segments, segments])
    rng = np.random.default_rng(0)
    height = np.zeros(len(ball.vertices))
    for _ in range(12):
        direction = rng.normal(size=3)
        along = ball.vertices @ (direction / np.linalg.norm(direction))
        height += np.sin(along * rng.uniform(5.0, 25.0) + rng.uniform(0.0, 6.0))
    vertices = np.array(ball.vertices) * (0.3 + 0.0087 * height)[:, None]
    return vertices + np.array([0.0, 0.0, at]), np.array(ball.faces)


def test_coacd_is_asked_of_what_is_simple_within_the_error_only(monkeypatch):
    asked = []

    def counted(function, solid, *_, limits):
        asked.append((function, len(solid[1])))
        assert limits.cpu_s is None
        return Outcome([], None, "", "", 0.1)

    monkeypatch.setattr(ladder, "run_isolated", counted)
    intricate = manifold_of(*blob(70))
    assert intricate is not None
    found = ladder.search(intricate, 0.01, DecomposeConfig())
    assert not asked
    assert "faces, want at most 1300" in found.degraded[0]
    asked.clear()
    # The same with many more faces that say nothing more.
    smooth = torus_solid().refine(8)
    assert smooth.num_tri() > 30_000
    ladder.search(smooth, 0.01, DecomposeConfig())
    assert [(function, faces <= 2000) for function, faces in asked] == [(ladder.coacd_pieces, True)]


def test_pieces_are_split_again_up_to_a_count(monkeypatch):
    def halved(solid, error_m, config):
        """Two hulls, whatever they fill."""
        low, high = np.array(solid.bounding_box()).reshape(2, 3)
        axis = int((high - low).argmax())
        halves = solid.split_by_plane(np.eye(3)[axis], float(low[axis] + high[axis]) / 2.0)
        return SolidPieces(tuple(hull_of(triangles_of(half)[0]) for half in halves), "cut")

    monkeypatch.setattr(methods, "METHODS", (halved,))
    monkeypatch.setattr(methods, "MOST_AGAIN", 1)
    assert len(split_closely(torus_solid(), 0.01, CONFIG, NOWHERE).hulls) == 3
    monkeypatch.undo()
    monkeypatch.setattr(methods, "METHODS", (halved,))
    assert len(split_closely(torus_solid(), 0.01, CONFIG, NOWHERE).hulls) == 4


@pytest.mark.full
def test_a_hundred_thousand_faces_in_two_blobs_become_hulls(tmp_path):
    """It takes 13 s of processor time, and took minutes of CoACD."""
    base, lid = (Mesh.from_triangles(*blob(112, at=at)) for at in (0.0, 0.8))
    joint = Joint("slide", JointKind.PRISMATIC, 0, 1, np.array([0, 0, 1.0]), np.zeros(3), 0.0, 0.1)
    articulation = parted({"base": [base], "lid": [lid]}, joint)
    assert len(articulation.mesh.faces) > 98_000
    for result in decomposed(articulation, DecomposeConfig()):
        assert (result.method, len(result.hulls) <= 64) == ("halved", True)


def test_without_memory_the_next_method_is_tried_and_that_is_kept(monkeypatch, tmp_path):
    full = Outcome[object](None, Failure.RAISED, "ran out of memory", "", 0.1, error=MemoryError())
    monkeypatch.setattr(ladder, "run_isolated", lambda *_, limits: full)
    monkeypatch.setattr(methods, "METHODS", (ladder.search,))
    first, kept = (decomposed(one_part(*torus()), CONFIG, Store(tmp_path))[0] for _ in range(2))
    assert (first.method, first.degraded) == (kept.method, kept.degraded)
    assert "ran out of memory" in first.degraded[0]
    assert list(tmp_path.rglob("*.npz"))


def test_a_program_that_cannot_start_children_is_not_taken_for_a_bad_mesh(monkeypatch):
    error = ImportError("no coacd")
    gone = Outcome(None, "raised", "ImportError: no coacd", "", 0.1, error=error)
    monkeypatch.setattr(ladder, "run_isolated", lambda *_, limits: gone)
    with pytest.raises(ImportError):
        ladder.search(torus_solid(), 0.01, CONFIG)


def test_coacd_that_takes_too_long_is_killed():
    slow = DecomposeConfig(resolution=20000, iterations=2000, nodes=50, search_depth=4)
    limits = Limits(wall_s=30.0, cpu_s=1.0)
    outcome = run_isolated(ladder.coacd_pieces, torus(), 1e-4, slow, limits=limits)
    assert outcome.failure == "crashed"
    assert outcome.seconds < 30.0


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_any_pile_of_boxes_is_covered_and_nothing_reaches_farther_than_the_error(seed, count):
    random = np.random.default_rng(seed)
    specs = [(random.uniform(0.02, 0.3, 3), random.uniform(-0.3, 0.3, 3)) for _ in range(count)]
    vertices, faces = boxes(*specs)
    result = only(vertices, faces)
    assert uncovered(result.hulls, surface_points(vertices, faces)) < 1e-6
    single = [hull for spec in specs for hull in only(*boxes(spec)).hulls]
    solid = union([manifold_of_hull(hull) for hull in single])
    extra = cover_volume(result) - solid.volume()
    assert extra >= -1e-9
    assert extra <= 0.005 * solid.surface_area()
    if result.method == "exact":
        assert extra == pytest.approx(0.0, abs=1e-9)
