"""Results as a console shows them: under 20 lines, with units; verdicts of runs that cannot be judged."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac
from ebac import faults, paper
from ebac._util import formatting, verdicts
from ebac._util.report import cell, report
from ebac.operators import Operators
from ebac.studies import ablation, stiffest, study, worst
from ebac.studies.maps import stability_map
from ebac.studies.measures import MEASURES
from ebac.studies.zwidth import zwidth
from ebac.tracking import RecordedPath, error_budget, evaluate
from ebac.worlds import Body, Placed, Sphere, World
from ebac.worlds.triangles import GridError

Run = Callable[..., ebac.Trace]
SHORT = ebac.Scenario(seconds=1.0)
FEW = Operators.sample(3, seed=1)


def results() -> dict[str, Callable[[], Any]]:
    """Return what makes each result, and the unit its text must show."""
    budget = lambda: error_budget(runs=2)  # noqa: E731
    return {
        "trace [s]": lambda: ebac.simulate(SHORT, "ebac").head(),
        "summary mm": lambda: ebac.simulate(SHORT, "ebac").summary(),
        "contact mm": lambda: ebac.contact(ebac.simulate(SHORT, "ebac")),
        "study [mJ]": lambda: study(FEW, ["tca", "ebac"], ["d1K10"]),
        "ablation hands": lambda: ablation(FEW),
        "stiffest [N/m]": lambda: stiffest(
            ["tca", "ebac"], population=FEW, stiffnesses=[1e3], base=SHORT
        ),
        "worst [mJ]": lambda: worst("ebac", family=["impact"], evaluations=40),
        "sweep [mm]": lambda: ebac.sweep([SHORT] * 40, ["tca", "ebac"]),
        "map [N/m]": lambda: stability_map("ebac", base=SHORT, xs=[0, 5], ys=[1e3, 1e4]),
        "zwidth [N/m]": lambda: zwidth(
            ["tca", "ebac"], base=SHORT, delays=[1], dampings=[0.0, 5.0]
        ),
        "campaign ticks": lambda: faults.run_campaign(40),
        "budget [mm]": budget,
        "tracking mm": lambda: evaluate(
            RecordedPath(points=budget().examples["line"], name="x", remark="simulated")
        ),
        "finding 1/s": lambda: paper.find("eq4"),
    }


def test_a_vibration_that_is_none_is_printed_as_0() -> None:
    assert formatting.quantity(1.8e-12, "threshold") == "0"
    assert formatting.quantity(19.816, "threshold") == "19.82"
    assert verdicts.force_verdict(True, 0.1, 0, 1.8e-12).endswith("vibration 0 thresholds")


def test_a_contact_with_bodies_and_the_error_of_a_grid_have_units_and_few_digits() -> None:
    ball = Placed(Sphere(), at=(0.03, 0.002, 0.0))
    plane = ebac.Device(kinematics=ebac.Linear(axes=2))
    pressed = SHORT.replace(device=plane, environment=World(Body(solid=ball)))
    trace = ebac.simulate(pressed, "ebac")
    met = ebac.metrics.world_contact(trace)
    assert repr(met) == str(met)
    far = World(Body(solid=Placed(Sphere(), at=(0.3, 0.0, 0.0))))
    missed = ebac.metrics.world_contact(
        ebac.simulate(SHORT.replace(environment=far, device=plane), "ebac")
    )
    assert "  deepest             -\n  depth               -\n" in repr(missed)
    assert f"  deepest             {formatting.quantity(met.deepest_m, 'm')}\n" in repr(met)
    assert re.search(r"\n  normal error        [\d.]+ deg\n  friction share      -\n", repr(met))
    error = GridError(
        cell_m=1 / 1e4, samples=100, depth_rms_m=1e-5 / 3, depth_max_m=1e-4 / 3,
        normal_median_deg=1 / 7, normal_p99_deg=10 / 3,
    )  # fmt: skip
    assert "triangles at 100 points" in repr(error)
    assert re.search(r"\n  normal, 99 %        [\d.]+ deg$", repr(error))
    assert "\n  depth, rms          0.0033 mm\n" in repr(error)
    for text in (repr(met), repr(error)):
        assert not re.search(r"\d\.\d{6}", text)


@pytest.mark.parametrize("name", list(results()))
@pytest.mark.slow
def test_every_result_is_read_in_under_20_lines(name: str) -> None:
    what, unit = name.split()
    shown = repr(results()[name]())
    lines = shown.splitlines()
    assert len(lines) < 20
    assert max(map(len, lines)) < 240
    if what not in ("finding",):
        assert unit in shown


def test_a_printed_sweep_shows_its_results_whatever_was_swept() -> None:
    scenarios = [
        SHORT.replace(environment=ebac.Wall(stiffness=k, damping=b), hand=ebac.Hand(mass=m))
        for k in (5e3, 1e4)
        for b in (0, 5)
        for m in (0.1, 0.3)
    ]
    shown = repr(ebac.sweep(scenarios, ["tca", "ebac"]))
    for heading in (
        "hand.mass [kg]", "environment.stiffness [N/m]", "environment.damping [N s/m]", "rest [mm]", "ideal [mm]",
        "swing [mm]", "settled [s]", "least energy [mJ]",
    ):  # fmt: skip
        assert shown.count(heading) == 1, heading
    assert "more column" not in shown
    assert shown.count("  law ") == 2  # which row it is stands in both tables
    assert len(shown.splitlines()) < 20


def test_a_printed_contact_has_every_number_with_its_unit(run: Run) -> None:
    text = str(ebac.contact(run("ebac")))
    assert text.splitlines()[0] == "Contact of ebac: exact and quiet"
    assert text.splitlines()[1].startswith("  force quiet: settled 0.028 s, no jump, ")
    for label, unit in (
        ("rest", "mm"),
        ("force swing", "N"),
        ("force settled", "s"),
        ("ripple", "N"),
        ("settled", "s"),
        ("least energy", "mJ"),
    ):
        (line,) = [one for one in text.splitlines() if one.startswith(f"  {label} ")]
        assert line.endswith(f" {unit}")


def test_a_printed_contact_says_that_the_motor_was_saturated(run: Run) -> None:
    class Wild:
        def step(self, port: ebac.Port) -> float:
            return 1e6 if port.x > 0 else 0.0

        def reset(self) -> None:
            pass

    wild = ebac.contact(ebac.simulate(ebac.Scenario(seconds=0.5), Wild()))
    assert wild.saturated_share is not None
    assert 0 < wild.saturated_share < 1
    assert f"motor saturated     {100 * wild.saturated_share:.0f} %" in str(wild)
    fine = ebac.contact(run("ebac"))
    assert fine.saturated_share == 0
    assert "motor saturated" not in str(fine)


def test_head_names_what_is_asked_for(run: Run) -> None:
    lines = run("eba").head(3, "t", "x").splitlines()
    assert len(lines) == 1 + 1 + 3
    assert lines[1].split() == ["t", "[s]", "x", "[mm]"]
    with pytest.raises(KeyError, match="no column is called 'y'"):
        run("eba").head(3, "y")


def test_head_and_summary_of_nothing(run: Run) -> None:
    nothing = run("eba").rows(0, 0)
    assert "0 rows" in nothing.head()
    assert "0 rows" in nothing.summary()


def test_a_part_outside_the_run_names_its_span(run: Run) -> None:
    with pytest.raises(ValueError, match=r"trace\[10:20\]: outside the run, which spans 0 to 6 s"):
        run("eba")[10:20]
    with pytest.raises(ValueError, match=r"trace\[:-1\]: outside"):
        run("eba")[:-1]


@pytest.mark.parametrize("kind", ["npz", "csv", "mcap"])
def test_a_folder_that_does_not_exist_is_named_as_asked(
    kind: str, run: Run, tmp_path: Path
) -> None:
    path = tmp_path / "no" / f"x.{kind}"
    with pytest.raises(FileNotFoundError) as caught:
        run("eba", seconds=1.0).save(path)
    assert caught.value.filename == str(path)
    assert "draft" not in str(caught.value)


@pytest.mark.parametrize(
    ("away", "text"),
    [(5.634e-3, "5.63 mm"), (0.9994, "999 mm"), (0.9996, "1000 mm"), (3.738, "3738 mm")],
)
def test_a_deviation_in_words_has_no_exponent(away: float, text: str, run: Run) -> None:
    contact = replace(ebac.contact(run("ebac")), rest_m=away, ideal_m=0.0)
    assert contact.verdict == f"quiet, too deep by {text}"


def test_a_short_run_is_not_judged(run: Run) -> None:
    assert ebac.contact(run("tca", seconds=0.01)).verdict == "too short to judge"
    assert ebac.contact(run("tca")).verdict == "swings"


def test_a_run_in_free_air_has_no_contact(run: Run) -> None:
    free = ebac.contact(run("ebac", environment=ebac.Free(), seconds=1.0))
    assert free.verdict == "no contact"
    assert "  rest                -\n  ideal rest          -\n" in str(free)
    assert "; rest -, swing" in repr(free)
    assert (
        ebac.contact(run("ebac", environment=ebac.Wall(position=1.0), seconds=1.0)).touched is False
    )


def test_a_handle_that_left_the_surface_has_no_rest_to_judge(run: Run) -> None:
    pressed = ebac.contact(run("ebac", seconds=2.0))
    assert pressed.touched_at_rest is True
    hand = ebac.Hand(release_at=1.0)  # s; the wall pushes the handle out
    left = ebac.contact(run("ebac", hand=hand, seconds=3.0))
    assert (left.touched, left.touched_at_rest) == (True, False)
    assert left.verdict == "left the surface: no contact at rest"
    shaking = ebac.contact(run("tca"))
    assert (shaking.touched_at_rest, shaking.verdict) == (True, "swings")
    assert pressed.row()["touched_at_rest"] is True


@given(st.floats(1e-12, 4e-8))
def test_lengths_far_below_a_count_read_as_zero(metres: float) -> None:
    assert formatting.quantity(metres, "m") == "0 mm"


@given(st.floats(1e-6, 1e3), st.sampled_from(["m", "J"]))
def test_rounding_keeps_three_digits_or_a_tenth_of_a_micro(value: float, unit: str) -> None:
    number, shown = formatting.quantity(value, unit).split()
    assert float(number) / (1 if shown == "J" else 1e3) == pytest.approx(
        value, rel=6e-3, abs=6e-8 if unit == "m" else 6e-7
    )


@given(st.sampled_from(MEASURES), st.floats(0, 10), st.floats(-1e-9, 1e-9))
def test_numbers_that_read_the_same_are_the_same(measure: Any, value: float, little: float) -> None:
    one, other = value, value + little
    if formatting.cell(one, measure.unit) == formatting.cell(other, measure.unit):
        assert measure.gain(one, other, 60) == 0


def test_zero_newton_is_no_better_than_zero_newton() -> None:
    ripple = next(m for m in MEASURES if m.key == "force_swing_N")
    assert ripple.gain(0.0, 3e-16, 60) == 0
    assert ripple.gain(1e-13, 0.0, 60) == 0
    assert ripple.gain(0.0, 1.0, 60) == 1


def test_a_sweep_carries_what_was_swept() -> None:
    pytest.importorskip("pandas")
    stiff = [1e3, 5e3, 1e4]
    scenarios = [SHORT.replace(environment=ebac.Wall(stiffness=k)) for k in stiff]
    result = ebac.sweep(scenarios, ["tca", "ebac"])
    assert result.swept == ("environment.stiffness_N_per_m",)
    assert result["environment.stiffness_N_per_m"].tolist() == stiff * 2
    assert "environment.stiffness_N_per_m" in result.rows()[0]
    frame = result.to_pandas()
    assert frame["environment.stiffness_N_per_m"].tolist() == stiff * 2


def test_a_sweep_over_hands_worlds_and_timing() -> None:
    hand = SHORT.hand
    scenarios = [
        SHORT,
        SHORT.replace(hand=hand.replace(path=ebac.Step(target=0.02)), environment=ebac.Free()),
        SHORT.replace(timing=SHORT.timing.replace(delay=2)),
    ]
    result = ebac.sweep(scenarios, ["direct"])
    assert result["environment"].tolist() == ["Wall", "Free", "Wall"]
    assert np.isnan(result["environment.stiffness_N_per_m"][1])
    assert result["hand.path.target_m"].tolist() == [0.04, 0.02, 0.04]
    assert result["timing.delay_samples"].tolist() == [1, 1, 2]


def test_a_sweep_of_equal_scenarios_has_no_swept_columns() -> None:
    assert ebac.sweep([SHORT, SHORT], ["direct"]).swept == ()


@given(
    st.lists(
        st.fixed_dictionaries({"rest_m": st.floats(-1, 1), "law": st.text(max_size=9)}), max_size=60
    )
)
def test_a_report_is_never_longer_than_20_lines(rows: list[dict[str, Any]]) -> None:
    plain = [{**row, "law": "".join(c for c in row["law"] if c.isprintable())} for row in rows]
    assert len(report("title", plain, "note").splitlines()) < 20


def test_arrays_and_texts_are_no_part_of_a_repr(tmp_path: Path) -> None:
    path = ebac.tracking.read_path(ebac.datasets.write("circle", tmp_path))
    log = ebac.logs.read(ebac.datasets.write("tapping", tmp_path))
    recording = ebac.identify.Recording.from_trace(ebac.datasets.press())
    loop = ebac.identify.fit_loop(recording, ebac.identify.Target.steps(1.0))
    late = ebac.realtime.Jitter(lateness=np.full(1000, 2e-5), dt=1e-3, skipped=0, grants=[])
    runs = [ebac.simulate(SHORT.replace(seed=seed), "ebac") for seed in (1, 2)]
    for thing, shown in [
        (path, "400 points"),
        (ebac.tracking.fit_circle(path.points), "radius 40 mm"),
        (ebac.tracking.fit_line(ebac.datasets.line()), "length 80.18 mm"),
        (ebac.identify.frequency_response(recording), " Hz"),
        (loop, "Wall(stiffness="),
        (log, "10001 rows"),
        (log.about, "ebac, 1 axis"),
        (ebac.datasets.joystick(), "socketcan"),
        (late, "late by 20 us (median)"),
        (ebac.testing.compare(*runs), "channels differ"),
        (ebac.spec_sheet(ebac.Device()), "<Spec resolution: "),
    ]:
        text = repr(thing)
        assert shown in text
        assert text.count("\n") < 20
        assert len(text) < 1500


def test_a_spec_sheet_prints_as_a_table() -> None:
    sheet = ebac.spec_sheet(ebac.Device())
    lines = str(sheet).splitlines()
    assert len(lines) == len(sheet)
    assert lines[1].split("  ")[0] == "continuous force"
    assert lines[1].endswith(" N  rated torque through capstan and lever")
    assert "<Spec" not in str(sheet)
    assert "<td" in sheet._repr_html_()  # type: ignore[attr-defined]


def test_the_report_of_a_run_prints_in_words() -> None:
    grants = [
        ebac.realtime.Grant(name="memory", asked="all pages locked", granted=True, why="", remedy=""),
        ebac.realtime.Grant(
            name="priority", asked="SCHED_FIFO 80", granted=False, why="Operation not permitted", remedy="ulimit -r 80"
        ),
    ]  # fmt: skip
    trace = ebac.simulate(SHORT, "ebac")
    report = replace(
        ebac.hardware.Report.of_virtual(trace, None, fault=False), grants=tuple(grants), drives=("ready",)
    )  # fmt: skip
    text = str(report)
    assert text.startswith(f"Run of {len(trace):,} ticks, ended by time\n  log       none\n")
    assert "  grant     memory: all pages locked, granted\n" in text
    assert "priority: SCHED_FIFO 80, not granted (Operation not permitted); ulimit -r 80" in text
    assert "object at 0x" not in text + repr(report) + repr(grants)
    assert (
        repr(grants[1]) == "<Grant priority: SCHED_FIFO 80, not granted: Operation not permitted>"
    )
    assert repr(report).endswith("ended by time; no log; not granted: priority>")


def test_what_is_one_is_told_in_the_singular() -> None:
    handle = ebac.hardware.Configuration.from_toml(
        ebac.datasets.joystick_text("handle"), name="handle.toml"
    )
    assert ", node 1; " in repr(handle)
    with pytest.raises(ValueError, match=r"1 or -1 for the one axis, such as \[-1\]"):
        ebac.hardware.Configuration.from_toml(f"{handle.text}\n[signs]\nmotor = [1, 1]\n")
    two = handle.text.replace('drives = "handle"', 'drives = "joystick"', 1)
    with pytest.raises(ValueError, match="has 2 drives, the device 1 axis: must be as many"):
        ebac.hardware.Configuration.from_toml(two)
    assert repr(ebac.simulate(SHORT, "ebac")).endswith(", 1 axis>")


def test_numbers_and_flags_of_numpy_read_like_those_of_python() -> None:
    assert [cell("good", np.bool_(True)), cell("x_m", np.float64(0.5))] == ["True", "500.000"]


@pytest.mark.parametrize(("value", "text"), [(9999.4, "9999"), (9999.6, "10000"), (12345, "12345")])
def test_a_number_of_five_digits_is_written_out(value: float, text: str) -> None:
    assert formatting.quantity(value, "N/m") == f"{text} N/m"
