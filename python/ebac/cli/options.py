"""The options that set up a run, for every command that simulates.

None of them has a default of its own: what is not given leaves the scenario as it is.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, TypeAlias

import typer


def option(name: str, text: str, default: str, panel: str) -> Any:
    """Return an option that tells what the reference scenario has."""
    text = f"{text}; default {default}." if default else f"{text}."
    return typer.Option(name, help=text, show_default=False, rich_help_panel=panel)


_WALL, _HAND, _DEVICE, _RUN = "Wall", "Hand", "Device", "Run"

Law: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        "--law",
        "-l",
        help="A law by name, see `ebac laws`; repeat it for several, `all` for every law.",
        show_default="tca, eba, ebac",
        rich_help_panel=_RUN,
    ),
]

Stiffness: TypeAlias = Annotated[
    float | None, option("--stiffness", "Stiffness K of the wall [N/m]", "10000", _WALL)
]
Damping: TypeAlias = Annotated[
    float | None, option("--damping", "Damping B of the wall [N s/m]", "0", _WALL)
]
Position: TypeAlias = Annotated[
    float | None,
    option("--position", "Where its surface is [m], from the start", "0", _WALL),
]

HandName: TypeAlias = Annotated[
    str | None, option("--hand", "A hand by name, see `ebac presets`", "reference", _HAND)
]
Mass: TypeAlias = Annotated[float | None, option("--mass", "Mass of the hand [kg]", "0.15", _HAND)]
HandDamping: TypeAlias = Annotated[
    float | None, option("--hand-damping", "Damping of the hand [N s/m]", "6", _HAND)
]
HandStiffness: TypeAlias = Annotated[
    float | None, option("--hand-stiffness", "Stiffness of the hand [N/m]", "300", _HAND)
]
Target: TypeAlias = Annotated[
    float | None, option("--target", "Where the hand wants to be [m]", "0.04", _HAND)
]

DeviceName: TypeAlias = Annotated[
    str | None, option("--device", "A device by name, see `ebac presets`", "reference", _DEVICE)
]
Noise: TypeAlias = Annotated[
    float | None,
    option("--noise", "Noise of the force sensor, standard deviation [N]", "0", _DEVICE),
]
Permille: TypeAlias = Annotated[
    bool | None,
    typer.Option(
        "--permille/--no-permille",
        help="Torque in whole thousandths of the rated torque, as a CANopen drive takes it.",
        show_default=False,
        rich_help_panel=_DEVICE,
    ),
]

Rate: TypeAlias = Annotated[float | None, option("--rate", "Ticks per second [Hz]", "1000", _RUN)]
Delay: TypeAlias = Annotated[
    int | None, option("--delay", "Ticks until a command acts [samples]", "1", _RUN)
]
Jitter: TypeAlias = Annotated[
    float | None, option("--jitter", "Largest deviation of a tick, as a share of it", "0", _RUN)
]
Through: TypeAlias = Annotated[
    str | None,
    option(
        "--through",
        "What lies between loop and plant: `can` for a CAN bus with simulated drives",
        "nothing",
        _RUN,
    ),
]
Seconds: TypeAlias = Annotated[
    float | None, option("--seconds", "Length of the run [s]", "6", _RUN)
]
Seed: TypeAlias = Annotated[
    int | None, option("--seed", "Seed of noise, jitter and the encoder's phase", "1", _RUN)
]
ScenarioFile: TypeAlias = Annotated[
    Path | None,
    option("--scenario", "Start from a scenario in TOML; other options come on top", "", _RUN),
]
Threads: TypeAlias = Annotated[
    int | None,
    typer.Option(
        help="Threads.", show_default="one per core", min=1, max=1024, rich_help_panel=_RUN
    ),
]


def out_folder(what: str, default: Path) -> Any:
    """Return the option for the folder a command writes `what` to."""
    text = f"Folder for {what}; with --json only when given."
    return typer.Option("--out", help=text, show_default=str(default), rich_help_panel=_RUN)


def resume(what: str) -> Any:
    """Return the option that continues `what` where it was stopped."""
    text = f"Continue a {what} that was stopped in --out."
    return typer.Option("--resume", help=text, rich_help_panel=_RUN)
