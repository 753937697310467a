"""The entries of the figures of discrete rods, of studies and of other packages."""

from __future__ import annotations

from cosserat.thesis.figures.entry import Entry

RODS: dict[str, Entry] = {
    "fig_3_1": Entry(
        "Fig. 3.1: reference and current configuration",
        "Left a straight chain of vertices with equal upright arrows, right the same chain bent "
        "like a hook, its arrows turned and of several lengths; dashed, the arrows reflected "
        "downwards.",
        "geometry",
        cases=("bent_rod",),
    ),
    "fig_3_2": Entry(
        "Fig. 3.2: a rod-like body",
        "A slender curved tube with one hatched elliptical section, a dashed line near its "
        "middle, an arrow across for the height and a long one beside it for the length.",
        "geometry",
        cases=("clamped_free",),
    ),
    "fig_3_3": Entry(
        "Fig. 3.3: section and directors",
        "Two sections: a rounded oblique one whose two directors meet at less than a right angle, "
        "and a rectangle whose two directors are at right angles and start below its middle.",
        "geometry",
        cases=("clamped_free",),
    ),
    "fig_3_4": Entry(
        "Fig. 3.4: discrete osculating circle",
        "A circle touches two neighbouring edges of a bent chain, each half a Voronoi length from "
        "their common vertex, and an arc shows the clockwise turning angle there.",
        "geometry",
        cases=("bent_rod",),
    ),
    "fig_3_5": Entry(
        "Fig. 3.5: bending, then stretching",
        "Two rings, one inside the other: left smooth circles, right polygons with few corners; "
        "the outer ring is the inner one stretched.",
        "geometry",
        cases=("clamped_free",),
    ),
    "fig_3_6": Entry(
        "Fig. 3.6: tangents, director and angles",
        "Arrows from one vertex: the tangents of both edges, their mean and the director; then "
        "the upright to the mean tangent and the arcs of the two angles.",
        "geometry",
        cases=("bent_rod",),
    ),
    "fig_3_7": Entry(
        "Fig. 3.7: energy characteristics",
        "Both energies follow their dashed parabolas near rest; the stretching energy rises "
        "without bound where the length vanishes, the shearing energy where the section lies "
        "down.",
        "geometry",
    ),
    "fig_3_8": Entry(
        "Fig. 3.8: equilibria of the four static problems",
        "Four magnified bodies with lines across them: a bar that grows along itself, a beam that "
        "sags to its free end, one that sags in its middle, and a pulled bar, thin and orange but "
        "at its fixed ends.",
        "chapter3",
        cases=tuple(
            name + rod
            for name in ("hanging_bar", "clamped_free", "clamped_clamped", "necking")
            for rod in ("", "_consistent")
        ),
    ),
    "fig_3_9": Entry(
        "Fig. 3.9: bar hanging under its own weight",
        "The displacement of the hanging bar rises and flattens towards its free end with the "
        "points on the curve; the differences of the published rod rise alike and are far "
        "smaller, those of the other are none.",
        "chapter3",
        cases=("hanging_bar", "hanging_bar_consistent"),
    ),
    "fig_3_10": Entry(
        "Fig. 3.10: clamped-free Timoshenko beam",
        "The beam sags more and more towards its free end and its sections turn ever less; in the "
        "differences the hollow squares drift away and the dots and diamonds stay near zero.",
        "chapter3",
        cases=("clamped_free", "clamped_free_ends_halved", "clamped_free_consistent"),
    ),
    "fig_3_11": Entry(
        "Fig. 3.11: clamped-clamped Timoshenko beam",
        "The beam sags in its middle and its sections turn opposite ways in its two halves; in "
        "the differences the dots make an arch above zero, and squares and diamonds stay near it.",
        "chapter3",
        cases=("clamped_clamped", "clamped_clamped_ends_halved", "clamped_clamped_consistent"),
    ),
    "fig_3_12": Entry(
        "Fig. 3.12: necking",
        "The section strain is flat along the bar and rises to zero within a short reach of both "
        "fixed ends; with the coupling as printed the points lie several times too deep.",
        "chapter3",
        cases=("necking", "necking_printed", "necking_consistent"),
    ),
    "fig_varied_sections": Entry(
        "A tapered beam, and a bar of two materials",
        "A beam that becomes thin towards its free end hangs less low than the dashed uniform one; the "
        "displacement of a bar bends sharply at its joint, and one row of markers misses the curve below "
        "it.",
        "varied",
        cases=("cone", "clamped_free", "two_materials", "two_materials_consistent"),
    ),
    "fig_low_centreline": Entry(
        "One body, two centrelines",
        "Two rows of markers sag differently for the same beam, while a solid and a dotted line lie on "
        "one another.",
        "varied",
        cases=(
            "clamped_free",
            "low_centreline",
            "clamped_free_consistent",
            "low_centreline_consistent",
        ),
    ),
    "fig_couple_and_support": Entry(
        "A couple, and a support that moves",
        "A clamped beam curls up in an even bend, its sections square to its axis; another beam bends "
        "down to a clamp that stands lower than the first and is tilted.",
        "varied",
        cases=("couple", "turned_support"),
    ),
    "fig_hook": Entry(
        "A rod that is curved at rest",
        "A filled curved rod lies on its dotted reference; an outlined straight one leaves it from the "
        "same clamp.",
        "varied",
        cases=("hook", "hook_printed"),
    ),
    "fig_calibration": Entry(
        "Calibration and the number of vertices",
        "At the published coefficients the answers of the two beams rise with the number of "
        "vertices and settle above one; of the coefficients that fit, the one of shear grows and "
        "grows.",
        "calibration",
        studies=("calibration",),
    ),
    "fig_3_13": Entry(
        "Fig. 3.13: free vibration",
        "The tip swings like a cosine, the stiffer beam a little faster than the others; the "
        "energy of the first mode pulses twice a swing, and the whole energy of the stiff beam "
        "has a fast ripple above it.",
        "motion",
        cases=("vibration_c4_2", "vibration_c4_20", "vibration_consistent"),
    ),
    "fig_edge_strains": Entry(
        "The strains of an edge",
        "A slanting edge with a director at each end and a vector half-way between their directions; two "
        "dashed legs split the edge along the normal of that vector and along the vector itself.",
        "edge_strains",
    ),
    "fig_convergence": Entry(
        "Errors of the consistent rod",
        "Grey lines of errors fall with slope minus two as edges are doubled, in statics and in "
        "vibration alike; one orange line, of the published rod, rises instead and levels off.",
        "consistent",
        studies=("convergence", "calibration"),
    ),
    "fig_far": Entry(
        "Large deflections",
        "Four strongly deformed rods: one bent up nearly upright, one rolled into a circle, a "
        "column that leans over past its foot, and an arch pushed through to its other side.",
        "consistent",
        cases=("elastica", "roll_up", "column_path", "arch_path"),
    ),
    "fig_paths": Entry(
        "Paths of equilibria",
        "The load on the column rises straight, turns sharply aside at Euler's load and climbs "
        "again along the exact curve; the load on the arch rises, falls below zero and rises, "
        "hollow while unstable.",
        "consistent",
        cases=("column_path", "arch_path"),
    ),
    "fig_tumbling": Entry(
        "A tumbling rod",
        "A straight rod turns over and over as it flies to the right; below, on a logarithmic "
        "axis, the changes of energy, momentum and angular momentum stay far under a dashed line.",
        "consistent",
        cases=("tumbling",),
        round_off=True,
    ),
    "fig_conventions": Entry(
        "Frames and signs",
        "Three drawings: a bent rod with its axes and surfaces, a cut with normal force, shear "
        "force and moment in their positive senses, and a straight stress profile over the "
        "height.",
        "conventions",
    ),
    "fig_modes": Entry(
        "The lowest modes of the vibrating beam",
        "Four mode shapes of a clamped beam with arrows: bent once, bent twice, moved along its "
        "axis, and bent three times, each with its opposite as a dotted outline.",
        "motion",
        cases=("vibration_c4_20",),
    ),
    "fig_worm_stride": Entry(
        "Which inputs decide the stride",
        "Bars show that advancing pressure, radius and length decide most of the stride; two "
        "clouds of points rise with the two strongest inputs.",
        "studies",
        studies=("worm_stride",),
    ),
    "fig_calibration_reach": Entry(
        "How far the published calibration reaches",
        "The sag over that of the beam falls with slenderness; curves of different numbers of "
        "vertices lie apart, those of different Poisson's ratios nearly on one another.",
        "studies",
        studies=("calibration_reach",),
    ),
    "fig_column_strength": Entry(
        "The strength of imperfect columns",
        "Strength falls as the bow grows, the computed dots on the crosses of the formula; the "
        "histogram beside it is broad with its median near its middle.",
        "studies",
        studies=("column_strength",),
    ),
    "fig_peers": Entry(
        "Error against time",
        "In three panels with logarithmic axes the points of two packages lie together or side by "
        "side at the left, those of the third far to the right with an equal or larger error.",
        "peers",
        tables=("peers.csv",),
    ),
}
