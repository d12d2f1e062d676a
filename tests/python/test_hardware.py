"""A law on simulated drives in real time. No test asserts a deadline: the machine decides when a thread wakes."""

import gc
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

import numpy as np
import pytest

import ebac
from ebac import drives
from ebac._core import SharedHandTarget
from ebac._util.child_processes import Child, end, first_lines, text
from ebac.hardware import (
    Configuration,
    OpenDevice,
    Run,
    Terminated,
    backends,
    drives_subprocess,
    times,
    under_the_law,
)

pytestmark = pytest.mark.real_time

#: The fixture: waits for something that happens while a loop runs.
Until = Callable[[Run, Callable[[], bool]], None]

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"


def configuration(**changes: object) -> Configuration:
    """The example, patient with a busy machine, and quick."""
    known = Configuration.load(EXAMPLE)
    hand = known.hand.replace(
        path=[ebac.MinimumJerk(target=0.04, at=0, duration=0.2), ebac.Step(target=0)]
    )
    # An answer that comes after others were missed looks like a leap.
    patient = known.limits.replace(overruns=100_000, pause=100, force_age=10, jump=1.0, speed=100.0)
    return known.replace(
        silent=1000, limits=patient, soft_start=0.05, ramp_down=0.05, hand=hand
    ).replace(**changes)


@pytest.fixture
def device() -> "ebac.hardware.OpenDevice":  # type: ignore[misc]
    with ebac.Device.open(configuration(), simulate=True) as opened:
        yield opened


def states(place: object) -> list[drives.State]:
    with drives.DriveBus.open(interface=place.interface, channel=place.channel) as bus:  # type: ignore[attr-defined]
        return [bus.drive(node).state for node in (1, 2)]


@pytest.mark.slow
def test_a_run_is_rows_a_log_and_drives_without_power(device: OpenDevice, tmp_path: Path) -> None:
    trace = device.run("ebac", seconds=1, log=tmp_path / "run.mcap")
    part = under_the_law(trace)
    assert len(part) == 1000
    assert set(trace["state"]) == {1, 2, 3}
    assert (trace["f_applied"][-1] == 0).all()
    assert np.abs(part["f_applied"][:, 0]).max() > 1  # N: the wall was felt
    report = device.report
    assert report is not None
    assert report.ended_by == "time"
    assert report.drives == ("switch on disabled",) * 2
    assert report.lost_rows == 0
    assert report.recorded == report.ticks == len(trace)
    log = ebac.logs.read(tmp_path / "run.mcap")
    assert log.condition.complete
    assert len(log.trace) == len(trace)
    assert (log.trace["tick"] == trace["tick"]).all()
    assert (log.trace["x"] == trace["x"]).all()
    assert ebac.contact(trace) == ebac.contact(part)
    found = times(part)
    assert 0 < found.compute_p50_s <= found.compute_p99_9_s <= found.compute_most_s
    assert device.run("tca", ebac.Free(), seconds=0.1).law == "tca"  # and again, on the same device
    assert states(device.backend) == [drives.State.SWITCH_ON_DISABLED] * 2


def test_what_changes_while_it_runs_acts_and_is_in_the_log(
    device: OpenDevice, tmp_path: Path, until: Until
) -> None:
    with device.start("eba", seconds=30, log=tmp_path / "run.mcap") as run:
        until(run, lambda: run.state is ebac.LoopState.RUN and run.ticks >= 300)
        assert run.retune(share=0.5).share == 0.5  # type: ignore[attr-defined]
        assert run.change(stiffness=1e3).stiffness == 1e3  # type: ignore[union-attr]
        with pytest.raises(ValueError, match=r"mm inside the wall, which would throw it out"):
            run.change(position=-0.04)
        with pytest.raises(ValueError, match=r"share = 7: must lie in"):
            run.retune(share=7.0)
        with pytest.raises(ValueError, match=r"cannot change from .* while the loop runs"):
            run.retune(damping=1.0)
        seen = run.ticks
        until(run, lambda: run.ticks >= seen + 100)
        tail = run.tail(50)
        assert len(tail) == 50
        inside = tail["x"][:, 0] > 0.0101
        if inside.any():
            depth = tail["x"][inside, 0] - 0.01
            assert np.allclose(tail["f_env"][inside, 0], 1e3 * depth)
        run.stop()
    trace = run.finish()
    assert run.report is not None
    assert run.report.ended_by == "stop"
    with pytest.raises(RuntimeError, match="has ended"):
        run.retune(share=1.0)
    events = [e for e in ebac.logs.read(tmp_path / "run.mcap").events if e.kind == "parameter"]
    assert [sorted(e.values) for e in events] == [["law.share"], ["environment.stiffness"]]
    at = events[1].tick
    row = int(np.searchsorted(trace["tick"], at))
    assert events[1].t == trace["t"][row]


def test_a_run_is_gone_with_its_rows_as_soon_as_nobody_holds_it_and_its_device() -> None:
    gc.disable()
    try:
        with ebac.Device.open(configuration(), simulate=True) as opened:
            run = opened.start("eba", seconds=0.1)
            run.finish()
        gone = weakref.ref(run)
        del run, opened
        end = time.monotonic() + 10  # until the thread that looks after the parent has noticed
        while gone() is not None and time.monotonic() < end:
            time.sleep(0.01)
        assert gone() is None
    finally:
        gc.enable()


def test_a_fault_is_one_exception_with_the_last_rows(tmp_path: Path) -> None:
    known = configuration()
    strict = known.replace(limits=known.limits.replace(speed=0.02))
    with (
        ebac.Device.open(strict, simulate=True) as device,
        pytest.raises(ebac.LoopFault, match="fault 14") as caught,
    ):
        device.run(seconds=5, log=tmp_path / "run.mcap")
    assert caught.value.fault is ebac.Fault.OVERSPEED
    trace = caught.value.trace
    first = int((trace["fault"] != 0).argmax())
    assert f"tick {trace['tick'][first]}" in str(caught.value)
    assert (trace["current"][first + 1 :] == 0).all()
    assert device.report is not None
    assert device.report.ended_by == "fault"
    assert device.report.drives == ("switch on disabled",) * 2
    log = ebac.logs.read(tmp_path / "run.mcap")
    assert log.condition.complete
    assert [e.values["fault"] for e in log.events if e.kind == "fault"] == [14]


@pytest.mark.slow
def test_drives_that_go_away_leave_the_fault_and_the_rows(
    monkeypatch: pytest.MonkeyPatch, until: Until
) -> None:
    served: list[Any] = []
    at_work = backends.at_work

    def kept(what: Any, *rest: Any) -> Any:
        served.append(what)
        return at_work(what, *rest)

    monkeypatch.setattr(backends, "at_work", kept)
    monkeypatch.setattr(backends, "virtual_can", lambda: None)
    monkeypatch.setattr(backends, "_PATIENCE", 1.0)
    with ebac.Device.open(configuration(silent=20), simulate=True) as device:
        run = device.start(seconds=30)
        until(run, lambda: run.ticks > 300)
        served[0].stop()
        run.wait()
        with pytest.raises(drives.DriveError, match="did not answer") as caught:
            run.end()
    fault = caught.value.__cause__
    assert isinstance(fault, ebac.LoopFault)
    assert fault.fault is ebac.Fault.DRIVE_SILENT
    assert len(fault.trace) > 300
    assert "fault 9 (drive silent)" in "".join(caught.value.__notes__)
    assert run.report is not None
    assert run.report.ended_by == "fault"


def test_after_a_fault_a_run_wants_a_reset(device: OpenDevice) -> None:
    known = configuration()
    device.configuration = known.replace(limits=known.limits.replace(speed=0.02))
    with pytest.raises(ebac.LoopFault):
        device.run(seconds=5)
    device.configuration = known
    for _ in range(2):
        with pytest.raises(RuntimeError, match=r"ended by a fault.*call `reset\(\)`"):
            device.run(seconds=0.1)
    assert states(device.backend) == [drives.State.SWITCH_ON_DISABLED] * 2
    device.reset()
    device.run("ebac", ebac.Free(), seconds=0.1)  # by now the hand may be where the wall was
    assert device.report is not None
    assert device.report.ended_by == "time"


def test_a_second_ctrl_c_leaves_out_the_ramp() -> None:
    known = configuration(ramp_down=10.0)
    with ebac.Device.open(known, simulate=True) as device:
        timer = threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT])
        start = time.monotonic()

        def look(run: Run) -> None:
            if run.ticks > 200:
                timer.start()
                os.kill(os.getpid(), signal.SIGINT)

        with pytest.raises(KeyboardInterrupt):
            device.run(seconds=60, look=look)
        timer.join()
        assert 0.5 < time.monotonic() - start < 8
        assert states(device.backend) == [drives.State.SWITCH_ON_DISABLED] * 2


def test_an_exception_ends_the_run_and_comes_after_it(device: OpenDevice, tmp_path: Path) -> None:
    class Mine(Exception):
        pass

    def look(run: Run) -> None:
        if run.ticks > 200:
            raise Mine

    with pytest.raises(Mine):
        device.run(seconds=60, log=tmp_path / "run.mcap", look=look)
    assert device.report is not None
    assert device.report.ended_by == "exception"
    assert states(device.backend) == [drives.State.SWITCH_ON_DISABLED] * 2
    assert ebac.logs.read(tmp_path / "run.mcap").condition.complete


@pytest.mark.parametrize(
    ("number", "raised"),
    [
        (signal.SIGINT, KeyboardInterrupt),
        (signal.SIGTERM, Terminated),
        (signal.SIGHUP, Terminated),
        (signal.SIGQUIT, Terminated),
        (signal.SIGTSTP, Terminated),
        (signal.SIGUSR1, Terminated),
        (signal.SIGALRM, Terminated),
    ],
)
def test_a_signal_ends_it_and_a_second_one_does_no_harm(
    device: OpenDevice, tmp_path: Path, number: signal.Signals, raised: type[BaseException]
) -> None:
    def look(run: Run) -> None:
        if run.ticks > 200:
            os.kill(os.getpid(), number)
            time.sleep(1)

    with pytest.raises(raised):
        device.run(seconds=60, log=tmp_path / "run.mcap", look=look)
    assert device.report is not None
    assert device.report.ended_by == number.name
    assert device.report.drives == ("switch on disabled",) * 2
    assert ebac.logs.read(tmp_path / "run.mcap").condition.complete


def test_signals_are_python_s_again_afterwards() -> None:
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    with ebac.Device.open(configuration(), simulate=True):
        assert signal.getsignal(signal.SIGTERM) not in before
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


@pytest.mark.slow
def test_a_device_that_is_forgotten_stops(tmp_path: Path, until: Until) -> None:
    opened = ebac.Device.open(configuration(), simulate=True)
    run = opened.start(seconds=60, log=tmp_path / "run.mcap")
    until(run, lambda: run.ticks >= 100)
    del opened
    gc.collect()
    assert run.done
    assert run.report is not None
    assert run.report.drives == ("switch on disabled",) * 2
    assert ebac.logs.read(tmp_path / "run.mcap").condition.complete


@pytest.mark.slow
@pytest.mark.weekly
def test_long_runs_keep_the_last_rows_in_memory_and_all_on_disk(tmp_path: Path) -> None:
    known = configuration(memory=1.0)
    with ebac.Device.open(known, simulate=True) as device:
        run = device.start(seconds=6.5, log=tmp_path / "run.mcap")
        with run:
            run.wait()
        trace = run.finish()
    report = device.report
    assert report is not None
    assert len(trace) < report.ticks == report.recorded
    log = ebac.logs.read(tmp_path / "run.mcap")
    assert len(log.trace) == report.ticks
    assert log.lost == 0
    assert (np.diff(log.trace["tick"]) == 1).all()


def test_what_cannot_be_is_refused_before_anything_moves(
    device: OpenDevice, tmp_path: Path
) -> None:
    there = tmp_path / "run.mcap"
    there.write_bytes(b"")
    with pytest.raises(FileExistsError):
        device.run(seconds=1, log=there)
    with pytest.raises(ValueError, match=r"must end in \.mcap"):
        device.run(seconds=1, log=tmp_path / "run.csv")
    with pytest.raises(ValueError, match="seconds = 0 s"):
        device.run(seconds=0)
    with pytest.raises(KeyError, match="no law is called"):
        device.run("ebca")
    assert device.report is None
    with device.start(seconds=60), pytest.raises(RuntimeError, match="under way"):
        device.start(seconds=1)


def test_without_a_sensor_a_force_loop_is_refused() -> None:
    with ebac.Device.open(configuration(sensor=None), simulate=True) as device:
        with pytest.raises(ValueError, match="no force sensor"):
            device.run("tca", kp=0.3)
        trace = device.run("tca", ebac.Free(), seconds=0.1)
        assert (trace["f_meas"] == 0).all()
        assert "kp=0.0" in trace.law_repr


def test_the_force_loop_is_closed_on_the_sensor(device: OpenDevice) -> None:
    trace = under_the_law(device.run("tca", ebac.Free(), seconds=0.5, kp=0.0))
    assert np.abs(trace["f_meas"][:, 0]).max() > 1  # N: the hand pulls the handle away
    assert (trace["ft.age"][:, 0] >= 0).all()


@pytest.mark.parametrize(
    ("profile", "watch"),
    [("copley-accelnet", "heartbeat_consumer"), ("copley-guarded", "life_time_factor")],
)
def test_drives_do_not_miss_a_loop_that_has_ended(profile: str, watch: str, tmp_path: Path) -> None:
    network = tmp_path / "network.toml"
    nodes = "".join(f'[[node]]\nid = {node}\nprofile = "{profile}"\n' for node in (1, 2))
    network.write_text(nodes, encoding="utf-8")
    known = configuration(drives=drives.load(network))

    def seen() -> list[tuple[int, int]]:  # what each drive watches, and its errors
        with drives.DriveBus.open(interface=place.interface, channel=place.channel) as bus:
            both = (bus.drive(node) for node in (1, 2))
            return [(one.number(watch), one.number((0x1003, 0))) for one in both]

    with ebac.Device.open(known, simulate=True) as device:
        place = device.backend
        watching = seen()
        assert all(watched > 0 and errors == 0 for watched, errors in watching)
        for _ in range(2):
            under_the_law(device.run(environment=ebac.Free(), seconds=0.1))
            time.sleep(0.5)
            assert seen() == watching  # and nothing lost meanwhile


def test_a_drive_that_holds_something_else_is_refused() -> None:
    known = configuration(interface="ebac", channel="joystick-test", setup="verify")
    with pytest.raises(drives.NotVerified, match="holds something else"):
        ebac.Device.open(known)


def test_a_misspelt_bus_inside_this_process_is_named() -> None:
    with pytest.raises(
        drives.DriveError, match=r"bus\.channel: .*'joystik'.* did you mean 'joystick'"
    ):
        ebac.Device.open(configuration(interface="ebac", channel="joystik"))


def test_a_bus_that_cannot_carry_it_is_refused_before_it_is_opened() -> None:
    fast = configuration(timing=ebac.Timing(dt=2e-4), interface="socketcan", channel="nobody0")
    with pytest.raises(drives.ProfileError, match="%"):
        ebac.Device.open(fast)


def test_what_simulated_drives_refuse_names_the_times_that_no_file_has() -> None:
    known = configuration()
    profile = known.drives.nodes[0].profile
    values = {**profile.values, "limits.rated_current": 0.9}
    for name in ("motor.torque_constant", "limits.max_current"):
        del values[name]
    wrong = replace(known.drives.nodes[0], profile=replace(profile, values=values))
    nodes = (wrong, *known.drives.nodes[1:])
    with pytest.raises(drives.NotApplied, match="from the data of its motor, 985 mA") as caught:
        ebac.Device.open(known.replace(drives=replace(known.drives, nodes=nodes)), simulate=True)
    (note,) = caught.value.__notes__
    assert "sync_period at least 10 ms, a watch over the loop at least 200 ms" in note


def test_a_simulated_hand_may_wait_for_power() -> None:
    from ebac._core import Joystick

    setup = configuration().scenario(seconds=10).setup()
    free, waits = Joystick(setup), Joystick(setup, wait_for_power=True)
    for joystick in (free, waits):
        for _ in range(50):
            joystick.elapse(0.01)
    assert free.truth(0).x > 0.01
    assert waits.truth(0).x == 0


def test_json_of_a_report_is_plain(device: OpenDevice) -> None:
    device.run(seconds=0.05)
    assert device.report is not None
    json.dumps(device.report.row())


# --- drives in another process ---


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="SocketCAN is Linux's")
@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (60.0, "simulated drives on vcan99: .*vcan99"),
        (0.05, r"simulated drives on vcan99: did not start within 0\.05 s"),
    ],
)
def test_drives_that_do_not_start_in_another_process_are_an_error_in_time(
    seconds: float, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drives_subprocess, "_START", seconds)
    known = configuration()
    aim = SharedHandTarget()
    with (
        pytest.raises(drives.BusError, match=words),
        drives_subprocess.in_a_process("vcan99", known, known.scenario(seconds=10), aim),
    ):
        pass


def test_what_a_process_prints_is_read_while_it_goes_on_and_stays_whole() -> None:
    """Process and reader share the place in the file."""
    lines = [f"line {i}" for i in range(20_000)]
    code = f"for i in range({len(lines)}): print('line', i, flush=True)"
    with TemporaryFile() as out, TemporaryFile() as err:
        process = subprocess.Popen([sys.executable, "-c", code], stdout=out, stderr=err)
        child = Child(process, out, err)
        while process.poll() is None:
            text(out)
        assert first_lines(child, len(lines), 1.0) == lines


def test_half_a_character_at_the_end_of_what_is_printed_is_no_error() -> None:
    with TemporaryFile() as out:
        out.write("5 µs, 3 µ".encode()[:-1])
        out.flush()
        assert text(out).startswith("5 µs, 3 ")


def test_the_first_lines_of_a_process_are_waited_for_but_not_for_ever() -> None:
    """Whatever it complains meanwhile."""
    code = (
        "import sys, time; sys.stderr.write('x' * 1_000_000)\n"
        "print('one', flush=True); print('two', end='', flush=True); time.sleep(60)"
    )
    with TemporaryFile() as out, TemporaryFile() as err:
        process = subprocess.Popen([sys.executable, "-c", code], stdout=out, stderr=err)
        child = Child(process, out, err)
        try:
            assert first_lines(child, 1, 20.0) == ["one"]
            assert first_lines(child, 2, 0.1) == ["one"]
            process.kill()
            process.wait()
            assert first_lines(child, 2, 20.0) == ["one"]
            assert len(text(err)) == 1_000_000
        finally:
            end(process)


@pytest.mark.slow
def test_the_example_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = Path(__file__).parents[2] / "docs" / "how-to" / "run_on_hardware.md"
    (code,) = re.findall(
        r"```py\n(import time\n.*?)```", page.read_text(encoding="utf-8"), re.DOTALL
    )
    patient = "overruns = 100000\npause = 100.0\nforce_age = 10.0\njump = 1.0\nspeed = 100.0\n"
    text = EXAMPLE.read_text(encoding="utf-8").replace("speed = 1.0 # m/s\n", patient)
    (tmp_path / "joystick.toml").write_text(
        text.replace("[bus]\n", "[bus]\nsilent = 1000\n"), encoding="utf-8"
    )
    monkeypatch.chdir(tmp_path)
    assert code.count("seconds=5") == 2
    exec(code.replace("seconds=5", "seconds=2"), {})
    assert (tmp_path / "run.mcap").exists()
