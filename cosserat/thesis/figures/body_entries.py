"""The entries of the figures of directed rods, worms and robots."""

from __future__ import annotations

from cosserat.thesis.figures.entry import Entry

BODIES: dict[str, Entry] = {
    "fig_opening": Entry(
        "What the package solves",
        "Four bodies of a worm below each other, orange where thin and long and blue where fat "
        "and short, above a column that buckles, an arch that snaps through and a thrown rod.",
        "opening",
        cases=("worm", "column_path", "arch_path", "tumbling"),
    ),
    "fig_directed_rod": Entry(
        "A directed rod as the body it stands for",
        "A tube that is fat and short in its rear half and thin and long in front; its axis steps "
        "down with it, and in three sections two arrows at right angles reach from the axis to "
        "the boundary.",
        "chapter1",
        cases=("soft_robot",),
    ),
    "fig_directors": Entry(
        "Directors of a bar",
        "A straight block with three arrows at right angles, and below it the same block curved, with a "
        "thin and long part in its middle; there the arrows across it are short and the one along it is long.",
        "beams",
    ),
    "fig_slice": Entry(
        "A slice of a rod and its loads",
        "Three squares with arrows: one oblique force on each face and one at the middle; arrows up "
        "and down at faces, middle and surface; and arrows that pull above and push below.",
        "beams",
    ),
    "fig_strains": Entry(
        "Six strains of one section",
        "Six small blocks over their dotted shapes at rest: one is longer, one is sheared in its end "
        "face, one is higher, one wider, and two slope up or aside with upright ends.",
        "beams",
    ),
    "fig_gradients": Entry(
        "Six changes from one section to the next",
        "Six small blocks over their dotted shapes at rest: one is an arch, one curves aside, one "
        "grows in height and one in width along itself, and two are twisted or skewed more and more.",
        "beams",
    ),
    "fig_worm_parts": Entry(
        "A crawling worm and its parts",
        "Two side views of a worm with names at its parts: the anchoring part is fat, the advancing "
        "parts are thin, a line stands at each front and a triangle under the anchor.",
        "worm_parts",
        cases=("worm",),
    ),
    "fig_2_1": Entry(
        "Fig. 2.1: a stride of the earthworm",
        "Six side views of the worm below each other: a fat anchoring region travels from front "
        "to rear while the thin regions before and behind it slide forward.",
        "chapter2",
        cases=("worm", "worm_printed"),
    ),
    "fig_2_2": Entry(
        "Fig. 2.2: segment 50 over three strides",
        "Over time the section switches between fat and long: two stretches fall as the third "
        "rises, and the pressure jumps up in the same instants; dashed lines are the measured "
        "levels.",
        "chapter2",
        cases=("worm", "worm_printed"),
        rows=(
            "2.8.6-mu1-ratio",
            "2.8.6-mu3-ratio",
            "2.8-p-longitudinal-measured",
            "2.8-p-circular-measured",
        ),
    ),
    "fig_2_5": Entry(
        "Fig. 2.5: muscles as forces along the centreline",
        "The load of one muscle is a block upwards beside an equal one downwards, and its force "
        "is a triangle below zero; with more and more muscles in a row the triangle becomes "
        "nearly a rectangle.",
        "chapter2",
    ),
    "fig_five_regions": Entry(
        "Five regions of muscles",
        "A worm with two thin parts between three fat ones; along it each stretch is flat within a "
        "part and changes steeply where two parts meet, over less than the radius of the body.",
        "postures",
        cases=("worm", "worm_at_rest"),
    ),
    "fig_2_7": Entry(
        "Fig. 2.7: a cycle of push and pull",
        "Eight side views of the robot in three groups: its front grows thin and long while the "
        "rear holds, both fronts pass, then the rear is pulled up while the front holds.",
        "gaits",
        cases=("soft_robot",),
    ),
    "fig_2_8": Entry(
        "Fig. 2.8: fronts of the push-pull gait",
        "Two falling rows of points in each cycle, one for each front, enclose a slanted band of "
        "advancing load; everything else is anchoring load, and a pause at rest comes first.",
        "gaits",
        cases=("soft_robot",),
    ),
    "fig_2_9": Entry(
        "Fig. 2.9: the soft robot crawls",
        "Both ends of the robot climb in steps, first the front end and then the rear one, and "
        "the drawn bodies of the second cycle are those of the first further along.",
        "gaits",
        cases=("soft_robot",),
    ),
    "fig_2_11": Entry(
        "Fig. 2.11: fronts of the protrusion-stance gait",
        "The fronts fall from the front end to the rear end again and again; slanted bands of "
        "advancing load between them widen and narrow, and one front bends down to twice its "
        "speed.",
        "gaits",
        cases=("worm",),
    ),
    "fig_2_12": Entry(
        "Fig. 2.12: the anchored point",
        "The anchored point runs backwards in the first part of a stride, jumps to the rear end, "
        "stays, and jumps to the front end; the two readings differ only in when it reaches the "
        "rear end.",
        "chapter2",
        cases=("worm", "worm_early"),
    ),
    "fig_masses": Entry(
        "Earthworms of every size",
        "On logarithmic axes stride and speed rise and frequency falls with the mass; the line of "
        "constant stress runs along the one of the literature, and only its extreme stretches "
        "stay level.",
        "chapter2",
        studies=("worm_masses", "worm_masses_constant_pressure", "worm_masses_strip"),
    ),
}
