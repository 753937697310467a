"""The ways to refine a case: the vertices of a rod, the steps of a motion, elements and instants of a crawl."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cosserat.problem import Problem
from cosserat.problems.crawl import Crawl
from cosserat.problems.crawler import CrawlerProblem
from cosserat.problems.motion import RodMotion
from cosserat.publications import kinds
from cosserat.rods.problem import RodProblem
from cosserat.solvers.integrate import step_count
from cosserat.studies.keys import put, table_of


@dataclass(frozen=True)
class Refinement:
    """One way to refine a case.

    paths : the keys that change together, the first names it.  count : of intervals in the case.  least : fewest.
    more : of a key that counts, its value less the intervals.  whole : else, what its value is the equal part of.
    """

    paths: tuple[str, ...]
    count: int
    least: int
    more: int = 0
    whole: float | None = None

    def values(self, count: int) -> dict[str, object]:
        """The values of the keys for so many intervals."""
        value = count + self.more if self.whole is None else self.whole / count
        return dict.fromkeys(self.paths, value)

    def said(self, count: int) -> str:
        """The value of the keys for so many intervals, in words."""
        return f"{self.values(count)[self.paths[0]]:.6g}" + ("" if self.whole is None else " s")

    def others(self) -> list[int]:
        """Other numbers of intervals in the order in which they are tried; those that halve come first."""
        coarser = [
            self.count // k for k in (2, 4) if self.count % k == 0 and self.count // k >= self.least
        ]
        return [*coarser, *(self.count * k for k in (2, 4, 8))]


def refinements(problem: Problem) -> tuple[Refinement, ...]:
    """The ways to refine a problem, by its kind."""
    function = kinds()[problem.kind].refined_function()
    return () if function is None else tuple(function(problem))


def of_rod(problem: RodProblem) -> list[Refinement]:
    """More vertices."""
    inner = ("start_from.rod.vertices",) if getattr(problem, "start_from", None) is not None else ()
    return [Refinement(("rod.vertices", *inner), problem.rod.vertices - 1, 2, more=1)]


def of_motion(problem: RodMotion) -> list[Refinement]:
    """More vertices, and shorter steps where the method has them."""
    if problem.integrator.method == "rk45":
        return of_rod(problem)
    count = step_count(problem.between_frames, problem.integrator)
    return [*of_rod(problem), Refinement(("integrator.step",), count, 1, whole=problem.between_frames)]


def of_crawler(problem: CrawlerProblem) -> list[Refinement]:
    """More elements, where the solver has them."""
    if problem.solver != "banded":
        return []
    return [Refinement(("mesh.elements",), problem.mesh.elements, 3)]


def of_crawl(problem: Crawl) -> list[Refinement]:
    """More elements and more instants."""
    return [*of_crawler(problem), Refinement(("step",), 4, 2, whole=4 * problem.step)]


def by_place(problem: Problem) -> dict[str, Any]:
    """The table of a problem whose places are no numbers of vertices, which are other places on other meshes."""
    table, arc = table_of(problem), getattr(problem, "arc_length", None)
    if arc is None:
        return table
    for prefix, owner in (("", problem), ("start_from.", getattr(problem, "start_from", None))):
        for name, items in dict(owner).items() if owner is not None else ():
            for k, item in enumerate(items if isinstance(items, tuple) else ()):
                at = getattr(item, "at", None)
                if type(at) is int:
                    path = f"{prefix}{name}.{k}.at".split(".")
                    table = put(table, path, "last" if at == arc.size - 1 else f"{float(arc[at])!r} m")
    return table
