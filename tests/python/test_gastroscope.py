"""The gastroscope, the patient and the physician, and `ebac gastroscopy`."""

from __future__ import annotations

import _thread
import json
import pickle
import threading
import time
from dataclasses import replace
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from ebac import TCADamped, Trace, gastroscope, logs
from ebac.cli import app
from ebac.gastroscope import Lumen, Master, Patient, Procedure, Scope, Slave, camera
from ebac.live.gastroscopy_session import GastroscopySession
from ebac.plot import plot_gastroscopy, plot_gastroscopy_study
from ebac.worlds import Cavity, Tube

bends = st.floats(-2.5, 2.5)
STILL = Patient(breathing=0, peristalsis=0, antral_depth=0)


@given(bends, bends)
def test_the_jacobian_is_that_of_the_kinematics(x: float, y: float) -> None:
    h = 1e-6
    found = camera(x, y)
    for column, (dx, dy) in enumerate(((h, 0), (0, h)), start=2):
        slope = (camera(x + dx, y + dy).at - camera(x - dx, y - dy).at) / (2 * h)
        np.testing.assert_allclose(found.jacobian[:, column], slope, atol=2e-8)
    turned = np.cross([0, 0, 1], found.at)
    np.testing.assert_allclose(found.jacobian[:, 1], turned, atol=1e-12)
    np.testing.assert_allclose(found.jacobian[:, 0], [0, 0, 1])


@given(bends, bends)
def test_the_camera_has_axes_and_is_within_reach(x: float, y: float) -> None:
    found, scope = camera(x, y), Scope()
    np.testing.assert_allclose(found.axes @ found.axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(found.axes) == pytest.approx(1)
    assert found.axes[2, 2] == pytest.approx(np.cos(np.hypot(x, y)))
    assert np.linalg.norm(found.at) <= scope.section + scope.tip + 1e-12


@given(st.floats(0.02, 0.7), st.floats(0, 6.3), st.floats(-5e-3, 5e-3))
def test_the_depth_of_a_ball_is_what_its_gradient_says(
    place: float, angle: float, off: float
) -> None:
    lumen = Lumen(STILL)
    at = lumen.target(place, angle)
    middle = lumen.line([place])[0][0]
    out = (at - middle) / np.linalg.norm(at - middle)
    x = at + off * out
    wall = lumen.near(x, 0.0, place=place)
    assert abs(wall.depth - off) < 3e-3
    step = 1e-6 * out
    more = lumen.near(x + step, 0.0, place=wall.place)
    assert (more.depth - wall.depth) / 1e-6 == pytest.approx(float(wall.way @ out), abs=2e-2)


@settings(max_examples=8, deadline=None)
@given(st.floats(0.1, 0.66), st.floats(0, 6.3), st.floats(-1, 1), st.floats(-1, 1))
def test_a_wall_at_rest_gives_back_what_it_took(
    place: float, angle: float, tilt: float, phase: float
) -> None:
    """Along a closed way through the wall: what comes back may differ by the steps of the centre line."""
    lumen = Lumen(STILL)
    points, axes, _ = lumen.line([place])
    at = lumen.target(place, angle)
    out = (at - points[0]) / np.linalg.norm(at - points[0])
    turn = np.linspace(0, 2 * np.pi, 600) + phase
    other = axes[0, 2] + tilt * np.cross(out, axes[0, 2])
    way = at + 4e-3 * (np.outer(np.sin(turn), out) + np.outer(np.cos(turn), other))
    walls = [lumen.near(x, 2e-3, place=place) for x in way]
    depth = np.array([max(wall.depth, 0.0) for wall in walls])
    force = depth[:, None] * np.array([wall.way for wall in walls])
    work = float((0.5 * (force[1:] + force[:-1]) * np.diff(way, axis=0)).sum())
    assert abs(work) < 0.1 * max(float((0.5 * depth**2).max()), 1e-7)


def test_a_motor_pushes_no_harder_than_it_can() -> None:
    slave = Slave(lumen=Lumen(STILL), start=0.65)
    pushes = [slave.step(1.5)[0] for _ in range(10000)]  # straight, it does not pass the pylorus
    assert max(pushes) < 15 + 1e-6
    np.testing.assert_allclose(pushes[-500:], Scope().most_push, atol=1e-6)


@pytest.mark.parametrize("start", [0.15, 0.2, 0.25, 0.3])
def test_a_procedure_begins_at_rest_in_the_wall(start: float) -> None:
    """The section lay in the wall with up to 54 N."""
    run = gastroscope.gastroscopy("direct", Procedure(start=start, seconds=0.05), every=1)
    assert run.findings["perforations"] == 0
    np.testing.assert_allclose(run.rows["section_force"], run.rows["section_force"][0], atol=0.2)


@pytest.mark.parametrize("damping", [2.0, 4.0, 10.0])
def test_a_wall_and_motors_at_rest_push_with_one_force(damping: float) -> None:
    patient = Patient(breathing=0, peristalsis=0, antral_depth=0, damping=damping)
    slave = Slave(lumen=Lumen(patient), start=0.2)
    base = slave.state.inserted - 0.082
    forces = []
    for i in range(8000):
        slave.step(base, 0.6 * min(1, i / 4000))
        forces.append(slave.state.section_force)
    assert 4 < min(forces[-1000:]) < max(forces[-1000:]) < min(forces[-1000:]) + 0.1


def test_tendons_have_slack_that_a_bend_crosses_first() -> None:
    slave = Slave(Scope(backlash=0.3, hysteresis=0), Lumen(STILL), 0.2)
    base = slave.state.inserted - 0.082
    for _ in range(600):
        slave.step(base, 0.14)
    assert abs(slave.state.bend[0]) < 0.01
    for _ in range(600):
        slave.step(base, 0.4)
    assert slave.state.bend[0] == pytest.approx(0.25, abs=0.05)


class Named(Lumen):
    """A lumen of a user's own class."""


@pytest.mark.parametrize(
    ("command", "says"),
    [
        ({"insertion": nan}, r"Slave\.step: insertion = nan m: must lie in \[-10, 10\] m"),
        ({"insertion": 0.1, "bend_x": inf}, r"bend_x = inf rad"),
        ({"insertion": 0.1, "dt": nan}, r"dt = nan s: must lie in \[1e-05, 0\.1\] s"),
        ({"insertion": 0.1, "dt": -1.0}, r"dt = -1 s"),
    ],
)
def test_a_command_that_is_no_number_moves_nothing(command: dict[str, float], says: str) -> None:
    """It became an index into the tube, and ended the interpreter."""
    slave = Slave()
    slave.step(0.1)
    before = slave.state.inserted
    with pytest.raises(ValueError, match=says):
        slave.step(**command)
    assert slave.state.inserted == before


@pytest.mark.parametrize("radius", [nan, inf, -0.1, 0.0, 1e9])
def test_a_radius_that_no_lumen_has_is_refused(radius: float) -> None:
    line = [(0.0, 0.0, -0.02 * i) for i in range(4)]
    with pytest.raises(ValueError, match=r"Lumen\.radii\[2\] = .* m: must lie in \[0\.001, 1\] m"):
        Lumen(points=line, radii=[0.01, 0.01, radius, 0.01])
    with pytest.raises(ValueError, match="0 points and 1 radii"):
        Lumen(radii=[0.01])


def test_ctrl_c_ends_a_gastroscopy() -> None:
    timer = threading.Timer(0.2, _thread.interrupt_main)
    begun = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        gastroscope.gastroscopy("ebac", Procedure(seconds=3600))
    timer.join()
    assert time.monotonic() - begun < 10


def test_a_copy_of_a_lumen_is_what_the_lumen_was_made_from() -> None:
    points = np.array([(-0.02 * i, 0.0, 0.0) for i in range(12)])
    radii = [0.012] * 12
    lumen = Named(STILL, points=points, radii=radii)
    before = str(lumen.near([0.0, 0.01, 0.0], 5e-3))
    points[:], radii[:] = 0, [0.02] * 12
    again = pickle.loads(pickle.dumps(lumen))
    assert type(again) is Named
    assert str(again.near([0.0, 0.01, 0.0], 5e-3)) == before


def test_a_wall_of_ones_own_is_met() -> None:
    points = [(-0.02 * i, 0.0, 0.0) for i in range(12)]
    tube = Tube(points=points, radius=[0.012] * 12)
    own = Lumen(STILL, points=points, radii=[0.012] * 12, wall=Cavity(tube))
    plain = Lumen(STILL, points=points, radii=[0.012] * 12)
    for lumen in (own, plain):
        again = pickle.loads(pickle.dumps(Procedure(lumen=lumen))).lumen
        assert again.patient == STILL
        assert str(again.near([0.0, 0.01, 0.0], 5e-3)) == str(lumen.near([0.0, 0.01, 0.0], 5e-3))
    for x in ((-0.1, 0.005, 0.0), (-0.1, 0.011, 0.004)):
        assert own.near(x, 4e-3, place=0.1).depth == pytest.approx(
            plain.near(x, 4e-3, place=0.1).depth, abs=1e-6
        )
    with pytest.raises(ValueError, match="two points or more"):
        Lumen(wall=Cavity(tube))
    with pytest.raises(ValueError, match="must be \\(n, 3\\)"):
        Lumen(points=[[1.0, 2.0]])


SHORT = Procedure(seconds=4)


def test_a_run_is_the_same_bits_and_another_seed_is_another_run() -> None:
    one, other = (gastroscope.gastroscopy("ebac", SHORT) for _ in range(2))
    assert one.findings == other.findings
    for name, column in one.rows.items():
        np.testing.assert_array_equal(column, other.rows[name])
    assert gastroscope.gastroscopy("ebac", replace(SHORT, seed=2)).findings != one.findings


def test_without_feedback_nothing_is_felt() -> None:
    none = gastroscope.gastroscopy("direct", replace(SHORT, master=Master(feedback=0)))
    assert none.findings["most_felt"] == 0
    felt = gastroscope.gastroscopy("direct", SHORT)
    assert felt.findings["most_felt"] > 0


@pytest.mark.parametrize("insertion", [0, 1, 2])
@pytest.mark.parametrize("by_rate", [False, True])
def test_every_mapping_advances(insertion: int, by_rate: bool) -> None:
    master = Master(insertion=insertion, bend_by_rate=by_rate, bend_rate=40.0)
    run = gastroscope.gastroscopy("direct", replace(SHORT, master=master))
    assert run.findings["fault"] == 0
    assert run.rows["inserted"][-1] > run.rows["inserted"][0] + 0.01


def test_the_camera_draws_whole_rings_in_a_round_picture() -> None:
    run = gastroscope.gastroscopy("direct", replace(SHORT, seconds=3.0))
    figure = plot_gastroscopy(run)
    cameras = [ax for ax in figure.axes if ax.get_title().startswith("camera at")]
    assert len(cameras) == 2
    for ax in cameras:
        rings = [line for line in ax.lines if line.get_linestyle() == "-"]
        assert len(rings) > 5
        for ring in rings:
            assert ring.get_clip_path() is not None
            u, v = ring.get_data()
            steps = np.hypot(np.diff(u), np.diff(v))
            assert np.nanmax(steps, initial=0.0) < 0.1  # no chord
            cut = np.flatnonzero(np.isnan(u[1:]) != np.isnan(u[:-1]))
            at_cut = np.fmax(np.hypot(u, v)[cut], np.hypot(u, v)[cut + 1])
            assert (at_cut > 1).all()  # beyond the edge of the picture


def test_the_time_in_the_pylorus_is_marked() -> None:
    run = gastroscope.gastroscopy("direct", SHORT)
    assert "in the pylorus" not in labels_of(run)
    rows = {name: values.copy() for name, values in run.rows.items()}
    rows["place"][-50:] = run.procedure.lumen.landmarks()["pylorus"] + 1e-3
    assert "in the pylorus" in labels_of(replace(run, rows=rows))


def labels_of(run: gastroscope.Gastroscopy) -> list[str]:
    """Return what the legend of the panel of forces says."""
    legend = plot_gastroscopy(run).axes[-1].get_legend()
    return [text.get_text() for text in legend.get_texts()]


def test_a_study_pairs_physicians_and_does_not_depend_on_threads() -> None:
    base = Procedure(seconds=1.5)
    one, two = (
        gastroscope.gastroscopy_study(
            ["direct"], delays=[0.05], count=3, procedure=base, threads=threads
        )
        for threads in (1, 2)
    )
    assert one.table() == two.table()
    effect = one.effects[0]
    assert effect.low_N <= effect.difference_N <= effect.high_N
    assert 0 <= effect.power <= 1
    figure = plot_gastroscopy_study(two)
    assert figure.get_suptitle().startswith("3 simulated physicians, each with and without force")
    drawn = [line for line in figure.axes[0].lines if line.get_linestyle() == "None"]
    assert [len(line.get_xdata()) for line in drawn if len(line.get_xdata())] == [3, 3]
    legend = figure.axes[0].get_legend()
    words = [text.get_text() for text in legend.get_texts()]
    assert words == ["with feedback, direct", "without", f"limit, {two.force_limit_N:g} N"]


def test_a_study_takes_two_laws_of_a_kind_by_names_of_their_own() -> None:
    """The second one took the place of the first in the rows."""
    few = {"delays": [0.05], "count": 2, "procedure": Procedure(seconds=0.3)}
    soft, hard = TCADamped(virtual_damping=1), TCADamped(virtual_damping=30)
    with pytest.raises(ValueError, match="two laws are called 'tca-damped': give a mapping"):
        gastroscope.gastroscopy_study([soft, hard], **few)
    found = gastroscope.gastroscopy_study({"little": soft, "much": hard}, **few)
    assert [(row.law, row.feedback) for row in found.rows] == [
        ("little", False), ("little", True), ("much", False), ("much", True),
    ]  # fmt: skip
    assert [effect.law for effect in found.effects] == ["little", "much"]
    alone = gastroscope.gastroscopy_study([soft], **few)
    assert [replace(row, law="little") for row in alone.rows] == list(found.rows[:2])


@pytest.mark.parametrize(
    ("given", "kind", "message"),
    [
        ({"laws": ()}, ValueError, "laws = []: is empty; give one at least"),
        ({"laws": "ebac"}, TypeError, "laws = 'ebac' (str): must be a sequence, such as ['ebac']"),
        ({"delays": ()}, ValueError, "delays = []: is empty; give one at least"),
        ({"delays": 0.1}, TypeError, "delays = 0.1 (float): must be a sequence, such as [0.1]"),
        ({"delays": ["a"]}, TypeError, "delays = 'a': must be a number"),
        (
            {"threads": 0},
            ValueError,
            "threads = 0: must lie in [1, 1024]; without it there is one per usable core",
        ),
        ({"count": 2.5}, TypeError, "count = 2.5: must be a whole number"),
        (
            {"delays": [0.1, 0, 0.0]},
            ValueError,
            "delays = [0.1, 0.0, 0.0] s: 0.0 s stands there twice; give each once",
        ),
        (
            {"laws": ["ebac", "direct", "ebac"]},
            ValueError,
            "two laws are called 'ebac': give a mapping of names to laws",
        ),
        ({"laws": {}}, ValueError, "no law given: a study needs at least one"),
    ],
)
def test_a_study_refuses_what_it_cannot_run_by_name(
    given: dict[str, Any], kind: type[Exception], message: str
) -> None:
    with pytest.raises(kind) as refused:
        gastroscope.gastroscopy_study(**{"count": 2, **given})
    assert str(refused.value) == message


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--insertion", "feet"], "there are: pedals, rate, clutch"),
        (["--bending", "none"], "there are: position, rate"),
        (["--seconds", "0"], "must lie in"),
        (["--law", "ebax"], "ebac"),
        (["--delay", "3"], "--delay"),
        (["study", "--physicians", "1"], "--physicians"),
        (["--log", "run.txt"], "must end in"),
        (["--live", "--log", "run.mcap"], "writes no files"),
        (["--no-browser"], "belong to --live"),
    ],
)
def test_wrong_input_is_refused(words: list[str], said: str) -> None:
    result = CliRunner().invoke(app, ["gastroscopy", *words, "--json"])
    assert result.exit_code == 2
    assert said in result.output


def test_the_command_writes_figure_record_and_json(tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ["gastroscopy", "--seconds", "2", "--law", "direct", "--out", str(out), "--json"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    row = json.loads(result.stdout)["rows"][0]
    assert row["most_section_N"] >= row["most_tip_N"] >= 0
    assert {path.name for path in out.iterdir()} >= {"gastroscopy.csv", "gastroscopy.json"}
    assert (out / "gastroscopy.csv").read_text(encoding="utf-8").startswith("tick,t [s],place [m]")


def test_a_log_is_read_back_with_units_touches_and_parameters(tmp_path: Path) -> None:
    log = tmp_path / "run.mcap"
    words = ["gastroscopy", "--seconds", "2", "--law", "direct", "--log", str(log), "--json"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    run = gastroscope.gastroscopy(
        "direct", Procedure(seconds=2, physician=gastroscope.Physician(heed=3)), every=1
    )
    read = logs.read(log)
    assert (read.condition.complete, read.lost, read.about.law) == (True, 0, "direct")
    for name, column in run.rows.items():
        np.testing.assert_array_equal(read.trace[name], column)
    assert read.trace.columns["section_force"].unit == "N"
    assert "handle" not in read.trace.summary()
    beside = json.loads(read.about.files["gastroscopy.json"])
    assert beside["physician"]["heed"] == 3
    assert beside["findings"] == run.findings
    again = CliRunner().invoke(app, ["log", "info", str(log), "--json"])
    assert again.exit_code == 0, again.output
    assert json.loads(again.stdout)["lost_rows"] == 0
    for suffix in (".npz", ".csv"):
        run.save(tmp_path / f"run{suffix}")
        assert len(Trace.load(tmp_path / f"run{suffix}")) == len(read.trace)


@pytest.mark.parametrize("every", [1, 7, 10])
def test_a_log_of_every_tenth_row_has_lost_none_and_names_one_that_is_lost(
    every: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nine of ten ticks, which nobody had kept, counted as lost."""
    monkeypatch.setattr("ebac.logs.files.CHUNK_ROWS", 20)
    run = gastroscope.gastroscopy("direct", Procedure(seconds=1), every=every)
    for suffix in (".mcap", ".npz", ".csv"):
        run.save(tmp_path / f"run{suffix}")
        read = logs.read(tmp_path / f"run{suffix}")
        assert (read.lost, read.gaps, len(read.trace)) == (0, [], len(run.rows["t"])), suffix
    whole = bytearray((tmp_path / "run.mcap").read_bytes())
    chunks, at = [], 8
    while at < len(whole) - 9:
        length = int.from_bytes(whole[at + 1 : at + 9], "little")
        if whole[at] == 0x06:
            chunks.append(at + 9 + length // 2)
        at += 9 + length
    whole[chunks[2]] ^= 0xFF
    (tmp_path / "damaged.mcap").write_bytes(whole)
    damaged = logs.read(tmp_path / "damaged.mcap")
    assert damaged.lost == 20
    (gap,) = damaged.gaps
    assert gap.t == run.rows["t"][39]


def test_a_log_has_an_event_for_each_touch_and_each_time_above_the_limit(tmp_path: Path) -> None:
    polyp = gastroscope.Polyp(place=0.2, angle=0.5)
    tender = Lumen(Patient(force_limit=0.5))
    run = gastroscope.gastroscopy("direct", Procedure(lumen=tender, targets=[polyp], seconds=25))
    run.save(tmp_path / "run.mcap")
    read = logs.read(tmp_path / "run.mcap")
    assert read.trace.origin == "simulated"
    assert "simulated: the 3-axis joystick" in read.trace.plot().get_suptitle()
    assert "free air" not in read.trace.plot().get_suptitle(), "its world is the patient"
    events = read.events
    kinds = [event.kind for event in events]
    assert run.findings["touched"] == kinds.count("touch") == 1
    assert kinds.count("limit") >= 1
    assert [event.tick for event in events] == sorted(event.tick for event in events)
    for event in events:  # a tick names a row
        assert event.t == read.trace["t"][read.trace["tick"] == event.tick]


def test_a_thinned_record_keeps_the_largest_forces() -> None:
    full, coarse = (gastroscope.gastroscopy("direct", SHORT, every=n) for n in (1, 10))
    thin = full.thinned(10)
    for name, column in coarse.rows.items():
        np.testing.assert_array_equal(thin.rows[name], column)
    with pytest.raises(ValueError, match="must be 1 or more"):
        full.thinned(0)


@pytest.mark.slow
def test_the_default_physician_stays_below_the_limit_and_touches_all_targets() -> None:
    """The wall in steps pushed with 6.6 N for one tick."""
    run = gastroscope.gastroscopy("ebac", Procedure(physician=gastroscope.Physician(heed=3)))
    assert (run.findings["reached"], run.findings["touched"]) == (1, 3)
    assert run.findings["over_limit"] == 0


def test_no_spike_of_the_force_lies_between_two_rows() -> None:
    done = gastroscope.gastroscopy("direct", Procedure(seconds=4), every=50)
    for column, most in (("section_force", "most_section"), ("tube_force", "most_tube")):
        assert done.rows[column].max() == done.findings[most]
    assert done.rows["t"][-1] == done.findings["seconds"]


@pytest.mark.slow
def test_the_tutorial_shows_what_the_command_prints() -> None:
    page = Path(__file__).parents[2] / "docs" / "tutorials" / "gastroscopy.md"
    shown = page.read_text(encoding="utf-8").partition("```text\n")[2].partition("```")[0]
    lines = [" ".join(line.split()) for line in shown.strip().splitlines()]
    assert len(lines) == 5
    done = CliRunner().invoke(app, ["gastroscopy", "--no-files"])
    printed = [" ".join(line.split()) for line in done.stdout.splitlines()]
    assert [line for line in lines if line not in printed] == []


@pytest.mark.parametrize("law", ["ebac", "lag-compensator-tuned-observer"])
def test_a_live_gastroscopy_is_the_run_of_the_same_law(law: str) -> None:
    """A law that was tuned on the observer's estimate ran on the encoder alone."""
    procedure = Procedure(seconds=1)
    whole = gastroscope.gastroscopy(law, procedure, every=20)
    with GastroscopySession(law, procedure) as session:
        session.advance(0.9)
        row = session.snapshot()[0]
    at = int(np.argmin(np.abs(whole.rows["t"] - row["t"])))
    for name in ("t", "place", "handle_x", "handle_z", "x", "z"):
        assert row[name] == whole.rows[name][at], name
