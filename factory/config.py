"""One frozen configuration per stage; defaults are here, presets in ``configs/`` override them."""

from __future__ import annotations

from dataclasses import dataclass, field

from asset_factory.sim_checks.config import LIMIT, CheckConfig

#: Metadata of a setting that refuses inputs: it changes what becomes of one, not a stage's result.
GATE = "gate"
#: What repairs may change: nothing, collision geometry only, or joints too.
REPAIR_KINDS = ("none", "geometry", "all")


@dataclass(frozen=True)
class IntakeConfig:
    """Mesh intake.

    Attributes:
        up: axis of the input that points up: ``x y z -x -y -z``, or ``auto`` (glTF: y, by its
            specification; everything else: z).
        height: real height [m] to scale to; ``None``: sidecar, else the table by category, else as
            is.
        max_bytes: largest input file, its buffers and textures included [bytes].
        max_faces: most triangles.
        max_texture_pixels: largest texture [pixels].
        allowed_licenses: under which an input may stand: names such as ``CC-BY-4.0`` or patterns
            such as ``CC0-*``, in any case; ``unknown`` for those that do not say; empty: all.
        roots: folders that a description may refer to, beside its own and its package, see
            :class:`~asset_factory.sim_checks.read.roots.ReadOptions`.
        given: folders that inputs were found in, and those of ``ROS_PACKAGE_PATH``: the same.
        allow_outside: let descriptions refer to any file.
        arguments: of xacro files, written ``name:=value``.
    """

    up: str = "auto"
    height: float | None = None
    max_bytes: int = 512 * 1024 * 1024
    max_faces: int = 1_000_000
    max_texture_pixels: int = 8192 * 8192
    allowed_licenses: tuple[str, ...] = field(default=(), metadata={GATE: True})
    roots: tuple[str, ...] = ()
    given: tuple[str, ...] = field(default=(), metadata={GATE: True})
    allow_outside: bool = False
    arguments: tuple[str, ...] = ()


@dataclass(frozen=True)
class ParticulateConfig:
    """Articulation by a trained network.

    Attributes:
        checkpoint: file with its weights; ``shipped``: those of the small network that comes with
            the package.
        features: file with the weights of its feature extractor, for networks that want features.
        precision: of the products over points: ``float32`` or ``bfloat16``, which is faster where
            the processor has instructions for it.
        device: ``cpu``, ``cuda``, ``cuda:<n>`` or ``mps``; ``auto``: a GPU where there is one, else
            the CPU. Answers of a GPU may differ in their last digits from those of another.
        driving: points per sample that parts are told from, the others being labelled only; 0: all
            of them.
        points: labelled per sample, half of them on sharp edges; more where a face would have none.
            The release takes 102,400; a sixth changes no more labels than another sample of all
            does.
        context_points: from which features of the whole shape are computed.
        max_faces: a mesh with more is shown to the network as a lighter one.
        samples: answers of the network; the one that agrees most with the others is taken.
        seed: of the samples.
        least_confidence: parts whose points are less sure of them are dissolved; 0 keeps all.
        refinement: ``component``: one part per connected component; ``patch``: one connected patch
            per part; ``auto``: ``patch`` where components are fused from several parts; ``none``.
        fused_share: see ``auto``: a component is fused if it covers so much of the mesh, and parts
            that would vanish altogether cover so much of it.
        tree: ``present``: the tree is the best one over parts with points; ``all``: over all of the
            network's.
    """

    checkpoint: str = "shipped"
    features: str = ""
    precision: str = "float32"
    device: str = "auto"
    driving: int = 0
    points: int = 16_384
    context_points: int = 40_000
    max_faces: int = 50_000
    samples: int = 1
    seed: int = 0
    least_confidence: float = 0.0
    refinement: str = "auto"
    fused_share: float = 0.1
    tree: str = "present"


@dataclass(frozen=True)
class AutoConfig:
    """Articulation by the shipped network, shape rules and geometric evidence together.

    Attributes:
        views: sides from which the network is asked, 1 to 4; what it sees from all of them is
            surer.
        points: labelled per view.
        context_points: per view, from which what components look like is measured.
        least_confidence: parts less likely to be right stay fixed, 0 to 1; ``None``: as the shipped
            trust says, 0.3.
    """

    views: int = 4
    points: int = 4096
    context_points: int = 8192
    least_confidence: float | None = None


@dataclass(frozen=True)
class DecomposeConfig:
    """Convex decomposition of each part.

    Attributes:
        error_m: farthest that a hull's surface may be from the part [m]: dents are filled to this
            depth, slots and holes to twice this width; tied to joint clearances of a few
            millimetres.
        error_share, coarsest_m: away from other parts dents may be deeper: up to this share of the
            part's diagonal, and up to this depth [m].
        near_convex: a part of several pieces that fills this share of its hull, with no deeper
            dent, is one hull.
        shell_m: thickness given to surfaces that enclose nothing, towards their inside [m].
        max_faces: simplify to this many triangles before CoACD; meshes too intricate for that are
            halved.
        max_hulls: a part that needs more, once hulls are joined as ``hulls`` says, is rejected.
        max_vertices: corners of one hull; simulators on the GPU take at most 64.
        resolution: CoACD's surface samples for its measure of concavity.
        iterations, nodes, search_depth: of CoACD's Monte Carlo tree search.
        seed: of that search.
        wall_s: after which a child process hangs, and the asset is unjudged [s].
        memory_bytes: limit of one child process [bytes]; without that much it fails on every
            machine, and the next method is tried.
    """

    error_m: float = 0.005
    error_share: float = 0.006
    coarsest_m: float = 0.012
    near_convex: float = 0.98
    shell_m: float = 0.0015
    max_faces: int = 2000
    max_hulls: int = 256
    max_vertices: int = 64
    resolution: int = 1000
    iterations: int = 60
    nodes: int = 10
    search_depth: int = 2
    seed: int = 0
    wall_s: float = field(default=600.0, metadata={LIMIT: True})
    memory_bytes: int = 3 * 1024**3


@dataclass(frozen=True)
class HullsConfig:
    """How many hulls an asset may have.

    Attributes:
        wanted: an asset of more has them joined, with up to ``coarse`` times the decomposition's
            error, unless it is rejected then and passes without.
        coarse: see ``wanted``.
        most: an asset that still has more has them joined with up to ``coarsest`` times the error,
            on the same terms; files of 400 take SAPIEN seconds to load.
        coarsest: see ``most``.
    """

    wanted: int = 32
    coarse: float = 2.0
    most: int = 180
    coarsest: float = 16.0


@dataclass(frozen=True)
class SolidsConfig:
    """Solid parts made of a one-piece mesh.

    Attributes:
        construct: make bodies of parts that are patches of one surface; without it they are
            decomposed as they are.
        interior: invent interiors behind panels: hollows and drawers' boxes.
        cells: along an object's longest side, in which space is divided.
        wall_m: thickness of walls around hollows [m].
        gap_m: between a panel and what surrounds it, each side of the seam [m]; both together must
            be more than the 2 mm that PyBullet needs.
        behind_m: between a panel's back and the part behind it [m].
        most_pieces: of one part.
    """

    construct: bool = True
    interior: bool = True
    cells: int = 80
    wall_m: float = 0.018
    gap_m: float = 0.0015
    behind_m: float = 0.003
    most_pieces: int = 60


@dataclass(frozen=True)
class SeparateConfig:
    """Cutting hulls of different parts apart.

    Attributes:
        clearance_m: gap left between them [m]. PyBullet wraps every hull in a millimetre, so it
            takes more than two to be apart there; an asset that one engine passed is used in the
            others too.
        tolerance_m: how much deeper than at rest two parts may get along a slide for their hulls to
            be cut [m]; deeper is the asset's fault.
        poses: sampled along each joint that moves the two parts against one another.
        overlap_poses: of those, how many are tested for overlap of the meshes.
        most_cut: largest share of a part's collision volume that may be cut away for one pair.
        visible_m: cuts deeper than this are reported, and their area counted [m].
        bared_m: how much may be cut off two parts together where nothing excuses it [m]; what a
            joint that is hung well runs into on its way is planed instead.
        scraped_m: most of that, clearance included [m].
        hinge_m: how far from a hinge's line lies what may be planed off so that it can turn [m].
        planed_m, planed_share: most that may be planed off two parts together, beside their hinge,
            where their joint is hung well, or where they overlap and no joint holds one in the
            other: [m], and as a share of the diagonal of what the hinge holds, else of the smaller
            part. A hinge that is off by a twentieth of its part needs more.
        planed_volume, planed_area: largest shares of a solid part's collision volume, and of any
            part's visible surface, that planing may take.
        gap_m, most_untouched: largest share of a part's visible surface that may lie further than
            this [m] outside what all cuts together leave; more rejects.
    """

    clearance_m: float = 0.0025
    tolerance_m: float = 0.002
    poses: int = 49
    overlap_poses: int = 8
    most_cut: float = 0.5
    visible_m: float = 0.005
    bared_m: float = 0.006
    hinge_m: float = 0.06
    scraped_m: float = 0.013
    planed_m: float = 0.025
    planed_share: float = 0.035
    planed_volume: float = 0.05
    planed_area: float = 0.05
    gap_m: float = 0.01
    most_untouched: float = 0.1


@dataclass(frozen=True)
class InertiaConfig:
    """Masses.

    Attributes:
        density: of the material [kg/m3] where nothing else tells the mass; chipboard's by default.
        shell_thickness_m: wall assumed for surfaces that enclose no volume [m].
    """

    density: float = 650.0
    shell_thickness_m: float = 0.004


@dataclass(frozen=True)
class RepairConfig:
    """The loop from a verdict back to the stage that can mend it.

    Attributes:
        kinds: ``none``; ``geometry``: of collision geometry only; ``all``: of joints too.
        max_rounds: most rounds after the first.
        near_mm: hulls of two parts nearer to one another than this are cut apart [mm].
        least_range_share: a joint may be shortened to this share of its range, not further.
        small_share: parts up to this share of the object's diagonal are small: a button, a knob,
            not a door.
        most_work: no further round is begun after so much work on one hypothesis, counted as
            :func:`~.verify.drafts.work_of` does. Of 27 generated, one-piece and real objects most
            took under 4,000, and a counter of twelve joints 10,000.
    """

    kinds: str = "all"
    max_rounds: int = 7
    near_mm: float = 2.4
    least_range_share: float = 0.5
    small_share: float = 0.15
    most_work: int = 20_000


@dataclass(frozen=True)
class VlmConfig:
    """A vision-language model that is asked what opens, by ``articulator = "vlm"``.

    Attributes:
        url: of an endpoint that speaks OpenAI's chat-completions protocol, without that word, such
            as ``http://localhost:8000/v1``. Pictures of inputs and their file names go there.
        model: its name there.
        wait_s: longest wait for an answer [s].
        most_tokens: of an answer.
        answers: folder where answers are kept; empty: ``asset-factory/answers`` in the user's
            cache.
    """

    url: str = ""
    model: str = ""
    wait_s: float = field(default=120.0, metadata={LIMIT: True})
    most_tokens: int = 4096
    answers: str = field(default="", metadata={LIMIT: True})


@dataclass(frozen=True)
class ReadingsConfig:
    """How several hypotheses of an input become one asset.

    Attributes:
        most: hypotheses that are built and validated, until one passes; the likeliest first.
        most_work: no further one is begun after so much work on those before, counted as
            :func:`~.verify.drafts.work_of` does.
    """

    most: int = 4
    most_work: int = 10_000


@dataclass(frozen=True)
class BuildConfig:
    """One build: every stage's settings.

    Attributes:
        articulator: ``auto`` (what came with the input, else ``particulate`` with a checkpoint of
            one's own, else the shipped network and the rules of shape together), ``annotated``,
            ``geometric``, ``particulate``, ``vlm``, ``rigid``.
        simulators: who judges.
        formats: what an asset is written in, besides URDF and MJCF: ``sdf``, ``usd``, ``glb``.
        asset_wall_s: longest a single input may take, repairs included [s].
        asset_memory_bytes: most address space of the process that builds one input [bytes].
        retries: further tries for an input whose process crashed, hung or ran out of memory.
        cache_gb: a build leaves so much of the registry's cache, results of the last hour not
            counted; 0: any amount [GB].
    """

    articulator: str = "auto"
    simulators: tuple[str, ...] = ("sapien",)
    formats: tuple[str, ...] = ("urdf", "mjcf")
    asset_wall_s: float = field(default=1800.0, metadata={LIMIT: True})
    asset_memory_bytes: int = field(default=16 * 1024**3, metadata={LIMIT: True})
    retries: int = field(default=1, metadata={LIMIT: True})
    cache_gb: float = field(default=10.0, metadata={LIMIT: True})
    intake: IntakeConfig = field(default_factory=IntakeConfig)
    particulate: ParticulateConfig = field(default_factory=ParticulateConfig)
    auto: AutoConfig = field(default_factory=AutoConfig)
    decompose: DecomposeConfig = field(default_factory=DecomposeConfig)
    hulls: HullsConfig = field(default_factory=HullsConfig)
    solids: SolidsConfig = field(default_factory=SolidsConfig)
    separate: SeparateConfig = field(default_factory=SeparateConfig)
    inertia: InertiaConfig = field(default_factory=InertiaConfig)
    checks: CheckConfig = field(default_factory=CheckConfig)
    repair: RepairConfig = field(default_factory=RepairConfig)
    vlm: VlmConfig = field(default_factory=VlmConfig)
    readings: ReadingsConfig = field(default_factory=ReadingsConfig)
