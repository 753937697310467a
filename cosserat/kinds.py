"""The registry of the kinds of problems.

A kind is a class of parameters that can be solved, and a function that draws its result.  Both are named by
"module:object" and imported when needed, which keeps the command line quick.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from cosserat.problem import Problem


@dataclass(frozen=True)
class Kind:
    """One kind.

    problem : a subclass of `cosserat.problem.Problem`.
    picture : a function from a Dataset to a figure; empty if `cosserat plot` has none.
    animate : a function from a Dataset to an animation of Matplotlib; empty if nothing moves.
    """

    problem: str
    picture: str = ""
    animate: str = ""

    def problem_class(self) -> type[Problem]:
        """The class of its parameters."""
        return cast("type[Problem]", pkgutil.resolve_name(self.problem))

    def picture_function(self) -> Callable[..., Any]:
        """The function that draws its result."""
        return cast("Callable[..., Any]", pkgutil.resolve_name(self.picture))

    def animation_function(self) -> Callable[..., Any]:
        """The function that animates its result."""
        return cast("Callable[..., Any]", pkgutil.resolve_name(self.animate))


KINDS = {
    "rod statics": Kind("cosserat.problems.static:RodStatics", "cosserat.figures.rod:picture"),
    "rod motion": Kind(
        "cosserat.problems.motion:RodMotion",
        "cosserat.figures.motion:picture",
        "cosserat.figures.animations:motion",
    ),
    "rod path": Kind(
        "cosserat.problems.path:RodPath",
        "cosserat.figures.path:picture",
        "cosserat.figures.animations:path",
    ),
    "modes": Kind(
        "cosserat.problems.modes:RodModes",
        "cosserat.figures.modes:picture",
        "cosserat.figures.animations:modes",
    ),
    "critical loads": Kind(
        "cosserat.problems.critical:RodCriticalLoads", "cosserat.figures.modes:critical_picture"
    ),
    "calibration": Kind("cosserat.studies.calibration:CalibrationProcedure"),
    "convergence": Kind("cosserat.studies.convergence:Convergence"),
    "posture": Kind("cosserat.problems.crawl:Posture", "cosserat.figures.crawlers:picture"),
    "crawl": Kind(
        "cosserat.problems.crawl:Crawl",
        "cosserat.figures.crawlers:picture",
        "cosserat.figures.animations:crawl",
    ),
}
"""Kinds by the value of `kind` in a case; `cosserat.publications` adds those of each publication."""
