"""Build a loop on hardware from a configuration and the backend of its drives."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING, Any

from ebac import _core
from ebac.drives.signs_of_life import guards, own_beat, request_period
from ebac.hardware.configuration_fields import SILENT, SILENT_SIMULATED, check_seconds
from ebac.realtime.mode import mode_named

if TYPE_CHECKING:
    from ebac.drives import Node
    from ebac.hardware.backends import Backend
    from ebac.hardware.configuration import Configuration

#: Rows beside those of the run itself: before the drives are enabled, and while they stop.
_MORE_ROWS = 4096
#: The longest the drives may take to be enabled [s], beside the ticks that they may be silent for.
_ENABLE = 2.0
#: Monitored for three of a drive's heartbeats.
_BEATS = 3.0
#: How long the loop goes on at zero force for drives that are not off yet [s].
_REST = 0.5
#: The longest a drive's torque may lag behind, and differ [s].
_LAG = 0.01


def run_setup(
    known: Configuration, nodes: Sequence[Node], *, backend: Backend, seconds: float
) -> _core.RunSetup:
    """Return what a loop is made of: device and world, drives, plan, limits, rows.

    Raises
    ------
    ValueError
        For a time out of range.
    """
    check_seconds(seconds)
    dt = known.timing.dt
    signs = known.signs
    ticks = max(1, round(seconds / dt))
    profiles = [node.profile for node in nodes]
    sent = [float(one.values["heartbeat.producer"]) for one in profiles]
    waits = zip(guards(profiles), sent, strict=True)
    watched = [guard / _BEATS if guard else beat for guard, beat in waits]
    masters = {int(one.values["heartbeat.master"]) for one in profiles}
    beat = own_beat(profiles)
    watch = known.limits.watch_force and backend.sensor is not None
    both = known.limits.watch_motion and backend.sensor is not None
    limits = known.limits.replace(watch_force=watch, watch_motion=both)
    silent = known.silent
    if silent is None:
        silent = SILENT if backend.real else SILENT_SIMULATED
    return _core.RunSetup(
        device=known.device,
        environment=known.environment,
        dt=dt,
        nodes=[node.id for node in nodes],
        answer_time=known.answer_share * dt,
        plan=_core.RunPlan(
            soft_start=known.soft_start,
            ramp_down=known.ramp_down,
            stop_ticks=max(10, ceil(0.02 / dt)),
            rest_ticks=ceil(_REST / dt),
            arm=True,
            ticks=ticks,
        ),
        limits=limits,
        observer=known.scenario().designed_observer(),
        sensor=None if backend.sensor is None else backend.sensor.core(),
        rows=min(ticks, ceil(known.memory / dt)) + _MORE_ROWS,
        ring=True,
        mode=mode_named(known.mode),
        realtime=known.realtime,
        aim=backend.aim,
        motor_sign=list(signs.motor),
        encoder_sign=list(signs.encoder),
        encoder_zero=list(known.zero.counts),
        drives={
            "silent_ticks": silent,
            "torque_ticks": min(max(10, ceil(_LAG / dt)), 128),
            "enable_ticks": ceil(_ENABLE / dt) + silent,
            "heartbeat_timeout": _BEATS * max(watched),
            "own_node": masters.pop() if beat > 0 else 0,  # one: `check_stall`
            "heartbeat_period": beat or 0.01,
            "guard_period": request_period(profiles),
        },
    )


def started(law: Any, backend: Backend, setup: _core.RunSetup) -> _core.Running:
    """Start a loop, and return it.

    Raises
    ------
    TypeError
        For a law that no loop knows.
    """
    if not hasattr(law, "_start"):
        raise TypeError(
            f"{law!r}: cannot run in real time, as it is not one of the library's laws compiled in C++; "
            "simulate it instead (`ebac.simulate`, `ebac run --virtual`)"
        )
    running: _core.Running = law._start(backend.bus, setup)
    return running
