"""Who may see the page of `ebac live`, and who may control it."""

from __future__ import annotations

import hmac
import secrets
from dataclasses import dataclass, field
from http import HTTPStatus
from socket import gethostname
from typing import Literal
from urllib.parse import parse_qs, urlsplit

#: What the page may do: nothing from elsewhere, in no frame of another page.
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; "
        "img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
#: The port that a browser leaves out of an address.
HTTP_PORT = 80
#: What a server listens on to be reached by each of its addresses; no page is opened under them.
EVERY_ADDRESS = ("0.0.0.0", "::")
Role = Literal["control", "watch"]


def _token() -> str:
    return secrets.token_urlsafe(24)


@dataclass(frozen=True, kw_only=True)
class Gate:
    """Two secrets, and the addresses under which a page may have been loaded.

    Attributes
    ----------
    host : str
        Where the server listens.
    port : int
        Its port.
    control, watch : str
        The secret of who may control, and that of who may only watch.
    """

    host: str
    port: int
    control: str = field(default_factory=_token)
    watch: str = field(default_factory=_token)

    @property
    def loopback(self) -> bool:
        """Whether only this machine can reach it."""
        return self.host in ("127.0.0.1", "::1", "localhost")

    def url(self, role: Role = "control") -> str:
        """Return the address with its secret: by the machine's name if the server listens on every address."""
        host = gethostname() if self.host in EVERY_ADDRESS else self.host
        host = f"[{host}]" if ":" in host else host
        secret = self.control if role == "control" else self.watch
        return f"http://{host}:{self.port}/?token={secret}"

    def role(self, target: str) -> Role | None:
        """Return what the secret in a request allows; None without a right one."""
        given = parse_qs(urlsplit(target).query).get("token", [""])[0].encode()
        if hmac.compare_digest(given, self.control.encode()):
            return "control"
        if hmac.compare_digest(given, self.watch.encode()):
            return "watch"
        return None

    def refuses(
        self, target: str, *, host: str | None, origin: str | None, socket: bool
    ) -> tuple[HTTPStatus, str] | None:
        """Return why a request is refused; None for one that is not.

        A page of another origin cannot open the socket, nor can a name that was made to point here (DNS rebinding).
        """
        if host is None or (self.loopback and not self._known(host)):
            return HTTPStatus.FORBIDDEN, f"open the page under {self.host}:{self.port}"
        if socket and origin != f"http://{host}":
            return HTTPStatus.FORBIDDEN, "the socket is for the page of this server only"
        if self.role(target) is None:
            return (
                HTTPStatus.FORBIDDEN,
                "the address lacks its token: open the one that `ebac live` printed",
            )
        return None

    def _known(self, host: str) -> bool:
        names = ("127.0.0.1", "localhost", "[::1]")
        bare = self.port == HTTP_PORT and host in names
        return bare or host in {f"{name}:{self.port}" for name in names}
