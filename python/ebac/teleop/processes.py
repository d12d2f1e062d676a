"""Master, network and slave as processes of their own, over UDP."""

from __future__ import annotations

from math import inf
from typing import Any

from ebac import _core
from ebac._core import Link, SlaveModel
from ebac._util.arguments import number
from ebac._util.reach import check_reach
from ebac.laws import CoreLaw, PythonLaw
from ebac.laws.making import compiled
from ebac.scenario import Scenario
from ebac.teleop.schemes import Scheme

#: What the states of a side mean.
STATES = (
    "waiting for the other side",
    "running",
    "LINK LOST: the slave holds, the master's force fades to zero",
    "link is back, waiting for the hand's consent",
)


class _Side:
    """What the three have in common."""

    _core: Any

    @property
    def port(self) -> int:
        """The UDP port it listens on."""
        return int(self._core.port)

    def run(self, seconds: float) -> dict[str, Any]:
        """Run for a time in this thread [s]; return what it has met so far, as `ebac teleop master --json`.

        Raises
        ------
        ValueError
            For a time that is negative or not finite.
        """
        if not 0 <= number("seconds", seconds) < inf:
            raise ValueError(f"seconds = {seconds:g} s: must be finite and at least 0 s")
        return dict(self._core.run(seconds))

    @property
    def units(self) -> dict[str, str]:
        """Units of what `run` returns, by name; a pure number has none."""
        return dict(self._core.units())


class Master(_Side):
    """A simulated stick with hand and law, at 1 kHz.

    Parameters
    ----------
    scenario : Scenario
        Device of one axis, hand and timing.
    law : law
        Made for that device.
    scheme : Scheme
        The same as the slave's.
    host, port : str, int
        Where to listen.
    peer : tuple of str and int
        Slave or network.
    consent_after : float, optional
        A simulated hand consents so long after the link is back [s]; default: only `consent`.

    Raises
    ------
    ValueError
        For a `host` from which no other machine is reached.
    OSError
        Where the port cannot be had.
    TypeError
        For a law that is written in Python.
    """

    def __init__(
        self,
        scenario: Scenario,
        law: CoreLaw | PythonLaw,
        scheme: Scheme,
        *,
        host: str,
        port: int,
        peer: tuple[str, int],
        consent_after: float | None = None,
    ) -> None:
        check_reach(host, peer[0], "the slave")
        self._core = _core._UdpMaster(
            setup=scenario.setup(),
            law=compiled(law),
            coupling=scheme.coupling,
            host=host,
            port=port,
            peer=peer[0],
            peer_port=peer[1],
            consent_after=inf if consent_after is None else consent_after,
        )

    def consent(self) -> bool:
        """Agree to go on after the link was lost; False where it is not back."""
        return bool(self._core.consent())


class Slave(_Side):
    """A simulated slave. It answers who sends it good packets, and holds without them."""

    def __init__(self, model: SlaveModel, scheme: Scheme, *, host: str, port: int) -> None:
        self._core = _core._UdpSlave(model=model, coupling=scheme.coupling, host=host, port=port)


class Network(_Side):
    """Delays, drops, reorders and damages datagrams between master and slave."""

    def __init__(
        self,
        there: Link,
        back: Link,
        *,
        host: str,
        port: int,
        slave: tuple[str, int],
        seed: int = 1,
    ) -> None:
        check_reach(host, slave[0], "the slave")
        self._core = _core._UdpNetwork(
            there=there,
            back=back,
            seed=seed,
            host=host,
            port=port,
            slave=slave[0],
            slave_port=slave[1],
        )

    def cut(self, on: bool) -> None:
        """Cut both ways, or mend them."""
        self._core.cut(on)
