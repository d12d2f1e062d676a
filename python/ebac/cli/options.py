"""The options that set up a run, in groups, for every command that simulates.

A group is a dataclass: a command takes it as one parameter, and `command.add` makes options of its fields. What is not
given is None and leaves the scenario as it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from ebac.cli import completion, setting

if TYPE_CHECKING:
    from ebac.operators import Operators

WALL, HAND, DEVICE, RUN, POPULATION = "Wall", "Hand", "Device", "Run", "Population"


def option(*names: str, text: str, default: str | bool = False, panel: str, **more: Any) -> Any:
    """Return an option whose help names what the reference scenario has."""
    return typer.Option(
        *names, help=f"{text}.", show_default=default, rich_help_panel=panel, **more
    )


def laws(default: str, *, panel: str = RUN) -> Any:
    """Return the option for several laws."""
    return typer.Option(
        "--law",
        "-l",
        help="A law by name, see `ebac laws`, or of your own, FILE.py:NAME or MODULE:NAME; several separated by "
        "commas, `all` for every law of the package.",
        show_default=default,
        rich_help_panel=panel,
        autocompletion=completion.laws,
    )


#: How a law of one's own is given where it must be compiled, and where it need not be.
COMPILED, OWN = "in C++, MODULE:NAME", "as FILE.py:NAME"


def one_law(*, panel: str = RUN, default: str | bool = True, own: str = "") -> Any:
    """Return the option for one law; `own`: how it may be one of one's own, COMPILED or OWN."""
    more = f", or of your own {own}" if own else ""
    return typer.Option(
        "--law",
        "-l",
        help=f"A law by name, see `ebac laws`{more}.",
        show_default=default,
        rich_help_panel=panel,
        autocompletion=completion.laws,
    )


def conditions(text: str, *, panel: str, default: str | bool = True) -> Any:
    """Return the option for conditions."""
    return typer.Option(
        "--condition",
        "-c",
        help=text,
        show_default=default,
        rich_help_panel=panel,
        autocompletion=completion.conditions,
    )


#: The condition where none is asked for, in words.
USUAL_CONDITION = "d1K10; as-given with --scenario"


def usual_condition(run: RunOptions) -> str:
    """Return the condition where none is asked for: a scenario that is given stays as it is."""
    return "d1K10" if run.scenario is None else "as-given"


HandName: TypeAlias = Annotated[
    str | None,
    option(
        text="A hand by name, see `ebac presets`",
        default="reference",
        panel=HAND,
        autocompletion=completion.hands,
    ),
]
DeviceName: TypeAlias = Annotated[
    str | None,
    option(
        text="A device by name, see `ebac presets`",
        default="reference",
        panel=DEVICE,
        autocompletion=completion.devices,
    ),
]
DeviceNoise: TypeAlias = Annotated[
    float | None,
    option(text="Noise of the force sensor, standard deviation [N]", default="0", panel=DEVICE),
]
DeviceLag: TypeAlias = Annotated[
    float | None,
    option(text="Time constant of the force sensor's filter [s]", default="0.0008", panel=DEVICE),
]
Rate: TypeAlias = Annotated[
    float | None, option(text="Ticks per second [Hz]", default="1000", panel=RUN)
]
Delay: TypeAlias = Annotated[
    int | None, option(text="Ticks until a command acts [samples]", default="1", panel=RUN)
]
Jitter: TypeAlias = Annotated[
    float | None,
    option(text="Largest deviation of a tick, as a share of it", default="0", panel=RUN),
]
Seed: TypeAlias = Annotated[
    int | None,
    option(text="Seed of noise, jitter and the encoder's phase", default="1", panel=RUN),
]
ScenarioFile: TypeAlias = Annotated[
    Path | None,
    option(text="Start from a scenario in TOML; other options come on top", panel=RUN),
]
Threads: TypeAlias = Annotated[
    int | None,
    typer.Option(
        help="Number of threads.",
        show_default="one per usable core",
        min=1,
        max=1024,
        rich_help_panel=RUN,
    ),
]


def observer(*, default: str | bool = True) -> Any:
    """Return the option that turns the state observer on or off."""
    return option(
        "--observer/--no-observer",
        text="Estimate the state from encoder and force sensor, and predict it; `ebac` uses it",
        default=default,
        panel=RUN,
    )


def resume(what: str) -> Any:
    """Return the option that continues a study, map or ablation where it was stopped."""
    text = f"Continue a stopped {what} in its folder: that of --out, or the last one; begin where there is none."
    return typer.Option("--resume", help=text, rich_help_panel=RUN)


@dataclass(frozen=True, kw_only=True)
class WallOptions:
    """The virtual wall."""

    wall_stiffness: Annotated[
        float | None, option(text="Stiffness K of the wall [N/m]", default="10000", panel=WALL)
    ] = None
    wall_damping: Annotated[
        float | None, option(text="Damping B of the wall [N s/m]", default="0", panel=WALL)
    ] = None
    wall_position: Annotated[
        float | None, option(text="Position of its surface [m]", default="0", panel=WALL)
    ] = None


@dataclass(frozen=True, kw_only=True)
class HandOptions:
    """The simulated hand."""

    hand: HandName = None
    hand_mass: Annotated[
        float | None, option(text="Mass of the hand [kg]", default="0.15", panel=HAND)
    ] = None
    hand_damping: Annotated[
        float | None, option(text="Damping of the hand [N s/m]", default="6", panel=HAND)
    ] = None
    hand_stiffness: Annotated[
        float | None, option(text="Stiffness of the hand [N/m]", default="300", panel=HAND)
    ] = None
    hand_target: Annotated[
        float | None, option(text="Position the hand moves to [m]", default="0.04", panel=HAND)
    ] = None


@dataclass(frozen=True, kw_only=True)
class PopulationOptions:
    """The hands of a study."""

    population: Annotated[
        str,
        typer.Option(
            help="grid60, random, or a CSV file with the columns m_kg, b_Ns_per_m, k_N_per_m, target_m and optionally "
            "approach_m, tremor_m, tremor_Hz.",
            rich_help_panel=POPULATION,
        ),
    ] = "grid60"
    hands: Annotated[
        int | None,
        typer.Option(
            help="Number of random hands.",
            show_default="500",
            min=1,
            max=1_000_000,
            rich_help_panel=POPULATION,
        ),
    ] = None
    seed: Annotated[
        int,
        typer.Option(
            help="Seed of random hands, noise and jitter.", min=0, rich_help_panel=POPULATION
        ),
    ] = 1

    def operators(self, approach: float | None = None) -> Operators:
        """Return the hands, with another way through free air before the wall [m] if it is given."""
        return setting.population(self.population, self.hands, self.seed, approach)


@dataclass(frozen=True, kw_only=True)
class DeviceOptions:
    """The simulated device."""

    device: DeviceName = None
    device_noise: DeviceNoise = None
    device_lag: DeviceLag = None
    device_sensor: Annotated[
        bool | None,
        option(
            "--device-sensor/--no-device-sensor",
            text="Whether the device has a force sensor; without, laws run on the encoder alone, without force loops",
            default="sensor",
            panel=DEVICE,
        ),
    ] = None
    device_coulomb: Annotated[
        float | None,
        option(text="Coulomb friction of the device [N]", default="0", panel=DEVICE),
    ] = None
    device_friction_compensation: Annotated[
        float | None,
        option(text="Friction that its motor compensates [N]", default="0", panel=DEVICE),
    ] = None
    device_counts: Annotated[
        int | None,
        option(text="Encoder counts per turn of the motor", default="1024", panel=DEVICE),
    ] = None
    device_permille: Annotated[
        bool | None,
        option(
            "--device-permille/--no-device-permille",
            text="Torque in whole thousandths of the rated torque, as a CANopen drive takes it",
            panel=DEVICE,
        ),
    ] = None


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """Length and file of a simulated run."""

    rate: Rate = None
    jitter: Jitter = None
    observer: Annotated[bool | None, observer()] = None
    observer_every_law: Annotated[
        bool | None,
        typer.Option(
            "--observer-every-law",
            help="Let every law use the estimate of the observer, not only `ebac`; not with --observer-learns.",
            rich_help_panel=RUN,
        ),
    ] = None
    observer_learns: Annotated[
        bool | None,
        typer.Option(
            "--observer-learns",
            help="Let the observer learn, from swings on the wall, how strong the motor is for the force sensor; not "
            "with --observer-every-law.",
            rich_help_panel=RUN,
        ),
    ] = None
    seconds: Annotated[
        float | None, option(text="Length of the run [s]", default="6", panel=RUN)
    ] = None
    scenario: ScenarioFile = None


@dataclass(frozen=True, kw_only=True)
class ScenarioOptions(RunOptions, DeviceOptions, HandOptions, WallOptions):
    """All that sets up one run."""

    world: Annotated[
        str | None,
        option(
            text="A world by name instead of the wall, see `ebac worlds`, or mesh:FILE; its surface has the stiffness, "
            "damping and position of the wall",
            default="a flat wall",
            panel=WALL,
            autocompletion=completion.worlds,
        ),
    ] = None
    world_friction: Annotated[
        float | None, option(text="Coulomb friction of its surface [1]", default="0", panel=WALL)
    ] = None
    delay: Delay = None
    seed: Seed = None
