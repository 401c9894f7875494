"""Every code of the validator, and its meaning; ``docs/reasons.md`` is made from this."""

from __future__ import annotations

from collections.abc import Mapping

#: The description could not be read, so nothing else was asked.
UNREADABLE: Mapping[str, str] = {
    "invalid_xml": "no XML",
    "invalid_xacro": "a xacro file that cannot be expanded",
    "forbidden_doctype": "XML with entities or a document type, which can be made to explode",
    "unknown_format": "neither a URDF nor an MJCF; or USD whose files cannot be told beforehand",
    "too_large": "more bytes, faces, pixels, bodies, geoms, prims or memory than the limit named",
    "missing_element": "the format demands an element that is not there",
    "missing_name": "a link or joint without a name",
    "missing_number": "the format demands a number that is not there",
    "invalid_number": "a number that is none",
    "no_links": "a description without links",
    "missing_geometry": "a shape of no kind",
    "unknown_geometry": "a shape of a kind that no engine loads",
    "invalid_size": "a primitive of size 0 or less",
    "not_finite": "a place, axis, scale or corner that is NaN, infinite or beyond 1e6; "
    "or a simulator made such numbers of it",
    "missing_file": "a mesh, an included document or another file that is not there",
    "unsupported_mesh": "a mesh format that no engine loads",
    "unreadable_mesh": "a mesh that cannot be read",
    "empty_mesh": "a mesh without triangles",
    "unreadable": "the file, or one it needs, cannot be read, or MuJoCo does not compile it",
    "outside_folder": "the description, or what it refers to, names a file outside its folder, "
    "its package and the roots",
    "nested_too_deep": "documents nested in themselves",
}

#: These reject.
ERRORS: Mapping[str, str] = {
    "rest_penetration": "two parts overlap too deeply with every joint closed [mm]",
    "sweep_penetration": "as a joint moves, two parts penetrate deeper than at rest [mm]",
    "joint_obstructed": "a joint cannot reach its range once another is a tenth open, or more [mm]",
    "jammed": "a bounded force does not open the joint [share of its range]",
    "not_returned": "a bounded force does not close it again [share of its range]",
    "pushed_at_rest": "a joint moves by itself, pushed by contact [share of its range]",
    "others_moved": "driving one joint moves another [share of its range]",
    "limit_overshoot": "a joint passes its limit [share of its range]",
    "creeps": "left alone, a joint moves that its friction should hold [m or rad]",
    "energy_grows": "left alone, parts gain energy that nothing gave them [J]; to 2 m/s a warning",
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
    "axis_remote": "a hinge axis two diagonals away from its part [m]; a warning from one on",
    "axis_oblique": "a hinge over 3 deg off every edge of the box that it turns [deg]",
    "part_remote": "what a joint moves lies further from all else than either is across [m]",
    "part_detached": "what a joint moves is near its carrier in no pose, or leaves its hinge [mm]",
    "friction_excessive": "friction takes over 100 N at the far edge [N]; over 30 a warning",
    "damping_excessive": "damping takes over 100 N at the far edge [N]; over 30 a warning",
    "collision_scale": "collision geometry ten times smaller or larger than what is visible",
    "inertia_impossible": "mass spread further along an axis than the link reaches [m]",
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

#: Codes that warn from one degree on and are errors from another, which rejects; and why.
DEGREES: Mapping[str, tuple[str, str, str]] = {
    "collision_gap": (
        "surfaces over 10 mm and 5 % of the link's diagonal apart",
        "under 90 % of the visible surface within 10 mm of collision geometry",
        "a hand passes through what is seen, or stops before it",
    ),
    "density_implausible": (
        "under 5 or over 12,000 kg/m3 of hulls",
        "under 0.05, or over 22,600 of hulls and of what the visible surfaces enclose",
        "osmium has 22,600, lead 11,300, air 1.2; hulls around hollow things weigh little",
    ),
    "axis_not_unit": (
        "an axis whose length is over 0.001 off 1",
        "over 0.01 off",
        "loaders scale motion by it or not",
    ),
    "center_outside": (
        "over 5 % of the diagonal outside the box of the link's shapes",
        "over 10 %, and over 10 mm",
        "mass lies within a body; small parts that a mesh leaves out move its centre little",
    ),
    "missing_inertia": (
        "a URDF states none of a link that never moves",
        "none of a link that moves",
        "engines make up 1 kg, or fill its hulls with water",
    ),
    "axis_remote": (
        "over one diagonal of its part away",
        "over two",
        "a hinge is fastened to something",
    ),
    "friction_excessive": (
        "over 30 N at the far edge",
        "over 100 N",
        "a robot's arm pulls some 30 N, nobody opens against 100 N",
    ),
    "damping_excessive": ("over 30 N at the far edge to open it in 3 s", "over 100 N", "as above"),
    "energy_grows": ("speeds from nowhere of 1 m/s", "2 m/s", "contacts act as springs"),
    "others_moved": (
        "another joint pushed by 5 % of its range",
        "by half of it",
        "a light touch is no obstacle, opening another is",
    ),
    "limit_overshoot": (
        "2 % of the range beyond a limit",
        "20 %",
        "engines with soft limits pass theirs by a few percent",
    ),
    "pushed_at_rest": (
        "2 % of the range",
        "10 %",
        "parts that overlap push each other open",
    ),
    "creeps": (
        "over 5 % of the range, 1 mm or 0.01 rad in 2 s, in MuJoCo from a URDF and in Newton",
        "the same, in MuJoCo from an MJCF and in PyBullet; SAPIEN drops friction",
        "stated friction that outweighs the load must hold; no URDF can tell MuJoCo how stiffly",
    ),
    "inertia_implausible": (
        "a radius of gyration over half the link's diagonal",
        "mass spread over half of an axis' extent and 10 % of the diagonal (`inertia_impossible`)",
        "a uniform rod has 0.29, two points in opposite corners 0.5",
    ),
    "many_hull_vertices": (
        "over 64 corners of a hull",
        "over 4000",
        "PhysX on a GPU takes 64; each engine cooks thousands down to others",
    ),
    "interior_filled": (
        "under half of the free space within the link's outline left free",
        "under half of a pocket that a hand gets into",
        "what should go in finds it full",
    ),
}

#: Nobody could say: the judge, not the asset, failed to finish.
UNJUDGED: Mapping[str, str] = {
    "simulator_crashed": "a simulator's process died",
    "simulator_timeout": "a simulator gave no answer in time",
    "simulator_missing": "a simulator is not installed",
    "not_simulated": "no simulator asked for reads the format",
    "too_large_to_judge": "more shapes, motions or contacts than are validated; says which",
    "check_crashed": "the process of the static checks died",
    "check_timeout": "the static checks gave no answer in time",
    "reading_timeout": "what reads the input gave no answer in time",
    "reading_killed": "what reads the input was killed by somebody else",
    "decomposition_timeout": "convex decomposition gave no answer in time",
    "decomposition_killed": "somebody, or the kernel, ended the process of convex decomposition",
    "build_crashed": "the process that built the asset died, or met a fault of the program",
    "crashed": "as before, twice in one stage; waits for another version of anything, or settings",
    "build_timeout": "the asset was not built in time",
}

#: Codes of what PhysX does not take on a GPU, or simulates badly there.
GPU_LIMITS = frozenset({"oblong_hull", "many_hulls", "many_hull_vertices"})

#: Worth knowing, no reason to reject.
WARNINGS: Mapping[str, str] = {
    "hinge_overlap": "the knuckle of a hinge; MuJoCo is told not to collide that pair [mm]",
    "excluded_penetration": "parts that overlap and that the file excludes from contact [mm]",
    "joint_dependency": "a joint that opens only after others, which open without it",
    "joints_collide": "parts that collide where two joints are open, by both their values [mm]",
    "combination_penetration": "parts that collide in a pose with several joints open [mm]",
    "interior_filled": "hulls fill what is open in no container: a handle's gap, under a table",
    "mimic_limits": "limits of a joint that follows another stop before its leader does",
    "topples": "resting on the floor, fastened to nothing, it falls [mm]",
    "no_stable_footing": "it has no ground to stand on [mm]",
    "topples_when_pulled": "a hand's pull where a joint sticks or ends tips the whole object [N]",
    "creeps": "the same in MuJoCo from a URDF, which cannot say how stiffly friction holds",
    "opens_by_itself": "a joint opens under its own weight [share of its range]",
    "mimic_ignored": "joints that the file couples are not coupled so by this simulator itself",
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
    "loader_warning": "a loader's warning, in its own words",
    "engine_warning": "an engine's warning, in its own words",
    "damping_stiff": "damping that Bullet, which integrates it explicitly, turns into an explosion",
}

#: How the file was validated, and what an engine is by nature: nothing in the file to mend.
NOTES: Mapping[str, str] = {
    "not_driven": "a joint without a range, which the simulators did not drive",
    "friction_ignored": "the simulator drops joint friction",
    "damping_ignored": "the simulator drops joint damping",
    "joints_not_swept": "pairs of joints, not swept together for the work that it takes [pairs]",
    "read_as_urdf": "a USD asset, validated as the URDF that says the same",
    "pairs_exempt": "links that an SRDF lets pass through each other [pairs]",
    "read_by_xacro": "a xacro file, validated as the URDF that it makes",
    "read_from_root": "files of the description lie outside its folder, in its package or a root",
    "format_not_loaded": "the simulator does not read this format",
    "simulated_beside": "no engine asked reads the format; a file beside it that says the same ran",
}
