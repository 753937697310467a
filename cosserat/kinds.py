"""The registry of the kinds of problems.

A kind is a class of parameters that can be solved, and functions that draw its result.  They are named by
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
    animate : a function from a Dataset and a number of frames to a `cosserat.figures.stage.Stage`, or empty.
    mesh : a function from a Dataset to the body as a `cosserat.export.mesh.Body`; empty if there is no body.
    moving : a function to a `cosserat.problems.tangents.Motion`, for exact derivatives; empty if there is none.
    refined : a function from a problem to its `cosserat.studies.analysis.refinements.Refinement`; empty without any.
    """

    problem: str
    picture: str = ""
    animate: str = ""
    mesh: str = ""
    moving: str = ""
    refined: str = ""

    def problem_class(self) -> type[Problem]:
        """The class of its parameters."""
        return cast("type[Problem]", pkgutil.resolve_name(self.problem))

    def picture_function(self) -> Callable[..., Any]:
        """The function that draws its result."""
        return cast("Callable[..., Any]", pkgutil.resolve_name(self.picture))

    def animation_function(self) -> Callable[..., Any]:
        """The function that animates its result."""
        return cast("Callable[..., Any]", pkgutil.resolve_name(self.animate))

    def moving_function(self) -> Callable[..., Any] | None:
        """The function by which its results move with a parameter, if there is one."""
        return cast("Callable[..., Any]", pkgutil.resolve_name(self.moving)) if self.moving else None

    def refined_function(self) -> Callable[..., Any] | None:
        """The function that names the ways to refine a problem, if there is one."""
        return cast("Callable[..., Any]", pkgutil.resolve_name(self.refined)) if self.refined else None

    def mesh_function(self) -> Callable[..., Any]:
        """The function that makes a mesh of its body."""
        return cast("Callable[..., Any]", pkgutil.resolve_name(self.mesh))


_ROD, _CRAWLER = "cosserat.export.mesh:rod", "cosserat.export.mesh:crawler"
_REFINED = "cosserat.studies.analysis.refinements"

STUDY_CLASS = "cosserat.studies.study:Study"
"""Class of a study, which is a table of a case file and no problem."""

FIT_CLASS = "cosserat.studies.analysis.fitting:Fit"
"""Class of a fit, likewise."""

KINDS = {
    "rod statics": Kind(
        "cosserat.problems.static:RodStatics",
        "cosserat.figures.rod:picture",
        mesh=_ROD,
        moving="cosserat.problems.moving:moving_statics",
        refined=f"{_REFINED}:of_rod",
    ),
    "rod motion": Kind(
        "cosserat.problems.motion:RodMotion",
        "cosserat.figures.motion:picture",
        "cosserat.figures.animations:motion",
        _ROD,
        refined=f"{_REFINED}:of_motion",
    ),
    "rod path": Kind(
        "cosserat.problems.path:RodPath",
        "cosserat.figures.path:picture",
        "cosserat.figures.animations:path",
        _ROD,
        refined=f"{_REFINED}:of_rod",
    ),
    "modes": Kind(
        "cosserat.problems.modes:RodModes",
        "cosserat.figures.modes:picture",
        "cosserat.figures.animations:modes",
        _ROD,
        "cosserat.problems.moving_modes:moving_modes",
        f"{_REFINED}:of_rod",
    ),
    "critical loads": Kind(
        "cosserat.problems.critical:RodCriticalLoads",
        "cosserat.figures.modes:critical_picture",
        "cosserat.figures.animations:critical",
        moving="cosserat.problems.moving_critical:moving_critical",
        refined=f"{_REFINED}:of_rod",
    ),
    "calibration": Kind("cosserat.problems.calibration:Calibration"),
    "discretization errors": Kind("cosserat.problems.discretization:DiscretizationErrors"),
    "posture": Kind(
        "cosserat.problems.crawl:Posture",
        "cosserat.figures.crawlers:picture",
        mesh=_CRAWLER,
        moving="cosserat.problems.moving_crawl:moving_posture",
        refined=f"{_REFINED}:of_crawler",
    ),
    "crawl": Kind(
        "cosserat.problems.crawl:Crawl",
        "cosserat.figures.crawlers:picture",
        "cosserat.figures.crawling:animate",
        _CRAWLER,
        "cosserat.problems.moving_crawl:moving_crawl",
        f"{_REFINED}:of_crawl",
    ),
}
"""Kinds by the value of `kind` in a case; `cosserat.publications` adds those of each publication."""
