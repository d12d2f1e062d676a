"""`ebac.live.serve()`: the live page of a loop in real time, from Python."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ebac.hardware import Configuration, OpenDevice
from ebac.laws import AnyLaw
from ebac.live.server import Server
from ebac.live.session import Session
from ebac.scenario import Scenario


@contextmanager
def serve(
    given: Scenario | Configuration | None = None,
    *,
    device: OpenDevice | None = None,
    law: AnyLaw | None = None,
    observer: bool | None = None,
    host: str = "127.0.0.1",
    port: int = 0,
    allow_control: bool = False,
    dead_man: bool = False,
    virtual: bool = False,
    max_stiffness: float | None = None,
    max_damping: float | None = None,
    folder: str | Path = ".",
) -> Iterator[Server]:
    """Run a loop and serve the page on which it is seen, moved and changed, until the end of the block.

    The loop runs in real time, or on a virtual clock.

    Without a device all is simulated, and the loop starts at once. A device that is given must be open, with its zero
    confirmed; nothing moves until somebody with `allow_control` holds the page's dead-man key.

    Parameters
    ----------
    given : Scenario or Configuration, optional
        What to begin with; default: the paper's joystick at a wall of 10 kN/m.
    device : OpenDevice, optional
        Hardware; it stays open.
    law : str, law class, Variant or law, optional
        The law to begin with; default: that of the configuration, or "ebac". A page can choose it by its name beside
        those of `ebac.LAWS`.
    observer : bool, optional
        Whether a simulation begins with the state observer; default: as given, else with it.
    host : str
        Where to listen; another than 127.0.0.1 lets other machines in that know the token, unencrypted.
    port : int
        0 for a free one.
    allow_control : bool
        Whether a page may control hardware; a simulation always.
    dead_man : bool
        Whether a simulation needs the dead-man key, too.
    virtual : bool
        Whether a simulation's clock is virtual: no tick is late, however busy the machine is.
    max_stiffness, max_damping : float, optional
        Of a surface that a page may choose on hardware [N/m, N s/m]; default: those of the configuration's world.
    folder : path
        Where logs and scenarios go.

    Yields
    ------
    Server
        `server.gate.url()` is the address to open, `server.session` the loop.

    Raises
    ------
    ImportError
        Without websockets (`pip install 'ebac[live]'`).
    OSError
        When host and port cannot be had.
    ValueError
        For an unknown law, a limit that is none, a device on a virtual clock, an observer without a force sensor.

    Examples
    --------
    >>> with ebac.live.serve(ebac.Scenario(), law="tca") as server:  # doctest: +SKIP
    ...     print(server.gate.url())
    ...     server.session.change(law="ebac", stiffness=2e4)
    ...     input("Enter ends it")
    """
    with Session(
        given, device=device, dead_man=dead_man, law=law, observer=observer, virtual=virtual,
        max_stiffness=max_stiffness, max_damping=max_damping, folder=folder,
    ) as session:  # fmt: skip
        control = allow_control or not session.real
        with Server(session, host=host, port=port, control=control) as server:
            if not session.dead_man:
                session.start()
            yield server
