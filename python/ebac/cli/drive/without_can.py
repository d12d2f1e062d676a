"""What a command can do on a machine without CAN: simulated drives, by an option that this command has."""

from __future__ import annotations

from ebac.cli import by_option


def remedy(error: Exception) -> str:
    """Return the simulation to take instead, as words after the error; empty for other errors and commands."""
    from ebac.drives.errors import NoCan

    if not isinstance(error, NoCan):
        return ""
    has = by_option.current.values()
    if "--simulated" in has:
        instead = " in place of --allow-control" if "--allow-control" in has else ""
        return f". Without CAN: the same command with --simulated{instead} takes simulated drives"
    if "--interface" in has:
        return ". Without CAN: --interface ebac --channel joystick takes simulated drives"
    return ""
