"""What `ebac run` asks before real motors have power: whether the handle is where the encoders say."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from ebac.cli import output
from ebac.cli.drive import positions
from ebac.cli.drive.options import sure

if TYPE_CHECKING:
    from ebac.hardware import Configuration, OpenDevice

_ASKS = "A run on hardware asks whether the zero of the encoders is right."


def names_its_drives(known: Configuration, instead: str) -> None:
    """End the command where a file has nothing that only hardware has; `instead` is a remedy."""
    from ebac._util.file_kinds import SCENARIO, kind_of
    from ebac._util.toml import parsed

    if known.text and kind_of(parsed(known.text)) in (SCENARIO, ""):
        output.fail(
            f"{known.name}: no table of it says which bus and drives these are, such as [bus]; {instead}, or write "
            "[bus] into it for hardware"
        )


def can_ask(known: Configuration, yes: bool) -> None:
    """End the command where nobody could be asked, before a drive is asked for anything."""
    if yes or known.interface != "socketcan" or known.zero.absolute:
        return
    if sys.stdin is None or not sys.stdin.isatty():
        output.fail(
            f"{_ASKS} Nobody is here to ask: look at `ebac drive zero {known.name}`, then add --yes"
        )


def confirm(device: OpenDevice, yes: bool, *, stderr: bool) -> None:
    """Show where each axis stands and how far the virtual world is; ask whether that is so, unless `yes`."""
    from ebac._core import Free
    from ebac.hardware import distances
    from ebac.hardware.axis_positions import check_outside

    if not device.backend.real:
        return
    found = device.positions()
    known = device.configuration
    positions.show(found, distances(known, found), stderr=stderr)
    check_outside(known, found, known.environment)
    if not isinstance(known.environment, Free):
        output.console(stderr=stderr).print(
            f"After {known.seconds:g} s every force fades within {known.ramp_down:g} s (run.ramp_down): who still "
            "presses then falls through the wall, so release the handle before.",
            soft_wrap=True,
            markup=False,
        )
    if not device.confirmed:
        sure("The motors get power. Is the handle where this says?", yes)
        device.confirm_zero()
