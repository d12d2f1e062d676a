"""Find the signs of motors and encoders: push each axis with a small current and observe its motion."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Device, Elastic, Free, Limits, LoopState, Plane, Step, Wall
from ebac.hardware.configuration import Configuration
from ebac.hardware.device import OpenDevice
from ebac.hardware.run import Run
from ebac.hardware.signs import Signs
from ebac.worlds import Body, Placed, World

#: Longest push, and pause after each [s].
PUSH, PAUSE = 0.5, 0.4
#: A push ends here; what moves less than the other did not move [m].
FAR, LEAST = 5e-3, 5e-4
#: Share of the motor's force that a hand must hold against, for the force sensor to count.
HELD = 0.3
#: Where the wall stands that pushes with a force that hardly changes [m].
_BEHIND = -1.0
#: Current of a push [A].
LEAST_CURRENT, MOST_CURRENT = 0.02, 0.3
#: Current comes in with this slope [A/s].
_SLEW = 1.0
#: The force of the loop comes in within this at most [s]: short beside a push.
_SOFT_START = 0.2
_ENDING = (LoopState.STOP, LoopState.IDLE, LoopState.FAULT)


@dataclass(frozen=True, kw_only=True)
class AxisSigns:
    """Result of the pushes of one axis.

    Attributes
    ----------
    axis, node : int
        Number of the axis, from 0, and node id of its drive.
    configured_motor, configured_encoder : int
        The signs of the configuration.
    motor, encoder : int or None
        The correct signs; None if the axis did not move, or not in both directions.
    moved_m : float
        Motion along +x under a positive force, mean of both directions [m]; negative is correct.
    force_N : float or None
        Reading of the force sensor against a positive force [N]; positive is correct, None if no hand held the handle.
    remark : str
        The result in words.
    """

    axis: int
    node: int
    configured_motor: int
    configured_encoder: int
    motor: int | None
    encoder: int | None
    moved_m: float
    force_N: float | None
    remark: str

    @property
    def right(self) -> bool:
        """Whether the configured signs are correct."""
        return (self.motor, self.encoder) == (self.configured_motor, self.configured_encoder)


def most_current(device: Device) -> float:
    """Return the largest current [A] that a push may have: no more than the peak of the motor, in whole mA."""
    return min(MOST_CURRENT, math.floor(1e3 * device.drive.peak_current(device.motor)) / 1e3)


def gentle(known: Configuration, current: float) -> Configuration:
    """Return the configuration of the test: no wall, no law, at most `current` [A] that comes in slowly."""
    rated = Limits.of(known.device)
    limits = known.limits.replace(
        peak_current=current,
        continuous_current=min(current, known.limits.continuous_current, rated.continuous_current),
        thermal_time=min(known.limits.thermal_time, rated.thermal_time),
        slew=_SLEW,
        edge_stiffness=0.0,
        watch_motion=False,
    )
    axes = known.device.axes
    return known.replace(
        law="direct",
        changes={},
        environment=Free(),
        limits=limits,
        soft_start=min(known.soft_start, _SOFT_START),
        observer=False,
        hand=known.hand.replace(path=[Step(target=0.0)] * axes),
    )


def find_signs(
    known: Configuration,
    *,
    simulate: bool = False,
    current: float = 0.1,
    encoder: Sequence[int] | None = None,
    look: Callable[[Run], None] = lambda run: None,
) -> list[AxisSigns]:
    """Push every axis in both directions with a small current, and return the correct signs.

    The handle is free or held loosely. The force sensor can distinguish a reversed motor from a reversed encoder only
    if a hand holds against the motor. Otherwise the signs of the encoders must be known, as of `find_encoder_signs`; if
    they are not, and the two signs do not match, the motor is reported as wrong.

    Parameters
    ----------
    known : Configuration
        The device.
    simulate : bool
        Whether simulated drives stand in for the real ones.
    current : float
        Current of every push [A], 0.02 to 0.3, and no more than the peak of the motor.
    encoder : sequence of int, optional
        The correct sign of each encoder, 1 or -1, where it is known.
    look : callable
        Called repeatedly while the rows are read; it may stop the run, which ends the test.

    Raises
    ------
    ValueError
        For a current out of range, or encoder signs that are not 1 or -1 for each axis.
    RuntimeError
        When the test was stopped before its end.
    LoopFault, DriveError
        As for a run.
    """
    if not LEAST_CURRENT <= current <= MOST_CURRENT:
        raise ValueError(
            f"current = {current:g} A: must lie in [{LEAST_CURRENT}, {MOST_CURRENT}] A"
        )
    if current > (most := most_current(known.device)):
        remedy = (
            f"give less: `--current {most:g}` (in Python current={most:g})"
            if most >= LEAST_CURRENT
            else f"a push needs at least {LEAST_CURRENT} A, so look at both"
        )
        raise ValueError(
            f"current = {current:g} A: is beyond the peak of the motor, {most:g} A (device.motor.rated_torque, "
            f"device.drive.peak_ratio); {remedy}"
        )
    axes = known.device.axes
    right: Sequence[int | None] = (None,) * axes
    if encoder is not None:
        right = Signs.from_table({"encoder": list(encoder)}, axes).encoder
    tested = gentle(known, current)
    signs = known.signs.of_all(axes)
    seconds = 2.0 + axes * 2 * (PUSH + PAUSE) * 3
    with (
        OpenDevice(tested, simulate=simulate) as device,
        _started(device, seconds) as run,
    ):
        _wait(run, look, lambda: run.state is LoopState.RUN, PUSH * 10)
        pushes = [
            [_push(run, look, axis, way * known.device.force(current)) for way in (1, -1)]
            for axis in range(axes)
        ]
        run.stop()
        run.finish()
    sensor = known.sensor is not None
    return [
        judged(
            axis,
            node.id,
            signs,
            np.array(both),
            known.device,
            current,
            sensor=sensor,
            right=right[axis],
        )
        for axis, (node, both) in enumerate(zip(known.drives.nodes, pushes, strict=True))
    ]


def _started(device: OpenDevice, seconds: float) -> Run:
    device.confirm_zero()  # whoever asked for the test put the handle into the middle, and there is no wall
    return device.start(seconds=seconds)


def _wait(run: Run, look: Callable[[Run], None], there: Callable[[], bool], seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end and not there():
        look(run)
        if run.done or run.state in _ENDING:
            run.finish()
            raise RuntimeError("the test was stopped before its end; nothing was written")
        time.sleep(0.005)


def _push(run: Run, look: Callable[[Run], None], axis: int, force: float) -> tuple[float, float]:
    """Push one axis; return its way [m] and the change of the measured force [N], both for a positive force."""
    before = _mean(run, axis, 0.05)
    run.change(_wall(axis, force), into_hand=True)
    _wait(run, look, lambda: bool(abs(_mean(run, axis, 0.0)[0] - before[0]) > FAR), PUSH)
    after = _mean(run, axis, 0.02)
    run.change(Free())
    _wait(run, look, lambda: False, PAUSE)
    way, reaction = (after - before) * math.copysign(1.0, force)
    return float(way), float(reaction)


def _wall(axis: int, force: float) -> Wall | World:
    """Return a surface far behind the handle, which pushes along the axis with a force that hardly changes."""
    stiffness = abs(force) / -_BEHIND
    if axis == 2:  # a wall has an angle in the plane of the first two
        way = math.copysign(1.0, force)
        plane = Placed(Plane(), (0.0, 0.0, way * _BEHIND), (0.0, -way * math.pi / 2, 0.0))
        return World(Body(solid=plane, material=Elastic(stiffness=stiffness)))
    angle = axis * math.pi / 2 + (0.0 if force > 0 else math.pi)
    angle -= 2 * math.pi if angle > math.pi + 0.05 else 0.0
    return Wall(stiffness=stiffness, position=_BEHIND, angle=angle)


def _mean(run: Run, axis: int, seconds: float) -> NDArray[np.float64]:
    """Return the mean position and force of the last rows: as long at any rate, at least one row."""
    last = run.tail(100)
    last = last[last["t"][-1] - seconds :]
    columns = [np.reshape(last[name], (len(last), -1))[:, axis] for name in ("x", "f_meas")]
    return np.array([column.mean() for column in columns])


def judged(
    axis: int,
    node: int,
    signs: Signs,
    pushes: NDArray[np.float64],
    device: Device,
    current: float,
    *,
    sensor: bool,
    right: int | None = None,
) -> AxisSigns:
    """Return the signs of an axis from way [m] and reaction force [N] of a push each way [A], shape (2, 2).

    `right` is the correct sign of its encoder, where it is known.
    """
    force = device.force(current)
    ways, reaction = pushes[:, 0], pushes[:, 1]
    motor, encoder = signs.motor[axis], signs.encoder[axis]
    held = (
        sensor and bool((np.abs(reaction) > HELD * force).all()) and reaction[0] * reaction[1] > 0
    )
    shown: dict[str, Any] = {
        "axis": axis,
        "node": node,
        "configured_motor": motor,
        "configured_encoder": encoder,
        "moved_m": float(ways.mean()),
        "force_N": float(reaction.mean()) if held else None,
    }
    if not (np.abs(ways) > LEAST).all():
        remark = f"did not move: let go of the handle, look at friction, brake and drive{_more(current, device)}"
        return AxisSigns(**shown, motor=None, encoder=None, remark=remark)
    if ways[0] * ways[1] < 0:
        remark = "moved the same way under both forces: something else pushes; let go of the handle"
        return AxisSigns(**shown, motor=None, encoder=None, remark=remark)
    together = bool(ways[0] < 0)
    if right is not None:
        encoder_right = right == encoder
        motor_right = together == encoder_right
    else:
        motor_right = bool(reaction[0] > 0) if held else together
        encoder_right = together == motor_right
    wrong = [
        name for name, right in (("motor", motor_right), ("encoder", encoder_right)) if not right
    ]
    remark = f"{' and '.join(wrong)} wrong" if wrong else "right"
    if not held and right is None:
        remark += "; by the encoder alone: where x grows to the wrong side, turn motor and encoder"
    return AxisSigns(
        **shown,
        motor=motor if motor_right else -motor,
        encoder=encoder if encoder_right else -encoder,
        remark=remark,
    )


def _more(current: float, device: Device) -> str:
    """Return the remedy of a larger current, where the test may use one."""
    most = most_current(device)
    if current >= most:
        return f"; {most:g} A is the most of this test"
    better = min(2 * current, most)
    return (
        f", or give more: `--current {better:g}` (at most {most:g} A; in Python current={better:g})"
    )
