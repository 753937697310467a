"""`python -m tests.studies.gradients [CASE...]`: derivatives against differenced solves of the same cases.

The solves have the tolerance 1e-14, those of crawlers 1e-13, and know nothing of tangents.  Their differences use
Ridders' method: steps shrink, a table of extrapolations grows, and the entry that changes least is taken.  Exit 1
where an error is above 1e-8 of the largest derivative of the read-out, each times the value of its key.  `stride` has
a stride once more by other means: `by_other_means` compares with it.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

import cosserat

from .stride import derivative

FILE = Path(__file__).with_suffix(".toml")
ROD = (
    "rod.material.young",
    "rod.material.poisson",
    "rod.section.width",
    "rod.section.height",
    "rod.length",
)
BENT = {
    "tip": "u.E2 at last",
    "bent": "max |kappa|",
    "stored": "strain_energy",
    "size": "norm u.E2",
    "inside": "u.E2 at 0.33 m",
    "held": "reaction_moment.first",
    "stress": "max fibre_stress",
}
SHORT = {"tip": "u.E2 at last", "bent": "max |kappa|", "held": "reaction_moment.first"}
MODES = {
    "first": "natural_frequency at 0",
    "third": "natural_frequency at 2",
    "shape": "norm mode_u.E2 at 0",
    "shared": "effective_mass.E2 at 0",
}
FACTORS = {"linear": "linear_load_factor at 0", "true": "max special_load_factor"}
MATTER = ("crawler.material.young", "loads.anchoring", "loads.advancing", "loads.gravity")
STRIDE = ("crawler.length", "crawler.radius", *MATTER[:3])
BODY = ("crawler.length", "crawler.radius", *MATTER)
CRAWL = {
    "stride": "change along at last",
    "middle": "final along at 33",
    "held": "final anchor_along",
    "stretch": "max mu_3",
}
SHAPES = {
    **FACTORS,
    "second": "norm linear_u at 1",
    "thick": "norm linear_delta at 0",
    "place": "norm special_x.E2",
}
CASES = {
    "bent": ((*ROD, "rod.section.shear_factor", "rod.material.density", "forces.0.force"), BENT),
    "moved": (
        (*ROD, "forces.0.force", "prescribed_displacements.0.by", "prescribed_rotations.0.by"),
        {"middle": "u.E2 at 10", "bent": "max |kappa|", "held": "reaction_force.E3.last"},
    ),
    "oblique": (
        (
            *ROD,
            "forces.0.force",
            "rod.rest.curvature",
            "springs.0.stiffness",
            "springs.1.rotational_stiffness",
            "temperatures.0.gradient",
        ),
        SHORT,
    ),
    "followed": ((*ROD, "follower_forces.0.force", "gravity.g", "rod.material.density"), SHORT),
    "published": (
        ("rod.material.young", "rod.material.poisson", "rod.section.width", "rod.section.height", "rod.length",
         "gravity.g", "rod.calibration.c3"),
        {"tip": "u.E2 at last", "bent": "max |kappa|", "turned": "max |phi|"},
    ),
    "posed": ((*ROD, "pose.curvature", "forces.0.force"), {"middle": "u.E2 at 10", "held": "reaction_moment.first"}),
    "vibrating": ((*ROD, "rod.material.density", "forces.0.force"), MODES),
    "fluttering": (
        (*ROD, "rod.material.density", "follower_forces.0.force"),
        {"first": "natural_frequency at 0", "third": "natural_frequency at 2"},
    ),
    "free": ((*ROD, "rod.material.density"), {"first": "natural_frequency at 3", "second": "natural_frequency at 4"}),
    "robot": ((*BODY, "crawler.density", "crawler.material.poisson", "gait.phases.1", "gait.gamma.0.1.1"), CRAWL),
    "robot_as_printed": ((*BODY, "crawler.density", "crawler.material.poisson"), CRAWL),
    "earthworm": ((*BODY, "crawler.mass", "gait.gamma.0.2.1", "gait.anchor.0.1.1"),
                  {**CRAWL, "inside": "max p_coelom"}),
    "earthworm_as_printed": ((*BODY, "crawler.mass", "gait.gamma.0.2.1"), {**CRAWL, "inside": "final p_coelom at 20"}),
    "tapered": ((*MATTER, "crawler.mass", "crawler.segments.0.radius.0", "crawler.segments.1.young.1", "gait.ramp"),
                {**CRAWL, "inside": "final p_coelom at 33"}),
    "chambered": ((*BODY, "gait.ramp", "gait.chambers.0.begin", "gait.chambers.0.pressure", "gait.chambers.2.force"),
                  CRAWL),
    "measured": (("crawler.length", "gait.measured.0.length", "gait.measured.1.length", "gait.measured.2.length"),
                 CRAWL),
    "posture": ((*BODY, "regions.1.pressure", "crawler.material.poisson"),
                {"length": "max along", "thickest": "max |height|", "stretch": "mu_3 at 30",
                 "place": "along at 0.1 m"}),
    "column": (ROD, {**FACTORS, "thick": "norm linear_delta at 0", "place": "norm special_x"}),
    "posed_arch": ((*ROD, "pose.curvature", "forces.1.force"), SHAPES),
    "begun_column": (("gravity.g",), FACTORS),
    "begun": (("forces.0.force",), MODES),
    "arch": ((*ROD, "rod.rest.curvature", "forces.1.force"), SHAPES),
}  # fmt: skip


def read(case, key, values, of):
    """The read-outs of a case solved to round-off for some values of a key, (values, read-outs)."""
    solver, tolerance = ("mesh", 1e-13) if hasattr(case.problem, "crawler") else ("newton", 1e-14)
    members = {key: list(values), f"{solver}.tolerance": [tolerance]}
    found = cosserat.study(case, members, of, name="near", progress=lambda *_: None)
    assert (found["status"] <= 1).all(), found["reason"].to_numpy()
    return np.array([found[name].to_numpy().ravel() for name in of]).T


def differenced(case, key, value, of):
    """Derivatives by a key times its value, by Ridders' method on whole solves, (read-outs,)."""
    steps = 2.0 ** -np.arange(5.0, 11.0)
    ahead, behind = np.split(read(case, key, value * (1 + np.concatenate([steps, -steps])), of), 2)
    best, error, before = None, np.full(len(of), np.inf), []
    for first in (ahead - behind) / (2 * steps[:, None]):
        row = [first]
        for order, coarse in enumerate(before, start=1):
            row.append(row[-1] + (row[-1] - coarse) / (4**order - 1))
            change = np.maximum(np.abs(row[-1] - row[-2]), np.abs(row[-1] - coarse))
            best = row[-1].copy() if best is None else np.where(change < error, row[-1], best)
            error = np.minimum(change, error)
        before = row
    return best


def compared(name, keys=None):
    """Largest error over the largest scaled derivative of each read-out, its name, and seconds of both ways."""
    case = cosserat.load_cases(FILE)[name]
    own, of = CASES[name]
    keys = keys or own
    began = time.process_time()
    found = cosserat.sensitivity(case, keys, of)
    exact = time.process_time() - began
    values = {found[name].attrs.get("key"): found[name].item() for name in found.coords if name != "key"}
    slow = np.array([differenced(case, key, values[key], of) for key in keys])
    errors = {}
    for number, read_out in enumerate(of):
        quick = found[f"{read_out}_scaled"].sel(key=list(keys)).to_numpy()
        errors[read_out] = np.abs(quick - slow[:, number]).max() / np.abs(slow[:, number]).max()
    return errors, exact, time.process_time() - began - exact


def by_other_means(degree, keys=STRIDE):
    """Largest error of the stride of the earthworm, and of its scaled derivatives over the largest of them."""
    case = cosserat.case("worm").vary("one_stride", strides=1, step="10 s")
    found = cosserat.sensitivity(case, list(keys), {"stride": "change along at last"})
    exact = np.array([derivative(key.rpartition(".")[2], degree) for key in keys])
    errors = np.abs(found["stride_scaled"].to_numpy() - exact[:, 1]).max() / np.abs(exact[:, 1]).max()
    return abs(found["stride"].item() / exact[0, 0] - 1), errors


def main(names):
    worst = 0.0
    if not names:
        value, worst = by_other_means(160)
        print(f"stride by other means: {value:.1e} of it, its derivatives {worst:.1e}", flush=True)
    for name in names or CASES:
        errors, exact, slow = compared(name)
        worst = max(worst, *errors.values())
        said = ", ".join(f"{read_out} {error:.1e}" for read_out, error in errors.items())
        print(f"{name:12s} {exact:6.2f} s against {slow:6.2f} s: {said}", flush=True)
    print(f"largest error {worst:.1e} of the largest scaled derivative")
    return int(worst > 1e-8)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
