"""The reproduction of one publication: E. G. Hemingway's thesis (Berkeley, 2020).

Its cases, its worm, the table of its numbers with their judge, its figures, the errata, and the book.  Outside this
folder only `cosserat.publications` names it.
"""

from cosserat.kinds import Kind
from cosserat.publications import Publication

PUBLICATION = Publication(
    title="commands that reproduce E. G. Hemingway's thesis (Berkeley, 2020)",
    reference=(
        "E. G. Hemingway, Cosserat Curves: Descriptions of Peristalsis and a Discrete Model, UC Berkeley, 2020"
    ),
    kinds={
        "body mass": Kind("cosserat.thesis.earthworm:BodyMass"),
        "worm calibration": Kind("cosserat.thesis.worm_calibration:WormCalibration"),
    },
    folder="cosserat.thesis.cases",
    cases=("chapter2.toml", "chapter3.toml", "studies.toml"),
    variables="cosserat.thesis.variables:VARIABLES",
    commands="cosserat.thesis.commands:add_commands",
)
