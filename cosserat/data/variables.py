"""The table of stored variables: dimensions, unit, meaning, symbol and equation of the thesis, and round-off floor."""

from __future__ import annotations

from cosserat.data.crawler_variables import CRAWLERS
from cosserat.publications import publications
from cosserat.solution import Variable

LABELS = {
    "axis": "component in the plane of motion",
    "dof": "degree of freedom of a vertex, eq. (3.3.42)",
    "stretching_coefficient": "coefficient of eq. (3.4.13)",
    "beam_coefficient": "coefficient of eq. (3.4.13)",
    "section_coefficient": "coefficient of eq. (3.4.13)",
    "part": "part of the energy of the consistent rod",
    "measure": "what is compared with an exact answer",
    "term": "term of the strain energy, eq. (3.4.11)",
    "special": "kind of a special point of a path of equilibria",
    "surface": "surface of the rod; directors point to the upper one",
    "support": "vertex with supports",
    "probe": "point that the case names",
}
"""Meaning of the dimensions whose values are names, not numbers."""

COORDINATES: tuple[str, ...] = ("xi", "xi_edge", "xi_section", "time", "load_factor")
"""Variables that place the others."""

VARIABLES: dict[str, Variable] = {
    "xi": Variable(("vertex",), "m", "reference arc length of the vertices", r"\xi", "3.3.1", 1e-14),
    "xi_edge": Variable(
        ("edge",), "m", "reference arc length of the edge midpoints", r"\xi", "3.3.1", 1e-14
    ),
    "x_ref": Variable(
        ("vertex", "axis"), "m", "reference centreline position", r"\mathbf{X}", "3.3.1", 1e-14
    ),
    "d_ref": Variable(("vertex", "axis"), "m", "reference director", r"\mathbf{D}", "3.3.3", 1e-14),
    "x": Variable(("vertex", "axis"), "m", "centreline position", r"\mathbf{x}", "3.3.2", 1e-12),
    "d": Variable(("vertex", "axis"), "m", "director", r"\mathbf{d}", "3.3.3", 1e-12),
    "u": Variable(("vertex", "axis"), "m", "centreline displacement", r"\mathbf{u}", "3.3.2", 1e-12),
    "delta": Variable(
        ("vertex", "axis"), "m", "director displacement", r"\boldsymbol{\delta}", "3.3.3", 1e-12
    ),
    "mu_edge": Variable(("edge",), "1", "stretch of the edges", r"{}^K\mu", "3.3.19", 1e-12),
    "mu": Variable(("vertex",), "1", "centreline stretch at the vertices", r"{}_K\mu", "3.3.20", 1e-12),
    "lam": Variable(("vertex",), "1", "stretch of the sections", r"{}_K\lambda", "3.3.21", 1e-12),
    "phi": Variable(("vertex",), "rad", "turning angle", r"{}_K\varphi", "3.3.18", 1e-11),
    "kappa": Variable(("vertex",), "m-1", "centreline curvature", r"{}_K\kappa", "3.3.23", 1e-10),
    "theta": Variable(("vertex",), "rad", "shear angle", r"{}_K\vartheta", "3.3.26", 1e-11),
    "shear": Variable(
        ("edge",), "rad", "shear angle of the edges of the consistent rod", "g/a", "3.3.24", 1e-11
    ),
    "applied_force": Variable(
        ("vertex", "dof"), "N", "applied force", r"\mathbf{F}_{ext}", "3.3.40", 1e-9
    ),
    "support_force": Variable(
        ("vertex", "dof"), "N", "force of the supports", r"\mathbf{R}", "3.3.40", 1e-3
    ),
    "energy": Variable(
        ("term",), "J", "strain energy above that of the reference", r"\Pi_e", "3.4.11", 1e-10
    ),
    "energy_parts": Variable(
        ("part",),
        "J",
        "energy of the consistent rod above that of the reference",
        r"\Pi",
        "3.4.11",
        1e-10,
    ),
    "errors": Variable(("measure",), "1", "error as a fraction of the exact value", "", "3.5.3", 1e-8),
    "time": Variable(("time",), "s", "time", "t", "3.3.50", 1e-14),
    "x_rate": Variable(
        ("vertex", "axis"), "m s-1", "centreline velocity", r"\dot{\mathbf{x}}", "3.3.27", 1e-9
    ),
    "d_rate": Variable(
        ("vertex", "axis"), "m s-1", "director velocity", r"\dot{\mathbf{d}}", "3.3.27", 1e-9
    ),
    "first_angle": Variable(
        ("time",),
        "rad",
        "angle of the first director, from E3 towards E2, counted through whole turns",
        "",
        "3.3.41",
        1e-9,
    ),
    "internal_variables": Variable(
        ("time", "internal"), "1", "internal variables of the loads, each in its own unit", "", "", 1e-9
    ),
    "other_dofs": Variable(
        ("time", "vertex", "other_dof"),
        "m",
        "vectors of the vertices beside position and director",
        "",
        "",
        1e-12,
    ),
    "other_rates": Variable(
        ("time", "vertex", "other_dof"), "m s-1", "rates of these vectors", "", "", 1e-9
    ),
    "kinetic_energy": Variable(("time",), "J", "kinetic energy", "T", "3.3.33", 1e-9),
    "strain_energy": Variable(
        (), "J", "strain energy above that of the reference", r"\Pi_e", "3.4.11", 1e-9
    ),
    "load_potential": Variable((), "J", "potential of the constant loads", "-W", "3.3.40", 1e-9),
    "dissipated_energy": Variable(
        ("time",), "J", "energy that the damping has taken since the start", "", "section 3.5", 1e-9
    ),
    "support_work": Variable(
        (), "J", "work that moved supports have done since the start", "", "3.3.40", 1e-9
    ),
    "total_load_work": Variable((), "J", "work of all loads since the start", "W", "3.3.40", 1e-9),
    "contact_force": Variable(
        ("edge", "axis"),
        "N",
        "force with which the part beyond an edge acts on the part before it",
        r"\mathbf{n}",
        "1.2.71",
        1e-3,
    ),
    "normal_force": Variable(
        ("edge",), "N", "normal force, positive in tension, across the section of an edge", "N", "", 1e-3
    ),
    "shear_force": Variable(
        ("edge",),
        "N",
        "shear force in the section of an edge, positive along the director on the part before it",
        "Q",
        "",
        1e-3,
    ),
    "bending_moment": Variable(
        ("edge",),
        "N m",
        "bending moment about the centreline at the middle of an edge, positive from E3 towards E2",
        "M",
        "1.2.89",
        1e-3,
    ),
    "contact_director_force": Variable(
        ("edge", "axis"), "N", "contact director force across an edge", r"\mathbf{m}", "1.2.77", 1e-3
    ),
    "intrinsic_director_force": Variable(
        ("vertex", "axis"),
        "N",
        "intrinsic director force of the part round a vertex",
        r"\mathbf{k}\,{}_KL",
        "1.2.78",
        1e-3,
    ),
    "fibre_stress": Variable(
        ("edge", "surface"),
        "Pa",
        "axial stress at a surface by beam theory, without stress concentrations",
        r"N/A \mp M y/I",
        "",
        1e-3,
    ),
    "fibre_strain": Variable(
        ("edge", "surface"), "1", "axial strain at a surface by beam theory", "", "", 1e-12
    ),
    "shear_stress": Variable(
        ("edge",), "Pa", "mean shear stress of a section, without its distribution", "Q/A", "", 1e-3
    ),
    "reaction_force": Variable(
        ("support", "axis"), "N", "force of the supports of a vertex on the rod", r"\mathbf{R}", "", 1e-3
    ),
    "reaction_moment": Variable(
        ("support",),
        "N m",
        "moment of the supports of a vertex on its section, positive from E3 towards E2",
        "",
        "",
        1e-3,
    ),
    "reaction_director_force": Variable(
        ("support", "axis"), "N", "force of the supports of a vertex on its director", "", "", 1e-3
    ),
    "rotation": Variable(
        ("vertex",),
        "rad",
        "rotation of the sections, from E3 towards E2, counted through whole turns",
        "",
        "3.3.26",
        1e-9,
    ),
    "probe_displacement": Variable(
        ("probe", "axis"), "m", "displacement of a named point", "", "", 1e-12
    ),
    "probe_rotation": Variable(
        ("probe",), "rad", "rotation of the section of a named point, from E3 towards E2", "", "", 1e-9
    ),
    "load_work": Variable(
        ("time",),
        "J",
        "work since the start of the loads that depend on time or have no potential",
        "",
        "3.3.40",
        1e-9,
    ),
    "attached_energy": Variable((), "J", "energy of springs and foundations", "", "", 1e-9),
    "attached_force": Variable(
        ("vertex", "dof"), "N", "force of springs and foundations on the rod", "", "", 1e-9
    ),
    "momentum": Variable(("time", "axis"), "kg m s-1", "linear momentum", r"\mathbf{G}", "3.3.30", 1e-7),
    "angular_momentum": Variable(
        ("time",), "kg m2 s-1", "angular momentum about the origin", r"\mathbf{H}_O", "3.3.33", 1e-7
    ),
    **CRAWLERS,
    "load_factor": Variable(("point",), "1", "fraction of the full load", "", "3.3.40", 1e-9),
    "stable": Variable(
        ("point",), "1", "one where the potential has a minimum, else zero", "", "3.4.7", 1e-9
    ),
    "potential": Variable(
        ("point",), "J", "strain energy of the rod less the work of its couples", "", "3.4.11", 1e-9
    ),
    "natural_frequency": Variable(("mode",), "Hz", "natural frequency, without damping", "", "", 1e-9),
    "growth_rate": Variable(
        ("mode",), "s-1", "rate of growth of a mode, positive if it is unstable", "", "", 1e-9
    ),
    "mode_u": Variable(
        ("mode", "vertex", "axis"),
        "kg-0.5",
        "centreline displacement of a mode of unit modal mass, its largest component positive",
        "",
        "",
        1e-7,
    ),
    "mode_delta": Variable(
        ("mode", "vertex", "axis"),
        "kg-0.5",
        "director displacement of a mode of unit modal mass",
        "",
        "",
        1e-7,
    ),
    "mode_u_imaginary": Variable(
        ("mode", "vertex", "axis"),
        "kg-0.5",
        "imaginary part of the centreline displacement of a mode, a quarter of a period before the real one",
        "",
        "",
        1e-7,
    ),
    "mode_delta_imaginary": Variable(
        ("mode", "vertex", "axis"),
        "kg-0.5",
        "imaginary part of the director displacement of a mode, a quarter of a period before the real one",
        "",
        "",
        1e-7,
    ),
    "effective_mass": Variable(
        ("mode", "axis"), "kg", "effective mass of a mode in translation along an axis", "", "", 1e-9
    ),
    "effective_inertia": Variable(
        ("mode",),
        "kg m2",
        "effective moment of inertia of a mode in rotation about the first vertex",
        "",
        "",
        1e-9,
    ),
    "total_mass": Variable(("axis",), "kg", "mass of the whole rod, in translation", "", "", 1e-12),
    "total_inertia": Variable((), "kg m2", "moment of inertia about the first vertex", "", "", 1e-12),
    "linear_load_factor": Variable(
        ("mode",), "1", "critical load by the linear criterion, as a fraction of the loads", "", "", 1e-9
    ),
    "linear_u": Variable(
        ("mode", "vertex", "axis"),
        "1",
        "centreline displacement of a mode of the linear criterion, the largest component one",
        "",
        "",
        1e-7,
    ),
    "linear_delta": Variable(
        ("mode", "vertex", "axis"),
        "1",
        "director displacement of a mode of the linear criterion",
        "",
        "",
        1e-7,
    ),
    "special_load_factor": Variable(
        ("special",),
        "1",
        "load at a limit point or a bifurcation, as a fraction of the loads",
        "",
        "",
        1e-9,
    ),
    "special_after": Variable(
        ("special",), "1", "index of the point of the path before a special point", "", "", 1e-9
    ),
    "special_x": Variable(
        ("special", "vertex", "axis"), "m", "centreline position at a special point", "", "", 1e-9
    ),
    "special_d": Variable(
        ("special", "vertex", "axis"), "m", "director at a special point", "", "", 1e-9
    ),
    "special_u": Variable(
        ("special", "vertex", "axis"),
        "1",
        "centreline displacement of the mode that costs no energy there, the largest component one",
        "",
        "",
        1e-7,
    ),
    "special_delta": Variable(
        ("special", "vertex", "axis"),
        "1",
        "director displacement of the mode that costs no energy there",
        "",
        "",
        1e-7,
    ),
    "beams_coefficients": Variable(
        ("beam_coefficient",),
        "1",
        "coefficients fitted to both beams at once, displacements and directors",
        "c",
        "3.4.13",
        1e-4,
    ),
    "beams_misfit": Variable(
        (), "1", "root mean square misfit of both beams at that fit", "", "3.4.13", 1e-7
    ),
    "beams_singular_values": Variable(
        ("beam_direction",), "1", "sensitivity of both beams to log c, by direction", "", "3.4.13", 1e-5
    ),
}

# A direction that a fit does not determine multiplies round-off by the fit's condition number (in the solver's
# statistics, with a warning): between processors the coefficients of the beams moved by 5e-4 of themselves along it.
for _problem, _dim, _floor in (
    ("hanging_bar", "stretching", 1e-7),
    ("clamped_free", "beam", 1e-2),
    ("clamped_clamped", "beam", 1e-2),
    ("necking", "section", 1e-2),
):
    _name = _problem.replace("_", " ")
    _directions = f"{_dim}_direction"
    VARIABLES |= {
        f"{_problem}_coefficients": Variable(
            (f"{_dim}_coefficient",),
            "1",
            f"coefficients fitted to the {_name}",
            "c",
            "3.4.13",
            _floor,
        ),
        f"{_problem}_misfit": Variable(
            (), "1", f"root mean square misfit of the {_name} at the fit", "", "3.4.13", 1e-7
        ),
        f"{_problem}_singular_values": Variable(
            (_directions,),
            "1",
            f"sensitivity of the {_name} to log c, by direction",
            "",
            "3.4.13",
            1e-5,
        ),
        f"{_problem}_directions": Variable(
            (_directions, f"{_dim}_coefficient"),
            "1",
            f"directions in log c of these sensitivities of the {_name}",
            "",
            "3.4.13",
            1e-2,
        ),
        f"{_problem}_published": Variable(
            (), "1", f"{_name} over its formula at the published coefficients", "", "3.4.13", 1e-8
        ),
    }

for _publication in publications():
    _own = _publication.own_variables()
    VARIABLES |= _own.variables
    LABELS |= _own.labels
    COORDINATES += _own.coordinates
