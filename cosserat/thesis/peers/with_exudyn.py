"""Exudyn's geometrically exact linear beam on one problem.

`python with_exudyn.py PROBLEM` prints, as JSON, the versions it uses, then an answer for each line of its input.

Static problems use its Newton solver, with five load steps for large deflections, its best number; motion uses its
implicit trapezoidal rule with a modified Newton method.
"""

# mypy: ignore-errors
import json
import platform
import sys
import time
from importlib.metadata import version

import exudyn as exu
import numpy as np
from exudyn.beams import GenerateBeamElementsAlongLine
from exudyn.itemInterface import (
    LoadForceVector,
    MarkerNodePosition,
    ObjectBeamGeometricallyExact2D,
    SensorNode,
)

_MAX_DENSE_ELEMENTS = 25  # elements up to which its dense solver is faster


def shape(problem, x):
    """First mode of a clamped Bernoulli-Euler beam, of unit tip, and its slope."""
    b = 1.8751040687119611
    c = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))
    s = b * x / problem["length"]
    w = np.cosh(s) - np.cos(s) - c * (np.sinh(s) - np.sin(s))
    slope = b / problem["length"] * (np.sinh(s) + np.sin(s) - c * (np.cosh(s) - np.cos(s)))
    return w / 2, slope / 2


def build(problem):
    """The beam along x, clamped at its start."""
    system = exu.SystemContainer().AddSystem()
    beam = ObjectBeamGeometricallyExact2D(
        nodeNumbers=[-1, -1],
        physicsMassPerLength=problem["line_density"],
        physicsCrossSectionInertia=problem["rotary"],
        physicsBendingStiffness=problem["bending"],
        physicsAxialStiffness=problem["axial"],
        physicsShearStiffness=problem["shear"],
    )
    gravity = -problem["load"] / problem["line_density"] if problem["kind"] == "weight" else 0.0
    made = GenerateBeamElementsAlongLine(
        system,
        [0, 0, 0],
        [problem["length"], 0, 0],
        problem["elements"],
        beam,
        gravity=[0, gravity, 0],
        groundConstraintsStart=[1, 1, 1],
    )
    nodes = made["nodes"]
    if problem["kind"] == "force":
        marker = system.AddMarker(MarkerNodePosition(nodeNumber=nodes[-1]))
        system.AddLoad(LoadForceVector(markerNumber=marker, loadVector=[0, problem["load"], 0]))
    if problem["kind"] == "vibration":
        for node, x in zip(nodes, np.linspace(0, problem["length"], len(nodes)), strict=True):
            w, slope = shape(problem, x)
            start = [0, problem["load"] * w, problem["load"] * slope]
            system.SetNodeParameter(node, "initialCoordinates", start)
    sensor = system.AddSensor(
        SensorNode(
            nodeNumber=nodes[-1],
            storeInternal=True,
            writeToFile=False,
            outputVariableType=exu.OutputVariableType.Displacement,
        )
    )
    system.Assemble()
    return system, nodes, sensor


def settings(problem):
    """Settings of its solver, quiet, with tolerances like ours."""
    chosen = exu.SimulationSettings()
    chosen.solution.file.write = False
    sparse, dense = exu.LinearSolverType.EigenSparse, exu.LinearSolverType.EXUdense
    chosen.linearSolver.solverType = dense if problem["elements"] <= _MAX_DENSE_ELEMENTS else sparse
    chosen.staticSolver.numberOfLoadSteps = 5 if problem["kind"] == "force" else 1
    chosen.staticSolver.newton.relativeTolerance = 1e-9
    chosen.staticSolver.newton.maxIterations = 50
    chosen.staticSolver.verboseMode = chosen.timeIntegration.verboseMode = 0
    chosen.timeIntegration.endTime = problem["duration"]
    chosen.timeIntegration.numberOfSteps = problem["steps"]
    chosen.timeIntegration.generalizedAlpha.spectralRadius = 1
    chosen.timeIntegration.newton.useModifiedNewton = True
    chosen.solution.sensors.writePeriod = problem["duration"] / problem["steps"]
    return chosen


def solve(problem):
    """One run: seconds of the solver alone, and from the parameters to the answer, and the answer."""
    built = time.perf_counter()
    system, nodes, sensor = build(problem)
    chosen = settings(problem)
    moving = problem["kind"] == "vibration"
    start = time.perf_counter()
    done = (
        system.SolveDynamic(chosen) if moving else system.SolveStatic(chosen, updateInitialValues=True)
    )
    seconds = time.perf_counter() - start
    if not done:
        raise SystemExit("the solver reports no success")
    if moving:
        record = system.GetSensorStoredData(sensor)
        tips = {"times": record[:, 0].tolist(), "tips": record[:, 2].tolist()}
        return {"seconds": seconds, "whole": time.perf_counter() - built, **tips}
    position = exu.OutputVariableType.Position
    places = np.array([system.GetNodeOutput(node, position) for node in nodes])
    whole = time.perf_counter() - built
    return {
        "seconds": seconds,
        "whole": whole,
        "profile": places[:, 1].tolist(),
        "tip": float(places[-1, 1]),
    }


def main():
    """Print the versions, then run once for every line of input."""
    problem = json.loads(sys.argv[1])
    used = {"python": platform.python_version()} | {name: version(name) for name in ("exudyn", "numpy")}
    print(json.dumps(used), flush=True)
    for _ in sys.stdin:
        print("\n" + json.dumps(solve(problem)), flush=True)


main()
