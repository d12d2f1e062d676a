"""An engine called at a rate, beside a loop: in a thread of its process, or in another one."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from ebac._core import _EngineClient
from ebac._util.arguments import number
from ebac.worlds.answers import model_numbers
from ebac.worlds.engines import Engine

#: Rates of an engine [Hz].
RATES = (1.0, 1000.0)
#: How often an engine without anything to do looks whether its loop still runs [s].
_LOOK = 0.1


def checked_rate(owner: str, rate: float) -> float:
    """Return a rate [Hz]; raise ValueError for one out of range."""
    if not RATES[0] <= number(f"{owner}.rate", rate) <= RATES[1]:
        raise ValueError(f"{owner}.rate = {rate} Hz: must lie in [{RATES[0]:g}, {RATES[1]:g}] Hz")
    return float(rate)


def checked_engine(owner: str, engine: Any) -> Engine:
    """Return what can be called; raise TypeError for anything else."""
    if isinstance(engine, type) or not callable(engine):
        raise TypeError(f"{owner}.engine = {engine!r}: must be callable")
    made: Engine = engine
    return made


def answer_poses(end: Any, engine: Engine, rate: float, over: Callable[[float], bool]) -> int:
    """Call an engine with each newest pose, `rate` times a second at most, until `over(wait)`; return how often."""
    period, due, calls = 1 / rate, time.monotonic(), 0
    while not over(max(0.0, due - time.monotonic())):
        due = max(due + period, time.monotonic())
        pose: Any = end.pose()
        if pose is not None:
            x, v, _ = pose
            end.post(model_numbers(engine(x, v)))
            calls += 1
    return calls


def serve_engine(engine: Engine, *, rate: float = 60.0, channel: str | None = None) -> int:
    """Serve a loop in another process with an engine, until that loop ends. Return how often it was called.

    For the program that `EngineProcess` or `ebac run --engine-command` starts::

        from ebac.worlds import LocalModel, serve_engine

        serve_engine(lambda x, v: LocalModel(at=(0.01, 0, 0), normal=(1, 0, 0), stiffness=2000), rate=500)

    Parameters
    ----------
    engine : callable
        `engine(position, velocity)`, [m] and [m/s], returns a `LocalModel`, or None where no surface is near. What it
        raises ends the program; its force in the loop fades.
    rate : float
        Calls per second at most [Hz], [1, 1000]; only where the loop has ticked since.
    channel : str, optional
        Name of the loop's channel; default: that of the environment variable EBAC_ENGINE_CHANNEL, as who starts the
        program sets it.

    Raises
    ------
    TypeError, ValueError
        For something that cannot be called, a rate out of range, no channel, or a loop of another version of ebac.
    FileNotFoundError
        When no loop has opened the channel, or it has ended.
    RuntimeError
        When its loop has ended without closing it, or another engine was there first.
    """
    called = checked_engine("serve_engine", engine)
    at_most = checked_rate("serve_engine", rate)
    client = _EngineClient("" if channel is None else channel)

    def over(wait: float) -> bool:
        while client.loop_runs:
            if wait <= 0:
                return False
            time.sleep(min(wait, _LOOK))
            wait -= _LOOK
        return True

    return answer_poses(client, called, at_most, over)
