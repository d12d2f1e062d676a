"""A run through a CAN bus with simulated drives: the same bits, and the same verdicts."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app


def quantised(scenario: ebac.Scenario) -> ebac.Scenario:
    drive = scenario.device.drive.replace(permille=True)
    return scenario.replace(device=scenario.device.replace(drive=drive))


def assert_same_bits(scenario: ebac.Scenario, law: Any) -> ebac.Trace:
    """Every column of a run without a bus is in the run with one; bytes, so that -0 is not 0."""
    direct = ebac.simulate(quantised(scenario), law)
    through = ebac.simulate(scenario, law, through="can")
    assert set(direct) < set(through)
    for name in direct:
        assert through[name].tobytes() == direct[name].tobytes(), name
    return through


hands = st.builds(
    ebac.Hand,
    mass=st.floats(0.01, 1),
    damping=st.floats(0, 20),
    stiffness=st.floats(0, 1000),
    path=st.sampled_from([[ebac.Step(target=0.03)], [ebac.Tapping()], [ebac.Sine()]]),
)


@settings(max_examples=40)
@given(
    law=st.sampled_from(sorted(ebac.LAWS)),
    hand=hands,
    stiffness=st.floats(10, 50e3),
    friction=st.sampled_from([0.0, 0.5]),
    noise=st.sampled_from([0.0, 0.2]),
    jitter=st.sampled_from([0.0, 0.3]),
    delay=st.integers(1, 8),
    seed=st.integers(0, 2**62),
)
def test_the_bus_changes_no_bit(
    law: str,
    hand: ebac.Hand,
    stiffness: float,
    friction: float,
    noise: float,
    jitter: float,
    delay: int,
    seed: int,
) -> None:
    device = ebac.Device(
        mechanics=ebac.Mechanics(coulomb=friction), sensor=ebac.ForceSensor(noise=noise)
    )
    scenario = ebac.Scenario(
        device=device,
        hand=hand,
        environment=ebac.Wall(stiffness=stiffness),
        timing=ebac.Timing(delay=delay),
        jitter=jitter,
        seconds=0.3,
        seed=seed,
    )
    assert_same_bits(scenario, law)


@pytest.mark.parametrize("law", sorted(ebac.LAWS))
def test_two_axes_on_one_bus(law: str) -> None:
    scenario = ebac.Scenario(
        device=ebac.presets.device("joystick"),
        environment=ebac.Wall(angle=0.4),
        seconds=0.5,
    )
    trace = assert_same_bits(scenario, law)
    assert trace["bus.statusword"].shape == (501, 2)


def test_three_axes_on_one_bus() -> None:
    device = ebac.Device(kinematics=ebac.Linear(axes=3))
    scenario = ebac.Scenario(device=device, environment=ebac.Corner(), seconds=0.5)
    with pytest.warns(UserWarning, match="74.5 %"):
        assert_same_bits(scenario, "eba")


class Spring:
    def step(self, port: ebac.Port) -> float:
        return 0.3 * port.f_env

    def reset(self) -> None: ...


def test_a_law_in_python_too() -> None:
    assert_same_bits(ebac.Scenario(seconds=0.2), Spring())


@pytest.fixture(scope="module")
def trace() -> ebac.Trace:
    return ebac.simulate(ebac.Scenario(seconds=1), "ebac", through="can")


def test_the_row_reports_the_bus(trace: ebac.Trace) -> None:
    assert (trace["bus.statusword"] & 0x6F == 0x27).all()
    assert (trace["bus.controlword"] == 0x0F).all()
    assert (trace["bus.age"] == 0).all()
    for name in ("missing", "late", "duplicate", "malformed", "foreign", "refused"):
        assert np.ptp(trace[f"bus.{name}"]) == 0, name
    one = ebac.Motor().current(ebac.Motor().rated_torque) / 1000
    assert (trace["current_applied"] == one * trace["bus.actual_permille"]).all()
    asked = np.round(trace["current"] / one)
    assert (trace["bus.target_permille"][1:] == asked[:-1]).all()
    assert (trace["bus.actual_permille"][1:] == trace["bus.target_permille"][:-1]).all()
    assert np.abs(trace["bus.target_permille"]).max() > 500
    for name in trace:
        assert trace.columns[name].meaning, name


def test_the_trace_keeps_what_was_run(trace: ebac.Trace, tmp_path: Any) -> None:
    assert trace.scenario is not None
    assert trace.scenario.device.drive.permille
    trace.to_npz(tmp_path / "run.npz")
    again = ebac.Trace.from_npz(tmp_path / "run.npz")
    assert (again["bus.actual_permille"] == trace["bus.actual_permille"]).all()
    trace.to_csv(tmp_path / "run.csv")
    assert "bus.missing" in (tmp_path / "run.csv").read_text().partition("\n")[0]


class Broken(Spring):
    def __init__(self) -> None:
        self.tick = 0

    def step(self, port: ebac.Port) -> float:
        self.tick += 1
        return 5.0 if self.tick < 20 else float("nan")


def test_a_fault_takes_the_drives_to_rest() -> None:
    with pytest.raises(ebac.LoopFault) as caught:
        ebac.simulate(ebac.Scenario(seconds=1), Broken(), through="can")
    trace = caught.value.trace
    assert caught.value.fault is ebac.Fault.LAW_NOT_FINITE
    first = int((trace["fault"] != 0).argmax())
    assert first == 19
    assert trace["bus.target_permille"][first] != 0
    assert (trace["bus.target_permille"][first + 1 :] == 0).all()
    assert trace["bus.controlword"][first + 1] == 0x0F  # zero torque first
    assert (trace["bus.controlword"][first + 2 :] == 0).all()
    assert trace["bus.statusword"][-1] & 0x4F == 0x40


def test_a_plant_that_leaves_the_numbers_is_a_fault_of_its_drive() -> None:
    pull = ebac.Recorded(t=[0.0, 0.01, 0.02], x=[0.0, 0.0, 1.7e308])
    with pytest.raises(ebac.LoopFault) as caught:
        ebac.simulate(ebac.Scenario(hand=ebac.Hand(path=pull)), "direct", through="can")
    assert caught.value.fault in (ebac.Fault.DRIVE_EMERGENCY, ebac.Fault.POSITION_NOT_FINITE)
    assert (caught.value.trace["current"][-9:] == 0).all()


def test_what_a_bus_cannot_do_is_refused() -> None:
    with pytest.raises(ValueError, match=r"through = 'lin': must be 'can' or None"):
        ebac.simulate(ebac.Scenario(), through="lin")
    with pytest.raises(ValueError, match=r"Timing.delay = 0 samples: over a CAN bus"):
        ebac.simulate(ebac.Scenario(timing=ebac.Timing(delay=0)), through="can")
    with pytest.raises(ValueError, match=r"must be at most 90 %; the remedy"):
        ebac.simulate(ebac.Scenario(timing=ebac.Timing(dt=1e-4)), through="can")


def test_a_full_bus_is_warned_of() -> None:
    scenario = ebac.Scenario(timing=ebac.Timing(dt=1 / 3000), seconds=0.05)
    with pytest.warns(UserWarning, match="over 70 %"):
        ebac.simulate(scenario, through="can")


def wall(*words: str) -> dict[str, Any]:
    result = CliRunner().invoke(app, ["wall", "--json", "--seconds", "2", *words])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)  # type: ignore[no-any-return]


def test_the_wall_has_the_same_verdicts_through_can() -> None:
    through = wall("--law", "all", "--through", "can")
    direct = wall("--law", "all", "--device-permille")
    assert (direct["through"], through["through"]) == (None, "can")
    assert through["rows"] == direct["rows"]
    assert through["scenario"] == direct["scenario"]


def test_the_command_names_the_run_with_the_same_bits() -> None:
    words = ["wall", "--no-files", "--law", "tca", "--seconds", "0.5", "--through", "can"]
    shown = " ".join(CliRunner().invoke(app, words).stdout.split())
    assert "the same to the bit without the bus by --device-permille" in shown


def test_the_command_names_the_law_whose_torque_a_drive_limited() -> None:
    from ebac.cli.wall.results import limited_by_i2t

    stiff = ebac.Hand(stiffness=3000, path=[ebac.Step(target=0.06)])
    held = ebac.Scenario(hand=stiff, seconds=70, observer=False)
    trace = ebac.simulate(held, "direct", through="can")
    direct = ebac.simulate(quantised(held), "direct")
    assert trace["x"].tobytes() != direct["x"].tobytes()
    assert limited_by_i2t([direct, trace]) == ["direct"]
    words = ["wall", "--no-files", "--law", "direct", "--seconds", "70", "--through", "can"]
    words += ["--hand-stiffness", "3000", "--hand-target", "0.06"]
    shown = " ".join(CliRunner().invoke(app, words).stdout.split())
    assert "under direct the i2t limit of a drive held the torque" in shown
    assert "to the bit" not in shown


@pytest.mark.parametrize("delay", ["1", "2"])
def test_the_wall_with_the_papers_drive_has_the_verdict_of_an_ideal_one(delay: str) -> None:
    from ebac._util.verdicts import verdict

    scenario = ebac.Scenario(timing=ebac.Timing(delay=int(delay)))
    for law in ("tca", "eba", "ebac"):
        words = [
            verdict(ebac.contact(run)).partition(" by")[0]
            for run in (
                ebac.simulate(scenario, law),
                ebac.simulate(scenario, law, through="can"),
            )
        ]
        assert words[0] == words[1], law


def test_the_command_names_its_option() -> None:
    result = CliRunner().invoke(app, ["wall", "--no-files", "--through", "usb"])
    assert result.exit_code == 2
    assert "--through usb: must be can, or left out" in " ".join(result.output.split())


def test_the_command_reports_a_full_bus() -> None:
    result = CliRunner().invoke(
        app,
        ["wall", "--no-files", "--through", "can", "--rate", "3000", "--seconds", "0.1"],
    )
    assert result.exit_code == 0
    assert "Warning: the planned frames take 285 us" in " ".join(result.output.split())
