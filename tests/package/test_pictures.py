"""What `cosserat plot` and `cosserat show` say of loads that follow, press or are over, of forces and named points."""

import io
import warnings
from xml.etree import ElementTree

import numpy as np
import pytest
from conftest import case_of_kind
from matplotlib.text import Annotation, Text

import cosserat
from cosserat.cli import main
from cosserat.figures import motion, player, rod
from cosserat.publications import kinds
from cosserat.text import printable

CLAMP = [{"at": "first", "fixed": "clamped"}]


def bent(**changes):
    """A slender rod that a couple bends by a right angle."""
    stiffness = cosserat.case("elastica").problem.rod
    angle = np.pi / 2 * stiffness.material.young * stiffness.second_moment / stiffness.length
    couples = [{"at": "last", "moment": angle}]
    return cosserat.run(
        cosserat.case("elastica").vary("bent", **{"forces": [], "couples": couples} | changes)
    )


def shaken(**force):
    force = {"at": "50 %", "along": "E2", "force": 1e-3} | force
    return cosserat.run(
        cosserat.case("vibration_consistent").vary(
            "shaken",
            start={"shape": "reference", "amplitude": 0},
            supports=CLAMP,
            forces=[force],
            probes=[{"name": "tip", "at": "last"}],
            duration=0.01,
            every=0.001,
        )
    )


def arrows(ax):
    """Feet and directions of all straight arrows."""
    found = [text for text in ax.texts if isinstance(text, Annotation) and text.arrow_patch is not None]
    return [(np.array(text.get_position()), np.subtract(text.xy, text.get_position())) for text in found]


def test_a_follower_force_is_drawn_where_its_section_has_turned_to():
    data = bent(follower_forces=[{"at": "last", "along": "E3", "force": 1e-6}])
    top = rod.picture(data).axes[-1]
    ((_, along), *_) = arrows(top)
    assert along / np.hypot(*along) == pytest.approx([0, 1], abs=0.02)


@pytest.mark.parametrize(("side", "sign"), [("upper", 1), ("lower", -1)])
def test_a_pressure_is_drawn_on_its_side_and_into_the_body(side, sign):
    data = bent(couples=[], pressures=[{"side": side, "pressure": 1e-3}])
    top = rod.picture(data).axes[-1]
    found = arrows(top)
    assert len(found) == 9
    assert sign * found[0][0][1] > 0  # at the clamp, which stays
    assert all(sign * along[1] < 0 for _, along in found)


def test_a_pulse_that_is_over_is_not_drawn():
    pulse = {"kind": "pulse", "duration": 0.002}
    for changes, number in (({}, 1), ({"time_function": pulse}, 0)):
        assert len(arrows(motion.picture(shaken(**changes)).axes[0])) == number


def test_named_points_of_a_motion_are_drawn_over_time():
    data = shaken()
    (line,) = motion.picture(data).axes[3].get_lines()
    assert line.get_label() == "tip"
    np.testing.assert_array_equal(line.get_ydata(), data.u.sel(axis="E2")[:, -1])


def test_a_picture_of_an_equilibrium_has_its_forces_and_its_moment():
    data = bent()
    panels = {ax.get_ylabel(): ax.get_lines() for ax in rod.picture(data).axes}
    (moment,) = panels["bending moment [N m]"]
    np.testing.assert_allclose(moment.get_ydata(), data.bending_moment)
    assert [line.get_label() for line in panels["force across the section [N]"]] == ["normal", "shear"]


def test_show_names_each_point_and_support_with_its_component(tmp_path, capsys):
    data = bent(probes=[{"name": "tip", "at": "last"}])
    cosserat.save(data, tmp_path / "bent.nc")
    assert main(["show", str(tmp_path / "bent.nc")]) == 0
    rows = capsys.readouterr().out.split("\n")
    (tip,) = [line for line in rows if "probe_displacement tip, E2" in line]
    value = data.u.sel(axis="E2")[-1].item()
    assert [float(x) for x in tip.split()[3:5]] == pytest.approx([value, value], rel=1e-6)
    assert any("reaction_moment first" in line for line in rows)


TITLES = [
    r"a wrong $\frac$, costs $5, back\slash \$ {braces} %s _^",
    "<script>a && b]]>--></script> -- <!-- \"quoted\" 'too' -->",
    "日本語 العربية हिन्दी \x1b[31mred\x07 \u202e\x00\ufffe",  # the last could be in a file
]


@pytest.mark.parametrize("title", TITLES)
def test_any_title_is_set_as_it_is_written(title, tmp_path):
    data = bent().assign_attrs(title=title, warnings='["costs $5 and $\\\\frac$"]')
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = cosserat.plot(data, tmp_path / "a.svg")
    drawn = figure.axes[-1].get_title("left")
    assert drawn.replace(r"\$", "$").startswith(f"{printable(title)}, displacements")
    assert ElementTree.parse(tmp_path / "a.svg").getroot().tag.endswith("svg")


@pytest.mark.parametrize("kind", [name for name, entry in kinds().items() if entry.picture])
def test_no_title_is_mathematics_in_any_picture(kind, solved):
    data = solved[case_of_kind(kind).name].assign_attrs(title=r"a wrong $\frac$")
    figure = cosserat.plot(data)
    texts = [text.get_text() for text in figure.findobj(Text)]
    assert any(r"a wrong \$\frac\$" in text for text in texts)
    figure.savefig(io.BytesIO(), format="svg")


def test_the_name_of_a_file_is_no_markup_in_its_page():
    shown = cosserat.animate(shaken())
    assert "<title>&lt;b&gt;&amp;\\x1b</title>" in player.page(shown, "<b>&\x1b")
