"""Figures: that they have what they should show, and how they refuse."""

import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import plain_pictures
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

import ebac
from ebac._util import descriptions
from ebac.plot import COLOURS, DPI, colour, plot_columns, plot_overlay, plot_trace, plot_walls
from ebac.plot.marks import for_law
from ebac.plot.run import stiffness_in_motion
from ebac.plot.save import PRINT_DPI, fitted, millimetres, save
from ebac.plot.style import MOST_POINTS, _extremes

Run = Callable[..., ebac.Trace]


def labels(figure: Figure) -> list[str]:
    return [ax.get_ylabel() for ax in figure.axes if ax.get_ylabel()]


@pytest.mark.parametrize("law", list(ebac.LAWS))
@pytest.mark.slow
def test_every_law_has_a_colour_and_a_figure(law: str, run: Run, tmp_path: Path) -> None:
    assert law in COLOURS
    figure = plot_trace(run(law, observer=False))
    units = ("position [mm]", "force [N]", "energy [")
    assert all(any(unit in label for label in labels(figure)) for unit in units)
    assert any("beta" in label for label in labels(figure)) == ("law.beta" in run(law))
    plain_pictures.draw_plain(figure, tmp_path / "figure.png", 100)
    assert (tmp_path / "figure.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", ["arm", "press"])
def test_a_log_without_the_columns_of_a_loop_is_drawn_with_what_it_has(
    name: str, tmp_path: Path
) -> None:
    trace = ebac.load(ebac.datasets.write(name, tmp_path))
    figure = trace.plot()
    assert figure.get_suptitle() == "a run, simulated"
    assert labels(figure) == ["position [mm]", "force [N]"]


def test_of_a_log_without_the_columns_of_a_loop_what_never_changes_is_left_out(
    tmp_path: Path,
) -> None:
    file = tmp_path / "other.csv"
    rows = [f"{i * 1e-3},{i},{i * 1e-5},0" for i in range(100)]
    file.write_text("\n".join(["t,tick,x,sequence", *rows, ""]))
    (panel,) = ebac.load(file).plot().axes
    assert len(panel.lines) == 1


def test_one_column_of_panels_per_axis_in_use(run: Run) -> None:
    joystick = ebac.presets.device("joystick")
    figure = plot_trace(run("ebac", device=joystick, seconds=1.0, observer=False))
    assert len(labels(figure)) == 4
    assert "axis 1 not in use" in figure.get_suptitle()
    hand = ebac.Hand(path=(ebac.Step(target=0.02), ebac.Step(target=0.01), ebac.Step(target=0.0)))
    both = plot_trace(run("direct", device=joystick, hand=hand, seconds=1.0))
    legends = [legend for ax in both.axes if (legend := ax.get_legend())]
    titles = [title for legend in legends if (title := legend.get_title().get_text())]
    assert titles == ["axis 0", "axis 1"]


def test_a_run_on_three_axes_shows_beta_where_it_changes_and_is_not_too_wide(run: Run) -> None:
    """Side by side at full width, letters were too small to be read on a screen."""
    hand = ebac.Hand(path=[ebac.Step(target=x) for x in (0.02, -0.005, 0.008)])
    given = {"device": ebac.presets.device("joystick-3"), "hand": hand, "seconds": 0.3}
    trace = run("ebac", environment=ebac.worlds.preset("sphere"), observer=False, **given)
    beta = trace["law.beta"].copy()
    beta[:, 1:] = 1e-9  # as a law that rounds
    figure = plot_trace(trace.with_column("law.beta", beta))
    assert [label for label in labels(figure) if "beta" in label] == [r"$\beta$ [kN/m]"]
    assert "beta is constant on axes 1, 2, not shown" in figure.get_suptitle()
    below = [ax.get_ylabel() for ax in figure.axes if ax.get_xlabel()]
    assert below == [r"$\beta$ [kN/m]", "energy [mJ]", "energy [mJ]"]
    assert figure.get_size_inches()[0] < 17


def test_walls_of_several_axes_show_the_one_on_which_a_law_swings(run: Run) -> None:
    """In a corner they showed the first axis, at rest, while the second swung at the peak force."""
    hand = ebac.Hand(path=(ebac.Step(target=0.01), ebac.Step(target=0.04)))
    given = {
        "device": ebac.presets.device("joystick"), "hand": hand, "environment": ebac.Corner(), "seconds": 2.0,
    }  # fmt: skip
    swings = plot_walls([run("direct", **given), run("ebac", **given)])
    assert swings.axes[0].get_ylabel() == "position y [mm]"
    drawn = swings.axes[0].lines[0].get_ydata()
    assert np.ptp(np.asarray(drawn)) > 5  # mm
    still = plot_walls(run("ebac", **given))
    assert still.axes[0].get_ylabel() == "position x [mm]"


def test_the_name_of_an_axis_stands_above_a_legend_of_two_lines(run: Run) -> None:
    """It was a title at a fixed height, covered by the second line."""
    device = ebac.presets.device("joystick")
    trace = run("ebac", device=device, environment=ebac.Wall(position=0.01), seconds=3.0)
    figure = plot_trace(trace)
    figure.draw_without_rendering()
    legend = figure.axes[0].get_legend()
    assert legend is not None
    title, *words = (t.get_window_extent() for t in [legend.get_title(), *legend.get_texts()])
    assert all(title.y0 >= word.y1 for word in words)


def test_a_part_of_a_trace_is_drawn_over_its_own_time(run: Run) -> None:
    figure = run("ebac")[1.0:1.2].plot()
    low, high = figure.axes[0].get_xlim()
    assert low == pytest.approx(1.0, abs=0.01)
    assert high == pytest.approx(1.2, abs=0.01)


def test_the_first_contact_is_enlarged_beside_the_run_on_its_scales(run: Run) -> None:
    axes = run("ebac").plot().axes
    whole, contact = axes[: len(axes) // 2], axes[len(axes) // 2 :]
    assert contact[0].get_title() == "first contact"
    for left, right in zip(whole, contact, strict=True):
        assert left.get_ylim() == right.get_ylim()
        low, high = right.get_xlim()
        assert high - low < 0.3
        assert left.get_xlim()[1] > 5
    trace = run("ebac")
    met = trace["t"][np.flatnonzero(trace["f_env"])[0]]
    assert contact[0].get_xlim()[0] < met < contact[0].get_xlim()[1]


def test_no_contact_and_a_short_run_are_drawn_once(run: Run) -> None:
    assert len(run("ebac", environment=ebac.Free()).plot().axes) == 3
    assert len(run("ebac").between(0, 0.5).plot().axes) == 3


def test_beta_panel_is_bounded(run: Run) -> None:
    panel = next(
        ax for ax in plot_trace(run("ebac", observer=False)).axes if "beta" in ax.get_ylabel()
    )
    assert panel.get_yscale() == "symlog"
    assert max(map(abs, panel.get_ylim())) <= 6e4


def test_chosen_columns_of_beta_are_drawn_as_in_the_panel_of_a_run(run: Run) -> None:
    trace = run("ebac", observer=False)
    (panel,) = plot_columns(trace, ["law.beta", "law.beta_max"]).axes
    assert panel.get_ylabel() == "stiffness [kN/m]"
    assert panel.get_yscale() == "symlog"
    assert panel.get_xlim() == pytest.approx((-0.06, 6.06), abs=0.01)  # the whole log
    beta = panel.lines[0]
    assert beta.get_marker() == "."  # a line shows nothing of a row between two gaps
    assert np.nanmax(beta.get_ydata()) == pytest.approx(1e-3 * np.nanmax(trace["law.beta"]))
    assert [text.get_text() for text in panel.get_legend().get_texts()] == [
        "law.beta",
        "law.beta_max, shown to 100 kN/m",
    ]


def test_beta_within_a_decade_is_drawn_on_a_linear_scale(run: Run) -> None:
    """Logarithmic beyond 1 kN/m, all of EBA's beta of 0.8 to 2.3 kN/m was one row of dots."""
    trace = run("eba", observer=False)
    most = 1e-3 * np.nanmax(trace["law.beta"])
    (panel,) = trace.plot("law.beta").axes
    assert panel.get_yscale() == "linear"
    assert panel.get_ylim()[0] < 0 < most < panel.get_ylim()[1] < 2 * most
    (panel,) = trace.plot("law.beta", scale="log").axes
    assert panel.get_yscale() == "symlog"
    (panel,) = trace.plot("law.beta", "law.beta_max").axes
    assert panel.get_yscale() == "symlog", "its bounds run over decades"
    (panel,) = trace.plot("law.beta", "law.beta_max", scale="linear").axes
    assert panel.get_ylim()[1] < 2 * most
    (panel,) = [ax for ax in trace[0:0.1].plot(scale="linear").axes if "beta" in ax.get_ylabel()]
    assert panel.get_yscale() == "linear"
    with pytest.raises(ValueError, match=r"scale = 'linaer': must be .* did you mean 'linear'"):
        trace.plot("law.beta", scale="linaer")


def test_a_value_between_two_gaps_of_a_column_is_a_dot(run: Run) -> None:
    whole = run("tca")
    data = {name: whole[name].copy() for name in whole}
    data["f_meas"] = np.where(np.arange(len(whole)) == 1000, 3.0, np.nan)
    gaps = ebac.Trace(data=data, columns=whole.columns, axes=1)
    (panel,) = plot_columns(gaps, ["f_meas"]).axes
    shown = [line for line in panel.lines if line.get_marker() == "."]
    assert [np.nanmax(line.get_ydata()) for line in shown] == [3.0]


def test_a_log_without_simulation_can_be_drawn(run: Run) -> None:
    whole = run("tca")
    measured = [name for name in whole if not name.startswith(("true.", "law."))]
    bare = ebac.Trace(
        data={name: whole[name] for name in measured},
        columns={name: whole.columns[name] for name in measured},
        axes=1,
    )
    assert len(labels(plot_trace(bare))) == 3


@pytest.mark.parametrize("rows", [slice(100, 110), slice(None)], ids=["some rows", "all rows"])
def test_what_was_not_measured_is_left_out_of_the_panel(run: Run, rows: slice) -> None:
    whole = run("ebac", observer=False)
    data = {name: whole[name].copy() for name in whole}
    for name in ("f_meas", "f_env", "work"):
        data[name][rows] = np.nan
    figure = ebac.Trace(data=data, columns=whole.columns, axes=1, law="ebac").plot()
    low, high = figure.axes[1].get_ylim()
    shown = np.concatenate([data[name] for name in ("f_meas", "f_cmd", "f_applied")])
    assert low < np.nanmin(shown) < np.nanmax(shown) < high
    assert labels(figure)[-1] == labels(whole.plot())[-1] == "energy [mJ]"


def test_a_run_without_any_reading_of_force_has_an_empty_panel(run: Run) -> None:
    whole = run("tca")
    data = {name: whole[name].copy() for name in whole}
    for name in ("f_meas", "f_env", "f_cmd", "f_applied"):
        data[name][:] = np.nan
    figure = ebac.Trace(data=data, columns=whole.columns, axes=1, law="tca").plot()
    assert figure.axes[1].get_ylim() == (-0.15, 0.15)


def test_an_overlay_shows_the_part_in_which_the_traces_differ(run: Run) -> None:
    golden = run("tca")
    t, x = golden["t"], golden["x"].copy()
    x[(t >= 0.05) & (t < 0.15)] += 1e-3
    low, high = plot_overlay(golden.with_column("x", x), golden).axes[0].get_xlim()
    assert 0 <= low < 0.05
    assert 0.15 < high < 0.3
    x += 1e-3  # all along: the whole run
    assert plot_overlay(golden.with_column("x", x), golden).axes[0].get_xlim()[1] > t[-1]


def test_walls_shows_every_law_and_the_ideal(run: Run) -> None:
    figure = plot_walls([run("tca"), run("eba"), run("ebac")])
    (legend,) = figure.legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert texts[:3] == ["tca", "eba", "ebac"]
    assert "ideal rest, 1.165 mm" in texts
    shown = {line.get_color() for line in figure.axes[0].get_lines()}
    assert {colour("tca"), colour("eba"), colour("ebac")} <= shown


def test_walls_distinguish_variants_of_a_law(run: Run) -> None:
    scenario = ebac.Scenario(seconds=1.0)
    variant = ebac.simulate(scenario, ebac.Variant("tca-damped", {"kp": 0.0}))
    runs = [run("tca-damped", seconds=1.0), variant]
    counted = plot_walls(runs)
    named = plot_walls({"damped": runs[0], "kp=0": runs[1]})
    for figure, names in ((counted, ["tca-damped", "tca-damped (2)"]), (named, ["damped", "kp=0"])):
        assert [text.get_text() for text in figure.legends[0].get_texts()][:2] == names
        lines = {line.get_label(): line.get_color() for line in figure.axes[0].get_lines()}
        assert lines[names[0]] != lines[names[1]]
    apart = plot_walls([*runs, run("direct", seconds=1.0), run("tca", seconds=1.0)])
    titles = {ax.get_title(): ax.title.get_color() for ax in apart.axes if ax.get_title()}
    assert list(titles)[:2] == ["tca-damped", "tca-damped (2)"]
    assert len(set(titles.values())) == 4
    twice = plot_walls([run("tca"), run("ebac"), run("ebac")])
    assert "used by ebac only" in twice.get_suptitle()


def test_walls_take_a_single_trace(run: Run) -> None:
    (legend,) = plot_walls(run("eba", seconds=1.0)).legends
    assert legend.get_texts()[0].get_text() == "eba"


def test_walls_without_an_ideal_has_no_panel_for_it(run: Run) -> None:
    hand = ebac.Hand(path=ebac.Sine())
    for given in ({"hand": hand}, {"environment": ebac.Free()}):
        shown = labels(plot_walls([run("eba", **given, seconds=1.0)]))
        assert not any("ideal rest" in label for label in shown)
        assert shown.count("position [mm]") == 1


def test_walls_have_no_panel_without_a_curve(run: Run) -> None:
    """A motor at its peak: ebac on the observer has no beta, and rests far from the ideal rest."""
    hand = ebac.Hand(stiffness=5000.0)
    shown = labels(
        plot_walls([run("ebac", hand=hand, seconds=2.0), run("tca", hand=hand, seconds=2.0)])
    )
    assert not any("ideal rest" in label for label in shown)
    figure = plot_walls([run("eba", hand=hand, seconds=2.0)])
    limits = {ax.get_ylabel(): ax.get_xlim() for ax in figure.axes if ax.get_ylabel()}
    assert limits[r"$\beta$ [kN/m]"] == limits["position [mm]"]


def test_too_short_is_refused(run: Run) -> None:
    with pytest.raises(ValueError, match="0 rows"):
        plot_trace(run("tca").rows(0, 0))
    with pytest.raises(ValueError, match="at least one trace"):
        plot_walls([])


def test_long_lines_keep_their_extremes() -> None:
    y = np.zeros(10 * MOST_POINTS)
    y[12_345], y[54_321] = 3.0, -2.0
    kept = y[_extremes(y)]
    assert len(kept) <= 1.1 * MOST_POINTS
    assert (kept.max(), kept.min()) == (3.0, -2.0)


@pytest.mark.slow
def test_notebooks_get_a_picture(run: Run) -> None:
    assert plot_trace(run("eba"))._repr_png_().startswith(b"\x89PNG")


@pytest.mark.slow
@pytest.mark.weekly
def test_threads_may_draw_at_once(run: Run) -> None:
    trace = run("eba", seconds=1.0)
    sizes: list[int] = []
    draw = [
        threading.Thread(target=lambda: sizes.append(len(plot_trace(trace)._repr_png_())))
        for _ in range(4)
    ]
    for thread in draw:
        thread.start()
    for thread in draw:
        thread.join()
    assert len(set(sizes)) == 1
    assert len(sizes) == 4


@pytest.mark.parametrize("width", [None, "double"])
@pytest.mark.slow
def test_a_png_is_the_picture_that_matplotlib_saves(
    run: Run, tmp_path: Path, width: str | None
) -> None:
    traces = [run("direct"), run("ebac")]
    ours = save(plot_walls(traces), tmp_path / "ours.png", width=width)
    figure, theirs = plot_walls(traces), tmp_path / "theirs.png"
    with fitted(figure, None if width is None else millimetres(width) / 25.4):
        Figure.savefig(figure, theirs, dpi=DPI if width is None else PRINT_DPI)
    assert np.array_equal(imread(ours), imread(theirs))


def test_the_panel_of_beta_names_its_bounds_and_the_stiffness_in_motion(run: Run) -> None:
    """The dots of law.beta_max are the energy bound: far above c_h while the handle comes out."""
    trace = run("ebac", observer=False)
    assert stiffness_in_motion(trace) == pytest.approx(np.nanmax(trace["law.beta"]))
    swings = run("ebac", observer=False, hand=ebac.Hand(path=[ebac.Sine(frequency=2.0)]))
    assert stiffness_in_motion(swings) == pytest.approx(stiffness_in_motion(trace))
    (panel,) = [ax for ax in plot_trace(trace[0.0:1.0]).axes if "beta" in ax.get_ylabel()]
    assert [text.get_text() for text in panel.get_legend().get_texts()] == [
        "highest that the energy bound allows, shown to 100 kN/m",
        "lowest, shown to 100 kN/m",
        r"$\beta$ taken",
        "$c_h$, 3.82 kN/m",
        "force limited",
    ]
    for law in ("eba", "ebac-printed"):
        assert stiffness_in_motion(run(law, observer=False)) is None
    assert stiffness_in_motion(run("ebac")) is None  # no beta with the observer


@pytest.mark.parametrize(
    ("law", "observer", "said"),
    [
        ("eba", True, ""),
        ("ebac-printed", True, ""),
        ("ebac", False, ""),
        ("ebac", True, ", state observer"),
        ("eba", "every-law", ", state observer"),
    ],
)
def test_a_figure_of_one_law_names_the_observer_where_the_law_uses_it(
    law: str, observer: bool | str, said: str, run: Run
) -> None:
    trace = run(law, observer=observer, seconds=0.5)
    for figure in (plot_trace(trace), plot_walls([trace]), plot_columns(trace, ["x"])):
        assert f"1 sample of delay{said}; 0.5 s" in figure.get_suptitle()
    described = descriptions.describe(trace.scenario)
    assert f"1 sample of delay{said}; 0.5 s" in for_law(described, law)


def test_of_a_law_that_is_not_known_a_title_says_what_the_scenario_says() -> None:
    described = descriptions.describe(ebac.Scenario())
    assert for_law(described, "mine") == described


def test_a_law_that_does_not_limit_beta_says_so_where_beta_would_stand() -> None:
    scenario = ebac.Scenario(seconds=0.2)
    trace = ebac.simulate(scenario, "ebac")
    why = "with the state observer ebac does not limit beta"
    assert why in trace.plot().get_suptitle()
    (panel,) = trace.plot(["law.beta"]).axes
    legend = panel.get_legend()
    assert legend is not None
    assert why in legend.get_texts()[0].get_text()
    for other in ("eba", ebac.Variant("ebac", {"observer": False})):
        assert "does not limit" not in ebac.simulate(scenario, other).plot().get_suptitle()


def test_changes_of_a_run_are_marked_and_reported(run: Run) -> None:
    events = [
        ebac.logs.Event(kind=kind, message=message, tick=400, t=0.4)
        for kind, message in (
            ("parameter", "environment: stiffness 10000 -> 20000"),
            ("parameter", "law ebac: kp 0.1 -> 0"),
            ("lost", "3 rows"),
        )
    ]
    figure = ebac.plot.plot_trace(run("ebac", seconds=1.0), events=events)
    told = figure.get_suptitle()
    assert "1, at 0.4 s: environment: stiffness 10000 -> 20000" in told
    assert "2, at 0.4 s: law ebac: kp 0.1 -> 0" in told
    assert "3 rows" not in told
    at_the_time = [ax for ax in figure.axes if ax.dataLim.x0 <= 0.4 <= ax.dataLim.x1]
    assert len(at_the_time) >= 3
    assert all("1, 2" in [text.get_text() for text in ax.texts] for ax in at_the_time)


def test_one_axis_of_a_column_is_chosen_as_files_name_it() -> None:
    """`ebac log info`, CSV and Parquet call it x_1; it was refused."""
    device = ebac.Device(kinematics=ebac.Linear(axes=2))
    trace = ebac.simulate(ebac.Scenario(device=device, seconds=0.1), "direct")
    (panel,) = plot_columns(trace, ["x_1", "true.x_0"]).axes
    assert [line.get_label() for line in panel.lines] == ["x, axis 1", "true.x, axis 0"]
    np.testing.assert_allclose(panel.lines[0].get_ydata(), 1e3 * trace["x"][:, 1])
    with pytest.raises(ValueError, match=r"^x_2: x has axes 0 to 1$"):
        plot_columns(trace, ["x_2"])
    with pytest.raises(KeyError, match="y_0"):
        plot_columns(trace, ["y_0"])
    flat = ebac.simulate(ebac.Scenario(seconds=0.1), "direct")
    assert len(plot_columns(flat, ["x_0"]).axes[0].lines) == 1
    with pytest.raises(ValueError, match=r"^x_1: x has only axis 0$"):
        plot_columns(flat, ["x_1"])


def test_a_long_line_keeps_its_last_rows() -> None:
    """A spike in the rows that fill no bin was left out: where a fault is."""
    from ebac.plot.style import MOST_POINTS, _extremes

    for more in range(1, 40):
        y = np.zeros(4 * MOST_POINTS + more)
        y[-3] = -40.0
        assert y[_extremes(y)].min() == -40.0
