"""A gastroscopy in real time in the browser: the physician steers, the page shows outside, camera and forces."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ebac.gastroscope import Procedure
from ebac.laws import AnyLaw
from ebac.live.gastroscopy_frames import GastroscopyFrames
from ebac.live.gastroscopy_session import GastroscopySession
from ebac.live.served_page import served_page
from ebac.live.server import Server

#: Scripts of the page, in the order in which one needs the other.
SCRIPTS = ("vectors", "link", "solid", "lumen", "endoscope", "outside", "gastroscopy")


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
