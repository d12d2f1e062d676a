"""The server of `ebac live`: one page, one socket, in a thread beside the loop."""

from __future__ import annotations

import asyncio
import json
import logging
import threading
from concurrent.futures import ThreadPoolExecutor
from http import HTTPStatus
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from ebac.live.frames import Frames
from ebac.live.gate import Gate
from ebac.live.messages import LONGEST, MalformedError, read
from ebac.live.orders import carry_out
from ebac.live.pages import Pages, send
from ebac.live.served_page import answer, served_page
from ebac.live.session import Session

if TYPE_CHECKING:
    from websockets.asyncio.server import Server as Socket
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

#: Time between two frames [s], and the shortest after a drag.
FRAME, SOON = 1 / 30, 1 / 60
#: Malformed messages after which a page is cut off; messages a second that a page may send.
MOST_MALFORMED, MOST_MESSAGES = 100, 400
#: Pages at a time.
MOST_PAGES = 32
#: Messages that end something, which are done however many came before them.
ALWAYS = ("release", "pause")
#: Messages that are done before the next one is read.
AT_ONCE = ("hold", "release", "drag", "drop", "mode")


def _silent() -> logging.Logger:
    """Return a logger that says nothing: what strangers send is no news for the terminal."""
    logger = logging.getLogger("ebac.live.socket")
    logger.setLevel(logging.CRITICAL + 1)
    return logger


class Server:
    """Serves a session to browsers, one of which controls it. A context manager.

    Parameters
    ----------
    session : Session
        What is shown; the caller closes it.
    host : str
        Where it listens; other machines see it under an address that is not loopback.
    port : int
        0 for a free one.
    control : bool
        Whether any page may control it.

    Attributes
    ----------
    gate : Gate
        Tokens and addresses: `server.gate.url()`.

    Raises
    ------
    ImportError
        Without websockets.
    OSError
        When the address cannot be had.
    """

    def __init__(
        self,
        session: Session,
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        control: bool = True,
    ) -> None:
        try:
            import websockets.asyncio.server
        except ImportError as error:
            raise ImportError(
                "the live server needs websockets: pip install 'ebac[live]'"
            ) from error
        del websockets
        self.session = session
        self.malformed = 0
        self._frames = self._reader()
        self._pages = Pages(control=control)
        self._work = ThreadPoolExecutor(1, thread_name_prefix="ebac-live-work")
        self._shape = ""
        self._tasks: set[asyncio.Task[None]] = set()
        self._notice = ""
        self._ready = threading.Event()
        self._failed: BaseException | None = None
        self._thread = threading.Thread(
            target=self._run, args=(host, port), name="ebac-live-server", daemon=True
        )
        self._thread.start()
        self._ready.wait()
        if self._failed is not None:
            raise self._failed

    def _reader(self) -> Any:
        """Return what makes frames of the session."""
        return Frames(self.session)

    def _whole_page(self) -> str:
        """Return the page."""
        return served_page()

    def close(self) -> None:
        """End it; the session goes on."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._end.set)
            self._thread.join()
        self._work.shutdown()

    @property
    def pages(self) -> int:
        """How many browsers are attached."""
        return len(self._pages)

    # --- its thread ---

    def _run(self, host: str, port: int) -> None:
        try:
            asyncio.run(self._serve(host, port))
        except BaseException as error:  # for the caller
            self._failed = error
            self._ready.set()

    async def _serve(self, host: str, port: int) -> None:
        from websockets.asyncio.server import serve

        self._loop, self._end = asyncio.get_running_loop(), asyncio.Event()
        self._dragged = asyncio.Event()
        listener: Socket
        async with serve(
            self._page,
            host,
            port,
            process_request=self._request,
            max_size=LONGEST * 4,
            max_queue=64,
            compression=None,
            ping_interval=10,
            ping_timeout=10,
            close_timeout=1,
            server_header=None,
            logger=_silent(),
        ) as listener:
            self.gate = Gate(host=host, port=next(iter(listener.sockets)).getsockname()[1])
            self._html = self._loop.run_in_executor(None, self._whole_page)
            frames = asyncio.create_task(self._send_frames())
            self._ready.set()
            await self._end.wait()
            frames.cancel()

    async def _request(self, connection: ServerConnection, request: Request) -> Response | None:
        headers = request.headers
        socket = "websocket" in (headers.get("Upgrade") or "").lower()
        host, origin = headers.get("Host"), headers.get("Origin")
        refused = self.gate.refuses(request.path, host=host, origin=origin, socket=socket)
        if refused is not None:
            return connection.respond(refused[0], f"{refused[1]}\n")
        path = request.path.partition("?")[0]
        if socket and len(self._pages) >= MOST_PAGES:
            return connection.respond(
                HTTPStatus.SERVICE_UNAVAILABLE, f"{MOST_PAGES} pages are open already; close one\n"
            )
        if socket:
            return None if path == "/socket" else connection.respond(HTTPStatus.NOT_FOUND, "")
        if path != "/":
            return connection.respond(HTTPStatus.NOT_FOUND, "there is one page: /\n")
        return answer(connection, (await self._html).encode())

    async def _page(self, page: ServerConnection) -> None:
        """Serve a browser until it goes."""
        from websockets.exceptions import ConnectionClosed

        assert page.request is not None
        role = self.gate.role(page.request.path) or "watch"
        self._pages.add(page, role)
        begun, count, bad = self._loop.time(), 0, 0
        try:
            await self._send_state()
            await page.send(json.dumps({"kind": "history", "strips": self._frames.history()}))
            async for raw in page:
                count += 1
                if self._loop.time() - begun > 1:
                    begun, count = self._loop.time(), 0
                try:
                    message = read(raw)
                    if count <= MOST_MESSAGES or message["kind"] in ALWAYS:
                        await self._take(page, message)
                except MalformedError as error:
                    bad, self.malformed = bad + 1, self.malformed + 1
                    if bad > MOST_MALFORMED:
                        await page.close(1008, "too many malformed messages")
                        break
                    await page.send(json.dumps({"kind": "error", "text": f"message {error}"}))
        except ConnectionClosed:
            pass  # without a farewell
        finally:
            if self._pages.remove(page):
                self.session.let_go()
                self.session.hand.leave()
            await self._send_state()

    async def _take(self, page: ServerConnection, message: dict[str, Any]) -> None:
        """Do what a page asks, if it may."""
        kind = message["kind"]
        if kind == "take":
            self._pages.take(page)
            await self._send_state()
            return
        if not self._pages.controls(page):
            await page.send(json.dumps({"kind": "error", "text": "this page only watches"}))
            return
        if kind in AT_ONCE:
            await self._do(page, message)
            return
        # Beside the reading: whoever starts goes on holding the dead-man key.
        task = asyncio.create_task(self._do(page, message))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _do(self, page: ServerConnection, message: dict[str, Any]) -> None:
        """Do it, and report what came of it."""
        try:
            await self._done(message)
        except Exception as error:  # whatever a page sends: it gets an answer, and the others go on
            text = str(error.args[0] if isinstance(error, KeyError) else error)
            await send(page, json.dumps({"kind": "error", "text": text}))
            await self._send_state()

    async def _done(self, message: dict[str, Any]) -> None:
        session, kind = self.session, message["kind"]
        if kind == "hold":
            session.hold()
        elif kind == "release":
            session.let_go()
        elif kind == "drag":
            session.hand.drag(message["place"])
            self._dragged.set()
        elif kind == "drop":
            pass  # the hand stays where it was dragged to
        elif kind == "mode":
            session.hand.set_mode(message["mode"])
        else:
            self._notice = await self._loop.run_in_executor(
                self._work, carry_out, self.session, message
            )
            await self._send_state()

    # --- what it sends ---

    async def _send_state(self) -> None:
        """Send every page what is chosen, and whether it controls."""
        state = json.dumps(await self._loop.run_in_executor(self._work, self._state))
        await self._pages.send_state(state, self._shape)

    def _state(self) -> dict[str, Any]:
        self._shape = self._frames.shape()
        return {
            "kind": "state",
            **self._frames.state(),
            "notice": self._notice,
            "pages": len(self._pages),
        }

    async def _send_frames(self) -> None:
        ran = self.session.running
        last, due = -1.0, self._loop.time()
        while True:
            due = max(due + FRAME, self._loop.time())
            try:
                async with asyncio.timeout_at(due):
                    await self._dragged.wait()
                self._dragged.clear()
                await asyncio.sleep(max(0.0, SOON - (self._loop.time() - last)))
            except TimeoutError:
                pass
            last = self._loop.time()
            if not self._pages:
                continue
            if ran != self.session.running:  # ended by itself
                ran = not ran
                await self._send_state()
            try:
                text = json.dumps(self._frames.frame())
            except Exception as error:  # the picture goes on with the next one
                text = json.dumps({"kind": "error", "text": f"no picture: {error!r}"})
            await self._pages.send_frame(text)

    def __enter__(self) -> Self:
        """Return the server."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End it."""
        self.close()
