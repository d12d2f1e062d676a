"""Which walls can be rendered: the exact linear loop, the ceilings, the search."""

import json
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.image import imread
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.plot import plot_zwidth, save
from ebac.plot.save import fitted
from ebac.plot.zwidth import MARKS
from ebac.studies.zwidth import (
    CRITERIA,
    ZWidth,
    delay_ceiling,
    eigenvalues,
    passive_ceiling,
    quantised_ceiling,
    spectral_radius,
    stiffness_limit,
    zwidth,
)
from ebac.studies.zwidth.result import SEEDS, STIFFNESSES

NOBODY = ebac.Hand(mass=0, damping=0, stiffness=0)
FINE = ebac.Device(encoder=ebac.Encoder(counts_per_turn=2**26))


def scenario(**changes: Any) -> ebac.Scenario:
    return ebac.Scenario(device=FINE, **changes)


# --- the linear loop ---


def growth(stiffness: float, damping: float, hand: ebac.Hand, delay: int) -> float:
    """How the swing of a simulated contact grows from tick to tick, deep in the wall."""
    depth = 1e-4  # m
    pull = ebac.Step(target=stiffness * depth / hand.stiffness)
    still = ebac.Step(target=0.0)
    trace = ebac.simulate(
        scenario(
            hand=hand.replace(path=[pull, still, still]),
            environment=ebac.Wall(stiffness=stiffness, damping=damping, position=-depth),
            timing=ebac.Timing(delay=delay),
            seconds=4.0,
        ),
        ebac.Direct(peak_force=1e4),
    )
    x = trace.axis("true.x")
    inside = x > -0.5 * depth  # beyond, the wall's edge is near
    end = len(x) if inside.all() else int((~inside).argmax())
    if end < 400:
        return np.inf
    early, late = (np.ptp(part) for part in np.array_split(x[end // 4 : end], 2))
    return float(late / early)


@given(
    mass=st.floats(0.05, 1.0),
    hand_damping=st.floats(2, 20),
    hand_stiffness=st.floats(100, 1000),
    damping=st.floats(0, 15),
    delay=st.integers(0, 3),
)
@settings(max_examples=25)
def test_the_simulation_diverges_above_the_limit_and_decays_below(
    mass: float, hand_damping: float, hand_stiffness: float, damping: float, delay: int
) -> None:
    hand = ebac.Hand(mass=mass, damping=hand_damping, stiffness=hand_stiffness)
    limit = stiffness_limit(scenario(hand=hand, timing=ebac.Timing(delay=delay)), damping)
    assert limit > 0
    assert growth(0.96 * limit, damping, hand, delay) < 1
    assert growth(1.04 * limit, damping, hand, delay) > 1


def test_eigenvalues_come_largest_first() -> None:
    reference = ebac.Scenario()
    values = eigenvalues(reference, 3000, 5)
    assert len(values) == 6  # x, v, f_motor, last x, estimate, one command under way
    assert (np.diff(np.abs(values)) <= 1e-15).all()
    assert abs(values[0]) == pytest.approx(spectral_radius(reference, 3000, 5), abs=1e-15)


def test_what_is_not_linear_is_refused() -> None:
    with pytest.raises(ValueError, match=r"straight axes .* simulate this device instead"):
        stiffness_limit(ebac.Scenario(device=ebac.presets.device("joystick")))


# --- ceilings ---


@pytest.mark.parametrize(("delay", "damping"), [(0, 5.0), (1, 15.0), (2, 25.0)])
def test_the_papers_wall_needs_much_damping_to_be_passive(delay: int, damping: float) -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(damping=damping))
    assert passive_ceiling(device, ebac.Timing(delay=delay)) == pytest.approx(10e3)


def test_wall_damping_of_either_sign_costs_passivity() -> None:
    timing = ebac.Timing(delay=0)
    device = ebac.Device()
    assert passive_ceiling(device, timing, 0.5) == passive_ceiling(device, timing, -0.5) == 3000
    assert passive_ceiling(device, timing, 3) == 0


@pytest.mark.parametrize("hand", [None, ebac.Hand()])
@pytest.mark.parametrize("delay", [0, 1, 2])
def test_the_delay_ceiling_is_near_the_exact_limit(delay: int, hand: ebac.Hand | None) -> None:
    timing = ebac.Timing(delay=delay)
    exact = stiffness_limit(ebac.Scenario(hand=hand or NOBODY, timing=timing))
    assert delay_ceiling(ebac.Device(), timing, hand=hand) == pytest.approx(exact, rel=0.03)


def test_counts_need_friction() -> None:
    timing = ebac.Timing()
    assert quantised_ceiling(ebac.Device(), timing) == 0
    dry = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.02))
    assert quantised_ceiling(dry, timing) == pytest.approx(2 * 0.02 / dry.count)
    drier = ebac.Device(mechanics=ebac.Mechanics(coulomb=1.0))
    assert quantised_ceiling(drier, timing) == pytest.approx(4000)


# --- the search ---


def search(**changes: Any) -> ZWidth:
    given = {"base": None, "delays": (0, 1), "dampings": (0.0, 10.0), "rungs": 9}
    return zwidth(**{**given, "laws": ("direct", "eba"), **changes})


@pytest.fixture(scope="module")
def found() -> ZWidth:
    return search()


def test_direct_reaches_the_limit_of_the_linear_loop(found: ZWidth) -> None:
    still = found.limits["still"][0]
    assert still.shape == found.spectral.shape == (2, 2)
    assert (still < 1.05 * found.spectral).all()
    assert (still > 0.6 * found.spectral).all()


def test_usable_is_the_strictest_criterion_and_quiet_is_stricter_than_still(found: ZWidth) -> None:
    for name in ("quiet", "energy"):
        assert (found.limits["usable"] <= found.limits[name]).all()
    assert (found.limits["quiet"] <= found.limits["still"]).all()


def test_wall_damping_on_encoder_counts_is_felt_however_soft_the_wall(found: ZWidth) -> None:
    assert (found.limits["quiet"][0, :, 1] == 0).all()
    base = ebac.Scenario(seconds=3.0, observer="every-law")
    observed = search(base=base, laws="direct", delays=(1,))
    assert (observed.limits["quiet"][0, 0] > 1e3).all()


@pytest.mark.slow
def test_random_hands_find_the_energy_that_a_press_and_a_tap_do_not() -> None:
    few = {"delays": (1,), "dampings": (0.0, 10.0), "rungs": 4}
    base = ebac.Scenario(seconds=1.0, observer="every-law")
    laws = ("lag-compensator", "eba-account")
    pressed, explored = (search(base=base, laws=laws, hands=n, **few) for n in (0, 2))
    lag, account = 0, 1
    assert (explored.limits["energy"][lag] < 0.5 * pressed.limits["energy"][lag]).all()
    assert (explored.limits["energy"][account] == explored.most_stiffness).all()  # proven passive
    assert (explored.limits["usable"] <= explored.limits["energy"]).all()
    for name in ("still", "quiet"):
        assert (explored.limits[name] == pressed.limits[name]).all()


def test_eba_is_still_on_every_wall_and_shows_few(found: ZWidth) -> None:
    assert (found.limits["still"][1] == found.most_stiffness).all()
    assert (found.limits["usable"][1] < 0.2 * found.most_stiffness).all()


def test_rows_and_scores(found: ZWidth) -> None:
    rows = found.rows()
    assert len(rows) == 2 * 2 * 2
    assert set(rows[0]) == {
        "law",
        "delay_samples",
        "damping_Ns_per_m",
        "passive_N_per_m",
        "delay_ceiling_N_per_m",
        "spectral_N_per_m",
        *(f"{name}_N_per_m" for name in CRITERIA),
        "usable_ended_by",
    }
    direct = found.scores()[0]
    border = found.limits["quiet"][0, 0]
    assert direct["quiet_area"] == pytest.approx(10 * border.mean())
    assert direct["quiet_times_direct"] == 1
    assert direct["usable_share"] == pytest.approx(
        found.limits["usable"][0, 0].mean() / found.most_stiffness
    )


def test_vibration_shows_how_near_a_law_is_to_its_border() -> None:
    """A sensor of 0.05 N at 500 Hz leaves `ebac` hardly any wall: by 4 thresholds instead of 3, not by a cliff."""
    sensor = ebac.ForceSensor(noise=0.05, period=0.002)
    base = ebac.Scenario(device=ebac.Device(sensor=sensor), seconds=3.0)
    few = search(base=base, laws="ebac", delays=(1,), rungs=2)
    assert few.vibration.shape == (1, 1, len(STIFFNESSES), SEEDS)
    rows = few.vibrations()
    assert [row["stiffness_N_per_m"] for row in rows] == list(STIFFNESSES)
    assert all(2.5 < row["perceived_least"] < row["perceived_largest"] < 5 for row in rows)
    alone = base.replace(environment=ebac.Wall(stiffness=10e3), seed=3)
    alone_vibrates = ebac.contact(ebac.simulate(alone, "ebac")).perceived
    assert few.vibration[0, 0, 2, 2] >= alone_vibrates


def test_a_run_that_ends_early_has_no_vibration(found: ZWidth) -> None:
    gone = replace(found, vibration=np.full_like(found.vibration, np.nan))
    assert gone.vibrations()[0]["perceived_largest"] is None
    json.dumps(gone.vibrations(), allow_nan=False)


def test_a_border_says_what_it_ends_by(found: ZWidth) -> None:
    """`direct` shakes, `eba` shows few walls at half of their stiffness."""
    assert found.ended_by("eba", 1)[0] == "too soft"
    assert set(found.ended_by("direct", 0)) <= {"limit cycle", "vibration", "energy"}
    low = search(laws="direct", delays=(0,), dampings=(0.0, 0.1), most_stiffness=300.0)
    assert low.ended_by("direct", 0) == ["top", "top"]
    assert low.share("direct", 0) == 1


@pytest.mark.slow
def test_a_mean_says_where_the_search_ended_and_where_no_wall_was_held(found: ZWidth) -> None:
    note = "A wall damping at which a law holds no wall counts as 0 N/m."
    limits = {name: np.array([[[1e5, 3e4]]]) for name in CRITERIA}
    limits["energy"] = np.array([[[5e4, 3e4]]])
    one = replace(found, laws=("eba",), delays=(1,), limits=limits)
    for shown in (repr(one), one._repr_html_()):
        assert shown.count("65000 or more") == 3
        assert "40000 or more" not in shown
        assert note not in shown
    none = replace(one, limits={**limits, "quiet": np.array([[[0.0, 3e4]]])})
    assert note in repr(none)
    assert note in none._repr_html_()


def test_the_share_of_a_single_damping(found: ZWidth) -> None:
    one = replace(
        found, dampings=found.dampings[:1], limits={n: x[..., :1] for n, x in found.limits.items()}
    )
    assert one.share("direct", 0) == found.limits["usable"][0, 0, 0] / found.most_stiffness
    words = {"still": "limit cycle", "quiet": "vibration", "energy": "energy"}
    for row in found.rows():
        criterion = next(
            (name for name, word in words.items() if word == row["usable_ended_by"]), None
        )
        if criterion is not None:
            assert row[f"{criterion}_N_per_m"] == pytest.approx(row["usable_N_per_m"], rel=1e-9)


def test_the_search_does_not_depend_on_how_it_is_computed(found: ZWidth) -> None:
    with ThreadPoolExecutor(2) as pool:
        elsewhere = search(executor=pool)
    for name, limits in found.limits.items():
        assert (elsewhere.limits[name] == limits).all()


@pytest.mark.parametrize("hands", [0, 1])
def test_progress_comes_to_its_end(hands: int) -> None:
    seen: list[tuple[int, int]] = []
    few = {"laws": "direct", "delays": (1,), "rungs": 3, "hands": hands}
    search(**few, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1][0] == seen[-1][1]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"dampings": (5.0, 0.0)}, r"dampings = \(5.0, 0.0\) N s/m: must be at least two, rising"),
        ({"least_stiffness": 0.0}, "least_stiffness = 0.0 N/m, most_stiffness = 100000.0 N/m"),
        ({"delays": []}, r"zwidth: delays = \[\]: is empty"),
        ({"rungs": 1}, "rungs = 1: must lie in"),
        ({"epsilon": -1.0}, "epsilon = -1.0 J"),
        ({"hands": -1}, r"hands = -1: must lie in \[0, 1000\]"),
        (
            {"base": ebac.Scenario(environment=ebac.Free())},
            "with an ideal rest; here there is no wall: give a wall",
        ),
    ],
)
def test_bad_input_is_refused(changes: dict[str, Any], message: str) -> None:
    base = changes.pop("base", None)
    with pytest.raises(ValueError, match=message):
        zwidth("direct", base=base, **changes)


def test_a_single_delay_is_refused_by_the_name_of_the_argument() -> None:
    with pytest.raises(TypeError, match=r"zwidth: delays = 1 \(int\): must be a sequence"):
        zwidth("direct", delays=1)  # type: ignore[arg-type]


@pytest.mark.slow
def test_the_figure_has_every_law_and_ceiling(found: ZWidth) -> None:
    figure = plot_zwidth(found)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels[:2] == ["direct", "eba"]
    assert len(labels) == 2 + 1 + 1 + 1
    assert "end of the search, 100 kN/m" in labels
    figure.savefig("/dev/null", format="svg")


def test_a_ceiling_stands_in_the_panels_of_its_criterion_only(found: ZWidth) -> None:
    figure = plot_zwidth(found, ["still", "quiet", "energy", "usable"])
    columns, bars = len(found.delays), 1
    own = [labels(ax) for ax in figure.axes[: len(figure.axes) - bars * columns : columns]]
    stable = {"linear loop, no law", "linear loop by formula (Gil et al. 2009), hand on"}
    passive = {"passive without a law"}
    still, quiet, energy, usable = ({*row} & (stable | passive) for row in own)
    assert (still, quiet, energy, usable) == (stable, set(), passive, set())


def labels(ax: Axes) -> list[str]:
    return ax.get_legend_handles_labels()[1]


def test_a_law_that_renders_nothing_says_so_at_its_bar_and_in_the_legend(found: ZWidth) -> None:
    limits = {name: np.array([values[0], 0 * values[1]]) for name, values in found.limits.items()}
    figure = plot_zwidth(replace(found, limits=limits))
    assert "eba (none)" in [text.get_text() for text in figure.legends[0].get_texts()]
    bars = figure.axes[-1]
    [none] = bars.texts
    assert (none.get_text(), none.xy) == ("none", (0, 1))  # type: ignore[attr-defined]


def test_borders_that_coincide_all_remain_visible_and_a_law_without_one_is_named(
    found: ZWidth,
) -> None:
    same = np.full_like(found.limits["quiet"][0], found.most_stiffness)
    three = replace(
        found,
        laws=("direct", "eba", "ebac"),
        limits={name: np.array([same, same, 0 * same]) for name in found.limits},
    )
    panel = plot_zwidth(three).axes[0]
    assert panel.get_title(loc="left") == "no wall: ebac"
    first, second = (np.asarray(line.get_ydata(), float) for line in panel.lines[:2])
    assert np.allclose(1e3 * first, found.most_stiffness)
    assert (second < 0.99 * first).all()
    assert (second > 0.8 * first).all()


def test_a_damping_at_which_a_law_holds_no_wall_has_an_open_mark_at_the_lower_edge(
    found: ZWidth,
) -> None:
    border = np.array([[[0.0, 2e3]], [[0.0, 1e3]], [[0.0, 0.0]]])  # the last one is named above
    three = replace(
        found,
        laws=("direct", "eba", "ebac"),
        delays=(1,),
        spectral=found.spectral[:1],
        limits=dict.fromkeys(CRITERIA, border),
    )
    panel = plot_zwidth(three).axes[0]
    marks = [one for one in panel.lines if one.get_markerfacecolor() == "white"]
    direct, eba, ebac, explained = (np.asarray(one.get_ydata(), float) for one in marks)
    assert direct[0] == panel.get_ylim()[0]
    assert eba[0] > 1.05 * direct[0]  # beside it, not on it
    assert np.isnan([direct[1], eba[1], *ebac]).all()
    assert len(explained) == 0
    assert "no wall at this damping" in labels(panel)
    whole = {name: np.full_like(border, 2e3) for name in CRITERIA}
    assert "no wall at this damping" not in labels(
        plot_zwidth(replace(three, limits=whole)).axes[0]
    )


@pytest.mark.slow
@pytest.mark.parametrize("held", [0.0, 1.0])
def test_one_column_labels_every_decade_and_heads_its_panels_closely(
    held: float, found: ZWidth
) -> None:
    limits = {
        name: np.array([values[0], held * values[1]]) for name, values in found.limits.items()
    }
    long = replace(found, laws=("direct", "a law with quite a long name"), limits=limits)
    figure = plot_zwidth(long).narrow()  # type: ignore[misc]
    with fitted(figure, 89 / 25.4):
        figure.draw_without_rendering()
        panel = figure.axes[0]
        low, high = panel.get_ylim()
        labels = panel.get_yticklabels()
        shown = [text.get_text() for text in labels if low <= text.get_position()[1] <= high]
        assert shown == ["0.1", "1", "10", "100"]
        (heading,) = panel.texts
        assert heading.get_text() == "usable"
        above = panel._left_title if held == 0 else panel.patch  # type: ignore[attr-defined]
        gap = heading.get_window_extent().y0 - above.get_window_extent().y1
        assert 0 <= gap < 12 / 72 * figure.dpi


def test_every_searched_damping_has_a_mark_and_no_two_laws_the_same(found: ZWidth) -> None:
    for figure in (plot_zwidth(found), plot_zwidth(found).narrow()):  # type: ignore[misc]
        marks = [line.get_marker() for line in figure.axes[0].lines[:2]]
        assert len(set(marks) - {"None"}) == 2
    assert len(set(MARKS)) >= len(ebac.LAWS)


def test_the_panels_are_those_of_the_criteria_asked_for(found: ZWidth) -> None:
    shown = [ax.get_ylabel() for ax in plot_zwidth(found, ["quiet"]).axes if ax.get_ylabel()]
    assert shown == ["quiet\nup to K [kN/m]"]
    for wrong in ([], ["loud"]):
        with pytest.raises(ValueError, match="must be some of usable, energy, quiet, still"):
            plot_zwidth(found, wrong)


@pytest.mark.slow
def test_thirteen_laws_fit_a_page_in_one_column(found: ZWidth, tmp_path: Path) -> None:
    laws = len(ebac.LAWS)
    many = replace(
        found,
        laws=tuple(ebac.LAWS),
        limits={name: np.repeat(values[:1], laws, 0) for name, values in found.limits.items()},
    )
    file = save(plot_zwidth(many), tmp_path / "zwidth.png", width="single")
    assert imread(file).shape[0] < 230 / 25.4 * 300  # the height of a page's text


# --- ebac zwidth ---


def command(*words: str, code: int = 0) -> str:
    result = CliRunner().invoke(app, ["zwidth", *words])
    assert result.exit_code == code, result.output
    return result.output if code else result.stdout


SMALL = ("--law", "direct", "--delay", "1", "--points", "2", "--seconds", "1")


def test_the_command_says_rows_and_scores() -> None:
    told = json.loads(command(*SMALL, "--json"))
    assert [row["damping_Ns_per_m"] for row in told["rows"]] == [0, 20]
    assert told["scores"][0]["quiet_times_direct"] == 1
    assert told["hands"] == 0
    assert [row["stiffness_N_per_m"] for row in told["vibration"]] == list(STIFFNESSES)


@pytest.mark.slow
def test_the_command_writes_a_folder(tmp_path: Path) -> None:
    text = command(*SMALL, "--out", str(tmp_path / "out"))
    assert "stiffness times damping, in kN/m N s/m. Delay in samples." in " ".join(text.split())
    assert "linear loop, no law" in text
    assert "the stiffest usable wall with a damping of 0 N s/m" in " ".join(text.split())
    assert re.search(r"direct +\d+ % +[\d.]+ kN/m ", text)
    assert "a wall at 0 mm" in text
    assert "sample of delay" not in text
    assert "of the seeds 1 to 5, of a press or a tap" in " ".join(text.split())
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {
        "zwidth.png",
        "zwidth-still.png",
        "zwidth.json",
        "zwidth.csv",
        "scores.csv",
        "vibration.csv",
        "scenario.toml",
    }


def test_a_law_without_any_wall_has_a_reason() -> None:
    """It stood above a vibration of 0 at stiffer walls, without a word."""
    words = ("--law", "direct", "--delay", "8", "--points", "2", "--seconds", "1")
    text = " ".join(command(*words, "--least-stiffness", "5000", "--no-files").split())
    assert re.search(
        r"direct, delay 8: none, since 5 kN/m already fails: [a-z ]+.*\. Walls count up to the first that fails",
        text,
    )
    assert "already fails" not in command(*SMALL, "--no-files")


def test_words_for_the_end_of_a_wall_are_explained() -> None:
    words = ("--law", "direct,ebac", "--delay", "0", "--points", "2", "--seconds", "1")
    text = " ".join(command(*words, "--no-files").split())
    assert "top: the search ends at 100 kN/m before any wall is lost" in text
    assert "100 kN/m or more" in text


@pytest.mark.parametrize(("given", "seconds"), [("", 3), ("seconds = 1.0\n", 1)])
def test_a_device_file_without_a_length_has_that_of_the_command(
    given: str, seconds: float, tmp_path: Path
) -> None:
    file, out = tmp_path / "device.toml", tmp_path / "out"
    file.write_text(f"{given}[device.mechanics]\nhandle_mass = 0.1\n", encoding="utf-8")
    words = ("--law", "direct", "--delay", "1", "--points", "2", "--out", str(out))
    command("--scenario", str(file), *words)
    assert ebac.Scenario.load(out / "scenario.toml").seconds == seconds


def test_a_top_below_the_least_is_named() -> None:
    text = " ".join(command("--most-stiffness", "50", code=2).split())
    assert "--most-stiffness = 50 N/m: must lie above --least-stiffness = 100 N/m" in text


@pytest.mark.slow
def test_random_hands_are_named_where_the_result_is_shown(tmp_path: Path) -> None:
    text = command(*SMALL, "--hands", "1", "--out", str(tmp_path))
    assert "hold for 7 random hands as well; one that pulls harder than 20 N" in " ".join(
        text.split()
    )
    figure = plot_zwidth(search(laws="direct", delays=(1,), rungs=3, hands=1))
    assert "at most 1 mJ drawn (7 random hands included)" in figure.get_suptitle()


def test_the_command_puts_other_parameters_of_a_law_beside_it() -> None:
    small = ("--law", "ebac", "--delay", "2", "--points", "2", "--seconds", "1", "--json")
    told = json.loads(command(*small, "--change", "guard=off", "--change", "kp=0,pull=40"))
    assert [one["law"] for one in told["scores"]] == [
        "ebac",
        "ebac, guard=off",
        "ebac, kp=0,pull=40",
    ]
    assert "--change kp=0: changes one law, not 2; give one --law, as --law ebac" in command(
        "--law", "ebac,eba", "--change", "kp=0", code=2
    )


def test_the_command_refuses() -> None:
    assert "did you mean 'direct'" in " ".join(command("--law", "dirct", code=2).split())
    assert "--least-stiffness = -1 N/m: must lie in (0, 100000) N/m" in command(
        "--least-stiffness", "-1", code=2
    )
    assert "--most-stiffness = -1 N/m" in command("--most-stiffness", "-1", code=2)
