"""What the page of `ebac live` shows of a loop: world, choices, newest row, strips, a verdict in words."""

from __future__ import annotations

import json
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import QUIET_PERCEIVED, Fault, LoopState, _measure_contact
from ebac._util.fault_remedies import REMEDIES
from ebac.hardware import Run
from ebac.hardware.lateness import BY_MOTION
from ebac.live.choices import options
from ebac.live.session import Session
from ebac.live.surface import surface
from ebac.metrics.wall_contact import LEFT_AFTER, STILL_SWING
from ebac.scenario import Environment
from ebac.trace.columns import row_views

#: Time between two points of a strip, and how far the strips look back [s].
STEP, BACK = 8e-3, 10.0
#: A verdict looks back so far [s], and is given so often [s].
JUDGED, OFTEN = 1.5, 0.4


class Frames:
    """Reads the rows of a session's loop; one thread. `shape` and `state` may be called from another."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._run: Run | None = None
        self._seen = 0
        self._judged = -1e9
        self._touched = False
        self._late: NDArray[np.float64] = np.empty(0)
        self._skipped = 0
        self._world: Environment | None = None
        self._shape = ""

    def shape(self) -> str:
        """Return the surface of the world as a message, the same object until the world is another."""
        world = self._session.scenario.environment
        if self._world != world:
            vertices, triangles = surface(world)
            places = (1e5 * vertices).round().astype(int)
            shape = [places.ravel().tolist(), triangles.ravel().tolist()]
            self._world, self._shape = world, json.dumps({"kind": "shape", "shape": shape})
        return self._shape

    def state(self) -> dict[str, Any]:
        """Return what is chosen, and what can be."""
        session = self._session
        return {
            "choices": session.choices.row(),
            "options": options(session.laws),
            "ranges": session.ranges,
            "axes": session.hand.axes,
            "mode": session.hand.mode,
            "real": session.real,
            "virtual": session.virtual,
            "dead_man": session.dead_man,
            "running": session.running,
            "recording": session.run is not None and session.run.recorder is not None,
        }

    def frame(self) -> dict[str, Any]:
        """Return what is new since the last call. SI units."""
        session = self._session
        run = session.run
        found: dict[str, Any] = {
            "kind": "frame",
            "run": session.starts,
            "target": session.hand.place,
        }
        if run is not self._run:
            self._run, self._seen, self._skipped, self._touched = run, 0, 0, False
            self._late = np.empty(0)
        if run is None:
            return found | {"verdict": self._words(None)}
        rows = run._running.rows
        stop = rows.count
        first, raw = rows.copy(max(rows.first, self._seen, stop - round(BACK / _dt(run))), stop)
        self._seen = stop
        if len(raw):
            view = row_views(rows, raw)
            self._touched = self._touched or bool(np.any(view["f_env"]))
            self._skipped += int(view["skipped"].sum())
            self._late = np.concatenate([self._late, view["lateness"]])[-2000:]
            found |= {
                "x": _last(view["x"]),
                "force": _last(view["f_cmd"]),
                "strips": strips(view, first, _dt(run)),
            }
        now = time.monotonic()
        if now - self._judged > OFTEN:
            self._judged = now
            found["verdict"] = self._words(run)
            found["late_us"] = (
                float(1e6 * np.percentile(self._late, 99.9)) if len(self._late) else 0.0
            )
            found["skipped"] = self._skipped
        return found

    def history(self) -> dict[str, Any]:
        """Return the strips of the last seconds, for who comes later."""
        run = self._session.run
        if run is None:
            return {}
        rows = run._running.rows
        first, raw = rows.copy(max(rows.first, rows.count - round(BACK / _dt(run))), rows.count)
        return strips(row_views(rows, raw), first, _dt(run)) if len(raw) else {}

    def _words(self, run: Run | None) -> dict[str, str]:
        if run is None:
            return {"kind": "free", "head": "At rest", "more": "Press Start."}
        if self._session.trouble:
            return {"kind": "bad", "head": "Look at the device", "more": self._session.trouble}
        fault = self._session.fault
        if fault is not Fault.NONE:
            name = fault.name.lower().replace("_", " ")
            return {
                "kind": "bad",
                "head": f"Fault {int(fault)}: {name}",
                "more": self._remedy(fault),
            }
        if run.done:
            by = "" if run.report is None else f" Ended by: {run.report.ended_by}."
            return {"kind": "free", "head": "At rest", "more": f"The drives have no power.{by}"}
        return verdict(run, touched=self._touched)

    def _remedy(self, fault: Fault) -> str:
        if fault in BY_MOTION and not self._session.real:
            return "The law shook the handle, or the hand flung it. Choose a softer world or another law, then Start."
        return REMEDIES[fault]


def _dt(run: Run) -> float:
    return run._scenario.timing.dt


def _last(column: NDArray[Any]) -> list[float]:
    return [round(float(one), 7) for one in np.atleast_1d(column[-1])]


def strips(view: Any, first: int, dt: float) -> dict[str, Any]:
    """Return every eighth row, in the ticks that are multiples of it, along the first axis; forces as they were.

    None where there is no number, as beta with the observer.
    """
    every = max(1, round(STEP / dt))
    rows = slice((-first) % every, None, every)

    def axis(name: str) -> NDArray[Any]:
        column: NDArray[Any] = view[name]
        return column[:, 0] if column.ndim > 1 else column

    def plain(values: NDArray[Any]) -> list[float | None]:
        numbers = np.round(values[rows].astype(float), 6)
        return [float(one) if np.isfinite(one) else None for one in numbers]

    work = view["work"]
    found = {name: plain(axis(name)) for name in ("t", "x", "f_env", "f_cmd", "f_meas")}
    found["energy"] = plain(work.sum(axis=1) if work.ndim > 1 else work)
    if "law.beta" in view:
        found["beta"] = plain(axis("law.beta"))
    return found


def verdict(run: Run, *, touched: bool = False) -> dict[str, str]:
    """Return what the last seconds were like: `kind` good, fair, bad or free, a headline, a sentence behind it.

    `touched`: whether the world ever acted in this run.
    """
    tail = run.tail(round(JUDGED / _dt(run)))
    acts = tail["state"] == LoopState.RUN
    if acts.sum() * _dt(run) < 0.5:
        return {"kind": "free", "head": "Starting", "more": "The force comes in."}
    last = round(LEFT_AFTER / _dt(run))
    met = [k for k in range(tail.axes) if tail.axis("f_env", k)[acts][-last:].any()]
    if not met:
        drag = "Drag the hand into the world."
        if touched:
            more = f"The handle left the surface. {drag}"
            return {"kind": "free", "head": "No contact at rest", "more": more}
        return {"kind": "free", "head": "Free air", "more": drag}
    worst = max((_measured(tail, k, acts) for k in met), key=lambda one: one["swing"])
    if not worst["swing"] < STILL_SWING:
        at = worst["limit_cycle"]
        often = f" at {at:.0f} Hz" if np.isfinite(at) else ""
        return {
            "kind": "bad",
            "head": f"Swings by {1e3 * worst['swing']:.2g} mm",
            "more": f"The handle goes to and fro{often}.",
        }
    times = worst["perceived"]
    if not times < QUIET_PERCEIVED:
        return {
            "kind": "fair",
            "head": "Buzzes",
            "more": f"Still, but its force vibrates at {times:.2g} times the threshold of touch.",
        }
    limit = "" if times < 1 else f"{QUIET_PERCEIVED:g} times "
    return {
        "kind": "good",
        "head": "Still and quiet",
        "more": f"Its force vibrates below {limit}the threshold of touch.",
    }


def _measured(tail: Any, axis: int, acts: NDArray[np.bool_]) -> dict[str, float]:
    found: dict[str, float] = _measure_contact(
        t=tail["t"][acts], x=tail.axis("x", axis)[acts], force=tail.axis("f_applied", axis)[acts],
        energy=None, stored=None, clamped=None, pull=None,
    )  # fmt: skip
    return found
