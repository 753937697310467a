"""Indices, errors, bands and pictures of studies, tried at length: `python -m tests.studies.analysis`.

Right values are closed forms, and finer solves where there are none.
"""

from __future__ import annotations

import itertools
import sys
import tempfile
from pathlib import Path

import numpy as np

import cosserat
from cosserat.exact import elastica
from cosserat.problems.calibration import beam_of
from cosserat.studies.analysis.sequences import STATES

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[1]))

from test_answers import ANSWERS, texts_of
from test_indices import answer_of, ishigami, ishigami_indices

TIP = {"tip": "u.E2 at last"}
LAWS = {  # of a cantilever under a small force: low, high, power in its displacement
    "forces.0.force": (0.001, 0.004, 1),
    "rod.material.young": (1e9, 2e9, -1),
    "rod.section.height": (0.006, 0.008, -3),
}


def quiet(*_):
    """No progress."""


def moment(low, high, power):
    """The mean of a power of a log-uniform number."""
    return (high**power - low**power) / (power * np.log(high / low))


def cantilever_indices():
    """Shares of the variance of P L^3 / (3 E I), a product of independent numbers: first and total."""
    ratio = np.array([moment(lo, hi, 2 * p) / moment(lo, hi, p) ** 2 for lo, hi, p in LAWS.values()])
    whole = ratio.prod() - 1
    return (ratio - 1) / whole, 1 - (ratio.prod() / ratio - 1) / whole


def held(found, exact, name):
    """Whether intervals have the exact indices in them."""
    low, high = found[f"{name}_low"].to_numpy(), found[f"{name}_high"].to_numpy()
    return ((low <= exact) & (exact <= high)).tolist()


def indices_of_a_cantilever():
    """The study of the closed form, whose intervals hold the exact shares."""
    factor = {
        "saltelli": 1024,
        "seed": 3,
        **{key: {"log_uniform": [lo, hi]} for key, (lo, hi, _) in LAWS.items()},
    }
    answer = cosserat.study("elastica", [factor], TIP, progress=quiet)
    found = cosserat.indices(answer, of="tip")
    for name, exact in zip(("first", "total"), cantilever_indices(), strict=True):
        yield (
            all(held(found, exact, name)),
            f"{name} {found[name].to_numpy().round(4)}, exact {exact.round(4)}",
        )


def effects_of_a_cantilever():
    """The displacement is linear in the force: its effects are L^3 / (3 E I) times the range, at each modulus."""
    factor = {
        "morris": 50,
        "seed": 2,
        "forces.0.force": {"uniform": [0.001, 0.004]},
        "rod.material.young": {"uniform": [1e9, 2e9]},
    }
    answer = cosserat.study("elastica", [factor], TIP, progress=quiet)
    found = cosserat.indices(answer, of="tip").sel(key="force")
    beam = beam_of(cosserat.case("elastica").problem)
    young = 1e9 + 1e9 * (np.arange(4) + 0.5) / 4
    slopes = 0.003 * (
        beam.length**3 / (3 * young * beam.second_moment) + beam.length / (young / 2 * 5 / 6 * beam.area)
    )
    error = 4 * slopes.std() / np.sqrt(50) + 1e-3 * slopes.mean()
    for name, exact in (("mu", slopes.mean()), ("mu_star", slopes.mean()), ("sigma", slopes.std())):
        value = found[name].item()
        yield abs(value - exact) < error, f"{name} {value:.5g}, exact {exact:.5g}, allowed {error:.2g}"


def coverage_of_the_intervals():
    """Of 200 designs of 256 base points, the share of 95 % intervals with the exact index in them."""
    inside = {name: np.zeros(3) for name in ("first", "total")}
    for seed in range(200):
        found = cosserat.indices(answer_of("saltelli", 256, ishigami, seed=seed), of="y", resamples=300)
        for name, exact in zip(inside, ishigami_indices(), strict=True):
            inside[name] += held(found, exact, name)
    for name, count in inside.items():
        share = count / 200
        yield bool((share > 0.85).all()), f"{name}: {share}"


def estimated_errors():
    """Value less the exact one against the estimate: held, and not ten times as large as it need be."""
    for name, of, exact in exact_problems():
        found = cosserat.estimate_error(name, {"value": of}, progress=quiet)
        error, estimate = abs(found["value"].item() - exact), found["value_error"].item()
        order = ", ".join(f"{order:.2f}" for order in found["value_order"].to_numpy())
        states = ", ".join(STATES[k] for k in found["value_state"].to_numpy())
        called = getattr(name, "name", name)
        yield (
            error < estimate < 10 * error,
            f"{called}, {of}: error {error:.3g}, estimate {estimate:.3g}, order {order}, {states}",
        )


def exact_problems():
    """Cases with a read-out and its exact value, or that of a much finer solve where there is none."""
    case = cosserat.case("elastica")
    beam = beam_of(case.problem)
    unit = beam.bending_stiffness / beam.length**2
    for load in (1e-3, 1.0, 5.0, 10.0):
        force = load * unit
        shape = elastica.shearable_shape(
            load, beam.axial_stiffness / unit, beam.shear_stiffness / unit, np.array([0.0, 1.0])
        )
        pulled = case.vary(
            f"elastica_{1000 * load:.0f}", forces=[{"at": "last", "along": "E2", "force": force}]
        )
        yield pulled, "u.E2 at last", beam.length * shape[-1, 1]
        yield pulled, "max |bending_moment|", force * beam.length * shape[-1, 0]
    yield from of_modes()
    yield from of_motions()


def of_modes():
    """Natural frequencies of Timoshenko's beam."""
    file = Path(tempfile.mkdtemp()) / "more.toml"
    file.write_text('[modes]\nlike = "elastica"\nkind = "modes"\nforces = []\ncount = 3\n')
    case = cosserat.case("modes", file)
    exact = elastica.timoshenko_frequencies(beam_of(case.problem), 3) / (2 * np.pi)
    for k in range(3):
        yield case, f"natural_frequency at {k}", exact[k]


def of_motions():
    """The first mode of a slender cantilever, let go: its displacement is that of a cosine."""
    file = Path(tempfile.mkdtemp()) / "more.toml"
    file.write_text(
        '[swing]\nlike = "elastica"\nkind = "rod motion"\nforces = []\nduration = "0.2 s"\nevery = "0.1 s"\n'
        'rod.vertices = 21\nstart = { mode = 1, amplitude = "1 mm" }\nintegrator = { step = "5 ms" }\n'
    )
    case = cosserat.case("swing", file)
    rate = elastica.timoshenko_frequencies(beam_of(case.problem), 1)[0]
    start = cosserat.run(case, progress=quiet).u.sel(axis="E2").to_numpy()[0, -1]
    yield case, "final u.E2 at last", start * np.cos(rate * 0.2)


def bands_of_a_cantilever():
    """Displacements are proportional to a uniform force, and so are their quantiles."""
    factor = {"sobol": 1024, "forces.0.force": {"uniform": [0.001, 0.003]}}
    answer = cosserat.study("elastica", [factor], {}, keep_whole=["u"], progress=quiet)
    levels = np.array([0.05, 0.25, 0.5, 0.95])
    found = cosserat.bands(answer, "u", levels).u.sel(axis="E2").to_numpy()[:, -1]
    one = cosserat.run(
        cosserat.case("elastica").vary("one", forces=[{"at": "last", "along": "E2", "force": 1e-3}])
    )
    exact = (1 + 2 * levels) * one.u.sel(axis="E2").item(-1)
    error = np.abs(found / exact - 1).max()
    yield error < 2e-3, f"largest relative error of quantiles {error:.2g}"


def pictures():
    """No text of any kind of picture is outside or on another."""
    for kind, data in ANSWERS.items():
        figure = cosserat.plot(data)
        texts = texts_of(figure)
        apart = all(not a.overlaps(b) for (_, a), (_, b) in itertools.combinations(texts, 2))
        inside = all(
            figure.bbox.padded(1).contains(*corner) for _, box in texts for corner in (box.p0, box.p1)
        )
        yield apart and inside, f"{kind}: {len(texts)} texts"


TRIED = (
    indices_of_a_cantilever,
    effects_of_a_cantilever,
    coverage_of_the_intervals,
    estimated_errors,
    bands_of_a_cantilever,
    pictures,
)


def main() -> int:
    """Try everything, or what is named; 1 if something is not as it should be."""
    failed = 0
    for trial in TRIED:
        if len(sys.argv) > 1 and trial.__name__ not in sys.argv[1:]:
            continue
        print(f"{trial.__name__}: {trial.__doc__}")
        for good, said in trial():
            failed += not good
            print(f"  {'' if good else 'NOT SO: '}{said}", flush=True)
    print(f"{failed} not as it should be")
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main())
