"""A recorded log as hardware: the same law commands the same, another one is compared with it."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ebac

TWO = {"device": ebac.Device(kinematics=ebac.Linear(axes=2)), "environment": ebac.Corner()}
GIMBAL = {"device": ebac.Device(kinematics=ebac.Gimbal())}
SCENARIOS: dict[str, dict[str, Any]] = {
    "plain": {},
    "jitter, noise": {"jitter": 0.3, "device": ebac.Device(sensor=ebac.ForceSensor(noise=0.2))},
    "two axes": TWO,
    "gimbal": GIMBAL,
    "narrow counter": {"device": ebac.Device(encoder=ebac.Encoder(counter_bits=8))},
}


@pytest.fixture(params=SCENARIOS)
def scenario(request: pytest.FixtureRequest) -> ebac.Scenario:
    return ebac.Scenario(seconds=0.4, **SCENARIOS[request.param])


def assert_same_commands(replayed: ebac.Trace, recorded: ebac.Trace) -> None:
    assert len(replayed) == len(recorded)
    for name in recorded:
        if name.startswith(("true.", "bus.")):
            continue  # what only the device knows
        assert replayed[name].tobytes() == recorded[name].tobytes(), name
    for name in ("f_env", "f_cmd", "current"):
        assert replayed[f"log.{name}"].tobytes() == recorded[name].tobytes(), name


@pytest.mark.parametrize("law", ebac.LAWS)
def test_the_same_law_commands_the_same_to_the_bit(law: str, scenario: ebac.Scenario) -> None:
    recorded = ebac.simulate(scenario, law)
    assert (recorded["f_cmd"] != 0).any()
    assert_same_commands(ebac.replay(recorded, law), recorded)


def test_a_force_sensor_that_saturates_replays_to_the_bit(tmp_path: Path) -> None:
    """Its status is no column: the observer took note of it. Contacts made and left, so it comes and goes."""
    taps = ebac.Hand(path=ebac.Tapping(target=0.04, rest=-0.01, frequency=2.0))
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.03, range=5.0))
    recorded = ebac.simulate(
        ebac.Scenario(seconds=2, hand=taps, device=device, observer=True), "ebac"
    )
    recorded.save(tmp_path / "run.mcap")
    saturated = recorded["est.fallback"] == int(ebac.Fallback.FORCE_STATUS)
    assert 0.1 < saturated.mean() < 0.9
    assert {0.0, 1.0} < {*recorded["est.weight"]}
    assert np.count_nonzero(np.diff(saturated)) > 4
    for log in (recorded, tmp_path / "run.mcap"):
        assert_same_commands(ebac.replay(log, "ebac"), recorded)


@pytest.mark.parametrize(
    "sensor",
    [
        ebac.ForceSensor(period=1.3e-3, noise=0.03),
        ebac.ForceSensor(period=3e-3, delay=2e-3, stops_at=0.1, resumes_at=0.2),
        ebac.ForceSensor(stops_at=0.1, resumes_at=0.2, disconnects=True),
        ebac.ForceSensor(stops_at=0.1, repeats=True),
    ],
    ids=["slow", "slow and stops", "disconnects", "repeats"],
)
@pytest.mark.parametrize("through", [None, "can"])
@pytest.mark.parametrize("observer", [True, False])
def test_forces_that_are_not_new_in_each_tick_replay_to_the_bit(
    sensor: ebac.ForceSensor, through: Any, observer: bool
) -> None:
    scenario = ebac.Scenario(
        seconds=0.4, jitter=0.3, device=ebac.Device(sensor=sensor), observer=observer
    )
    recorded = ebac.simulate(scenario, "ebac", through=through)
    assert_same_commands(ebac.replay(recorded, "ebac"), recorded)


def test_through_a_log_on_disk_and_a_bus(tmp_path: Path) -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=0.4), "ebac", through="can")
    recorded.save(tmp_path / "run.mcap")
    for log in (
        tmp_path / "run.mcap",
        str(tmp_path / "run.mcap"),
        ebac.logs.read(tmp_path / "run.mcap"),
    ):
        assert_same_commands(ebac.replay(log, "ebac"), recorded)


def test_a_log_of_a_run_that_was_changed_is_replayed_with_a_warning(tmp_path: Path) -> None:
    ebac.simulate(ebac.Scenario(seconds=0.1), "direct").save(tmp_path / "run.mcap")
    log = ebac.logs.read(tmp_path / "run.mcap")
    moved = ebac.logs.Event(kind="parameter", message="hand target, 0.03 m", tick=50, t=0.05)
    log.events.append(moved)
    ebac.replay(log, "direct")
    log.events.append(replace(moved, message="environment: stiffness 10000 -> 20000"))
    with pytest.warns(UserWarning, match=r"environment: stiffness .* at 0\.05 s"):
        ebac.replay(log, "direct")


def test_counts_that_stood_for_want_of_an_answer_are_no_leap() -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=0.1), "direct", through="can")
    data = {name: recorded[name].copy() for name in recorded}
    data["counts"][51:54] = data["counts"][50]  # three answers are missing, the next is in time
    data["bus.age"][51:54] = [1, 2, 3]
    data["counts"][61:63] = data["counts"][60]  # one is missing, and comes a tick late
    data["counts"][62] = recorded["counts"][61]
    data["bus.age"][61:63] = 1
    gaps = ebac.Trace(
        data=data, columns=recorded.columns, axes=1, scenario=recorded.scenario, law="direct"
    )
    replayed = ebac.replay(gaps, "direct")
    x, v = recorded["x"], replayed["v"]
    held = recorded["v"][50]
    assert v[51:54].tolist() == [held] * 3
    assert v[54] == pytest.approx((x[54] - x[50]) / 4e-3)
    assert v[61] == v[60]
    assert v[62] == pytest.approx(recorded["v"][61])
    assert v[63] == pytest.approx((x[63] - x[61]) / 2e-3)
    assert v[64:].tolist() == recorded["v"][64:].tolist()
    assert np.abs(v[54]) > 0.02  # m/s: it moved


def test_a_law_in_python_is_driven_too() -> None:
    class Spring:
        name = "spring"

        def step(self, port: ebac.Port) -> float:
            return 3.0 * port.f_env + port.v

        def reset(self) -> None: ...

    recorded = ebac.simulate(ebac.Scenario(seconds=0.1), "tca")
    replayed = ebac.replay(recorded, Spring())
    assert (replayed["f_cmd"] == 3.0 * recorded["f_env"] + recorded["v"]).all()
    assert (replayed["log.f_cmd"] == recorded["f_cmd"]).all()
    assert replayed.law == "spring"


def test_another_law_meets_the_same_motion_and_no_feedback() -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=1, observer=False), "tca")
    replayed = ebac.replay(recorded, "ebac")
    for name in (
        "tick",
        "t",
        "lateness",
        "counts",
        "x",
        "v",
        "f_env",
        "f_applied",
        "f_meas",
        "work",
    ):
        assert replayed[name].tobytes() == recorded[name].tobytes(), name
    assert (replayed["f_cmd"] != recorded["f_cmd"]).any()
    assert "law.energy" in replayed
    assert not [name for name in replayed if name.startswith("true.")]
    assert "over a recorded log" in replayed.plot().get_suptitle()


def test_another_world_and_other_parameters() -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=0.4), "ebac")
    assert recorded.scenario is not None
    soft = recorded.scenario.replace(environment=ebac.Wall(stiffness=5e3))
    replayed = ebac.replay(recorded, "direct", scenario=soft)
    inside = recorded["x"] > 0
    assert replayed["f_env"][inside] == pytest.approx(5e3 * recorded["x"][inside])


def test_a_slice_and_a_gap_keep_their_ticks_and_times(tmp_path: Path) -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=0.3), "ebac")
    part = recorded[0.1:0.2]
    replayed = ebac.replay(part, "direct")
    assert replayed["tick"].tolist() == part["tick"].tolist()
    assert replayed["t"].tolist() == part["t"].tolist()
    assert replayed["x"].tolist() == part["x"].tolist()
    assert replayed.axis("dt")[0] == 0
    keep = np.r_[0:50, 80:100]
    gap = ebac.Trace(
        data={name: part[name][keep] for name in part}, columns=part.columns, axes=1,
        scenario=part.scenario, law=part.law, law_repr=part.law_repr,
    )  # fmt: skip
    over = ebac.replay(gap, "direct")
    assert over.axis("dt")[50] == pytest.approx(31e-3)
    assert over["dx"][50] == pytest.approx(gap["x"][50] - gap["x"][49])


def test_only_the_rows_in_which_the_law_ran_are_replayed() -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=0.3), "ebac")
    state = np.full(len(recorded), 2, np.int32)
    state[:20], state[250:] = 1, 3
    data = {**{name: recorded[name] for name in recorded}, "state": state}
    infos = {**recorded.columns, "state": ebac.ColumnInfo(name="state", unit="1", meaning="state")}
    armed = ebac.Trace(data=data, columns=infos, axes=1, scenario=recorded.scenario)
    assert ebac.replay(armed, "direct")["tick"].tolist() == list(range(20, 250))
    never = armed.with_column("state", np.ones_like(state))
    with pytest.raises(ValueError, match="no row in which the law ran"):
        ebac.replay(never, "direct")


def test_the_fault_of_a_device_ends_the_replay_where_it_ended_the_run() -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=0.2), "ebac")
    fault = recorded["fault"].copy()
    fault[100:] = int(ebac.Fault.DRIVE_SILENT)
    replayed = ebac.replay(recorded.with_column("fault", fault), "ebac")
    assert len(replayed) == 110
    assert (replayed["fault"] == fault[:110]).all()
    assert (replayed["f_cmd"][100:] == 0).all()
    own = np.where(fault, int(ebac.Fault.LAW_NOT_FINITE), 0).astype(np.uint32)
    assert_same_commands(
        ebac.replay(recorded.with_column("fault", own), "ebac")[:0.0995], recorded[:0.0995]
    )
    assert len(ebac.replay(recorded.with_column("fault", own), "ebac")) == 201


def test_a_law_that_fails_on_a_log_raises_with_its_trace() -> None:
    class Broken:
        def step(self, port: ebac.Port) -> float:
            return float("nan") if port.x > 0 else 0.0

        def reset(self) -> None: ...

    recorded = ebac.simulate(ebac.Scenario(seconds=1), "ebac")
    with pytest.raises(ebac.LoopFault, match="law not finite") as stopped:
        ebac.replay(recorded, Broken())
    assert "log.f_cmd" in stopped.value.trace

    class Raises(Broken):
        def step(self, port: ebac.Port) -> float:
            return 1 / 0

    with pytest.raises(ebac.LoopFault, match="the law Raises raised ZeroDivisionError") as stopped:
        ebac.replay(recorded, Raises())
    assert isinstance(stopped.value.__cause__, ZeroDivisionError)


def test_what_cannot_be_replayed_is_refused(tmp_path: Path) -> None:
    recorded = ebac.simulate(ebac.Scenario(seconds=0.1), "ebac")
    recorded.to_csv(tmp_path / "run.csv")
    with pytest.raises(ValueError, match="give scenario="):
        ebac.replay(tmp_path / "run.csv", "ebac")
    assert_same = ebac.replay(tmp_path / "run.csv", "ebac", scenario=recorded.scenario)
    assert assert_same["f_cmd"].tobytes() == recorded["f_cmd"].tobytes()
    with pytest.raises(ValueError, match="no rows"):
        ebac.replay(recorded[:0.0], "ebac")
    with pytest.raises(ValueError, match="the log has 1 axes, the device 2"):
        ebac.replay(recorded, "ebac", scenario=ebac.Scenario(**TWO))
    bare = ebac.Trace(
        data={name: recorded[name] for name in ("tick", "t")},
        columns={name: recorded.columns[name] for name in ("tick", "t")},
        axes=1, scenario=recorded.scenario,
    )  # fmt: skip
    with pytest.raises(ValueError, match="no column dt, lateness, fault, counts"):
        ebac.replay(bare, "ebac")
    with pytest.raises(KeyError, match="no law is called"):
        ebac.replay(recorded, "none")


@pytest.mark.parametrize(
    "compensation", [{}, {"friction": 0.3, "gravity_mass": 0.25, "inertia": 0.004}]
)
def test_a_run_with_a_soft_start_is_replayed(compensation: dict[str, float]) -> None:
    """What is in flight is what was sent, of static compensation too: `work` was off by 79 mJ."""
    device = ebac.Device(
        mechanics=ebac.Mechanics(coulomb=0.3, gravity=9.81),
        compensation=ebac.Compensation(**compensation),
    )
    recorded = ebac.simulate(ebac.Scenario(device=device, seconds=1.0), "ebac", soft_start=0.3)
    again = ebac.replay(recorded, "ebac")
    for column in ("est.x_act", "work", "law.energy", "f_cmd"):
        apart = np.abs(again[column] - recorded[column]).max()
        assert apart < 1e-9 if compensation else apart == 0, column


def test_another_law_takes_the_energy_of_the_recorded_force() -> None:
    device = ebac.Device(
        mechanics=ebac.Mechanics(gravity=9.81),
        compensation=ebac.Compensation(gravity_mass=0.25),
        drive=ebac.Drive(peak_ratio=1.0),
    )
    recorded = ebac.simulate(ebac.Scenario(device=device, seconds=1.0), "tca")
    assert np.abs(recorded["f_applied"]).max() == pytest.approx(device.peak_force)
    assert np.abs(ebac.replay(recorded, "eba")["work"] - recorded["work"]).max() < 1e-12
