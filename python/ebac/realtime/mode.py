"""What a thread does when the system refuses real-time resources, by name."""

from __future__ import annotations

from typing import Literal, get_args

from ebac._core import RealTimeMode
from ebac._util.arguments import unknown

Mode = Literal["auto", "enforce", "off"]
MODES: tuple[Mode, ...] = get_args(Mode)


def mode_named(name: str) -> RealTimeMode:
    """Return the mode of the core for "auto", "enforce" or "off".

    Raises
    ------
    ValueError
        For another name.
    """
    if name not in MODES:
        raise ValueError(unknown(f"mode = {name!r}", name, MODES))
    return RealTimeMode[name.upper()]
