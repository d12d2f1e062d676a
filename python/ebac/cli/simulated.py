"""What commands share that put something simulated before other programs, in real time, until Ctrl-C."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ebac.cli import setting

if TYPE_CHECKING:
    from ebac.scenario import Scenario

PlantFile: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        help="Take device, hand and seed from a scenario in TOML; other options override it.",
        show_default=False,
    ),
]
PlantDevice: TypeAlias = Annotated[
    str | None,
    typer.Option(help="A device by name, see `ebac presets`.", show_default="joystick"),
]
PlantHand: TypeAlias = Annotated[
    str | None,
    typer.Option(help="A hand by name, see `ebac presets`.", show_default="resting"),
]
Seconds: TypeAlias = Annotated[
    float | None,
    typer.Option(help="Stop after this time [s].", show_default="until Ctrl-C", min=0, max=1e7),
]


def plant_of(file: Path | None, device: str | None, hand: str | None, seed: int | None) -> Scenario:
    """Return device and hand: of the file, or a joystick that is held where it is."""
    from ebac import presets
    from ebac.can.channels import resting_joystick

    if file is None:
        base = resting_joystick()
    else:
        base = setting.base_scenario(file)
    parts = setting.given(
        device=None if device is None else presets.device(device),
        hand=None if hand is None else presets.hand(hand),
        seed=seed,
    )
    return base.replace(**parts)


@contextmanager
def signalled() -> Iterator[threading.Event]:
    """Give an event that Ctrl-C and SIGTERM set."""
    over = threading.Event()

    def stop(number: int, frame: FrameType | None) -> None:
        over.set()

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield over
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
