"""Wishes of other people that can be said now (`wishes.toml`) beside right values, and where the others are tested."""

import itertools

import numpy as np

from . import closed, timoshenko
from .checks import ORDER, Row, check, converging, displaced, frequencies, run
from .timoshenko import Piece

ELSEWHERE = {
    "a circle, a tube, an I, layers, given A and I or EA, EI and GA": (
        "rods/test_sections.py: test_a_cantilever_bends_shears_and_stretches_as_closed_forms_say",
        "rods/test_sections.py: test_given_stiffnesses_bend_and_stretch_a_beam",
    ),
    "G apart from E and nu": (
        "rods/test_materials.py: test_a_beam_by_shear_and_bulk_modulus_is_that_by_young_and_poisson",
    ),
    "forces inside along a path and in motion": (
        "problems/test_outputs.py: test_a_pulled_string_has_its_reactions_and_works_along_its_path",
        "problems/test_outputs.py: test_the_hinge_of_a_pendulum_has_the_force_of_mechanics",
    ),
    "limit load of an arch": (
        "problems/test_critical_loads.py: test_the_limit_load_of_an_arch_is_that_of_the_boundary_value_problem",
    ),
    "sine, pulse, chirp, record": (
        "rods/test_time_functions.py: test_one_mode_follows_duhamels_integral",
    ),
    "a pose that is not the shape at rest": (
        "problems/test_poses.py: test_a_curl_unrolled_and_a_rod_rolled_up_are_let_go_under_their_weight",
        "problems/test_poses.py: test_a_small_pose_swings_as_the_first_mode_does",
    ),
    "rotary inertia and offset of a mass": (
        "rods/test_masses.py: test_rotary_inertia_and_offset_are_of_second_order",
    ),
    "springs, an elastic clamp": (
        "rods/test_attachments.py: test_a_cantilever_on_a_spring_is_of_second_order",
        "rods/test_attachments.py: test_an_elastic_clamp_adds_its_rotation",
    ),
    "temperature, pre-strain, prescribed curvature": (
        "problems/test_temperatures.py: test_a_gradient_bends_a_cantilever_into_an_arc_with_the_hot_side_outside",
        "problems/test_temperatures.py: test_a_bar_between_walls_buckles_where_its_push_is_eulers",
        "problems/test_temperatures.py: test_a_prescribed_curvature_closes_a_ring_without_stress",
    ),
    "curvature that varies along the rod": (
        "rods/test_shapes.py: test_a_curved_rod_hangs_as_a_boundary_value_problem_says",
    ),
    "pressure and forces that follow": (
        "rods/test_following.py: test_an_arch_buckles_to_one_side_under_pressure",
        "rods/test_following.py: test_half_a_ring_between_guides_buckles_at_three_EI_over_R_cubed",
        "rods/test_following.py: test_a_follower_force_across_the_tip_meets_the_elastica",
    ),
    "damping that grows with stiffness, Rayleigh's pair": (
        "problems/test_damping.py: test_two_modes_fade_at_their_rates_to_second_order",
    ),
    "places in metres, supports by words, inclined ones": (
        "rods/test_places.py: test_a_load_between_vertices_is_of_second_order",
        "rods/test_places.py: test_a_support_in_metres_is_where_it_is_asked_for",
        "rods/test_supports.py: test_an_oblique_roller_pushes_across_and_is_of_second_order",
    ),
}
"""Wishes whose right values are in tests of their own."""


@check(quick=True)
def inner_forces():
    """Edges see a line load as forces at their ends, which shifts M by at most q h^2 / 8."""
    data = run("inner_forces")
    s = data.xi_edge.to_numpy()
    right = closed.inner_forces(2.0, s, (0.63, np.radians(-60), 2.0), (1.0, 2.0, 3.0))
    h = 2.0 / 20
    for name, unit, values, allowed in zip(
        ("normal_force", "shear_force", "bending_moment"),
        ("N", "N", "N m"),
        right,
        (1e-5, 1e-5, 3.0 * h**2 / 8 * 1.001),
        strict=True,
    ):
        away = float(np.abs(data[name].to_numpy() - values)[np.abs(s - 0.63) > h / 2].max())
        yield Row(f"largest error of the {name} [{unit}]", 0.0, away, allowed, "statics")


@check(quick=True)
def shock():
    """Waves to and fro: the end that is pushed, and the wall, which carries twice the force that arrives.

    The force begins and ends with a kink, which leaves two thirds of the order two in the tip.
    """
    EA, errors = 1e9 * 4e-4, []
    for n in (26, 51, 101):
        data = run("shock", rod={"vertices": n}, integrator={"step": 1e-3 / (n - 1)})
        t = data.time.to_numpy()
        tip, wall = closed.shocked_bar(1.0, 1e3, EA, 40.0, 3e-3, t)
        errors.append(float(np.abs(displaced(data, "E3") - tip).max()))
    allowed = 1e-3 * float(tip.max())
    yield Row("largest error of the tip [m]", 0.0, errors[-1], allowed, "D'Alembert")
    for coarse, fine in itertools.pairwise(errors):
        order = float(np.log2(coarse / fine))
        yield Row("order of the tip", 4 / 3, order, ORDER, "theory")
    held = -data.reaction_force.sel(support="first", axis="E3").to_numpy()
    yield Row("largest force on the wall [N]", 80.0, float(held.max()), 0.4, "D'Alembert")
    away = float(np.abs(held - wall).max())
    yield Row("largest error of the force on the wall [N]", 0.0, away, 1.6, "D'Alembert")


@check(quick=True)
def toggle_limit():
    right = closed.toggle_limit(1.0, 0.1, 10e6 * 0.2 * 0.05)
    data = run("toggle_limit")
    snaps = float(data.special_load_factor[0])
    yield Row("load at which it snaps [N]", right, snaps, 1e-8 * right, "linear bar")
    limits = float(data.special[0] == "limit point, first instability")
    yield Row("limit points there", 1.0, limits, 0.0, "linear bar")


@check(quick=True)
def tip_mass():
    beam = Piece.rectangle(0.5, 5e-3, 20e-3, 70e9, 0.27)
    right = timoshenko.frequencies([beam], 2, tip_mass=0.135)
    meshes = [frequencies("tip_mass", 2, rod={"vertices": n}) for n in (11, 21, 41)]
    for k, fraction in enumerate((5e-4, 3e-3)):
        found = [mesh[k] for mesh in meshes]
        yield from converging(f"frequency {k + 1} [Hz]", right[k], found, fraction, "transfer matrix")


@check(quick=True)
def rail():
    """A beam that ends fourteen wave lengths of its decay off is infinite to six digits."""
    EI, GA = 210e9 * 3038e-8, 0.4 * 210e9 / 2.6 * 76.7e-4
    sag, moment = closed.rail(125e3, 100e6, EI, GA)
    runs = [run("rail", rod={"vertices": n}) for n in (201, 401, 801)]
    found = [displaced(data, probe="wheel") for data in runs]
    yield from converging("sag under the wheel [m]", -sag, found, 1e-4, "Hetenyi with shear")
    errors = []
    for data in runs:
        beside = data.bending_moment.isel(edge=data.sizes["edge"] // 2)
        errors.append(float(beside) / moment(float(beside.xi_edge) - 10.0) - 1)
    yield Row("moment beside it, error", 0.0, errors[-1], 5e-4, "Hetenyi with shear")
    for coarse, fine in itertools.pairwise(errors):
        yield Row("order of the moment", 2.0, float(np.log2(coarse / fine)), ORDER, "theory")


@check(quick=True)
def let_go():
    """A force of 40 N ends at once: a triangle between both stretches of 0.1 mm, whose kinks the mesh rounds off."""
    data = run("let_go")
    t, tip = data.time.to_numpy(), displaced(data, "E3")
    right = closed.bar_let_go(1.0, 40.0, 1e9 * 4e-4, 1e3, t)
    yield Row("displacement at the start [m]", 1e-4, float(tip[0]), 1e-11, "F L / EA")
    away = float(np.abs(tip - right).max())
    yield Row("largest error in two periods [m]", 0.0, away, 1.5e-2 * 2e-4, "D'Alembert")
    half = float(np.interp(0.0, -tip[:50], t[:50]))
    yield Row("when it is as long as at rest [s]", 1e-3, half, 1e-6, "D'Alembert")
