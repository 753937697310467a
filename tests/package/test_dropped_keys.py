"""A case made `like` another drops an inherited key by the word "none"."""

import numpy as np
import pytest
from scipy.optimize import brentq

import cosserat
from cosserat.errors import InputError


def read(tmp_path, text, name="mine"):
    """A case of one's own from a file."""
    file = tmp_path / "mine.toml"
    file.write_text(text)
    return cosserat.case(name, file)


def test_a_robot_becomes_incompressible_in_one_line(tmp_path):
    """Without weight and all anchoring at t = 0: D / mu^3 = 3 k_I (mu - 1) with k_I of (2.6.17), mu_3 = 1 / mu^2."""
    text = '[mine]\nlike = "soft_robot"\nstrides = 1\nstep = "5 s"\nloads.gravity = "0 m/s²"\n'
    line = 'crawler.material = { kind = "incompressible", young = "10 kPa" }\n'
    data = cosserat.run(read(tmp_path, text + line))
    k_i = 2 / 3 * 10e3 * np.pi * 0.0254**2
    mu = brentq(lambda m: 1.0 / m**3 - 3 * k_i * (m - 1), 1, 2, xtol=1e-14)
    np.testing.assert_allclose(data.mu_1[0], mu, rtol=1e-10)
    np.testing.assert_allclose(data.mu_3[0], mu**-2, rtol=1e-10)
    compressible = cosserat.run(read(tmp_path, text))
    assert np.abs(compressible.mu_1[0] - mu).max() > 1e-3


def test_python_drops_keys_likewise():
    soft = cosserat.case("soft_robot")
    wet = soft.vary(
        "wet", crawler={"material": {"kind": "incompressible", "young": 1e4, "poisson": "none"}}
    )
    assert wet.problem.crawler.material.model_dump() == {"kind": "incompressible", "young": 1e4}
    heavy = soft.vary("heavy", crawler={"density": "none", "mass": "1 kg"})
    assert (heavy.problem.crawler.mass, heavy.problem.crawler.density) == (1.0, None)
    assert soft.vary("as_it_was", gait={"at_rest": "none"}).problem == soft.problem


def test_a_dropped_key_is_as_if_it_had_never_been_given(tmp_path):
    worm = read(
        tmp_path,
        '[mine]\nlike = "worm"\ngait.eta = "none"\ngait.sudden = 1\nloads.advancing_force = "none"',
    )
    assert worm.problem.gait.eta == ()
    chain = (
        '[a]\nlike = "worm"\nmesh.elements = 9\nmesh.degree = 10\n'
        '[b]\nlike = "a"\nmesh.elements = "none"\n[mine]\nlike = "b"\nmesh.degree = "none"\n'
        '[again]\nlike = "mine"\nmesh.elements = 4\n'
    )
    assert read(tmp_path, chain).problem.mesh == cosserat.case("worm").problem.mesh
    assert read(tmp_path, chain, "again").problem.mesh.elements == 4


def test_where_none_is_one_of_the_words_it_counts_as_this_word(tmp_path):
    held = '[held]\nlike = "soft_robot_held"\n[mine]\nlike = "held"\nloads.advancing_force = "none"\n'
    assert read(tmp_path, held).problem.loads.advancing_force == "none"
    free = read(tmp_path, '[mine]\nlike = "worm"\nloads.advancing_force = "none"\n')
    assert free.problem.loads.advancing_force == "none"
    mass = {"mass": "none", "density": "1 g/cm^3"}  # another key's None is no word
    assert cosserat.case("worm").vary("x", crawler=mass).problem.loads.advancing_force is None


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            'like = "worm"\ncrawler.density = "none"',
            "case 'mine': 'crawler' gives 'density' as 'none', which drops a key that 'like' brings in, and 'like' "
            "brings in none; leave it out",
        ),
        ('like = "worm"\nmesh.degree = "none"', "'mesh' gives 'degree' as 'none', which drops"),
        (
            'like = "worm"\ncrawler.material.poisson = "none"',
            "'crawler.material.poisson' is not a key; known are: kind, young",
        ),
        ('like = "worm"\ncrawler.length = "none"', "'crawler.length' is missing, length of the resting"),
        ('like = "worm"\ngait = "none"', "'gait' is missing, a periodic gait"),
        (
            'like = "worm_at_rest"\nregions = [{ begin = 0, end = "none", load = "anchoring" }]',
            "'regions.0' gives 'end' as 'none'",
        ),
        ('like = "worm"\nkind = "none"', "'kind' is 'none'"),
    ],
)
def test_a_none_that_cannot_be_is_one_sentence(tmp_path, text, sentence):
    with pytest.raises(InputError) as error:
        read(tmp_path, f"[mine]\n{text}\n")
    assert sentence in str(error.value)
    assert ". " not in str(error.value).replace("eq. ", "")
