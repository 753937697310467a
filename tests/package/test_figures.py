"""Figures: each is drawn from its cases, is reproducible, and shows the numbers of the table."""

import itertools
import re

import numpy as np
import pytest
from colours import contrast, distance
from conftest import ROOT
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.path import Path as Stroke
from matplotlib.quiver import Quiver
from matplotlib.text import Annotation, Text

import cosserat
from cosserat.errors import InputError
from cosserat.figures import crawlers, motion, path, rod
from cosserat.figures.style import settings, write
from cosserat.thesis.figures.catalogue import FIGURES, draw, draw_to
from cosserat.thesis.outputs.manifest import content_of, read
from cosserat.thesis.table import readouts

MANIFEST = ROOT / "results/reference/manifest.csv"
ONE_OF_EACH = list({entry.module: name for name, entry in FIGURES.items()}.values())


def drawn_to(solved, name, path):
    write(draw(name, needed(solved, name)), path)
    return path.read_bytes()


def test_a_figure_has_the_same_bytes_when_drawn_again(solved, tmp_path):
    """What decides this, names and dates, is the same for all of them."""
    first, second = (drawn_to(solved, "fig_opening", tmp_path / f"{n}.svg") for n in (1, 2))
    assert first == second
    assert len(set(re.findall(rb'id="[^"]*[0-9a-f]{10}"', first))) > 5, "names that could differ"


@pytest.mark.parametrize("name", ONE_OF_EACH)
def test_figures_are_those_of_the_manifest(solved, name, tmp_path):
    assert b"<dc:date>" not in drawn_to(solved, name, tmp_path / "1.svg")
    listed = next(output for output in read(MANIFEST) if output.path == f"figures/{name}.svg")
    drawn = content_of(tmp_path / "1.svg", round_off=FIGURES[name].round_off)
    assert drawn == listed.content, "the manifest is stale: 'make', then 'cosserat manifest'"
    assert sorted(file.name for file in tmp_path.iterdir()) == ["1.svg"]


def needed(solved, name):
    """The results that a figure shows."""
    return {case: solved[case] for case in (*FIGURES[name].cases, *FIGURES[name].studies)}


DRAWN = {}
PHONE = 332  # pixels of a figure on a phone of 390


def curves(ax):
    return {line.get_label(): line.get_xydata() for line in ax.get_lines()}


def test_beam_figures_plot_the_computed_and_the_analytic_curve_in_millimetres(solved):
    figure = draw("fig_3_10", {case: solved[case] for case in FIGURES["fig_3_10"].cases})
    computed, exact = readouts.clamped_free_curve(solved["clamped_free"])
    shown = curves(figure.axes[0])
    np.testing.assert_allclose(shown["end areas full"][:, 1], computed * 1e3)
    np.testing.assert_allclose(shown["eq. (3.5.3)"][-1], [5.0, exact[-1] * 1e3])
    directors, exact_directors = readouts.clamped_free_directors(solved["clamped_free"])
    shown = curves(figure.axes[2])
    np.testing.assert_allclose(shown["end areas full"][:, 1], directors * 1e3)
    np.testing.assert_allclose(shown["eq. (3.5.4)"][-1, 1], exact_directors[-1] * 1e3)
    differences = curves(figure.axes[1])["end areas full"][:, 1]
    np.testing.assert_allclose(differences, (computed - exact) * 1e3, atol=1e-12)


def test_every_axis_of_a_graph_has_a_unit(solved):
    for name in FIGURES:
        for ax in drawing(solved, name).axes:
            assert "[" in ax.get_xlabel(), name
            assert "[" in ax.get_ylabel() or not ax.get_yticks().size, (
                name
            )  # bodies below each other have no axis


def arrows(ax):
    """Directions of the arrows by the name beside their tips, rounded; and how many stand in rows without a name."""
    drawn, named, plain = [], {}, 0
    for text in ax.texts:
        if text.arrow_patch is not None:
            drawn.append(np.array(text.xy) - np.array(text.get_position()))
        elif drawn:
            named.setdefault(text.get_text(), []).append(drawn.pop())
            plain, drawn = plain + len(drawn), []
    return named, plain + len(drawn)


def test_loads_are_drawn_where_they_act_and_along_their_directions():
    case = cosserat.case("clamped_free").vary(
        "loaded",
        gravity={"g": 0.0, "along": "-E2"},
        forces=[{"at": "last", "along": "E2", "force": 2e4}, {"at": 7, "along": "E2", "force": -1e4}],
        couples=[{"at": "last", "moment": 1e4}],
    )
    data = cosserat.run(case)
    top = rod.picture(data).axes[-1]
    named, _ = arrows(top)
    assert set(named) == {"$n$", "$M$"}
    (up, down) = named["$n$"]
    assert up[1] > 0 > down[1]
    assert up[0] == down[0] == 0
    feet = [t.get_position() for t in top.texts if t.arrow_patch is not None][:2]
    x = data.x_ref + (data.x - data.x_ref) * rod.magnification(data.u.to_numpy(), 5.0)
    np.testing.assert_allclose(feet, x.to_numpy()[[-1, 7]])
    pressed = case.vary(
        "pressed",
        gravity={"g": 9.81, "along": "-E2"},
        forces=[{"at": "last", "along": "-E3", "force": 1.0}],
        couples=[],
        line_loads=[{"along": "-E2", "density": 5.0, "start": 1.0, "end": 2.0}],
    )
    top = rod.picture(cosserat.run(pressed)).axes[-1]
    named, plain = arrows(top)
    assert set(named) == {"$g$", "$n$"}
    assert plain == 9
    assert named["$n$"][0][0] < 0
    assert named["$g$"][0][1] < 0


def test_a_motion_is_drawn_as_bodies(solved):
    left = motion.picture(solved["relaxing_clamped_free"]).axes[0]
    bodies = [patch for patch in left.patches if len(patch.get_xy()) > 40]
    assert len(bodies) == 7
    tip = [patch.get_xy()[19, 1] - patch.get_xy()[20, 1] for patch in bodies]  # upper less lower surface
    np.testing.assert_allclose(tip, 0.5, rtol=1e-2)


def test_unknown_figures_are_refused(tmp_path):
    with pytest.raises(InputError, match="there is no figure"):
        draw("fig_3", {})
    with pytest.raises(InputError, match="does not exist"):
        draw_to("fig_3_8", tmp_path, tmp_path / "none" / "f.svg")


def drawing(solved, name):
    """A figure, drawn once for all tests."""
    if name not in DRAWN:
        DRAWN[name] = draw(name, needed(solved, name))
    return DRAWN[name]


def laid_out(figure):
    """What measures texts, after the layout has been made."""
    canvas = FigureCanvasAgg(figure)
    with settings():
        figure.draw_without_rendering()
    return canvas.get_renderer()


def shown_texts(figure):
    """Texts that are drawn: those of ticks outside the axes exist, but are not."""
    hidden = set()
    for ax in (a for outer in figure.axes for a in (outer, *outer.child_axes)):
        for axis in (ax.xaxis, ax.yaxis):
            every = {*axis.get_major_ticks(), *axis.get_minor_ticks()}
            for tick in every - set(axis._update_ticks()):
                hidden |= {tick.label1, tick.label2}
    return [
        text
        for text in figure.findobj(Text)
        if text.get_visible() and text.get_text().strip() and text not in hidden
    ]


def strokes(ax):
    """Lines, outlines and arrows of an axes, in pixels."""
    for artist in (*ax.lines, *ax.patches):
        yield artist.get_path().transformed(artist.get_transform())
    for field in ax.collections:
        if isinstance(field, Quiver):
            for foot, *arrow in zip(field.XY, field.U, field.V, strict=True):
                yield Stroke(ax.transData.transform([foot, foot + np.array(arrow)]))
    for text in ax.texts:
        if text.arrow_patch is not None:
            yield Stroke(ax.transData.transform([text.xy, text.get_position()]))


@pytest.mark.parametrize("name", FIGURES)
def test_texts_of_a_figure_are_visible_and_do_not_overlap(solved, name):
    figure = drawing(solved, name)
    pixels = laid_out(figure)
    texts = shown_texts(figure)
    boxes = [text.get_window_extent(pixels).padded(-1) for text in texts]
    for text, box in zip(texts, boxes, strict=True):
        assert figure.bbox.padded(1).containsx(box.x0), text
        assert figure.bbox.padded(1).containsx(box.x1), text
        assert figure.bbox.padded(1).containsy(box.y0), text
        assert figure.bbox.padded(1).containsy(box.y1), text
        assert not isinstance(text, Annotation) or text._check_xy(pixels), f"{text} is dropped"
    for (one, a), (other, b) in itertools.combinations(zip(texts, boxes, strict=True), 2):
        assert not a.overlaps(b), f"{one} and {other}"
    for ax in figure.axes:
        lines = list(strokes(ax))
        for text in ax.texts:
            if text.get_text() and text.get_bbox_patch() is None:  # one with a ground of its own may
                box = text.get_window_extent(pixels).padded(-1.5)
                assert not any(line.intersects_bbox(box, filled=False) for line in lines), text
        # nor does a legend cover what is drawn
        legend = ax.get_legend()
        if legend is not None:
            box = legend.get_window_extent(pixels)
            for line in ax.lines:
                points = line.get_transform().transform(line.get_xydata())
                assert not any(box.contains(*point) for point in points), line.get_label()


@pytest.mark.parametrize("name", FIGURES)
def test_curves_of_one_pair_of_axes_differ_for_a_deuteranope_and_are_seen_on_white(solved, name):
    for ax in drawing(solved, name).axes:
        colours = {line.get_color() for line in ax.lines if line.get_xydata().size}
        assert all(contrast(colour) >= 3 for colour in colours)
        for one, other in itertools.combinations(sorted(colours), 2):
            assert distance(one, other) >= 20, (one, other)


@pytest.mark.parametrize("name", FIGURES)
def test_texts_of_a_figure_are_read_on_a_phone(solved, name):
    figure = drawing(solved, name)
    shrunk = min(1.0, PHONE / (96 * figure.get_size_inches()[0]))
    for text in figure.findobj(Text):
        if text.get_text().strip():
            assert text.get_fontsize() * 96 / 72 * shrunk >= 9, text
            assert contrast(text.get_color()) >= 4.5, text


def annotations(ax):
    return [text.get_text() for text in ax.texts if text.get_text()]


def of_colour(ax, colour):
    return [line.get_xydata() for line in ax.lines if line.get_color() == colour]


def test_the_stride_shows_the_corrected_and_the_printed_worm_at_the_six_times(solved):
    ax = drawing(solved, "fig_2_1").axes[0]
    worm, printed = solved["worm"], solved["worm_printed"]
    dotted = [line.get_xydata() for line in ax.lines if line.get_linestyle() == ":"]
    assert len(dotted) == 6
    times = np.array([0, 3.15 / 3, 2 * 3.15 / 3, 3.15, 3.15 + 1.75 / 2, 4.9])
    base = 0.0
    for outline, time in zip(dotted, times, strict=True):
        state = printed.isel(time=int(np.abs(printed.time.to_numpy() - time).argmin()))
        np.testing.assert_allclose(outline[1:-1, 0], 1e2 * state.along)
        height = outline[1:-1, 1] - outline[0, 1]
        np.testing.assert_allclose(height, 4 * 2 * 0.38 * state.mu_1)
        assert outline[0, 1] <= base
        base = outline[0, 1] - 0.1
    feet = np.vstack(of_colour(ax, crawlers.ANCHOR))
    chosen = [int(np.abs(worm.time.to_numpy() - time).argmin()) for time in times]
    np.testing.assert_allclose(feet[:, 0], 1e2 * worm.anchor_along.to_numpy()[chosen])
    lane = feet[0, 1] - feet[1, 1]
    assert ax.get_ylim()[1] < lane  # no more room above the first body than above any other


def test_segment_50_is_drawn_beside_what_quillin_measured(solved):
    stretches, pressures = drawing(solved, "fig_2_2").axes
    from cosserat.thesis.table.crawl_readouts import segment

    run = segment(solved["worm"])
    drawn = [line.get_ydata() for line in stretches.lines if len(line.get_ydata()) > 2]
    assert any(np.array_equal(values, run.mu_2) for values in drawn)
    levels = [line.get_ydata()[0] for line in stretches.lines if len(line.get_ydata()) == 2]
    middle = run.isel(time=int(np.abs(run.time.to_numpy() - (2 * 4.9 + 1.575)).argmin()))
    np.testing.assert_allclose(levels, [0.75 * middle.mu_1, 1.60 * middle.mu_3])
    levels = [line.get_ydata()[0] for line in pressures.lines if len(line.get_ydata()) == 2]
    np.testing.assert_allclose(levels, [0.3, 0.8])  # kPa


def test_published_numbers_of_a_figure_come_from_the_table(solved, tmp_path):
    data = {case: solved[case] for case in FIGURES["fig_2_2"].cases}
    rows = (ROOT / "results/tolerances.csv").read_text().splitlines(keepends=True)
    changed = tmp_path / "changed.csv"
    changed.write_text("".join(rows).replace("0.3 kPa", "0.4 kPa"))
    lines = draw("fig_2_2", data, changed).axes[1].lines
    assert 0.4 in [line.get_ydata()[0] for line in lines]
    short = tmp_path / "short.csv"
    short.write_text("".join(row for row in rows if not row.startswith("2.8-p-circular-measured")))
    with pytest.raises(InputError, match="has no printed number 2.8-p-circular-measured"):
        draw("fig_2_2", data, short)


def changes_of_load(state):
    """Where advancing and anchoring regions meet, along the ground [cm]."""
    at = np.flatnonzero(np.diff(state.advancing.to_numpy() > 0.5))
    return 1e2 * (state.along.to_numpy()[at] + state.along.to_numpy()[at + 1]) / 2


def test_push_transition_and_pull_show_their_fronts(solved):
    ax = drawing(solved, "fig_2_7").axes[0]
    run = solved["soft_robot"]
    texts = annotations(ax)
    assert [text[:3] for text in texts if text.startswith("(")] == ["(a)", "(b)", "(c)"]
    times = [float(text.split("=")[1].split()[0]) for text in texts if text.startswith("$t_")]
    assert times == sorted(set(times))
    assert len(times) == 8
    green, blue = of_colour(ax, crawlers.GAMMA), of_colour(ax, crawlers.ETA)
    assert (len(green), len(blue)) == (4, 4)
    lanes = sorted({line[0, 1] for line in of_colour(ax, crawlers.ANCHOR)}, reverse=True)
    fronts = {lane: sorted(line[0, 0] for line in green + blue if line[0, 1] == lane) for lane in lanes}
    assert [len(found) for found in fronts.values()] == [0, 1, 1, 2, 2, 1, 1, 0]
    for time, found in zip(times, fronts.values(), strict=True):
        state = run.isel(time=int(np.abs(run.time.to_numpy() - time).argmin()))
        np.testing.assert_allclose(found, changes_of_load(state), atol=0.15)  # cm, a section apart
    anchors = np.array([line[0, 0] for line in of_colour(ax, crawlers.ANCHOR)])
    assert np.allclose(anchors[:3], 0)
    assert np.allclose(anchors[3:], anchors[3])
    assert anchors[3] > 30


def test_fronts_are_discrete_values_from_the_first_pause_on_that_never_reach_the_ends(solved):
    figure = drawing(solved, "fig_2_8")
    both, close = figure.axes
    assert both.get_xlim()[0] == 0
    points = {line.get_color(): line.get_xydata() for line in both.lines if len(line.get_xydata()) > 2}
    assert {line.get_linestyle() for line in both.lines} == {"None"}
    gamma, eta = points[crawlers.GAMMA], points[crawlers.ETA]
    for values in (gamma, eta):
        assert values[:, 1].min() > 0
        assert values[:, 1].max() < 1
        assert values[0, 0] > 5
    t = gamma[:, 0] % 22.5
    np.testing.assert_allclose(gamma[:, 1] * 25.4, 25.4 - 2.54 * (t - 5), atol=1e-9)  # (2.7.1)
    t = eta[:, 0] % 22.5
    np.testing.assert_allclose(eta[:, 1] * 25.4, 25.4 - 2.54 * (t - 5 - 10 * 0.75), atol=1e-9)  # (2.7.2)
    (values,) = (line.get_xydata() for line in close.lines if line.get_color() == crawlers.ETA)
    values = values[values[:, 0].argsort()]
    np.testing.assert_allclose(np.diff(values[:, 0]), 0.01)
    assert 0.98 < values[0, 1] < 1


def test_the_robot_is_drawn_crawling_through_both_cycles(solved):
    first, second = drawing(solved, "fig_2_9").axes[2:]
    run = solved["soft_robot"]
    gone = 1e2 * float(run.along.isel(section=-1)[-1] - run.along.isel(section=-1)[0]) / 2
    shapes = []
    for ax in (first, second):
        bodies = [p.get_xy() for p in ax.patches if len(p.get_xy()) > 2 * run.sizes["section"]]
        assert len(bodies) == 6
        shapes.append(np.array([(xy[:, 0].min(), xy[:, 0].max()) for xy in bodies]))
    assert np.ptp(np.diff(shapes[0], axis=1)) > 5  # cm: the body is long and short
    np.testing.assert_allclose(shapes[1] - shapes[0], gone, atol=1e-6)
    assert first.get_xlim() == second.get_xlim()


def test_the_worms_gamma_is_drawn_in_all_three_readings(
    solved,
):
    ax = drawing(solved, "fig_2_11").axes[0]
    green = [line for line in ax.lines if line.get_color() == crawlers.GAMMA]
    (taken,) = (line.get_xydata() for line in green if line.get_linestyle() == "None")
    assert taken[:, 1].min() > 0
    assert taken[:, 1].max() < 1
    first = taken[taken[:, 0] < 1.575]
    slow = np.polyfit(*first.T, 1)[0]
    lines = [line.get_xydata() for line in green if line.get_linestyle() != "None"]
    assert len(lines) == 2 * 3
    ends = {(round(end[0] - begin[0], 3), end[1]) for begin, end in lines}
    assert ends == {(1.575, 0), (1.575 + 1.75, 0)}
    for begin, end in lines:
        assert begin[0] % 4.9 == pytest.approx(1.575)
        assert begin[1] == 0.75
        assert (end[1] - begin[1]) / (end[0] - begin[0]) < 1.2 * slow < 0


def test_the_rod_like_body_shows_both_lengths_a_section_and_an_eccentric_centreline(solved):
    ax = drawing(solved, "fig_3_2").axes[0]
    named = [re.fullmatch(r"(\w+) \$(\w)\$ = [\d.]+ m", text).groups() for text in annotations(ax)]
    assert set(named) == {("length", "L"), ("thickness", "D")}
    assert [bool(patch.get_hatch()) for patch in ax.patches].count(True) == 1
    (span,) = (
        np.array([text.xy, text.get_position()])
        for text in ax.texts
        if text.arrow_patch is not None and text.arrow_patch.get_edgecolor()[0] > 0.5
    )
    assert np.hypot(*(span[1] - span[0])) == pytest.approx(0.5, rel=2e-3)
    (close,) = (line.get_xydata() for line in ax.lines if line.get_label() == "centreline")
    (body,) = (patch.get_path() for patch in ax.patches[:1])
    assert body.contains_points(close[:-1]).all()
    measure = next(line.get_xydata() for line in ax.lines if line.get_label() != "centreline")
    assert np.hypot(*np.diff(measure, axis=0).T).sum() == pytest.approx(5, rel=1e-6)
    middle = measure - np.array([0.1, -0.6])
    off = np.hypot(*(close - middle).T)
    assert 0.05 < off.max() < 0.25


def test_a_section_has_oblique_directors_that_end_on_its_surface_and_projected_lengths(solved):
    for ax, oblique in zip(drawing(solved, "fig_3_3").axes, (True, False), strict=True):
        boundary = ax.patches[0].get_path()
        arrows = [np.array([f.U[0], f.V[0]]) for f in ax.collections if isinstance(f, Quiver)]
        units = [arrow / np.hypot(*arrow) for arrow in arrows]
        assert (abs(units[0] @ units[1]) > 0.2) == oblique
        for arrow in arrows:
            assert boundary.contains_point(0.99 * arrow)
            assert not boundary.contains_point(1.01 * arrow)
        corner = sum(arrows)
        distance = np.hypot(*(boundary.vertices - corner).T).min()
        assert distance < 0.2 * np.hypot(*corner)
        lengths = {
            text.split("=")[0].strip("$ "): float(text.split("=")[1].split()[0])
            for text in annotations(ax)
            if "=" in text
        }
        for name, unit in zip("WH", units, strict=True):
            assert lengths[name] == pytest.approx(np.ptp(boundary.vertices @ unit), abs=5e-3)


def test_the_osculating_circle_belongs_to_a_negative_angle_and_touches_half_a_voronoi_length_away(
    solved,
):
    ax = drawing(solved, "fig_3_4").axes[0]
    rod = solved["bent_rod"]
    found = {line.get_label(): line.get_xydata() for line in ax.lines}
    (label,) = (text for text in annotations(ax) if "varphi" in text)
    assert label.split("=")[1].strip().startswith("-")
    part = found[next(name for name in found if "Voronoi" in name)]
    halves = np.hypot(*np.diff(part, axis=0).T)
    K = int(np.hypot(*(rod.x.to_numpy() - part[1]).T).argmin())
    assert float(rod.phi[K]) < 0
    assert float(label.split("=")[1].split("$")[0]) == pytest.approx(float(rod.phi[K]), abs=5e-3)
    edges = np.hypot(*np.diff(rod.x.to_numpy()[K - 1 : K + 2], axis=0).T)
    np.testing.assert_allclose(halves, edges.mean() / 2)
    circle = found["osculating circle"]
    centre, radius = circle[:-1].mean(axis=0), np.ptp(circle[:, 0]) / 2
    half_angle = abs(float(rod.phi[K])) / 2
    assert radius == pytest.approx(edges.mean() / 2 / np.tan(half_angle), rel=1e-3)  # (3.3.22)
    for end in part[[0, 2]]:
        assert np.hypot(*(end - centre)) == pytest.approx(radius, rel=1e-3)
        assert (end - centre) @ (end - part[1]) == pytest.approx(0, abs=1e-3)
    assert sum("ell / 2" in text for text in annotations(ax)) == 2


def test_the_angles_of_a_vertex_are_readable_and_have_the_right_sense(solved):
    ax = drawing(solved, "fig_3_6").axes[1]
    rod = solved["bent_rod"]
    arcs = [line.get_xydata() for line in ax.lines if len(line.get_xydata()) == 30]
    for arc, name in zip(arcs, ("phi", "theta"), strict=True):
        polar = np.unwrap(np.arctan2(*arc.T[::-1]))
        stored = float(rod[name][2])
        assert abs(stored) > 0.3
        assert polar[-1] - polar[0] == pytest.approx(stored, abs=1e-9)
        assert any(f"= {stored:.2f}$ rad" in text for text in annotations(ax))


def test_equilibria_have_a_legend_and_sections_that_neck_in_colour(solved):
    figure = drawing(solved, "fig_3_8")
    named = {text.get_text() for text in figure.legends[0].get_texts()}
    assert {"consistent rod, centreline", "sections", "reference"} <= named
    sections = {}
    for ax, name, magnified in zip(
        figure.axes,
        ("hanging_bar", "clamped_free", "clamped_clamped", "necking"),
        (5_000, 20, 500, 80_000),
        strict=True,
    ):
        run = solved[name]
        (line,) = (line.get_xydata() for line in ax.lines if line.get_label() == "_sections")
        ends = sections[name] = line.reshape(20, 3, 2)[:, :2]
        np.testing.assert_allclose(ends.mean(axis=1), run.x_ref + magnified * run.u)
        colours = {patch.get_facecolor()[:3] for patch in ax.patches if len(patch.get_xy()) == 5}
        assert (len(colours) > 1) == (name == "necking"), (
            "sections that keep their height have one colour"
        )
    heights = np.ptp(sections["necking"][:, :, 1], axis=1)
    assert heights[0] == pytest.approx(0.5)  # held
    assert 0.15 < heights[10] < 0.4  # what necks is seen to neck
    top = figure.axes[3]
    (end,) = (line.get_xdata()[0] for line in top.lines if "elongation" in str(line.get_label()))
    assert end == pytest.approx(5 + 80_000 * 1e3 * 5 / (1e9 * 0.25))
    (points,) = (line.get_xdata() for line in top.lines if "consistent rod" in str(line.get_label()))
    assert points[-1] == pytest.approx(end, rel=2e-3)
    feet = [text.get_position()[0] for text in top.texts if text.arrow_patch is not None]
    assert max(feet) >= points.max()  # the force begins where the farther rod ends


def test_necking_is_drawn_over_the_range_of_the_data_with_the_decay_that_each_rod_follows(solved):
    whole, close, printed = drawing(solved, "fig_3_12").axes
    for ax in (whole, close):
        assert ax.get_ylim()[0] > -1.5
        (second,) = ax.child_axes
        assert "m]" in second.get_ylabel()
    shown = curves(close)
    diamonds = shown["consistent rod"]
    inside = diamonds[:, 0] < 1.1
    off = {}
    for label, points in shown.items():
        if "3.5.8" in label:
            values = np.interp(diamonds[inside, 0], *points.T)
            off[label] = np.abs(values - diamonds[inside, 1]).max()
    (free,) = (label for label in off if "free section" in label)
    assert off[free] < 5e-3
    assert min(value for label, value in off.items() if label != free) > 2e-2
    lowest = min(points[:, 1].min() for points in curves(printed).values())
    assert lowest < -4  # the misprint's curve has a range of its own


def test_the_picture_of_a_path_marks_its_special_points(solved):
    data = solved["arch_path"]
    right = path.picture(data).axes[1]
    shown = {label: line for label, line in curves(right).items() if "limit point" in label}
    loads = data.special_load_factor.to_numpy()
    assert list(shown) == [
        f"limit point, first instability at {loads[0]:.4g}",
        f"limit point at {loads[1]:.4g}",
    ]
    assert [line[0, 1] for line in shown.values()] == list(loads)
    placed = np.linalg.norm(data.special_x.to_numpy() - data.x_ref.to_numpy(), axis=2).max(axis=1)
    assert [line[0, 0] for line in shown.values()] == list(placed)
