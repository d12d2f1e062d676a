"""Every figure: a title with source and scenario, units, legends inside, journal widths, marks of the end."""

import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from numpy.typing import NDArray
from PIL import Image

import ebac
from ebac._util import formatting
from ebac.faults import run_case
from ebac.operators import Operators
from ebac.plot import (
    COLOURS,
    WIDTHS,
    plot_ablation,
    plot_budget,
    plot_columns,
    plot_fault,
    plot_map,
    plot_stiffest,
    plot_study,
    plot_sweep,
    plot_trace,
    plot_tracking,
    plot_walls,
    plot_world,
    plot_worst,
    plot_zwidth,
    save,
)
from ebac.plot.ablation import _text
from ebac.plot.save import balanced, fitted, millimetres
from ebac.plot.study_overview import _energy
from ebac.plot.style import BETTER, OTHER_LAWS, QUANTITIES, SAME, WORSE, colours
from ebac.studies import MEASURES, ablation, stiffest, study, worst
from ebac.studies.maps import stability_map
from ebac.studies.zwidth import zwidth
from ebac.tracking import RecordedPath, error_budget, evaluate

Run = Callable[..., ebac.Trace]


def check_inside(figure: Figure, width: float | None = None) -> None:
    """Check that legends and titles lie inside the figure."""
    with fitted(figure, width):
        figure.draw_without_rendering()
        whole = figure.bbox.padded(2)
        legends = [*figure.legends, *(ax.get_legend() for ax in figure.axes)]
        for legend in filter(None, legends):
            box = legend.get_window_extent()
            assert box.x0 >= whole.x0
            assert box.x1 <= whole.x1
            assert box.y1 <= whole.y1
        for text in [*figure.texts, *(ax.title for ax in figure.axes)]:
            if text.get_text():
                box = text.get_window_extent()
                assert box.x0 >= whole.x0
                assert box.x1 <= whole.x1


def check_units(figure: Figure) -> None:
    """Check that every labelled axis has a unit, and each bottom axis a label."""
    for ax in figure.axes:
        for label in (ax.get_xlabel(), ax.get_ylabel()):
            assert not label or "[" in label or label in ("state", "hands"), label
    assert any(ax.get_xlabel() for ax in figure.axes)


def ended_by_fault(trace: ebac.Trace) -> ebac.Trace:
    """Return the trace as it would be had fault 4 ended it 100 ms before its end."""
    fault, state = trace["fault"].copy(), trace["state"].copy()
    fault[-100:], state[-100:] = 4, 3
    return trace.with_column("fault", fault).with_column("state", state)


@pytest.mark.parametrize(
    ("laws", "width"),
    [
        (("ebac",), "single"),
        (("tca", "eba", "ebac"), None),
        (("tca", "eba", "ebac"), "double"),
        (("direct", "tca", "eba", "ebac"), "single"),
    ],
)
@pytest.mark.slow
def test_walls_fit_any_column(laws: tuple[str, ...], width: str | None, run: Run) -> None:
    figure = plot_walls([run(law, seconds=1.0) for law in laws])
    assert figure.get_suptitle().startswith("simulated: the reference device")
    assert "1 sample of delay" in figure.get_suptitle()
    check_units(figure)
    check_inside(figure, None if width is None else millimetres(width) / 25.4)


@pytest.mark.slow(every=True)
@pytest.mark.parametrize("laws", [("tca", "tca", "eba", "ebac"), ("ebac",)])
def test_walls_fill_one_column_where_there_is_beta_and_friction(
    laws: tuple[str, ...], run: Run
) -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.1))
    wall = ebac.Wall(stiffness=4000.0)
    runs = [run(law, device=device, environment=wall, observer=False, seconds=1.0) for law in laws]
    figure = plot_walls(runs)
    assert any("beta" in ax.get_ylabel() for ax in figure.axes)
    assert figure.narrow is not None
    column = figure.narrow()
    inches = millimetres("single") / 25.4
    check_inside(column, inches)
    with fitted(column, inches):
        column.draw_without_rendering()
        places = [ax.get_position() for ax in column.axes]
        assert max(place.x1 for place in places) > 0.93
        assert max(place.width for place in places) > 0.75
    with fitted(figure, millimetres("double") / 25.4):
        figure.draw_without_rendering()
        assert max(ax.get_position().x1 for ax in figure.axes) > 0.95


@pytest.mark.parametrize("laws", [("tca", "ebac"), ("direct", "tca", "eba", "ebac")])
def test_walls_name_the_laws_of_the_observer_and_the_peak_force(
    laws: tuple[str, ...], run: Run
) -> None:
    figure = plot_walls([run(law) for law in laws])
    assert "1 sample of delay, state observer used by ebac only;" in figure.get_suptitle()
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels.count("peak force of the motor, 42.4 N") == 1
    assert "observer" not in plot_walls([run("tca")]).get_suptitle()


@pytest.mark.slow
def test_a_run_fits_any_column(run: Run) -> None:
    figure = plot_trace(run("ebac", seconds=1.0))
    assert "law ebac, simulated" in figure.get_suptitle()
    check_units(figure)
    for name in WIDTHS:
        check_inside(figure, millimetres(name) / 25.4)


def test_more_than_three_laws_get_panels_of_their_own(run: Run) -> None:
    laws = ("direct", "tca", "eba", "ebac")
    figure = plot_walls([run(law, seconds=1.0, observer=False) for law in laws])
    titles = [ax.get_title() for ax in figure.axes if ax.get_title()]
    assert titles == [*laws, "eba", "ebac"]
    assert len(figure.axes) == 2 * len(laws) + 2 + 1  # beta for two of them, beside the end
    rows = {ax.get_subplotspec().rowspan.start for ax in figure.axes}
    assert len(rows) == 3, "no row of panels for beta alone"


def test_beta_has_its_panel_in_walls(run: Run) -> None:
    figure = plot_walls([run("tca"), run("ebac", observer=False)])
    (panel,) = [ax for ax in figure.axes if "beta" in ax.get_ylabel()]
    assert len(panel.get_lines()) == 1
    none = plot_walls([run("tca"), run("direct")])
    assert not any("beta" in ax.get_ylabel() for ax in none.axes)


@pytest.mark.slow
def test_a_world_has_a_legend(run: Run) -> None:
    world = ebac.worlds.preset("sphere")
    traces = [run(law, environment=world, seconds=0.5) for law in ("tca", "ebac")]
    for shown, names in (
        (traces, ["handle under tca", "handle under ebac", "body"]),
        ([], ["body", "motion along x"]),
    ):
        figure = plot_world(world, shown)
        legend = figure.axes[1].get_legend()
        assert legend is not None
        assert [text.get_text() for text in legend.get_texts()] == names
        check_inside(figure)


@pytest.mark.slow
def test_a_short_path_in_a_world_is_shown_from_close_by(run: Run) -> None:
    world = ebac.worlds.preset("sphere")
    trace = run("ebac", environment=world, seconds=0.5)
    cut = plot_world(world, [trace]).axes[1]
    [inset] = cut.child_axes
    [path] = inset.get_lines()
    low, high = inset.get_xlim()
    assert np.ptp(np.asarray(path.get_xdata())) > 0.4 * (high - low)
    assert "[mm]" in inset.get_title()
    far = ebac.worlds.preset("sphere", position=0.02)
    long = run("ebac", environment=far, seconds=0.5)
    assert not plot_world(far, [long]).axes[1].child_axes


@pytest.mark.parametrize(("name", "half"), [("sphere", 50), ("torus", 90), ("plane", 50)])
def test_a_world_shows_bodies_whole_that_have_an_end(name: str, half: float) -> None:
    _, cut = plot_world(ebac.worlds.preset(name)).axes
    assert cut.get_xlim() == pytest.approx((-half, half))


def test_the_view_into_a_corner_has_no_holes() -> None:
    view = plot_world(ebac.worlds.preset("corner")).axes[0]
    image = np.asarray(view.images[0].get_array())
    white = (image > 0.99).all(axis=2)
    # from the top down, a column is background, then bodies, then background
    assert (np.abs(np.diff(white.astype(int), axis=0)).sum(axis=0) <= 2).all()


def test_a_fault_is_named_and_shown(run: Run) -> None:
    trace = ended_by_fault(run("eba", seconds=1.0))
    alone = plot_trace(trace)
    assert "ended by fault 4 (law not finite) at 0.9" in alone.get_suptitle()
    shown = [text.get_text() for text in alone.axes[0].get_legend().get_texts()]
    assert "force ramped to zero" in shown
    assert "fault 4 (law not finite)" in shown
    (legend,) = plot_walls([trace, run("ebac", seconds=1.0)]).legends
    names = [text.get_text() for text in legend.get_texts()]
    assert names[:2] == ["eba, ended by fault 4 (law not finite)", "ebac"]
    columns = plot_columns(trace, ["x"])
    assert "fault 4 (law not finite)" in columns.axes[0].get_legend_handles_labels()[1]


def test_columns_without_numbers_are_said_to_have_none_and_wrong_ones_are_refused(run: Run) -> None:
    trace = run("ebac", seconds=1.0)
    assert np.isnan(trace["law.beta"]).all()
    (legend,) = [ax.get_legend() for ax in plot_columns(trace, ["law.beta"]).axes]
    why = "law.beta: with the state observer ebac does not limit beta"
    assert [text.get_text() for text in legend.get_texts()] == [why]
    with pytest.raises(TypeError, match=r"names = 'x'.*such as \['x'\]"):
        plot_columns(trace, "x")
    with pytest.raises(TypeError, match="plot_columns takes a Trace"):
        plot_columns("x", ["x"])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"names = .*is empty"):
        plot_columns(trace, [])


def test_a_run_without_fault_has_no_mark(run: Run) -> None:
    shown = [t.get_text() for t in plot_trace(run("eba")).axes[0].get_legend().get_texts()]
    assert not any("fault" in text or "ramped" in text for text in shown)


@pytest.mark.parametrize(
    ("kind", "name", "stem"),
    [
        ("png", "run", "run"),
        ("png", "run.svg", "run"),
        ("pdf", "run.pdf", "run"),
        ("svg", "run.png", "run"),
        ("svg", "k2.5", "k2.5"),
    ],
)
def test_formats(kind: str, name: str, stem: str, run: Run, tmp_path: Path) -> None:
    figure = plot_columns(run("eba", seconds=1.0), ["x"])
    file = save(figure, tmp_path / name, file_format=kind, width="single")
    assert file == tmp_path / f"{stem}.{kind}"
    begin = {"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}[kind]
    assert file.read_bytes().startswith(begin)


@pytest.mark.parametrize(
    ("width", "inches"), [("single", 89 / 25.4), ("double", 183 / 25.4), (120, 120 / 25.4)]
)
def test_widths_on_paper(width: str | float, inches: float, run: Run, tmp_path: Path) -> None:
    figure = plot_columns(run("eba", seconds=1.0), ["x"])
    with Image.open(save(figure, tmp_path / "x.png", width=width)) as image:
        assert image.width / 300 == pytest.approx(inches, abs=0.01)


def test_four_laws_in_a_column_fit_a_page(run: Run, tmp_path: Path) -> None:
    figure = plot_walls([run(law) for law in ("tca", "tca-damped", "eba", "ebac")])
    with Image.open(save(figure, tmp_path / "x.png", width="single")) as image:
        assert 200 < image.height / 300 * 25.4 <= 230.1


@pytest.mark.slow
def test_saving_leaves_the_figure_as_it_was(run: Run, tmp_path: Path) -> None:
    def state() -> list[object]:
        figure.draw_without_rendering()
        texts = [(text.get_text(), text.get_fontsize()) for text in figure.findobj(Text)]
        widths = [line.get_linewidth() for line in figure.findobj(Line2D)]
        legends = [legend for ax in figure.axes if (legend := ax.get_legend())]
        columns = [legend._ncols for legend in legends]
        return [tuple(figure.get_size_inches()), set(texts), sorted(set(widths)), columns]

    figure = plot_trace(run("ebac", seconds=1.0))
    before = state()
    save(figure, tmp_path / "run.png", width="single")
    assert state() == before


def test_a_figure_is_saved_without_its_title(run: Run, tmp_path: Path) -> None:
    figure = plot_columns(run("eba", seconds=1.0), ["x"])
    title = figure.get_suptitle()
    panels = []
    for shown in (True, False):
        with fitted(figure, title=shown):
            figure.draw_without_rendering()
            panels.append(figure.axes[0].get_position().height)
    assert panels[1] > panels[0]  # its room is the panel's
    with_title, without = (
        save(figure, tmp_path / f"{shown}.svg", title=shown).read_text() for shown in (True, False)
    )
    assert "seed 1 -->" in with_title  # what a text was, in a comment beside its outlines
    assert "seed 1 -->" not in without
    assert figure.get_suptitle() == title


@pytest.mark.parametrize("width", ["triple", "5", 3000, "nan"])
def test_wrong_widths_are_refused(width: str | float) -> None:
    with pytest.raises(ValueError, match="width = "):
        millimetres(width)


def test_wrong_formats_are_refused(run: Run, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="png, pdf, svg"):
        save(plot_columns(run("eba", seconds=1.0), ["x"]), tmp_path / "x.gif")


def test_a_path_away_from_a_cut_does_not_seem_to_go_through_the_body(run: Run) -> None:
    """Around a ball, in the plane y = 0: in the cut at z = 0 it was a straight line through the middle."""
    world = ebac.worlds.preset("sphere")
    device = ebac.presets.device("joystick-3")
    trace = run("ebac", device=device, environment=world, seconds=1.0)
    view, *cuts = plot_world(world, [trace]).axes
    words = "before or behind the cut"
    for cut, beside in zip(cuts, (True, False), strict=True):
        legend = cut.get_legend()
        assert legend is not None
        assert (words in [text.get_text() for text in legend.get_texts()]) == beside
        path = cut.lines[0]
        x, y = (np.asarray(one) for one in (path.get_xdata(), path.get_ydata()))
        deep = np.hypot(x - 20, y) < 18  # mm, inside a ball of 40 mm
        assert not deep.any()
    assert any("handle comes in" in text.get_text() for text in view.texts)


# --- colours ---

#: Severe colour blindness in linear RGB (Machado, Oliveira and Fernandes 2009, severity 1).
EYES = {
    "usual": np.eye(3),
    "protan": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deutan": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritan": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}  # fmt: skip


def lab(shade: str, eye: str) -> NDArray[np.float64]:
    """Return a colour as an eye sees it, in CIE L*a*b* (D65)."""
    rgb = np.array(to_rgb(shade))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    xyz = to_xyz @ np.clip(EYES[eye] @ linear, 0, 1) / np.array([0.9505, 1, 1.089])
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("eye", list(EYES))
def test_every_eye_distinguishes_the_laws(eye: str) -> None:
    for one, other in itertools.combinations([*COLOURS.values(), *OTHER_LAWS], 2):
        assert np.linalg.norm(lab(one, eye) - lab(other, eye)) > 15
    for one, other in itertools.combinations((BETTER, WORSE, SAME), 2):
        assert np.linalg.norm(lab(one, eye) - lab(other, eye)) > 15


def test_laws_without_a_colour_of_their_own_get_different_ones() -> None:
    shades = colours(["ebac", "mine", "ebac, kp=0", "tca-tuned", "mine"])
    assert list(shades) == ["ebac", "mine", "ebac, kp=0", "tca-tuned"]
    assert shades["ebac"] == COLOURS["ebac"]
    assert shades["tca-tuned"] == COLOURS["tca"]
    assert [shades["mine"], shades["ebac, kp=0"]] == [*OTHER_LAWS[:2]]
    assert len(colours(map(str, range(6)))) == 6  # they begin anew
    forms = ["tca", "tca-tuned", "tca-tuned-observer"]
    assert len(set(colours(forms).values())) == 3


def test_pages_have_the_colours_of_the_figures(run: Run) -> None:
    pytest.importorskip("bokeh")
    from ebac.explore import page

    for law in ("tca", "ebac"):
        for panel in run(law, seconds=1.0).explore().panels:
            shown = dict(zip(panel.names, page.colours(panel, law), strict=True))
            for name, shade in shown.items():
                if name in ("true.x", "f_applied", "law.beta", "true.energy"):
                    assert shade == COLOURS[law]
                elif name in QUANTITIES:
                    assert shade == QUANTITIES[name]


@pytest.mark.parametrize("conditions", [["d1K10"], ["d1K10", "d2b1K15"]])
@pytest.mark.parametrize("width", [None, "single"])
def test_long_names_of_laws_leave_room_for_the_table(
    conditions: list[str], width: str | None, tmp_path: Path
) -> None:
    laws = ["lag-compensator-tuned-observer", "tca-damped-tuned-observer", "ebac"]
    base = ebac.Scenario(seconds=0.5, observer="every-law")
    few = study(Operators.grid()[:1], laws, conditions, base=base)
    _, overview = next(plot_study(few))
    save(overview, tmp_path / "overview.png", width=width)  # warns where a panel has no room
    shown = overview if width is None else overview.narrow()  # type: ignore[misc]
    with fitted(shown):
        shown.draw_without_rendering()
        for ax in shown.axes:
            rows = ax.get_window_extent().height / shown.dpi / len(conditions)
            assert rows > 0.15  # inch


# --- every other figure ---


def test_what_lies_in_the_grey_area_is_exact_and_still_and_not_always_good() -> None:
    hands = Operators.grid()[:2]
    found = study(hands, ["tca-damped"], ["d1K10"], base=ebac.Scenario(seconds=3.0))
    _, (_, scatter) = plot_study(found)
    [ax] = scatter.axes
    assert ax.get_title(loc="left") == "0 of 2 good"
    [grey] = ax.collections
    box = grey.get_datalim(ax.transData)
    [rings] = [line for line in ax.lines if line.get_markerfacecolor() == "white"]
    assert len(rings.get_xydata()) == found.columns["exact_and_still"].sum() > 0
    assert all(box.contains(x, y) for x, y in rings.get_xydata())
    [key] = scatter.legends
    said = [" ".join(text.get_text().split()) for text in key.get_texts()]
    assert said[0].startswith("exact and still: a rest within 2 encoder counts of the ideal")
    assert said[2] == "exact and still, force not quiet"


@pytest.mark.slow
def test_the_hands_of_one_law_have_a_title_of_few_lines() -> None:
    found = study(Operators.grid()[:1], ["tca"], ["d1K10"], base=ebac.Scenario(seconds=0.5))
    figure = dict(plot_study(found))["hands"]
    with fitted(figure):
        assert len(figure.get_suptitle().split("\n")) <= 4
    check_inside(figure)
    check_inside(figure.narrow(), millimetres("single") / 25.4)  # type: ignore[misc]


def test_a_study_of_several_conditions_names_what_they_share_and_explains_each() -> None:
    found = study(
        Operators.grid()[:1], ["tca"], ["d1K10", "d2b2K20"], base=ebac.Scenario(seconds=0.5)
    )
    figure = dict(plot_study(found))["hands"]
    assert figure.get_suptitle().endswith(
        "the reference device (0.25 kg, 2 N s/m, sensor without noise); 1 kHz, state observer for laws made for it"
    )
    assert "\n" not in figure.get_suptitle()
    [key] = figure.legends
    assert [text.get_text() for text in key.get_texts()][-2:] == [
        "d1K10: 1 sample of delay, wall 10 kN/m",
        "d2b2K20: 2 samples of delay, device damping 2 N s/m, wall 20 kN/m",
    ]
    check_inside(figure)


@pytest.mark.slow
@pytest.mark.weekly
def test_every_study_has_a_title_that_says_simulated() -> None:
    few = Operators.sample(3, seed=1)
    base = ebac.Scenario(seconds=1.0)
    few_laws = ["direct", "passivity-control", "tca", "eba", "ebac"]
    found = [
        *(figure for _, figure in plot_study(study(few, ["tca", "ebac"], ["d1K10"], base=base))),
        plot_ablation(ablation(few, base=base, measures=MEASURES[:2])),
        plot_sweep(ebac.sweep([base], ["tca", "ebac"])),
        plot_map(stability_map("ebac", base=base, xs=[0, 5, 9], ys=[1e3, 2e3, 1e4])),
        plot_zwidth(zwidth(["tca", "ebac"], base=base, delays=[1], dampings=[0.0, 5.0])),
        plot_stiffest(stiffest(few_laws, population=few, stiffnesses=[1e3, 1e4, 1e5], base=base)),
        plot_worst(worst("ebac", family=["impact"], evaluations=40, base=base)),
        plot_budget(error_budget(runs=2)),
    ]
    for figure in found:
        assert "simulated" in figure.get_suptitle()
        check_inside(figure)
        column = figure.narrow() if figure.narrow else figure
        check_inside(column, millimetres("single") / 25.4)


@pytest.mark.slow
def test_panels_stand_below_one_another_in_one_column(tmp_path: Path) -> None:
    path = RecordedPath(points=np.array([[0, 0], [1, 0.1], [2, 0], [3, 0.1]]), name="a", remark="")
    figure = plot_tracking(evaluate(path, shape="line"))
    assert figure.narrow is not None
    assert "recorded" not in figure.get_suptitle()
    left = {round(ax.get_position().x0, 1) for ax in figure.narrow().axes}
    assert len(left) == 1
    with Image.open(save(figure, tmp_path / "x.png", width="single")) as image:
        assert image.height > image.width


def test_lines_of_a_title_are_of_one_length_and_keep_units() -> None:
    lines = balanced("a wall of 10 kN/m at 0 mm; 1 kHz, 1 sample of delay; 6 s, seed 1", 40).split(
        "\n"
    )
    assert len(lines) == 2
    assert abs(len(lines[0]) - len(lines[1])) < 12
    assert "10\N{NO-BREAK SPACE}kN/m" in lines[0]
    for width in range(8, 30):
        one = balanced("the reference hand (0.15 kg, 6 N s/m, 0.1 N m)", width)
        assert all(end in one.replace("\N{NO-BREAK SPACE}", " ") for end in ("6 N s/m", "0.1 N m"))


def test_a_case_of_faults_names_fault_and_law() -> None:
    figure = plot_fault(run_case(15))
    assert "Simulated fault" in figure.get_suptitle()
    assert "law ebac" in figure.get_suptitle()
    check_inside(figure)


def test_an_overview_writes_energies_with_their_unit_and_names_level() -> None:
    laws = ["tca", "lag-compensator", "ebac"]
    found = study(Operators.grid()[:6], laws, ["d1K10"], base=ebac.Scenario(seconds=2.0))
    overview = dict(plot_study(found))["overview"]
    left, right = overview.axes
    assert "mJ" not in right.get_title()
    assert [text.get_text().split()[-1] for text in right.texts] == ["J", "mJ", "mJ"]
    for ax in (left, right):
        names = ax.get_xticklabels()
        assert [name.get_text() for name in names] == ["tca", "lag-\ncompensator", "ebac"]
        assert {name.get_rotation() for name in names} == {0.0}
    check_inside(overview)


@pytest.mark.slow
@pytest.mark.parametrize("width", [None, "double"])
def test_an_overview_of_many_laws_has_room_for_each(width: str | None) -> None:
    laws = [*ebac.LAWS, "tca-damped-tuned-observer", "lag-compensator-tuned-observer"]
    found = study(Operators.grid()[:2], laws, ["d1K10"], base=ebac.Scenario(seconds=0.5))
    _, overview = next(plot_study(found))
    with fitted(overview, None if width is None else millimetres(width) / 25.4):
        overview.draw_without_rendering()
        for ax in overview.axes:
            names = (*ax.get_xticklabels(), *ax.get_yticklabels())
            boxes = [text.get_window_extent() for text in (*ax.texts, *names)]
            assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
    check_inside(overview)


def test_hands_that_fail_show_on_top_of_good_ones() -> None:
    base = ebac.Scenario(seconds=3.0)
    found = study(Operators.grid()[:20], ["lag-compensator"], ["d1K20"], base=base)
    (panel,) = dict(plot_study(found))["hands"].axes
    good, ring, cross = panel.get_lines()
    assert 0 < len(good.get_xdata()) < 20
    assert len(good.get_xdata()) + len(ring.get_xdata()) + len(cross.get_xdata()) == 20
    assert good.get_zorder() <= ring.get_zorder() <= cross.get_zorder()
    assert ring.get_markerfacecolor() == "white"  # not the good ones behind it


LONG_NAMES = {
    "a law with quite a long name of its own": "tca",
    "lag-compensator-with-observer": "lag-compensator",
    "another_law_with_underscores": "ebac",
}


@pytest.mark.slow
@pytest.mark.parametrize("more", [["direct", "passivity-control", "tca", "tca-damped", "eba"], []])
def test_a_study_fits_one_column_whatever_its_laws_are_called(more: list[str]) -> None:
    laws = LONG_NAMES | {law: law for law in more}
    base = ebac.Scenario(seconds=1.0)
    found = dict(plot_study(study(Operators.grid()[:3], laws, ["d1K10"], base=base)))
    overview, hands = (found[name].narrow() for name in ("overview", "hands"))
    for column in (overview, hands):
        inches = millimetres("single") / 25.4
        check_inside(column, inches)
        with fitted(column, inches):
            column.draw_without_rendering()
            for ax in column.axes:
                assert ax.get_position().width > (0.6 if column is overview else 0.3)
                boxes = [text.get_window_extent() for text in ax.texts]
                assert all(column.bbox.x0 <= box.x0 and box.x1 <= column.bbox.x1 for box in boxes)
                if column is overview:
                    pairs = itertools.combinations(boxes, 2)
                    assert not any(one.overlaps(other) for one, other in pairs)


@pytest.mark.parametrize(
    ("drawn", "text"),
    [
        (0.0, "0 mJ"),
        (4e-4, "<0.001 mJ"),
        (0.0123, "0.012 mJ"),
        (87.4, "87 mJ"),
        (999.4, "999 mJ"),
        (999.6, "1.0 J"),
        (14e3, "14.0 J"),
        (140e3, "140 J"),
    ],
)
def test_an_energy_of_a_study_is_short_and_has_its_unit(drawn: float, text: str) -> None:
    assert _energy(drawn) == text


def test_a_large_energy_of_an_ablation_is_in_joule() -> None:
    assert _text(-45.908, "J") == "-45.9 J"  # its column is in mJ
    assert _text(-5.199, "J") == "-5.2 J"
    assert _text(-0.0123, "J") == formatting.cell(-0.0123, "J")
    assert _text(None, "J") == "-"


def test_the_view_of_a_world_has_the_paths_three_directions_and_what_swings(run: Run) -> None:
    still = ebac.worlds.preset("sphere")
    swing = ebac.worlds.Swing(amplitude_x=2e-3, amplitude_y=4e-3)
    swings = ebac.worlds.World(ebac.worlds.Body(solid=still.bodies[0].solid, motion=swing))
    joystick = ebac.presets.device("joystick-3")
    trace = run("ebac", environment=swings, device=joystick, seconds=0.5)
    view, *cuts = plot_world(swings, [trace]).axes
    assert [line.get_color() for line in view.lines] == [colours(["ebac"])["ebac"]]
    assert np.ptp(view.lines[0].get_xydata(), axis=0).max() > 0.5
    arrows = len([text for text in view.texts if text.get_text() == ""])
    words = [text.get_text() for text in view.texts if text.get_text()]
    assert words == ["handle comes in,\nalong x", "x", "y", "z"]
    for cut in cuts:
        assert cut.get_legend().get_texts()[-1].get_text() == "ends of its swing"
    alone = plot_world(still)
    assert len([text for text in alone.axes[0].texts if text.get_text() == ""]) == arrows - 1
    assert "ends of its swing" not in alone.axes[1].get_legend_handles_labels()[1]


def test_walls_draw_a_moving_surface_where_it_is(run: Run) -> None:
    wall = ebac.Wall(motion_amplitude=2e-3, motion_frequency=2.0)
    figure = plot_walls([run("ebac", environment=wall, seconds=2.0)])
    assert "a wall of 10 kN/m at 0 mm, swinging by 2 mm at 2 Hz;" in figure.get_suptitle()
    for ax in (figure.axes[0], figure.axes[1]):
        (surface,) = [line for line in ax.lines if line.get_label() == "wall surface"]
        t, y = surface.get_xydata().T
        assert y == pytest.approx(2 * np.sin(4 * np.pi * t))
        assert t[0] >= ax.get_xlim()[0]
        assert t[-1] <= ax.get_xlim()[1]
    assert figure.axes[0].get_xlim()[1] < 0.6


def test_walls_of_several_axes_say_which_is_shown(run: Run) -> None:
    joystick = ebac.presets.device("joystick-3")
    for laws in (["ebac"], ["tca", "tca-damped", "eba", "ebac"]):
        runs = [run(law, device=joystick, seconds=1.0) for law in laws]
        labels = {ax.get_ylabel() for ax in plot_walls(runs).axes}
        assert {"position x [mm]", "applied force x [N]"} <= labels
        assert "position [mm]" not in labels
