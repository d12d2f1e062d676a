"""Stability maps: a grid of scenarios, its score, its figure."""

import itertools
import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.plot import plot_map
from ebac.plot.save import fitted
from ebac.studies.maps import AXES, PRESETS, StabilityMap, stability_map
from ebac.studies.zwidth import stiffness_limit

BASE = ebac.Scenario(seconds=1.0)
MOVING = ebac.Wall(motion_amplitude=2e-3, motion_frequency=2.0)


class Spring(ebac.hands.OwnHand):
    mass, damping, stiffness = 0.15, 6.0, 300.0

    def force(self, t: float, x: float, v: float) -> float:
        return self.stiffness * (0.04 - x) - self.damping * v


def small(law: str = "direct", **changes: Any) -> StabilityMap:
    given = {"x": "damping", "y": "stiffness", "base": BASE}
    given |= {"xs": (0.0, 5.0, 10.0), "ys": (1e3, 2e3, 2e4, 5e4)}
    return stability_map(law, **{**given, **changes})


def assert_same_bits(a: StabilityMap, b: StabilityMap) -> None:
    assert list(a.result) == list(b.result)
    for name in a.result:
        assert a[name].tobytes() == b[name].tobytes(), name


def test_direct_is_quiet_below_the_limit_and_swings_above() -> None:
    found = small()
    limits = np.array([stiffness_limit(BASE, b) for b in found.xs])
    below = found.ys[:, None] < limits
    assert (found["still"] == below).all()
    assert (found.verdict[below] <= 1).all()
    assert (found.verdict[~below] >= 3).all()
    assert found.scores()["quiet_share"] == found.quiet.mean()


def test_a_cell_is_the_run_it_stands_for() -> None:
    found = small("ebac")
    wall = ebac.Wall(stiffness=2e4, damping=5.0)
    expected = ebac.contact(ebac.simulate(BASE.replace(environment=wall), "ebac"))
    assert found["swing_m"][2, 1] == expected.swing_m
    assert found["least_energy_J"][2, 1] == expected.least_energy_J


@pytest.mark.parametrize("name", AXES)
def test_every_quantity_changes_the_scenario(name: str) -> None:
    axis = AXES[name]
    low, high = axis.values(2)
    assert axis.apply(BASE, low) != axis.apply(BASE, high)
    assert axis.unit in axis.label


def test_the_mass_of_the_device_is_that_at_the_handle_rotor_included() -> None:
    for mass in AXES["device-mass"].values(3):
        assert AXES["device-mass"].apply(BASE, mass).device.mass == pytest.approx(mass)


def test_a_law_is_designed_anew_where_the_device_changes() -> None:
    found = stability_map(
        "ebac", "device-damping", "delay", xs=(1.0, 4.0), ys=(0, 2), base=BASE.replace(seconds=0.5)
    )
    device = ebac.Device(mechanics=BASE.device.mechanics.replace(damping=4.0))
    alone = ebac.simulate(
        BASE.replace(seconds=0.5, device=device, timing=ebac.Timing(delay=2)), "ebac"
    )
    assert found["rest_m"][1, 1] == ebac.contact(alone).rest_m


def test_whole_numbers_come_once_each() -> None:
    assert AXES["delay"].values(200).tolist() == list(range(9))


def test_the_map_does_not_depend_on_where_it_is_computed(tmp_path: Path) -> None:
    here = small("ebac")
    with ThreadPoolExecutor(2) as pool:
        there = small("ebac", executor=pool, out=tmp_path / "kept")
        again = small("ebac", executor=pool, out=tmp_path / "kept")
    for name in here.result:
        assert np.array_equal(here[name], there[name], equal_nan=name != "law")
        assert np.array_equal(here[name], again[name], equal_nan=name != "law")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.slow
@pytest.mark.weekly
def test_a_map_through_dask_has_the_same_bits() -> None:
    distributed = pytest.importorskip("distributed")
    here = small("ebac")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, distributed.Client(cluster) as client:
        there = small("ebac", executor=client.get_executor())
        workers = set(client.run(os.getpid).values())
    assert len(workers - {os.getpid()}) == 2
    assert_same_bits(there, here)


KILLED = """
import sys, ebac
from ebac.studies.maps import stability_map
stability_map(
    "ebac", xs=range(40), ys=[1e3 * k for k in range(1, 41)],
    base=ebac.Scenario(seconds=2.0), threads=1, out=sys.argv[1],
)
"""


@pytest.mark.slow
@pytest.mark.weekly
def test_a_map_that_was_killed_half_way_continues_and_has_the_same_bits(tmp_path: Path) -> None:
    out = tmp_path / "kept"
    worker = subprocess.Popen([sys.executable, "-c", KILLED, str(out)])
    while not list(out.glob("bundle-*")) and worker.poll() is None:
        time.sleep(0.002)
    worker.send_signal(signal.SIGKILL)
    assert worker.wait() == -signal.SIGKILL
    stamps = {file: file.stat().st_mtime_ns for file in out.glob("bundle-*")}
    assert 0 < len(stamps) < 4
    xs, ys, base = range(40), [1e3 * k for k in range(1, 41)], BASE.replace(seconds=2.0)
    resumed = stability_map("ebac", xs=xs, ys=ys, base=base, out=out)
    assert {file: file.stat().st_mtime_ns for file in stamps} == stamps
    assert len(list(out.glob("bundle-*"))) == 4
    assert_same_bits(resumed, stability_map("ebac", xs=xs, ys=ys, base=base))


def test_a_printed_map_has_its_symbols_in_plain_text() -> None:
    found = small(x="hand-stiffness", xs=(100.0, 300.0))
    assert "stiffness of the hand K0 [N/m] 100 to 300, wall stiffness K [N/m]" in repr(found)
    assert "$" not in repr(found)


def test_the_arrays_of_a_map_are_kept(tmp_path: Path) -> None:
    found = small()
    found.to_npz(tmp_path / "map.npz")
    with np.load(tmp_path / "map.npz") as kept:
        assert (kept["swing_m"] == found["swing_m"]).all()
        assert (kept["stiffness"] == found.ys).all()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"x": "stifness"}, "did you mean 'stiffness'"),
        ({"x": "stiffness"}, "a map needs two quantities"),
        ({"base": ebac.Scenario(environment=ebac.Free())}, "needs a wall"),
        ({"xs": [5, 2, 9]}, r"xs = \[5, 2, 9\] N s/m: must be at least two, rising"),
        ({"ys": [1e3]}, r"ys = \[1000.0\] N/m: must be at least two, rising"),
        ({"ys": [0, 1e3]}, r"ys = \[0, 1000.0\] N/m: must be above 0"),
        ({"xs": []}, r"xs = \[\]: is empty"),
    ],
)
def test_bad_input_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        small(**changes)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"xs": 0}, r"xs = 0 \(int\): must be a sequence, such as \[0\]"),
        ({"x": "delay", "xs": [0.5, 1.5]}, "delay = 0.5: must be a whole number in samples"),
    ],
)
def test_values_of_a_wrong_kind_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(TypeError, match=message):
        small(**changes)


def test_a_logarithmic_axis_starts_above_zero() -> None:
    with pytest.raises(ValueError, match="wall stiffness: 5 values from 0 to 10 N/m"):
        AXES["stiffness"].values(5, 0, 10)


@pytest.mark.parametrize("kind", PRESETS)
@pytest.mark.slow
def test_the_figure_has_four_panels(kind: str, tmp_path: Path) -> None:
    x, y = PRESETS[kind]
    xs, ys = AXES[x].values(6), AXES[y].values(6)
    figure = plot_map(stability_map("direct", x, y, xs=xs, ys=ys, base=BASE))
    panels = [ax for ax in figure.axes if ax.get_title()]
    assert len(panels) == 4
    assert "[" in panels[2].get_xlabel()
    figure.set_layout_engine("none")  # which test_figures.py does
    figure.savefig(tmp_path / "map.png", dpi=40)


@pytest.mark.slow
def test_the_figure_names_a_line_only_where_there_is_one_and_has_walls_in_kilonewtons() -> None:
    limits = set()
    for law in ("direct", "ebac"):
        figure = plot_map(small(law))
        for ax in figure.axes[1:4]:
            assert ("limit (line)" in ax.get_title()) == any(
                len(one.get_paths()[0].vertices) for one in ax.collections[1:]
            )
            limits.add("limit (line)" in ax.get_title())
    assert limits == {True, False}
    figure.draw_without_rendering()
    verdicts = figure.axes[2]
    assert verdicts.get_ylabel() == "wall stiffness K [kN/m]"
    assert "10" in [tick.get_text() for tick in verdicts.get_yticklabels()]


@pytest.mark.parametrize(
    ("base", "why"),
    [
        (
            BASE.replace(environment=MOVING),
            "the wall moves",
        ),
        (
            BASE.replace(hand=ebac.Hand(path=ebac.Sine(amplitude=0.01, frequency=1.0))),
            "the target of the hand keeps moving",
        ),
        (BASE.replace(hand=Spring()), "the hand is your own: where it rests is not known"),
    ],
)
def test_a_map_without_an_ideal_rest_is_not_judged_exact(base: ebac.Scenario, why: str) -> None:
    found = small(base=base)
    assert found.unjudged == why
    assert found.scores()["exact_share"] is None
    assert "exact not judged, energy" in repr(found)
    assert repr(found).endswith(f"; no ideal rest: {why}>")
    assert len(found.verdicts) == 4
    assert found.verdict.max() < 4
    figure = plot_map(found)
    assert f"not judged exact, there is no ideal rest: {why}" in figure.get_suptitle()
    assert not any("ideal [mm]" in ax.get_title() for ax in figure.axes)
    assert [ax.get_xlabel() for ax in figure.axes[1:3]] == ["wall damping B [N s/m]"] * 2
    assert small().unjudged == ""


@pytest.mark.slow
@pytest.mark.parametrize("ys", [(2e3, 4e3, 8e3), (1e3, 1e4, 1e5)])
def test_every_label_of_a_wall_is_in_kilonewtons(ys: tuple[float, ...]) -> None:
    figure = plot_map(small(ys=ys))
    figure.draw_without_rendering()
    axis = figure.axes[0].yaxis
    assert all(not text.get_text() for text in axis.get_minorticklabels())
    low, high = axis.get_view_interval()
    labels = zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=True)
    shown = [(place, text.get_text()) for place, text in labels if low <= place <= high]
    assert len(shown) >= 2
    assert all(float(text) == pytest.approx(1e-3 * place) for place, text in shown)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["hand-mass", "hand-stiffness"])
def test_labels_of_a_logarithmic_axis_do_not_overlap_in_one_column(name: str) -> None:
    figure = plot_map(small(x=name, xs=AXES[name].values(9)))
    with fitted(figure, 89 / 25.4):
        figure.draw_without_rendering()
        axis = figure.axes[2].xaxis
        low, high = axis.get_view_interval()
        labels = zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=True)
        boxes = [text.get_window_extent() for place, text in labels if low <= place <= high]
    assert len(boxes) >= 2
    assert all(one.x1 < other.x0 for one, other in itertools.pairwise(boxes))


# --- ebac map ---


def command(*words: str, code: int = 0) -> str:
    result = CliRunner().invoke(app, ["map", *words])
    assert result.exit_code == code, result.output
    return result.output if code else result.stdout


def test_the_command_prints_a_row_per_law() -> None:
    told = json.loads(command("Kd", "-l", "direct", "-l", "eba", "--side", "4", "--json"))
    assert [row["law"] for row in told["rows"]] == ["direct", "eba"]
    assert told["rows"][0]["x"] == "delay"
    assert told["rows"][0]["runs"] == 4 * 4
    assert 0 <= told["rows"][0]["quiet_share"] <= 1


def test_the_command_says_why_a_map_is_not_judged_exact(tmp_path: Path) -> None:
    BASE.replace(environment=MOVING).save(tmp_path / "moving.toml")
    given = ("--side", "2", "--scenario", str(tmp_path / "moving.toml"))
    text = command(*given)
    assert "Not judged exact, there is no ideal rest: the wall moves." in text
    assert json.loads(command(*given, "--json"))["rows"][0]["exact_share"] is None


@pytest.mark.slow
def test_the_command_writes_a_folder_and_continues(tmp_path: Path) -> None:
    out = str(tmp_path / "out")
    text = command("hand-mass,damping", "--side", "3", "--y-high", "5", "--out", out)
    assert "B 0 to 5 N s/m (3 values)" in " ".join(text.split())
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"map-ebac.png", "map-ebac.npz", "map.json", "scenario.toml", "sweep-ebac"}
    again = ("hand-mass,damping", "--side", "3", "--y-high", "5", "--out", out, "--resume")
    assert command(*again) == text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("KX",), "there are: KB, Kd, MB, X,Y"),
        (("stiffness",), "a map needs two quantities"),
        (("stiffness,massive",), "there are: stiffness, damping"),
        (("--x-low", "30"), "from 30 to 20 N s/m"),
        (("Kd", "--x-high", "2.5"), "--x-high = 2.5 samples (delay): must be a whole number"),
        (("--resume", "--json"), "give it with --out"),
    ],
)
def test_the_command_refuses(words: tuple[str, ...], message: str) -> None:
    assert message in " ".join(command(*words, code=2).split())
