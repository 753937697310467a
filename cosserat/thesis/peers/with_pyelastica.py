"""PyElastica on one problem: `python with_pyelastica.py PROBLEM` prints, as JSON, the versions it uses, then an answer
for each line of its input.

It has no static solver: relaxation with the critical damping of the first mode gives equilibria.  Its first element
straddles the wall, which makes its clamp second order.  Its step is nine tenths of the stable one.
"""

# mypy: ignore-errors
import json
import platform
import sys
import time
from importlib.metadata import version

import elastica as ea
import numpy as np

_MAX_ELEMENTS = 200  # of a motion: with 2000, 0.2 s take 440 000 steps


class World(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    """The system of PyElastica, with its features."""


def rod_of(problem):
    """A rod with the section of the problem: its round one, stiffnesses rescaled."""
    n = problem["elements"]
    edge = problem["length"] / (n - 0.5)
    area = 12 * problem["rotary"] / problem["line_density"]  # of a square, side^2 = 12 I / A
    young = problem["axial"] / area
    density = problem["line_density"] / area
    rod = ea.CosseratRod.straight_rod(
        n,
        np.array([-edge / 2, 0.0, 0.0]),
        np.array([1.0, 0, 0]),
        np.array([0.0, 0, 1.0]),
        n * edge,
        np.sqrt(area / np.pi),
        density,
        youngs_modulus=young,
        shear_modulus=young / 2,
    )
    bending = problem["bending"] / (young * area**2 / (4 * np.pi))
    rod.bend_matrix[:] *= bending
    rod.mass_second_moment_of_inertia[:] *= bending
    rod.inv_mass_second_moment_of_inertia[:] /= bending
    for k in (0, 1):
        rod.shear_matrix[k, k] *= problem["shear"] / (27 / 28 * young / 2 * area)
    return rod, edge


def stable_step(problem, edge):
    """Two over the highest frequency of the staggered beam."""
    square = (2 / edge) ** 2
    shear, bending = problem["shear"], problem["bending"]
    stiffness = np.array(
        [[shear * square, shear * np.sqrt(square)], [shear * np.sqrt(square), shear + bending * square]]
    )
    mass = np.diag([problem["line_density"], problem["rotary"]])
    highest = max(
        np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real.max(),
        problem["axial"] / problem["line_density"] * square,
    )
    return 2 / np.sqrt(highest)


def shape(problem, x):
    """First mode of a clamped Bernoulli-Euler beam, of unit tip, and its slope."""
    b = 1.8751040687119611
    c = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))
    s = b * np.maximum(x, 0) / problem["length"]
    w = np.cosh(s) - np.cos(s) - c * (np.sinh(s) - np.sin(s))
    slope = b / problem["length"] * (np.sinh(s) + np.sin(s) - c * (np.cosh(s) - np.cos(s)))
    return w / 2, slope / 2


def build(problem):
    """The rod in its world, the step, and how long to run."""
    rod, edge = rod_of(problem)
    step = 0.9 * stable_step(problem, edge)
    first = 3.516 / problem["length"] ** 2 * np.sqrt(problem["bending"] / problem["line_density"])
    world = World()
    world.append(rod)
    world.constrain(rod).using(
        ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,)
    )
    if problem["kind"] == "vibration":
        w, _ = shape(problem, rod.position_collection[0])
        rod.position_collection[1] = problem["load"] * w
        middle = (rod.position_collection[0, 1:] + rod.position_collection[0, :-1]) / 2
        _, slope = shape(problem, middle)
        turn = problem["load"] * slope
        turn[0] = 0.0
        rod.director_collection[1, 0], rod.director_collection[1, 1] = np.sin(turn), -np.cos(turn)
        rod.director_collection[2, 0], rod.director_collection[2, 1] = np.cos(turn), np.sin(turn)
        world.finalize()
        return world, rod, step, problem["duration"]
    if problem["kind"] == "weight":
        pull = np.array([0.0, -problem["load"] / problem["line_density"], 0.0])
        world.add_forcing_to(rod).using(ea.GravityForces, acc_gravity=pull)
    else:
        force = np.array([0.0, problem["load"], 0.0])
        world.add_forcing_to(rod).using(ea.EndpointForces, 0 * force, force, ramp_up_time=0.1 / first)
    world.dampen(rod).using(
        ea.AnalyticalLinearDamper, uniform_damping_constant=2 * first, time_step=step
    )
    world.finalize()
    return world, rod, step, 14 / first


def solve(problem, steps=None):
    """One run: seconds of the stepping alone, and the answer; or a given number of steps, to compile the kernels."""
    built = time.perf_counter()
    world, rod, step, duration = build(problem)
    count = steps or int(np.ceil(duration / step))
    stepper, now, times, tips = ea.PositionVerlet(), 0.0, [], []
    start = time.perf_counter()
    for k in range(count):
        now = stepper.step(world, now, duration / max(count, 3))
        if k % max(1, count // 400) == 0:
            times.append(float(now))
            tips.append(float(rod.position_collection[1, -1]))
    seconds = time.perf_counter() - start
    kept = rod.position_collection[0] >= 0
    edge = problem["length"] / (problem["elements"] - 0.5)
    places = (np.arange(problem["elements"] + 1) - 0.5) * edge
    return {
        "seconds": seconds,
        "whole": time.perf_counter() - built,
        "times": times,
        "tips": tips,
        "tip": float(rod.position_collection[1, -1]),
        "profile": rod.position_collection[1][kept].tolist(),
        "places": places[kept].tolist(),
    }


def main():
    """Print the versions, or {} for a problem that would take too long; then run once for every line of input."""
    problem = json.loads(sys.argv[1])
    if problem["kind"] == "vibration" and problem["elements"] > _MAX_ELEMENTS:
        print("{}")
        return
    solve(problem, steps=2)
    names = ("pyelastica", "numpy", "numba")
    used = {"python": platform.python_version()} | {name: version(name) for name in names}
    print(json.dumps(used), flush=True)
    for _ in sys.stdin:
        print(json.dumps(solve(problem)), flush=True)


main()
