"""What a stored result took to compute, for a person."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr


def effort(dataset: xr.Dataset) -> str:
    """What solving took, in a few words."""
    from cosserat.data.dataset import statistics_of

    done = statistics_of(dataset)
    if "instants" in done:
        how = (
            f"{done['newton_iterations']} Newton iterations"
            if "newton_iterations" in done
            else f"solve_bvp with up to {done['most_nodes']} nodes"
        )
        return f"{done['instants']} instants, {how}"
    if "crawls" in done:
        return f"{done['crawls']} crawls"
    if "misfit_evaluations" in done:
        return f"{done['misfit_evaluations']} evaluations of the misfits"
    if "points" in done:
        reached = done["load_factor_reached"]
        end = "" if reached == 1 else "; that was the last arc, raise 'arc.count' to go on"
        return (
            f"{done['points']} points, {done['unstable_points']} of them unstable, up to {reached:.4g} of the load, "
            f"{done['iterations']} Newton iterations{end}"
        )
    if "steps" in done:
        return f"{dataset.sizes['time'] - 1} frames in {done['steps']} steps"
    if "residual_N" not in done:
        return ", ".join(f"{value} {key}" for key, value in done.items())
    return (
        f"{done['iterations']} Newton iterations, largest unbalanced force {done['residual_N']:.2g} N "
        f"(allowed {done['tolerance_N']:.2g} N)"
    )
