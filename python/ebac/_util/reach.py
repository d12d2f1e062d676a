"""Whether an address of this machine can reach another one at all."""

from __future__ import annotations

from ipaddress import ip_address


def check_reach(host: str, peer: str, what: str) -> None:
    """Refuse to talk to another machine from a loopback address: the system drops every datagram, and nothing says so.

    Raises
    ------
    ValueError
        With the remedy. Names other than "localhost" are not looked up.
    """
    if _loopback(host) is True and _loopback(peer) is False:
        raise ValueError(
            f"host = {host}: from there nothing reaches {what} at {peer}; give the address of this machine in "
            "that network"
        )


def _loopback(address: str) -> bool | None:
    """Return whether it is; None for a name."""
    if address == "localhost":
        return True
    try:
        return ip_address(address).is_loopback
    except ValueError:
        return None
