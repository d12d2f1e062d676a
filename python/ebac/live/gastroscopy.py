"""A gastroscopy in real time in the browser: the physician steers, the page shows outside, camera and forces."""

from __future__ import annotations

import json
import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ebac import _core
from ebac.gastroscope import Procedure
from ebac.gastroscope.procedure import core_law
from ebac.laws import AnyLaw, law_name
from ebac.live.served_page import served_page
from ebac.live.server import Server

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Time from look to look [s], and how far the strips look back [s].
LOOK, BACK = 1 / 50, 10.0
#: Behind by more than this the page's time stands still [s].
LATEST = 0.2
PHASES = ("along the lumen", "at a target", "back from a target", "behind the pylorus")
#: Scripts of the page, in the order in which one needs the other.
SCRIPTS = ("vectors", "solid", "lumen", "endoscope", "outside", "gastroscopy")


class _NoHand:
    """A page leaves: the physician steers on."""

    def leave(self) -> None:
        """Do nothing."""


class GastroscopySession:
    """A gastroscopy that runs in real time, in a thread of its own. A context manager; from any thread.

    Parameters
    ----------
    law : law
        Of the joystick, of the core.
    procedure : Procedure, optional
        Default: `Procedure()`.

    Attributes
    ----------
    starts : int
        Runs so far.
    """

    def __init__(self, law: AnyLaw = "ebac", procedure: Procedure | None = None) -> None:
        self.procedure = Procedure() if procedure is None else procedure
        self._scenario = self.procedure.scenario()
        self._law: Any = core_law(law, self._scenario)
        self.law = law if isinstance(law, str) else law_name(self._law)
        self.hand = _NoHand()
        self.starts, self.running = 0, False
        self._lock = threading.RLock()
        self._over = threading.Event()
        self._thread: threading.Thread | None = None
        self._begin()
        self._thread = threading.Thread(target=self._go, name="ebac-gastroscopy", daemon=True)
        self._thread.start()

    def _begin(self) -> None:
        self._run = _core._Navigation(self.procedure.core(), self._scenario.setup(), self._law)
        self._run.advance(1)
        self.starts += 1
        self.recent: deque[dict[str, float]] = deque([self._run.row()], maxlen=round(BACK / LOOK))
        self._seen = 0  # rows taken, ever
        self._rows = 1
        self._due = time.monotonic()

    def start(self) -> None:
        """Let time go on; begin anew after the end."""
        with self._lock:
            if self._run.ended:
                self._begin()
            self._due = time.monotonic()
            self.running = True

    def pause(self) -> None:
        """Let time stand still."""
        self.running = False

    def reset(self) -> None:
        """Begin anew."""
        with self._lock:
            self._begin()
            self.running = True

    def advance(self, seconds: float) -> None:
        """Let so much time pass at once, in steps of 20 ms, whatever the clock says."""
        with self._lock:
            dt = self._scenario.timing.dt
            for _ in range(round(seconds / LOOK)):
                self._take(round(LOOK / dt))

    def let_go(self) -> None:
        """Nothing is held here."""

    hold = let_go

    def close(self) -> None:
        """End it."""
        self._over.set()
        if self._thread is not None:
            self._thread.join()

    def _go(self) -> None:
        dt = self._scenario.timing.dt
        while not self._over.wait(LOOK):
            with self._lock:
                if not self.running:
                    continue
                now = time.monotonic()
                self._due = max(self._due, now - LATEST)
                ticks = int((now - self._due) / dt)
                self._due += ticks * dt
                self._take(ticks)
                self.running = not self._run.ended

    def _take(self, ticks: int) -> None:
        self._run.advance(ticks)
        self.recent.append(self._run.row())
        self._rows += 1

    def snapshot(
        self,
    ) -> tuple[dict[str, Any], dict[str, Any], dict[str, float], list[dict[str, float]], int]:
        """Return newest row, state of the slave, findings, rows since the last call, number of the run."""
        with self._lock:
            new = min(self._rows - self._seen, len(self.recent))
            self._seen = self._rows
            rows = list(self.recent)
            return (
                rows[-1],
                self._run.state(),
                self._run.findings(),
                rows[len(rows) - new :],
                self.starts,
            )

    def __enter__(self) -> Self:
        """Return the session."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End it."""
        self.close()


class GastroscopyFrames:
    """What the page shows of a gastroscopy. SI units; places in tenths of a millimetre."""

    def __init__(self, session: GastroscopySession) -> None:
        self._session = session
        lumen = session.procedure.lumen
        self._places = np.arange(0.0, lumen.landmarks()["end"] - 1e-3, 6e-3)

    def frame(self) -> dict[str, Any]:
        """Return what is new since the last call."""
        row, slave, found, new, run = self._session.snapshot()
        lumen, t, bag = self._session.procedure.lumen.core, row["t"], slave["bag"]
        wall = [lumen.at(float(s), t, bag) for s in self._places]
        targets = []
        for polyp in self._session.procedure.polyps():
            middle, right, down, _, radius = lumen.at(polyp.place, t, bag)
            out = np.cos(polyp.angle) * np.array(right) + np.sin(polyp.angle) * np.array(down)
            targets.append(_tenths(np.array(middle) + radius * out))
        return {
            "kind": "frame",
            "run": run,
            "t": t,
            "place": row["place"],
            "force": row["section_force"],
            "most": found["most_section"],
            "tube_force": row["tube_force"],
            "touched": int(found["touched"]),
            "reached": bool(found["reached"]),
            "fault": int(found["fault"]),
            "over": found["over_limit"],
            "phase": PHASES[int(row["phase"])],
            "on_hand": float(np.linalg.norm([row[f"felt_{axis}"] for axis in "xyz"])),
            "energy": found["least_energy"],
            "at": _tenths(np.array(slave["at"])),
            "ahead": np.round(slave["ahead"], 4).tolist(),
            "right": np.round(slave["right"], 4).tolist(),
            "tube": _tenths(np.array(slave["tube"])),
            "wall": _tenths(np.array([one[0] for one in wall])),
            "radius": _tenths(np.array([one[4] for one in wall])),
            "targets": targets,
            "strips": _strips(new),
        }

    def history(self) -> dict[str, Any]:
        """Return the strips of the last seconds."""
        return _strips(list(self._session.recent))

    def shape(self) -> dict[str, Any]:
        """Return what does not change: axes of the rings of the wall."""
        lumen = self._session.procedure.lumen.core
        rows = [lumen.at(float(s), 0.0, (0.0, 0.0, 0.0)) for s in self._places]
        axes = np.array([[row[1], row[2]] for row in rows])
        right, down = np.round(axes, 4).transpose(1, 0, 2)
        return {"right": right.ravel().tolist(), "down": down.ravel().tolist()}


def _tenths(metres: NDArray[np.float64]) -> list[int]:
    found: list[int] = np.rint(1e4 * metres).astype(int).ravel().tolist()
    return found


def _strips(rows: list[dict[str, float]]) -> dict[str, list[float]]:
    names = {"t": "t", "force": "section_force", "tube": "tube_force", "place": "place"}
    return {own: [round(row[name], 4) for row in rows] for own, name in names.items()}


class GastroscopyServer(Server):
    """Serves a gastroscopy; tokens, origin and one controller as `Server` has them."""

    def __init__(
        self, session: GastroscopySession, *, host: str = "127.0.0.1", port: int = 0
    ) -> None:
        self._run_shown = session
        alike: Any = session  # start, pause, reset, hold, let go
        super().__init__(alike, host=host, port=port)

    def _reader(self) -> GastroscopyFrames:
        return GastroscopyFrames(self._run_shown)

    def _whole_page(self) -> str:
        return served_page("gastroscopy", SCRIPTS)

    async def _done(self, message: dict[str, Any]) -> None:
        kind = message["kind"]
        if kind not in ("start", "pause", "reset"):
            raise ValueError(f"{kind}: the physician steers; a page can start, pause and reset")
        getattr(self._run_shown, kind)()
        await self._send_state()

    def _state(self) -> dict[str, Any]:
        session, patient = self._run_shown, self._run_shown.procedure.lumen.patient
        if self._shape[0] is None:
            self._shape = True, json.dumps({"kind": "shape", "shape": self._frames.shape()})
        return {
            "kind": "state",
            "law": session.law,
            "delay_s": session.procedure.master.delay,
            "feedback": session.procedure.master.feedback,
            "heed_N": session.procedure.physician.heed,
            "limit_N": patient.force_limit,
            "targets": len(session.procedure.polyps()),
            "field_rad": session.procedure.physician.field_of_view,
            "tip_m": session.procedure.scope.tip,
            "diameter_m": session.procedure.scope.diameter,
            "running": session.running,
            "pages": self.pages,
        }


@contextmanager
def serve_gastroscopy(
    law: AnyLaw = "ebac",
    procedure: Procedure | None = None,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
) -> Iterator[GastroscopyServer]:
    """Run a gastroscopy in real time and serve its page until the end of the block.

    Parameters
    ----------
    law : law
        Of the joystick, of the core.
    procedure : Procedure, optional
        Default: `Procedure()`.
    host : str
        Where to listen; another than 127.0.0.1 lets other machines in that know the token, unencrypted.
    port : int
        0 for a free one.

    Yields
    ------
    GastroscopyServer
        `server.gate.url()` is the address to open, `server.session` the run.

    Raises
    ------
    ImportError
        Without websockets (`pip install 'ebac[live]'`).
    OSError
        When host and port cannot be had.
    """
    with (
        GastroscopySession(law, procedure) as session,
        GastroscopyServer(session, host=host, port=port) as server,
    ):
        session.start()
        yield server
