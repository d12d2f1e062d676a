"""The page of `ebac live`, one file with everything inside."""

from __future__ import annotations

import json
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._util.law_colours import COLOURS
from ebac.live.gate import HEADERS
from ebac.live.wasm_module import joined, script

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Response

SERVED = Path(__file__).with_name("served")
#: In the order in which one needs the other.
SCRIPTS = ("vectors", "link", "solid", "scene3d", "drag", "form", "main")


def served_page(page: str = "page", scripts: tuple[str, ...] = SCRIPTS) -> str:
    """Return a page as HTML: that of the loop, or another with its own scripts and style."""
    html = (SERVED / f"{page}.html").read_text(encoding="utf-8")
    own = joined("\n".join((SERVED / f"{name}.js").read_text(encoding="utf-8") for name in scripts))
    style = SERVED / f"{page}.css"
    own_style = "" if page == "page" else style.read_text(encoding="utf-8")
    parts = {
        "{style}": (SERVED / "page.css").read_text(encoding="utf-8") + own_style,
        "{colours}": json.dumps(COLOURS),
        "{script}": f"{script('strips')}\n{own}",
    }
    for mark, text in parts.items():
        html = html.replace(mark, text, 1)
    return html


def answer(connection: ServerConnection, html: bytes) -> Response:
    """Return the page as an answer, with what it may do."""
    response = connection.respond(HTTPStatus.OK, "")
    response.body = html
    del response.headers["Content-Length"], response.headers["Content-Type"]
    response.headers["Content-Length"] = str(len(html))
    response.headers["Content-Type"] = "text/html; charset=utf-8"
    for name, value in HEADERS.items():
        response.headers[name] = value
    return response
