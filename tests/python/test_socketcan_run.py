"""The whole of a run over SocketCAN: loop on the virtual interface that EBAC_CAN names, drives in another process.

`.ci/socketcan/run` gives an interface, under an emulated kernel on a slow core: the loop runs at 25 Hz there, so that
its threads, which run before all others, leave time for the test.
"""

import os
import re
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
from forked_program import ForkedProgram

import ebac
from ebac import drives
from ebac.hardware import Configuration, PositionError, under_the_law

INTERFACE = os.environ.get("EBAC_CAN", "")
EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
DT = 0.04  # s
PATIENCE = 180.0  # s

pytestmark = pytest.mark.skipif(
    not INTERFACE, reason="EBAC_CAN names no virtual CAN interface to test on"
)


@pytest.fixture
def config(tmp_path: Path) -> Path:
    """The example on the interface of the test, slow and patient; a wall that 25 Hz can render."""
    text = EXAMPLE.read_text(encoding="utf-8")
    for before, after in (
        ('"can0"', f'"{INTERFACE}"'),
        ("[bus]", "[bus]\nsilent = 500"),
        ('setup = "verify"', 'setup = "apply"'),
        ("dt = 1e-3", f"dt = {DT}"),
        ("stiffness = 10e3", "stiffness = 50.0"),
        ("[limits]", "[limits]\noverruns = 100000\npause = 1000.0\nforce_age = 10.0\njump = 0.05"),
        ("seconds = 10.0", "seconds = 3.0"),
    ):
        assert before in text, before
        text = text.replace(before, after)
    path = tmp_path / "joystick.toml"
    path.write_text(text, encoding="utf-8")
    assert Configuration.load(path).timing.dt == DT
    return path


@contextmanager
def served(config: Path) -> Iterator[ForkedProgram]:
    """Simulated drives, device, hand and sensor in another process; the configuration says where the sensor is."""
    scenario = config.with_name("scenario.toml")
    Configuration.load(config).scenario(seconds=10).save(scenario)
    words = ["drive", "simulate", "--channel", INTERFACE, "--scenario", str(scenario)]
    with ForkedProgram(*words, "--wait-for-power", "--until-eof", "--sensor") as process:
        said = process.stdout.readline()
        port = re.search(r"force sensor at 127\.0\.0\.1:(\d+)", said)
        assert port, said
        text = config.read_text(encoding="utf-8")
        there = f'host = "127.0.0.1"\nport = {port[1]}\nhttp_port = 0'
        config.write_text(text.replace('host = "192.168.1.1"', there), encoding="utf-8")
        try:
            yield process
        finally:
            process.stdin.close()
            process.wait(timeout=PATIENCE)


def states() -> list[drives.State]:
    with drives.DriveBus.open(interface="socketcan", channel=INTERFACE) as bus:
        return [bus.drive(node, timeout=2.0).state for node in (1, 2)]


def has_rows(folder: Path) -> bool:
    """Whether a log in a folder, perhaps not written as far as its columns, holds rows by now."""
    with suppress(ValueError):
        return any(len(ebac.logs.read(path).trace) > 0 for path in folder.glob("*.mcap"))
    return False


def test_hardware_is_what_stands_on_the_interface(config: Path, tmp_path: Path) -> None:
    with served(config), ebac.Device.open(config) as device:
        with pytest.raises(PositionError, match="confirm_zero"):
            device.run("ebac")
        assert [one.counts for one in device.positions()] == [0, 0]
        device.confirm_zero()
        trace = device.run("ebac", log=tmp_path / "run.mcap")
        assert states() == [drives.State.SWITCH_ON_DISABLED] * 2
    part = under_the_law(trace)
    assert len(part) == round(3 / DT)
    assert np.abs(part["f_applied"][:, 0]).max() > 0.1  # N: the wall was felt
    assert np.abs(part["f_meas"][:, 0]).max() > 0.1  # N: and the hand, over UDP
    assert device.report is not None
    assert device.report.drives == ("switch on disabled",) * 2
    log = ebac.logs.read(tmp_path / "run.mcap")
    assert log.condition.complete
    assert len(log.trace) == device.report.ticks


def test_simulated_means_another_process_whose_hand_is_told_where_to_go(
    config: Path, tmp_path: Path
) -> None:
    text = config.read_text(encoding="utf-8")
    for before, after in (
        ('type = "Wall"', 'type = "Free"'),
        ("stiffness = 50.0", ""),
        ("position = 0.01", ""),
        ("at = 0.5", "at = 500"),
    ):
        assert before in text, before
        text = text.replace(before, after)
    config.write_text(text, encoding="utf-8")
    with ebac.Device.open(config, simulate=True) as device:
        assert device.backend.interface == "socketcan"
        assert "another process" in device.backend.about
        with device.start(seconds=60, log=tmp_path / "run.mcap") as run:
            end = time.monotonic() + PATIENCE
            while run.state is not ebac.LoopState.RUN:
                assert time.monotonic() < end
                time.sleep(0.05)
            assert run.set_target(-0.02) == (-0.02, None)
            while run.tail(1)["x"][-1, 0] > -0.015:
                assert not run.done
                assert time.monotonic() < end
                time.sleep(0.05)
            run.stop()
        run.finish()
        names = [grant.name for grant in run.grants]
        assert "priority of the simulated drives" in names
        assert "priority of the simulated sensor" in names
    (event,) = [e for e in ebac.logs.read(tmp_path / "run.mcap").events if e.kind == "parameter"]
    assert event.values == {"hand.target_0": -0.02}


def test_a_killed_loop_leaves_the_drives_to_their_own_watch(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ["run", str(config), "--out", str(out), "--no-live", "--yes", "--seconds", "600"]
    with served(config), ForkedProgram(*words) as process:
        end = time.monotonic() + PATIENCE
        # Rows come when the drives are set up: before, this test by SDO would disturb the run by SDO.
        while not has_rows(out) or states() != [drives.State.OPERATION_ENABLED] * 2:
            assert process.poll() is None
            assert time.monotonic() < end
            time.sleep(0.2)
        process.kill()
        assert process.wait(PATIENCE) == -signal.SIGKILL
        while drives.State.OPERATION_ENABLED in (now := states()) and time.monotonic() < end:
            time.sleep(0.05)
        assert drives.State.OPERATION_ENABLED not in now
    (log,) = out.glob("*.mcap")
    assert len(ebac.logs.repair(log).trace) > 0
