"""A registry with something to look at: a cabinet that passed, one whose door hits, one without
a model, and names that are markup."""

from dataclasses import replace

from export_samples import PROVENANCE, cabinet
from registry_samples import PASSED

from asset_factory.factory.export.bundle import export_bundle, write_model
from asset_factory.factory.manufacture.repair import Repair, RepairKind
from asset_factory.factory.part import PartKind, PartSource, Proposer
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.report_file import BuildReport
from asset_factory.factory.report.site.site import index_of, stale, write_asset, write_index
from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.measurements import MeasuredJoint, MeasuredPair, MeasuredPenetration

HOSTILE = "\"><img src=x onerror='window.hacked=1'></script><script>window.hacked=1</script>"
POINT = (0.1, -0.3, 0.25)
_PAIR = MeasuredPair(
    ("part_1", "part_2"), ("a", "b"), 4.2, POINT, "plain", None, None, 4.2, 4.3, at=0.8
)
_HINGE = MeasuredJoint("hinge", 0.0, 1.6, "rad", 4.2, 0.0, None, 0.7, 5, (_PAIR,), (), (), None)
_MEASURED = MeasuredPenetration(
    1.0, 4, (("part_0",), ("part_1",), ("part_2",)), (), None, (_HINGE,), (), ()
)
HIT = Finding(
    "sweep_penetration",
    Severity.ERROR,
    "as hinge moves, part_1 and part_2 penetrate 4.20 mm deeper than at rest",
    joint="hinge",
    parts=("part_1", "part_2"),
    value=4.2,
    unit="mm",
    limit=1.0,
)
OTHER = Finding("other_reading", Severity.WARNING, f"read otherwise, it is rejected {HOSTILE}")
WORDS = Finding("articulation_note", Severity.WARNING, HOSTILE, parts=(HOSTILE,))


def bundle_in(folder):
    """A cabinet's bundle with its model, its manifest full of markup."""
    made = cabinet()
    body, door, *rest = made.articulation.parts
    source = PartSource(HOSTILE, Proposer.SIDES, 0.7, {HOSTILE: 1.5})
    parts = (body, replace(door, kind=PartKind.DOOR, source=source), *rest)
    asset = replace(made, articulation=replace(made.articulation, parts=parts))
    provenance = replace(PROVENANCE, input=f"{HOSTILE}.glb")
    export_bundle(asset, provenance, folder)
    write_model(asset, folder)
    return folder


def make_registry(root):
    """The registry of the module's docstring."""
    registry = Registry(root, create=True)
    passed = replace(PASSED, category=HOSTILE)
    told = BuildReport(
        Report("asset.urdf", ("mujoco",), (WORDS, OTHER), {"asset.urdf": {}}),
        (Repair(RepairKind.HULLS_CUT_APART, pairs=((HOSTILE, "base"),)),),
    )
    with registry.staging_folder() as staging:
        registry.add(passed, told, bundle_in(staging / "one"))
    measurements = {"asset.urdf": {"penetration": _MEASURED.to_dict()}}
    # The MJCF says the same with other last digits, and names the pair the other way round.
    again = replace(HIT, message=f"{HIT.message} ", parts=HIT.parts[::-1], value=4.2001)
    report = Report("asset.urdf", ("mujoco",), (WORDS, HIT, again), measurements)
    hit = _rejected("hitting-2", HIT)
    with registry.staging_folder() as staging:
        registry.add(hit, BuildReport(report), bundle_in(staging / "two"))
    none = Finding("no_movable_joint", Severity.ERROR, HOSTILE)
    registry.add(_rejected("still-3", none), BuildReport(Report("a.glb", findings=(none,))))
    return registry


def draw(registry):
    """Draw every page that is not up to date; returns the first one."""
    for entry in stale(registry):
        write_asset(registry.root, entry)
    write_index(registry)
    return index_of(registry.root)


def _rejected(asset_id, finding):
    return replace(
        PASSED,
        id=asset_id,
        name=f"{HOSTILE} {asset_id}",
        status="rejected",
        reason=finding.code,
        message=finding.message,
        key="",
    )
