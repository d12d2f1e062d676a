"""What goes wrong with a force sensor, and what to do about it."""

from __future__ import annotations

from ebac._core import LinkState


class SensorError(RuntimeError):
    """The sensor does not do what it should; the message names it and the remedy."""


_REMEDIES = {
    LinkState.CLOSED: "it is closed; open it again",
    LinkState.STOPPED: "its stream is stopped; open it again",
    LinkState.WAITING: (
        "no answer; check its power and cable, that this machine is in its network (`ip address`), and that "
        "no firewall drops UDP. `ebac sensor simulate` is one without hardware"
    ),
    LinkState.STREAMING: "no newer record; see its losses with `ebac sensor read`",
    LinkState.SILENT: (
        "its records stopped; check power and cable, and whether another program has taken the stream: a "
        "sensor serves one at a time"
    ),
    LinkState.REFUSED: (
        "nobody listens at that port; check the address and that the sensor has power, or start a simulated one on "
        "this machine: `ebac sensor simulate`"
    ),
    LinkState.UNREACHABLE: (
        "no way leads to that address; check the cable and that this machine is in its network "
        "(`ip address`)"
    ),
}


def silence(host: str, port: int, state: LinkState, seconds: float) -> SensorError:
    """Return what to raise when no record came for so long."""
    return SensorError(f"sensor at {host}:{port}, nothing for {seconds:g} s: {_REMEDIES[state]}")
