"""Each problem of `cases.toml` that rests, and its crawlers, beside right values."""

import numpy as np

from . import closed, reissner, sides, timoshenko
from .checks import Row, check, converging, displaced, finer, frequencies, last, rectangle, run
from .reissner import CLAMP, FREE, Load, Rod
from .timoshenko import Piece


@check(quick=True)
def overhang():
    rod = rectangle("overhang")
    sag, left, right = closed.overhanging_tip(2.0, 4 / 3, 1000.0, rod.EI, rod.GA)
    runs = [run("overhang", rod={"vertices": 30 * k + 1}) for k in (1, 2, 4)]
    found = [displaced(data) for data in runs]
    yield from converging("sag of the free end [m]", -sag, found, 5e-4, "beam with shear")
    first, second = runs[0].reaction_force.sel(support=["first", "second"], axis="E2").to_numpy()
    yield Row("reaction at the first hinge [N]", left, first, 1e-5 * left, "statics")
    yield Row("reaction at the second hinge [N]", right, second, 1e-5 * right, "statics")


@check(quick=True)
def couple_at_middle():
    rod = rectangle("couple_at_middle")
    first, second, turn = closed.couple_at_middle(5.0, 10e3, rod.EI, rod.GA)
    runs = [run("couple_at_middle", rod={"vertices": 20 * k + 1}) for k in (1, 2, 4)]
    found = [float(data.probe_rotation.sel(probe="middle")) for data in runs]
    yield from converging("turn at the middle [rad]", turn, found, 5e-4, "beam with shear")
    ends = runs[0].reaction_force.sel(axis="E2").to_numpy()
    yield Row("reaction at the first end [N]", first, ends[0], 1e-6 * first, "statics")
    yield Row("reaction at the last end [N]", second, ends[1], 1e-6 * first, "statics")


@check(quick=True)
def circle():
    for GA in (5000, 500, 50):
        data = run("circle", rod={"section": {"shear_stiffness": GA}})
        gap = float(np.hypot(last(data, "E3"), last(data)))
        yield Row(f"gap of the ring at GA = {GA:.0f} N [m]", 0.0, gap, 1e-9, "pure bending")


def tips(name, beam, load, fraction, meshes=(21, 41, 81), **changes):
    """Both components of the tip on some meshes against the boundary value problem."""
    x, y = reissner.tip(beam, load)
    runs = [run(name, **finer(n, changes)) for n in meshes]
    for what, right, axis in (("tip along [m]", x, "E3"), ("tip across [m]", y, "E2")):
        found = [last(data, axis) for data in runs]
        yield from converging(what, right, found, fraction, "BVP", scale=beam.length)


@check(quick=True)
def large_rotation():
    load = Load(CLAMP, FREE | {"Ny": 2000.0})
    yield from tips("large_rotation", rectangle("large_rotation"), load, 1e-4)


@check()
def filament():
    rod = Rod.circle(10e-6, 25e-9, 2e9)
    yield from tips("filament", rod, Load(CLAMP, FREE | {"Ny": 1e-12}), 1e-4)


@check()
def curl():
    load = Load(CLAMP, FREE, py=-0.04195 * 9.81)
    for turns, meshes in ((0.5, (41, 81)), (1.0, (81, 161)), (2.0, (161, 321))):
        beam = rectangle("curl", 2 * np.pi * turns)
        for row in tips("curl", beam, load, 5e-4, meshes, rod={"rest": {"curvature": beam.K}}):
            yield Row(f"{turns:g} turns, {row.what}", row.right, row.found, row.tolerance, row.source)


@check(quick=True)
def tower():
    mass = 7860.0 * np.pi * (1.5**2 - 1.4**2) * 30.0
    data = run("tower")
    base = float(data.reaction_force.sel(support="first", axis="E3"))
    yield Row("force at the base [N]", mass * 9.80665, base, 1e-9 * mass * 9.80665, "weight")
    beam = Piece.tube(30.0, 3.0, 0.1, 210e9, 7860.0, 0.3)
    right = timoshenko.frequencies([beam], 2)
    meshes = [frequencies("tower_frequencies", 2, rod={"vertices": n}) for n in (16, 31, 61)]
    for k, fraction in ((0, 5e-4), (1, 3e-3)):
        found = [mesh[k] for mesh in meshes]
        yield from converging(f"frequency {k + 1} [Hz]", right[k], found, fraction, "transfer matrix")


@check(quick=True)
def chain():
    EA, weight = 3.27e9, 320 * 9.81
    H, first, second, shape = reissner.catenary(850.0, weight, EA, 800.0, 200.0)
    data = run("chain")
    force = data.reaction_force
    tension = np.hypot(force.sel(axis="E3"), force.sel(axis="E2"))
    for what, right, found in (
        ("horizontal force [N]", H, -force.sel(support="first", axis="E3")),
        ("tension at the lower end [N]", first, tension.sel(support="first")),
        ("tension at the upper end [N]", second, tension.sel(support="last")),
    ):
        yield Row(what, right, float(found), 2e-4 * right, "elastic catenary")
    away = float(np.abs(data.x.to_numpy() - np.column_stack(shape(data.xi.to_numpy()))).max())
    yield Row("largest distance from it [m]", 0.0, away, 850 * 2e-5, "elastic catenary")
    along = np.hypot(H, np.sqrt(second**2 - H**2) - weight * (850 - data.xi_edge.to_numpy()))
    error = float(np.abs(data.normal_force.to_numpy() - along).max())
    yield Row("largest error of the tension along it [N]", 0.0, error, 2e-4 * second, "elastic catenary")


@check(quick=True)
def buckling():
    """Edges of length h raise a buckling load by (k h)^2 / 6, k its wave number."""
    rod = rectangle("column_clamped_free")
    waves = {"hinged-hinged": 1.0, "clamped-free": 0.5, "clamped-hinged": 1.4303, "clamped-clamped": 2.0}
    for ends, wave in waves.items():
        right = reissner.buckling_load(rod, ends)
        found = critical("column_" + ends.replace("-", "_"))
        fraction = (wave * np.pi / 80) ** 2 / 5
        yield from converging(f"{ends} [N]", right, found, fraction, "Euler with shear and shortening")
    right = reissner.greenhill(rod) / (7.065 * 9.81)
    found = critical("column_own_weight")
    yield from converging(
        "own weight, times g", right, found, 2e-4, "Greenhill with shear and shortening"
    )


def critical(name):
    """The first critical load on two meshes, in loads of the case."""
    runs = [run(name, rod={"vertices": n}) for n in (41, 81)]
    return [float(data.special_load_factor[0]) for data in runs]


@check(quick=True)
def column_beyond():
    """A path with a side force of 2e-7 of the load, towards -E2, ends on that side, where the elastica stands."""
    state = reissner.column_beyond(rectangle("column_beyond"), 5828.4, -1e-3)
    path = run("column_beyond").isel(point=-1)
    yield Row("share of the load reached", 1.0, float(path.load_factor), 0.0, "asked")
    yield Row("tip along [m]", state[0, -1], last(path, "E3"), 3 * 5e-4, "BVP")
    yield Row("tip across [m]", state[1, -1], displaced(path), 3 * 5e-4, "BVP")


@check(quick=True)
def drawn():
    """Linear elasticity of a bar whose sections may narrow, and of one that keeps its width."""
    nu, strain = 0.3, 1e-6
    for section, along, across in (
        ("free", 1.0, nu),
        ("plane strain", 1 - nu**2, nu * (1 + nu)),
    ):
        data = run("drawn", rod={"lateral_constraint": section})
        yield Row(f"stretch, {section}", along * strain, displaced(data, "E3"), 1e-5 * strain, "Hooke")
        narrowed = float(data.lam.isel(vertex=10)) - 1
        yield Row(f"narrowing, {section}", -across * strain, narrowed, 1e-5 * strain, "Hooke")


@check(quick=True)
def flag_at_rest():
    """CSM1 and CSM2 of Turek and Hron (2006), published; the clamp on the cylinder begins between 0.350 and 0.351 m."""
    for name, printed in (("flag_1", (-7.187e-3, -66.10e-3)), ("flag_2", (-0.469e-3, -16.97e-3))):
        short, long = (run(name, rod={"length": L}) for L in (0.35, 0.351))
        for axis, value in zip(("E3", "E2"), printed, strict=True):
            ends = [displaced(data, axis) for data in (short, long)]
            middle, half = sum(ends) / 2, abs(ends[0] - ends[1]) / 2
            yield Row(f"{name}, u along {axis} [m]", value, middle, half, "Turek and Hron")


@check(quick=True)
def pushed_bar():
    state = reissner.column_beyond(rectangle("pushed_bar"), 980665.0, 1000.0)
    yield Row("tip across [m]", state[1, -1], displaced(run("pushed_bar")), 3 * 5e-4, "BVP")


@check()
def ribbon():
    middle = displaced(run("ribbon"), probe="middle")
    right = sides.ribbon(1e9, 0.1)[1, 200]
    yield Row("middle across [m]", float(right), middle, 1e-3, "BVP")


@check(quick=True)
def squeezed():
    along, across = closed.squeezed(1e3, 1e6, 0.3)
    data = run("squeezed").isel(section=125)
    yield Row("strain along", along, float(data.mu_3) - 1, 1e-3 * along, "Lame")
    yield Row("strain across", across, float(data.mu_1) - 1, 1e-3 * along, "Lame")
    shortened = 0.4 / (1e6 * np.pi * 0.02**2)
    data = run("contracted").isel(section=125)
    yield Row(
        "strain under a force along it", -shortened, float(data.mu_3) - 1, 1e-3 * shortened, "F / EA"
    )


@check(quick=True)
def inching():
    along, _ = closed.squeezed(1e3, 1e6, 0.3)
    stride = 0.3 * (along + 0.4 / (1e6 * np.pi * 0.02**2))
    data = run("inching")
    found = float(data.along[-1, 0] - data.along[0, 0]) / 2  # of two strides
    yield Row("stride [m]", stride, found, 1e-3 * stride, "lengths at both ends of a stride")


# ---------------------------------------------------------------- what jumps inside an edge


@check(quick=True)
def joint():
    """Meshes of 20, 40 and 80 edges meet the joint at other shares of an edge; of 10 and 40 at 13/30 m at the same."""
    rod, at = rectangle("joint"), 13 / 30

    def tip(at):
        return closed.cantilever_tip(
            1e-3,
            1.0,
            lambda s: rod.EI * (1 if s < at else 0.3),
            lambda s: rod.GA * (1 if s < at else 0.3),
            [at],
        )

    for n in (21, 41, 81):
        found = displaced(run("joint", rod={"vertices": n}))
        allowed = 1.5 / (n - 1) ** 2 * tip(0.52)
        yield Row(f"tip across, N = {n} [m]", tip(0.52), found, allowed, "beam with shear")
    stations = [{"at": at}, {"at": at, "young": 0.3}]
    errors = [
        abs(displaced(run("joint", rod={"vertices": n, "stations": stations})) - tip(at))
        for n in (11, 41)
    ]
    order = float(np.log2(errors[0] / errors[1]) / 2)
    yield Row("order of tip across, joint at 13/30 m", 2.0, order, 0.15, "theory")
    stretched = closed.pulled(1.0, 1.0, lambda s: rod.EA * (1 if s < 0.52 else 0.3), [0.52])
    found = displaced(run("joint_pulled"), "E3")
    yield Row("stretch when pulled [m]", stretched, found, 1e-9 * stretched, "bar")


@check(quick=True)
def toggle():
    """The curve of force and displacement of an apex that is moved down through both supports."""
    EA, rise = 10e6 * 0.2 * 0.05, float(np.sin(0.1))
    for fraction in (0.4, 1.0, 1.6):
        move = {"at": "last", "dof": "x2", "by": -fraction * rise}
        data = run("toggle", prescribed_displacements=[move])
        force = -data.reaction_force.sel(support="last", axis="E2").to_numpy()
        right = closed.toggle(1.0, 0.1, -displaced(data), EA)
        allowed = 1e-8 * closed.toggle_limit(1.0, 0.1, EA)
        what = f"force at {fraction:g} of the rise [N]"
        yield Row(what, float(right[-1]), float(force[-1]), allowed, "linear bar")
        away = float(np.abs(force - right).max())
        yield Row(f"largest error on the way to {fraction:g}", 0.0, away, allowed, "linear bar")
