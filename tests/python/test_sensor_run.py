"""A run in real time with a force sensor that fails on the way. No test asserts a deadline."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

import ebac
from ebac.hardware import Configuration, OpenDevice, Run, under_the_law
from ebac.sensor import EmulatorTrouble, SimulatedSensor

pytestmark = pytest.mark.real_time

Desk: TypeAlias = tuple[OpenDevice, SimulatedSensor]
AtTick: TypeAlias = Callable[[int, Callable[[], None]], Callable[[Run], None]]
EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"


def configuration() -> Configuration:
    """The example, patient with a busy machine in all but its force sensor."""
    known = Configuration.load(EXAMPLE)
    hand = known.hand.replace(
        path=[ebac.MinimumJerk(target=0.04, at=0, duration=0.2), ebac.Step(target=0)]
    )
    limits = known.limits.replace(overruns=100_000, pause=100, jump=1.0, speed=100.0, force_age=0.3)
    return known.replace(silent=1000, limits=limits, soft_start=0.05, ramp_down=0.05, hand=hand)


@pytest.fixture
def desk(
    open_with_sensor: Callable[[Configuration], AbstractContextManager[Desk]],
) -> Iterator[Desk]:
    """Give a device with a sensor that works; a new one, as drives in fault stay so."""
    with open_with_sensor(configuration()) as made:
        yield made


@pytest.mark.parametrize("law", [pytest.param("tca", marks=pytest.mark.slow), "ebac"])
def test_the_force_that_is_felt_comes_back_over_the_network(desk: Desk, law: str) -> None:
    device, sensor = desk
    wall = ebac.Wall(stiffness=2e3, position=0.01)  # soft enough for either law
    trace = under_the_law(device.run(law, wall, seconds=1.5))
    push = float(trace["f_meas"][-500:, 0].mean())
    assert push > 3  # N
    # At rest the hand pushes as hard as the motor holds: two ways to the same force.
    assert push == pytest.approx(float(trace["f_applied"][-500:, 0].mean()), rel=0.05)
    assert trace["ft.received"][-1, 0] > 1000
    assert trace["ft.lost"][-1, 0] == sensor.counts.dropped == 0
    assert (trace["ft.malformed"] == 0).all()


@pytest.mark.parametrize(
    ("trouble", "fault"),
    [
        (EmulatorTrouble(silent=True), ebac.Fault.FORCE_STALE),
        (EmulatorTrouble(status=0x80020000), ebac.Fault.FORCE_SATURATED),
        (EmulatorTrouble(status=0x80000004), ebac.Fault.FORCE_ERROR),
    ],
)
def test_a_sensor_that_fails_ends_the_run_by_name(
    desk: Desk, at_tick: AtTick, trouble: EmulatorTrouble, fault: ebac.Fault
) -> None:
    device, sensor = desk
    with pytest.raises(ebac.LoopFault) as caught:
        device.run(seconds=60, look=at_tick(200, lambda: sensor.inject(trouble)))
    error = caught.value
    assert error.fault is fault
    row = int(np.argmax(error.trace["fault"] != 0))
    assert (error.trace["current"][row:] == 0).all()
    assert (error.trace["f_applied"][-1] == 0).all()
    report = device.report
    assert report is not None
    assert report.drives == ("switch on disabled",) * 2


def test_a_simulated_sensor_has_the_bias_of_the_device_and_no_zero_of_its_own() -> None:
    known = configuration()
    assert known.sensor is not None
    biased = known.replace(
        device=known.device.replace(sensor=known.device.sensor.replace(bias=2.0)),
        sensor=known.sensor.replace(bias=(3.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    )
    with ebac.Device.open(biased, simulate=True) as device:
        trace = device.run("tca", ebac.Free(), seconds=0.1)
    assert trace["f_meas"][5, 0] == pytest.approx(2.0, abs=0.5)
    assert biased.simulate(seconds=0.1)["f_meas"][5, 0] == pytest.approx(2.0, abs=0.5)


def test_a_simulated_sensor_sends_as_many_records_as_its_period_says() -> None:
    """A sensor of 500 Hz sent 1000 records a second, every second one a repetition."""
    known = configuration()
    own = known.device.sensor.replace(period=0.002, noise=0.03)
    slow = known.replace(device=known.device.replace(sensor=own))
    with ebac.Device.open(slow, simulate=True) as device:
        trace = under_the_law(device.run(seconds=1.5))
    span = trace["t"][-1] - trace["t"][0]
    received = np.diff(trace["ft.received"][[0, -1], 0])[0]
    assert received / span == pytest.approx(500, rel=0.05)
    changes = np.count_nonzero(np.diff(trace["f_meas"][:, 0]))
    assert changes / received == pytest.approx(1, abs=0.1)


def test_a_run_without_its_sensor_does_not_begin(desk: Desk) -> None:
    device, sensor = desk
    sensor.inject(EmulatorTrouble(silent=True))
    with pytest.raises(ebac.LoopFault) as caught:
        device.run(seconds=60)
    assert caught.value.fault is ebac.Fault.FORCE_DISCONNECTED
    assert set(caught.value.trace["state"]) <= {1, 3}  # it never ran
    assert (caught.value.trace["current"] == 0).all()


def test_losses_on_the_way_are_counted_and_do_not_stop_it(desk: Desk) -> None:
    device, sensor = desk
    sensor.inject(EmulatorTrouble(loss=0.1, duplicate=0.1, reorder=0.1))
    trace = device.run("ebac", ebac.Free(), seconds=1)
    assert trace["fault"][-1] == 0
    assert 50 < trace["ft.lost"][-1, 0] < 300
    assert trace["ft.late"][-1, 0] > 30
    assert trace["ft.duplicate"][-1, 0] > 30
