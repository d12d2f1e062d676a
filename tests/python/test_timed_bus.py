"""A simulated run on a bus that takes time: what is late, what is refused, and that nothing else changes."""

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac import _core, drives
from ebac.cli import app
from ebac.drives import TimedBus
from ebac.hardware import Configuration, ConfigurationError, under_the_law
from ebac.hardware.configuration_fields import SILENT

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"


@pytest.fixture(scope="module")
def known() -> Configuration:
    return Configuration.load(EXAMPLE).replace(seconds=1.0)


def with_bus(known: Configuration, **changes: Any) -> Configuration:
    return known.replace(simulated_bus={**known.simulated_bus, **changes})


def test_a_broken_node_must_be_one_of_the_device() -> None:
    with pytest.raises(ValueError, match=r"TimedBus\.broken = 2: must lie in \[0, 1\]"):
        ebac.simulate(ebac.Scenario(seconds=0.1), through="can", bus=TimedBus(broken=2))


def test_drives_that_let_go_within_a_tick_are_refused() -> None:
    """A tick of 5 ms ended by "raise bus.answer_share", which does not help."""
    for dt, silence in ((1e-3, 0.0005), (1e-3, 0.001), (5e-3, 0.005)):
        scenario = ebac.Scenario(seconds=0.2, timing=ebac.Timing(dt=dt))
        with pytest.raises(ValueError, match=f"torque_silence = .* after a tick of {dt:g} s"):
            ebac.simulate(scenario, through="can", bus=TimedBus(torque_silence=silence))


@given(
    ms=st.integers(1, 100),
    dt=st.floats(5e-4, 2e-2),
    torque=st.booleans(),
)
def test_the_bus_refuses_the_watches_that_real_drives_refuse(
    known: Configuration, ms: int, dt: float, torque: bool
) -> None:
    silence = {"torque_silence": 0.0, "loop_silence": 0.0, "drive_heartbeat": 0.0}
    silence["torque_silence" if torque else "loop_silence"] = ms / 1e3
    (rpdo,) = (one for one in known.drives.nodes[0].profile.pdos if not one.sent)
    profile = drives.Profile(
        name="mine",
        values={"heartbeat.master": 127, "heartbeat.consumer": 0.0 if torque else ms / 1e3},
        pdos=(dataclasses.replace(rpdo, event=ms / 1e3 if torque else 0.0),),
    )
    network = drives.Network(name="mine", nodes=(drives.Node(id=1, profile=profile),))
    scenario = ebac.Scenario(seconds=0.02, timing=ebac.Timing(dt=dt))

    def refusal(of: Callable[[], object]) -> str:
        try:
            of()
        except ValueError as error:
            _, found, why = str(error).partition("a drive lets go")
            return found + why
        except ebac.LoopFault:
            pass
        return ""

    def simulated() -> None:
        ebac.simulate(scenario, "direct", through="can", bus=TimedBus(**silence))

    assert refusal(lambda: drives.check_pace(network, dt)) == refusal(simulated)


def test_two_drives_at_1_mbit_are_never_late_and_the_wall_is_the_same(known: Configuration) -> None:
    timed, prompt = known.simulate(), known.simulate(bus_time=False)
    assert np.ptp(timed["bus.missing"], axis=0).tolist() == [0, 0]
    assert (timed["bus.age"] == 0).all()
    assert (timed["t"] == prompt["t"]).all()
    rests = [ebac.contact(trace, truth=False).rest_m for trace in (timed, prompt)]
    assert rests[0] == pytest.approx(rests[1], abs=2 * known.device.count)


def test_readings_are_taken_once_a_sample_time_whatever_else_is_sent() -> None:
    """The loop's heartbeat went out before SYNC: every tenth reading came 58 us late, and a damping that was identified
    from such a log was 30 % off."""
    sine = ebac.Sine(centre=0.0, amplitude=0.03, frequency=1.3)
    free = ebac.Scenario(
        hand=ebac.Hand(path=sine), environment=ebac.Free(), seconds=2.0, observer=False
    )
    trace = ebac.simulate(free, "direct", through="can", bus=TimedBus())
    v = trace["true.v"]
    mean = 0.5 * (v[1:] + v[:-1])
    fast = np.abs(mean) > 0.1
    apart = np.diff(trace["true.x"])[fast] / mean[fast]
    assert np.abs(apart - free.timing.dt).max() < 2e-6  # s


def test_without_its_time_nothing_changes(known: Configuration) -> None:
    scenario = known.scenario()
    counts = scenario.device.sensor.replace(quantum=1e-6)  # those of the configured sensor
    scenario = scenario.replace(device=scenario.device.replace(sensor=counts))
    bare = ebac.simulate(
        scenario, known.design(), through="can", limits=known.limits,
        soft_start=known.soft_start, ramp_down=known.ramp_down,
    )  # fmt: skip
    prompt = known.simulate(bus_time=False)
    for name in bare:
        assert prompt[name].tobytes() == bare[name].tobytes(), name


def test_answers_that_the_loop_does_not_wait_for_are_late_and_a_tick_old(
    known: Configuration,
) -> None:
    trace = known.replace(answer_share=0.53).simulate()
    late = np.diff(trace["bus.missing"][:, 1]) > 0
    assert 0.002 < late.mean() < 0.9
    assert (trace["bus.age"][1:, 1] == late).all()
    assert trace["bus.missing"][-1, 0] == trace["bus.missing"][0, 0]
    assert trace["bus.late"][-1, 1] >= late.sum() - 1


@pytest.mark.parametrize("share", [0.4, 0.5])
def test_a_loop_that_waits_too_briefly_is_refused_with_both_times(
    known: Configuration, share: float
) -> None:
    """0.4: no answer can come; 0.5: at rest, where data are zeros and most bits are stuffed, none does."""
    text = (
        rf"the loop waits {1000 * share:.0f} us for answers, .* after 477 to 760 us at 1000 kbit/s"
    )
    with pytest.raises(ValueError, match=text):
        known.replace(answer_share=share).simulate()


def test_a_slow_bus_is_refused_with_its_load(known: Configuration) -> None:
    with pytest.raises(ValueError, match="must be at most 90 %"):
        with_bus(known, bit_rate=250e3).simulate()


@pytest.mark.parametrize("node", [1, 2])
def test_a_drive_off_the_bus_ends_the_run_without_force(known: Configuration, node: int) -> None:
    with pytest.raises(ebac.LoopFault) as caught:
        with_bus(known, broken=node, broken_from=0.5).simulate()
    trace = caught.value.trace
    assert caught.value.fault is ebac.Fault.DRIVE_SILENT
    first = int((trace["fault"] != 0).argmax())
    assert 500 < first <= 500 + SILENT + 3
    assert f"fault 9 (drive silent) of axis {node - 1} (no process data for " in str(caught.value)
    assert (trace["current"][first:] == 0).all()
    assert (trace["bus.target_permille"][first + 1 :] == 0).all()


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**31), rate=st.floats(0.0, 0.3))
def test_whatever_is_destroyed_a_run_ends_well_or_by_name(seed: int, rate: float) -> None:
    known = with_bus(Configuration.load(EXAMPLE), error_rate=rate, seed=seed)
    try:
        trace = known.simulate(seconds=0.3)
    except ebac.LoopFault as error:
        trace = error.trace
    except ValueError as error:
        assert "did not reach operation enabled" in str(error)  # noqa: PT017
        return
    fault = ebac.Fault(int(trace["fault"][-1]))
    assert fault.name in ("NONE", "DRIVE_SILENT", "BUS_DOWN", "DRIVE_EMERGENCY", "DRIVE_FAULT")
    assert (trace["current"][trace["fault"] != 0] == 0).all()
    assert len(under_the_law(trace)) == 301 or fault is not ebac.Fault.NONE


def test_a_seed_gives_the_same_rows(known: Configuration) -> None:
    def rows(seed: int) -> bytes:
        trace = with_bus(known, error_rate=0.02, seed=seed).simulate()
        return b"".join(trace[name].tobytes() for name in trace)

    assert rows(1) == rows(1)
    assert rows(1) != rows(2)


def test_the_table_of_a_configuration(tmp_path: Path) -> None:
    text = EXAMPLE.read_text() + "\n[simulated.bus]\nresponse = 2e-4\nerror_rate = 0.01\n"
    bus = Configuration.from_toml(text).timed_bus()
    assert (bus.response, bus.error_rate, bus.bit_rate) == (2e-4, 0.01, 1e6)
    assert (bus.torque_silence, bus.loop_silence, bus.drive_heartbeat) == (0.005, 0.1, 0.1)
    for wrong in ("error_rate = 2.0", "speed = 1", "bit_rate = 1e6"):
        with pytest.raises(ConfigurationError, match=r"(must lie in|simulated\.bus)"):
            Configuration.from_toml(EXAMPLE.read_text() + f"\n[simulated.bus]\n{wrong}\n")


def test_the_warning_of_a_full_bus_counts_heartbeats() -> None:
    """Process data of three drives take 74.5 % of the bus, and four heartbeats in a tick 26 % more."""
    plan = _core._load_on_bus(3, 1e-3, TimedBus())
    assert [frame.id for frame in plan.frames if frame.every] == [0x701, 0x702, 0x703, 0x764]
    assert plan.share == pytest.approx(0.745 + 3 * 65e-6 / 0.1 + 65e-6 / 0.03)
    assert _core._load_on_bus(3, 1e-3, None).share == pytest.approx(0.745)
    device = ebac.Device(kinematics=ebac.Linear(axes=3))
    bus = TimedBus(drive_heartbeat=1e-3, loop_silence=0.01, answer_share=0.9)
    with pytest.raises(ValueError, match=r"take 1005 us of each 1000 us, .* must be at most 90 %"):
        ebac.simulate(ebac.Scenario(device=device, seconds=0.1), through="can", bus=bus)


def test_a_bus_needs_a_run_through_it() -> None:
    with pytest.raises(ValueError, match="give through='can' as well"):
        ebac.simulate(ebac.Scenario(seconds=0.1), bus=TimedBus())


def test_the_command_with_and_without_the_time_of_the_bus() -> None:
    words = ["run", str(EXAMPLE), "--virtual", "--seconds", "1", "--json"]
    timed, prompt = (
        json.loads(CliRunner().invoke(app, [*words, *more]).stdout)["rows"][0]
        for more in ([], ["--no-bus-time"])
    )
    assert timed["law"] == prompt["law"]
    assert timed != prompt


def test_the_command_counts_late_answers(tmp_path: Path) -> None:
    file = tmp_path / "joystick.toml"
    file.write_text(EXAMPLE.read_text().replace("[bus]", "[bus]\nanswer_share = 0.53", 1))
    words = ["run", str(file), "--virtual", "--seconds", "1", "--no-files"]
    shown = " ".join(CliRunner().invoke(app, words).stdout.split())
    assert "answers came after the loop had stopped waiting" in shown


def test_the_doctor_finds_the_limits_that_a_run_refuses(tmp_path: Path) -> None:
    file = tmp_path / "joystick.toml"
    text = EXAMPLE.read_text().replace(
        "[limits]", "[limits]\nthermal_time = 41\npeak_current = 50", 1
    )
    file.write_text(text)
    ran = CliRunner().invoke(app, ["doctor", str(file), "--json"])
    assert ran.exit_code == 1
    rows = {row["what"]: row for row in json.loads(ran.stdout)["rows"]}
    for limit, value in (("limits.thermal_time", "41 s"), ("limits.peak_current", "50 A")):
        assert rows[limit]["verdict"] == "bad"
        assert f"{limit} = {value}: is beyond the " in rows[limit]["found"]
        assert ", line " in rows[limit]["found"]
        assert "--beyond-rating" in rows[limit]["remedy"]
    file.write_text(EXAMPLE.read_text())
    rows = json.loads(CliRunner().invoke(app, ["doctor", str(file), "--json"]).stdout)["rows"]
    assert not [row for row in rows if row["what"].startswith("limits.")]


def test_the_doctor_finds_a_motor_whose_time_constant_is_not_given(tmp_path: Path) -> None:
    file = tmp_path / "joystick.toml"
    text = EXAMPLE.read_text() + "\n[device.motor]\nrotor_inertia = 14e-7\n"
    for more, verdicts in (("", ["fair"]), ("thermal_time = 12.0\n", [])):
        file.write_text(text.replace("[limits]", f"[limits]\n{more}#", 1))
        rows = json.loads(CliRunner().invoke(app, ["doctor", str(file), "--json"]).stdout)["rows"]
        found = [row for row in rows if row["what"] == "limits.thermal_time"]
        assert [row["verdict"] for row in found] == verdicts
        for row in found:
            assert "16 s of an RE 30 are taken, but [device.motor] is another motor" in row["found"]
            assert "from its data sheet" in row["remedy"]


def test_the_doctor_finds_drives_that_let_through_more_than_their_motor_takes(
    tmp_path: Path,
) -> None:
    file = tmp_path / "joystick.toml"
    file.write_text(EXAMPLE.read_text() + "[device.drive]\npeak_ratio = 2.0\n")
    rows = json.loads(CliRunner().invoke(app, ["doctor", str(file), "--json"]).stdout)["rows"]
    found = {row["what"]: row for row in rows if row["what"].startswith("the drives' ")}
    assert len(found) == 3
    largest = found["the drives' limits.max_torque"]
    assert largest["verdict"] == "fair"
    assert "nodes 1, 2 of the built-in joystick: limits.max_torque = 0.212 N m" in largest["found"]
    assert largest["remedy"].startswith("give at most 0.106 in the profile")


@pytest.mark.parametrize(
    ("share", "verdict"),
    [(0.85, "good"), (0.78, "fair"), (0.7, "fair"), (0.5, "fair"), (0.4, "bad")],
)
def test_the_doctor_compares_both_times(tmp_path: Path, share: float, verdict: str) -> None:
    file = tmp_path / "joystick.toml"
    file.write_text(EXAMPLE.read_text().replace("[bus]", f"[bus]\nanswer_share = {share}", 1))
    told = json.loads(CliRunner().invoke(app, ["doctor", str(file), "--json"]).stdout)
    (row,) = [row for row in told["rows"] if row["what"] == "the bus, one tick"]
    assert row["verdict"] == verdict
    assert "answers after 477 to 760 us" in row["found"]
    assert ("answer_share" in (row["remedy"] or "")) == (verdict != "good")


def test_the_doctor_says_that_a_run_replaces_the_sync_period_of_a_profile(tmp_path: Path) -> None:
    def periods(setup: str, dt: str) -> tuple[list[dict[str, str]], str]:
        file = tmp_path / "joystick.toml"
        text = EXAMPLE.read_text().replace("dt = 1e-3", f"dt = {dt}", 1)
        file.write_text(text.replace('setup = "verify"', f'setup = "{setup}"', 1))
        rows = json.loads(CliRunner().invoke(app, ["doctor", str(file), "--json"]).stdout)["rows"]
        (bus,) = [row["found"] for row in rows if row["what"] == "the bus, one tick"]
        return [row for row in rows if row["what"].endswith("period of SYNC")], bus

    same, slow = periods("verify", "1e-3")
    assert same == []
    verified, fast = periods("verify", "2e-3")
    assert [row["what"] for row in verified] == ["node 1, period of SYNC", "node 2, period of SYNC"]
    assert "sync.period = 0.001 s in its profile, timing.dt = 0.002 s" in verified[0]["found"]
    assert verified[0]["verdict"] == "fair"
    assert "sync.period = 0.002" in verified[0]["remedy"]
    assert slow.rpartition("load")[2] != fast.rpartition("load")[2]  # the load is that of the loop
    written, _ = periods("apply", "2e-3")
    assert [(row["verdict"], row["remedy"]) for row in written] == [("good", None)] * 2
    assert "writes it" in written[0]["found"]
