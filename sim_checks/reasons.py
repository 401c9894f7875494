"""Every code that the judge may say, and what it means; ``docs/reasons.md`` is made from this."""

from __future__ import annotations

from collections.abc import Mapping

#: The description could not be read, so nothing else was asked.
UNREADABLE: Mapping[str, str] = {
    "invalid_xml": "no XML",
    "forbidden_doctype": "XML with entities or a document type, which can be made to explode",
    "unknown_format": "neither a URDF nor an MJCF; or USD whose files cannot be told beforehand",
    "too_large": "more bytes than the limit",
    "missing_element": "the format demands an element that is not there",
    "missing_name": "a link or joint without a name",
    "missing_number": "the format demands a number that is not there",
    "invalid_number": "a number that is none",
    "no_links": "a description without links",
    "missing_geometry": "a shape of no kind",
    "unknown_geometry": "a shape of a kind that no engine loads",
    "invalid_size": "a primitive of size 0 or less",
    "not_finite": "a place, axis, scale or corner that is NaN, infinite or beyond 1e6",
    "missing_file": "a mesh, or an included document, that is not there",
    "unsupported_mesh": "a mesh format that no engine loads",
    "unreadable_mesh": "a mesh that cannot be read",
    "empty_mesh": "a mesh without triangles",
    "unreadable": "the file cannot be read, or MuJoCo does not compile it",
    "outside_folder": "the description, or what it refers to, names a file outside its folder",
    "nested_too_deep": "documents nested in themselves",
}

#: These reject.
HARD: Mapping[str, str] = {
    "rest_penetration": "two parts overlap too deeply with every joint closed [mm]",
    "sweep_penetration": "as a joint moves, two parts penetrate deeper than at rest [mm]",
    "jammed": "a bounded force does not open the joint [share of its range]",
    "not_returned": "a bounded force does not close it again [share of its range]",
    "pushed_at_rest": "a joint moves by itself, pushed by contact [share of its range]",
    "others_moved": "driving one joint moves another [share of its range]",
    "limit_overshoot": "a joint passes its limit [share of its range]",
    "creeps": "left alone, a joint moves that its friction should hold [m or rad]",
    "energy_grows": "left alone, parts gain energy that nothing gave them [J]; soft up to 2 m/s",
    "not_finite": "a simulator produced NaN or infinity",
    "shape_dropped": "the simulator holds fewer collision shapes of a link than the file",
    "link_missing": "the simulator does not hold a link of the file",
    "joint_missing": "the simulator does not hold a joint of the file",
    "joint_kind": "the simulator holds a joint of another kind than the file",
    "limit_mismatch": "the simulator holds other limits than the file [rad or m]",
    "mass_mismatch": "the simulator holds another mass than the file [kg]",
    "inertia_mismatch": "the simulator holds another inertia than the file [kg m2]",
    "center_mismatch": "the simulator holds another centre of mass than the file [m]",
    "pose_mismatch": "the simulator places a link elsewhere than the file [m]",
    "axis_mismatch": "the simulator turns a joint about another axis than the file [deg]",
    "mimic_mismatch": "the simulator couples a joint to another, or at another rate, than the file",
    "interior_filled": "shapes fill a container where a hand should reach in [share left free]",
    "mimic_unknown": "a joint follows one that does not exist or move, itself, or a circle",
    "mimic_not_finite": "a joint follows another at a rate that is no number",
    "mimic_limits": "joints that move together have no common range",
    "load_failed": "the loader refused the file, in its own words",
    "range_implausible": "a slide over two diagonals [m], or a hinge over two turns [rad]",
    "axis_remote": "a hinge axis two diagonals away from its part [m]; soft from one on",
    "part_remote": "what a joint moves lies further from all else than either is across [m]",
    "friction_excessive": "friction takes over 100 N at the far edge to open [N]; soft over 30",
    "damping_excessive": "damping takes over 100 N at the far edge to open [N]; soft over 30",
    "collision_scale": "collision geometry ten times smaller or larger than what is visible",
    "inertia_impossible": "a radius of gyration larger than the link [m]",
    "many_hull_vertices": "over 4000 corners of one hull: each engine makes another shape of it",
    "no_collision": "a visible link that nothing can touch",
    "degenerate_collision": "a collision shape without volume",
    "collision_offset": "a collision shape that lies beside what is visible [mm]",
    "inertia_not_positive": "an inertia that no rigid body has",
    "inertia_not_finite": "an inertia that is no number, or beyond 1e6",
    "inertia_triangle": "principal moments that no rigid body has",
    "mass_not_positive": "a mass of 0 or less",
    "limits_not_ordered": "a lower limit above the upper one",
    "limits_not_finite": "a limit that is no number",
    "missing_limits": "a joint that needs limits and has none",
    "zero_axis": "an axis of no length",
    "axis_not_unit": "an axis not of length 1, by which loaders scale the motion or not",
    "center_outside": "a centre of mass a tenth of the link's diagonal outside its box [mm]",
    "missing_inertia": "no inertia of a link that moves: each simulator makes up another",
    "collision_gap": "a tenth of a link's visible surface over 10 mm outside what can be touched",
    "density_implausible": "denser than osmium, or far lighter than air [kg/m3]",
    "unknown_joint_type": "a joint that no two engines move alike",
    "invalid_dynamics": "negative or infinite damping or friction",
    "not_a_tree": "links that do not hang below one root, each once",
    "duplicate_name": "two links or joints of one name",
}

#: Codes that are soft up to a degree and hard beyond it: what is reported, and what rejects.
DEGREES: Mapping[str, tuple[str, str]] = {
    "collision_gap": (
        "surfaces over 10 mm and 5 % of the link's diagonal apart",
        "under 90 % of the visible surface within 10 mm of collision geometry",
    ),
    "density_implausible": (
        "under 5 or over 12,000 kg/m3 of hulls",
        "under 0.05, or over 22,600 (osmium) of hulls and of what the visible surfaces enclose",
    ),
    "axis_not_unit": (
        "an axis whose length is over 0.001 off 1",
        "over 0.01 off: loaders scale the motion by it or not",
    ),
    "center_outside": (
        "over 5 % of the link's diagonal outside the box of its shapes",
        "over 10 % and 10 mm",
    ),
    "missing_inertia": (
        "none stated of a link of the unmoved base, in a URDF",
        "none stated of a link that moves: engines make up 1 kg, or water in its hulls",
    ),
    "axis_remote": ("over one diagonal of its part away", "over two"),
    "friction_excessive": ("over 30 N at the far edge", "over 100 N"),
    "damping_excessive": ("over 30 N at the far edge in 3 s", "over 100 N"),
    "energy_grows": ("speeds from nowhere of 1 m/s", "2 m/s"),
    "others_moved": ("another joint pushed by 5 % of its range", "by half of it"),
    "limit_overshoot": ("2 % of the range beyond a limit", "20 %"),
    "pushed_at_rest": ("2 % of the range", "10 %"),
    "creeps": (
        "5 % of the range, 1 mm or 0.01 rad in 2 s, where no file of this format can tell the "
        "engine to hold it",
        "the same in any other engine and format",
    ),
    "inertia_implausible": (
        "a radius of gyration over half the link's diagonal",
        "over all of it (`inertia_impossible`)",
    ),
    "many_hull_vertices": ("over 64 corners of a hull", "over 4000"),
    "interior_filled": (
        "under half of the free space within the link's outline left free",
        "under half of a pocket that a hand gets into",
    ),
}

#: Nobody could say: the judge, not the asset, failed to finish.
UNJUDGED: Mapping[str, str] = {
    "simulator_crashed": "a simulator's process died",
    "simulator_timeout": "a simulator gave no answer in time",
    "simulator_missing": "a simulator is not installed",
    "not_simulated": "no simulator asked for reads the format",
    "check_crashed": "the process of the static checks died",
    "check_timeout": "the static checks gave no answer in time",
    "build_crashed": "the process that built the asset died, or met a fault of the program",
    "crashed": "as before, twice in one stage; waits for another version of anything, or settings",
    "build_timeout": "the asset was not built in time",
}

#: Codes of what PhysX does not take on a GPU, or simulates badly there.
GPU_LIMITS = frozenset({"oblong_hull", "many_hulls", "many_hull_vertices"})

#: Worth knowing, no reason to reject.
SOFT: Mapping[str, str] = {
    "hinge_overlap": "the knuckle of a hinge; MuJoCo is told not to collide that pair [mm]",
    "excluded_penetration": "parts that overlap and that the file excludes from contact [mm]",
    "joint_dependency": "a joint that opens only after others, which open without it",
    "combination_penetration": "parts that collide when two joints are open [mm]",
    "interior_filled": "hulls fill what is open in no container: a handle's gap, under a table",
    "mimic_limits": "limits of a joint that follows another stop before its leader does",
    "topples": "resting on the floor, fastened to nothing, it falls [mm]",
    "no_stable_footing": "it has no ground to stand on [mm]",
    "topples_when_pulled": "a hand's pull where a joint sticks or ends tips the whole object [N]",
    "opens_by_itself": "a joint opens under its own weight [share of its range]",
    "mimic_ignored": "joints that the file couples move freely in this simulator",
    "link_added": "the simulator holds links that the file does not have",
    "joint_added": "the simulator holds joints that the file does not have",
    "shape_added": "the simulator made more shapes of a link than the file has",
    "range_tiny": "a range below 1 mm or 0.5 deg, which opens nothing [m or rad]",
    "invalid_effort": "an effort or velocity limit that is not above 0: planners refuse it",
    "inertia_implausible": "a radius of gyration above half the link's diagonal [m]",
    "oblong_hull": "a hull too long and thin for simulation on a GPU",
    "many_hulls": "more hulls of a link than simulation on a GPU takes",
    "many_hull_vertices": "more corners of a hull than simulation on a GPU takes",
    "nonconvex_collision": "a collision mesh that is not convex: engines take its hull",
    "collision_gap": "visible and collision surface lie apart [mm]",
    "density_implausible": "mass over volume that no material has [kg/m3]",
    "center_outside": "a centre of mass outside the link's box [mm]",
    "missing_inertia": "no inertia of a link that never moves",
    "inertia_invented": "a simulator made up an inertia that the file does not state",
    "zero_outside_limits": "0, where simulators start, is no value of the joint",
    "axis_not_unit": "an axis that is not of length 1, by which some loaders scale",
    "no_moving_joint": "nothing moves",
    "not_driven": "a joint without a range, which the simulators did not drive",
    "friction_ignored": "the simulator drops joint friction",
    "damping_ignored": "the simulator drops joint damping",
    "read_as_urdf": "a USD asset, judged as the URDF that says the same",
    "format_not_loaded": "the simulator does not read this format",
    "loader_warning": "a loader's warning, in its own words",
    "engine_warning": "an engine's warning, in its own words",
    "damping_stiff": "damping that Bullet, which integrates it explicitly, turns into an explosion",
}
