"""Where a crawler holds on: instants at which the anchored point lies in a thin part of the body.

A worm anchors where it thickens, section 2.1: in its anchoring regions.  Under artificial muscles with negative
pressure the advancing regions are the thicker ones.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from cosserat.peristalsis.gait import Instant
from cosserat.peristalsis.instant import InstantProblem

_EQUAL_STRETCH_TOLERANCE = 1e-3  # regions whose mu_1 differs by less are equally thick


def lies_thin(problem: InstantProblem, anchor: float) -> bool:
    """Whether a place lies in a thin span, by the homogeneous states: mu_1 is nearer to the least than to the largest.

    Raises
    ------
    InputError : the loads collapse a section.
    """
    mu = problem.plateaus[0][:, 0]
    least, largest = float(mu.min()), float(mu.max())
    if not largest - least > _EQUAL_STRETCH_TOLERANCE:
        return False
    holding = next(m for m, s in zip(mu, problem.spans, strict=True) if s.left <= anchor <= s.right)
    return bool(holding < (least + largest) / 2)


def warning(thin: Sequence[Instant], instants: Sequence[Instant], length: float) -> str | None:
    """One sentence on the instants of a stride whose anchor lies thin, else None; length : of the body [m]."""
    if not thin:
        return None
    found = {m.time for m in thin}
    held = [m.anchor * length for m in thin]
    places = f"{min(held):.4g}" + (f" to {max(held):.4g}" if max(held) > min(held) else "")
    times = [m.time for m in instants]
    runs = [list(run) for is_thin, run in itertools.groupby(times, found.__contains__) if is_thin]
    spans = " and ".join(f"{run[0]:.4g} to {run[-1]:.4g} s" for run in runs)
    return (
        f"thin anchor: at {len(found)} of {len(times)} instants of a stride (t = {spans}) the point that holds on, "
        f"xi = {places} m, lies where the body is thin, and crawlers hold on where they are fat; "
        "move 'gait.anchor' to a thicker part, or exchange 'gait.gamma' and 'gait.eta'"
    )
