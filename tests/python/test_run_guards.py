"""What a run checks before it has power, and what stops it at once: rating, sensor's page, any key."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import ebac
from ebac.cli.run.any_key import any_key
from ebac.hardware import Configuration
from ebac.sensor import SensorConfig, SensorError, SimulatedSensor

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"


@pytest.mark.parametrize("name", ["continuous_current", "peak_current", "thermal_time"])
def test_limits_beyond_the_motor_are_refused_before_any_drive_is_met(name: str) -> None:
    known = Configuration.load(EXAMPLE)
    rated = ebac.Limits.of(known.device)
    beyond = {name: 1.1 * getattr(rated, name)}
    if name == "continuous_current":
        beyond["peak_current"] = rated.peak_current
    unmet = known.replace(
        limits=known.limits.replace(**beyond), interface="socketcan", channel="none0"
    )
    with pytest.raises(
        ebac.hardware.ConfigurationError, match=rf"limits\.{name} = .*`ebac run --beyond-rating`"
    ):
        ebac.Device.open(unmet)
    with pytest.raises(ebac.drives.BusError, match="none0"):  # and on: the next thing that is wrong
        ebac.hardware.OpenDevice.open(unmet.replace(sensor=None), beyond_rating=True)


@pytest.fixture(scope="module")
def page() -> Iterator[int]:
    with SimulatedSensor(http_port=0) as sensor:
        assert sensor.http_address is not None
        yield sensor.http_address[1]


def test_a_sensor_that_scales_otherwise_is_refused(page: int) -> None:
    here = SensorConfig(host="127.0.0.1", http_port=page)
    here.check_scale()
    here.replace(http_port=0, counts_per_force=7).check_scale()  # nothing to compare with
    with pytest.raises(SensorError, match=r"counts_per_force = 500000: the page .* has 1e\+06"):
        here.replace(counts_per_force=5e5).check_scale()
    with pytest.raises(SensorError, match=r"counts_per_torque"):
        here.replace(counts_per_torque=1.002e6).check_scale()


def test_a_simulated_sensor_names_its_own_page() -> None:
    with SimulatedSensor(http_port=0) as sensor:
        assert sensor.http_address == ("127.0.0.1", sensor.config.http_port)
        sensor.config.check_scale()
    assert SimulatedSensor().config.http_port == 0  # it has none


def test_a_sensor_without_its_page_is_reported() -> None:
    with pytest.warns(UserWarning, match=r"not compared .*http_port = 0"):
        SensorConfig(host="127.0.0.1", http_port=9).check_scale()


class Stopped:
    """A run that notes how it was stopped."""

    def __init__(self) -> None:
        self.asked: list[tuple[bool, str]] = []

    def stop(self, *, at_once: bool = False, by: str = "stop") -> None:
        self.asked.append((at_once, by))


def test_any_key_stops_a_run_at_once_and_the_terminal_is_as_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import termios

    ours, theirs = os.openpty()
    with (
        os.fdopen(theirs, "rb", buffering=0) as terminal,
        os.fdopen(ours, "wb", buffering=0) as keys,
    ):
        monkeypatch.setattr(sys, "stdin", terminal)
        monkeypatch.setattr(os, "tcgetpgrp", lambda _: os.getpgrp())
        before, run = termios.tcgetattr(terminal), Stopped()
        with any_key() as look:
            look(run)  # type: ignore[arg-type]
            assert run.asked == []
            keys.write(b"q")
            look(run)  # type: ignore[arg-type]
            assert run.asked == [(True, "key")]
        assert termios.tcgetattr(terminal) == before
        monkeypatch.setattr(os, "tcgetpgrp", lambda _: os.getpgrp() + 1)  # in the background
        with any_key() as look:
            assert termios.tcgetattr(terminal) == before
            keys.write(b"q\n")
            look(run)  # type: ignore[arg-type]
        assert len(run.asked) == 1


def test_without_a_terminal_no_key_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    with Path(os.devnull).open("rb") as empty:
        for nothing in (None, empty):
            monkeypatch.setattr(sys, "stdin", nothing)
            with any_key() as look:
                look(Stopped())  # type: ignore[arg-type]
