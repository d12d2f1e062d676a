"""The browsers that are attached to a server, one of which controls it."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection

#: What a page that cannot keep up may leave unread before frames are left out [bytes].
MOST_WAITING = 200_000


class Pages:
    """Who is attached, who controls, and what each was sent.

    Parameters
    ----------
    control : bool
        Whether any page may control.
    """

    def __init__(self, *, control: bool) -> None:
        self.control = control
        self._roles: dict[ServerConnection, str] = {}
        self._controller: ServerConnection | None = None
        self._drawn: dict[ServerConnection, str] = {}

    def __len__(self) -> int:
        """Return how many are attached."""
        return len(self._roles)

    def __iter__(self) -> Iterator[ServerConnection]:
        """Iterate over those attached now."""
        return iter(list(self._roles))

    def add(self, page: ServerConnection, role: str) -> None:
        """Attach a page that may "control" or "watch"; it controls where none does."""
        self._roles[page] = role
        self.take(page)

    def remove(self, page: ServerConnection) -> bool:
        """Forget a page, and return whether it controlled."""
        del self._roles[page]
        self._drawn.pop(page, None)
        controlled = self.controls(page)
        if controlled:
            self._controller = None
        return controlled

    def take(self, page: ServerConnection) -> None:
        """Let a page control, if it may and none does."""
        if self._free_for(page):
            self._controller = page

    def controls(self, page: ServerConnection) -> bool:
        """Whether a page controls."""
        return page is self._controller

    def _free_for(self, page: ServerConnection) -> bool:
        may = self.control and self._roles.get(page) == "control"
        return may and self._controller is None

    async def send_state(self, state: str, shape: str) -> None:
        """Send every page the state, a JSON object, with its own role, and the shape it has not drawn yet."""
        for page in self:
            if self._drawn.get(page) is not shape:
                self._drawn[page] = shape
                await send(page, shape)
            role = "control" if self.controls(page) else "watch"
            free = json.dumps(self._free_for(page))
            await send(page, f'{state[:-1]}, "role": "{role}", "free": {free}}}')

    async def send_frame(self, text: str) -> None:
        """Send a frame to every page that keeps up."""
        for page in self:
            if page.transport.get_write_buffer_size() < MOST_WAITING:
                await send(page, text)


async def send(page: ServerConnection, text: str) -> None:
    """Send a text to a page that may have gone."""
    from websockets.exceptions import ConnectionClosed

    with contextlib.suppress(ConnectionClosed):
        await page.send(text)
