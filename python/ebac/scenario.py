"""A scenario: everything of a simulated run but the law."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, Self, TypeAlias

from ebac._core import Corner, Device, Disc, Free, Hand, Observer, Setup, Timing, Wall, _World
from ebac._util.arguments import keywords_only, refuse_unknown, require, require_file, require_path
from ebac._util.at_user import warn
from ebac._util.atomic_file import write_text
from ebac._util.copying import refuse_uncopyable
from ebac._util.misplaced import Misplaced, misplaced
from ebac._util.text_file import read_text
from ebac._util.toml_lines import placed
from ebac.hands import as_hand, is_own
from ebac.scenario_checks import EVERY_LAW as EVERY_LAW
from ebac.scenario_checks import LEARNS_SCALE as LEARNS_SCALE
from ebac.scenario_checks import (
    NAMED_OBSERVERS,
    NUMBERS,
    PARTS,
    as_environment,
    check_axes,
    check_ranges,
    check_types,
    part_of,
)
from ebac.scenario_text import parts_of, text_of

__all__ = [
    "Environment",
    "Scenario",
]


def __dir__() -> list[str]:
    return __all__


Environment: TypeAlias = Free | Wall | Corner | Disc | _World


@keywords_only(PARTS, part_of)
@dataclass(frozen=True, kw_only=True)
class Scenario:
    """Device, hand, virtual world and time of a simulated run. The same scenario gives the same bits.

    Parameters
    ----------
    device : Device
        The haptic device; default: one axis of 0.25 kg and 2 N s/m with the paper's drive train.
    hand : Hand
        Who holds it; default: 0.15 kg, 6 N s/m, 300 N/m, pulling to 40 mm. A model of `ebac.hands` alone stands for
        the default hand with this model; an object with `force(t, x, v)` for a hand of your own.
    environment : Free, Wall, Corner, Disc, worlds.World, worlds.Bridge or worlds.FunctionWorld
        What it touches; default: a wall of 10 kN/m at 0 m (paper, section IV.C). A solid or body of `ebac.worlds`
        stands for a world of it.
    timing : Timing
        Sample time [s] and transport delay [samples]; default: 1 ms, 1 sample.
    seconds : float
        Length of the run [s], (0, 1e5].
    jitter : float
        Largest deviation of a tick from its instant, as a share of the sample time, [0, 0.45].
    seed : int
        Seed of sensor noise, jitter and the place of zero within an encoder count, [0, 2^63).
    observer : bool, "every-law", "learns-scale" or Observer
        Whether the state of the device is estimated in every tick, from encoder, force sensor and currents: columns
        `est.*`. `ebac` then meets the world where the device will be when the command acts; so does any other law with
        "every-law". With "learns-scale" it learns from swings on a world how strong the motor is for the force sensor.
        True, the default, and the names design it from device and timing, as `Observer.of`; an `Observer` is used as it
        is; False runs on the encoder alone, as does a device without a force sensor.

    Raises
    ------
    ValueError
        When a number is out of its range.
    TypeError
        When a part is of a wrong type.
    """

    device: Device = field(default_factory=Device)
    hand: Hand = field(default_factory=Hand)
    environment: Environment = field(default_factory=Wall)
    timing: Timing = field(default_factory=Timing)
    seconds: float = 6.0
    jitter: float = 0.0
    seed: int = 1
    observer: Observer | bool | Literal["every-law", "learns-scale"] = True

    def __post_init__(self) -> None:
        """Check types and ranges."""
        object.__setattr__(self, "hand", as_hand(self.hand))
        object.__setattr__(self, "environment", as_environment(self.environment))
        for name in (*NUMBERS, "observer"):
            value = getattr(self, name)  # of NumPy, which is not loaded for it
            if getattr(value, "ndim", None) == 0:
                object.__setattr__(self, name, value.item())
        check_types(self)
        check_ranges(self)

    @property
    def known_timing(self) -> Timing:
        """Timing that a law for this scenario is designed from; its jitter is included."""
        if self.jitter <= self.timing.jitter:
            return self.timing
        return self.timing.replace(jitter=self.jitter)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some parts changed."""
        refuse_unknown("Scenario", changes, PARTS, part_of)
        return dataclasses.replace(self, **changes)

    def doubts(self) -> tuple[str, ...]:
        """Return what is possible, but more likely not meant, a text for each: the value, what is usual, the remedy.

        `simulate` warns of these, but not of heat, and of a weak motor only where the ideal rest takes no search:

        - a device in wrong units: current and force of the motor, mass, counts of the encoder, noise and steps of the
          force sensor, weight, stops, a drum larger than its sector;
        - a stiffness outside 50 N/m to 500 kN/m;
        - a wall behind the stops of the device, which the handle never reaches;
        - a handle that begins more than 1 mm inside the world and is pushed with more than 1 N;
        - an ideal rest for which the motor is too weak, or for which it gets too hot to stay.

        See also `Trace.doubts`, for what only a run shows.
        """
        from ebac._util.doubts.scenario import doubts

        return doubts(self)

    def to_toml(self, *, folder: str | Path | None = None) -> str:
        """Return the scenario as TOML text, SI units throughout.

        Parameters
        ----------
        folder : path, optional
            Where it will lie: the file of a mesh below it is named from there, any other by its whole path; default:
            as the mesh names it.

        Raises
        ------
        ValueError
            When its hand or world is one of your own: code is not written to a file.
        """
        return text_of(self, None if folder is None else Path(folder))

    @classmethod
    def from_toml(cls, text: str, *, folder: str | Path | None = None) -> Self:
        """Read a scenario from TOML text; what is not named keeps its default.

        A device or hand may start from one of `ebac.presets`: `[device] preset = "joystick"`.

        Parameters
        ----------
        text : str
            TOML.
        folder : path, optional
            Where the document lies, from which the file of a mesh is named; default: the working directory.

        Raises
        ------
        ValueError
            For a number out of range, an unknown name or a syntax error; the message names the place.
        """
        require(text, str, "Scenario.from_toml", "text")
        parts = parts_of(text, cls, None if folder is None else Path(folder))
        try:
            return cls(**parts)
        except (ValueError, TypeError) as error:
            raise misplaced((), parts, error) from None

    def save(self, path: str | Path) -> None:
        """Write the scenario to a TOML file. The file of a mesh below its folder is named from there.

        Raises
        ------
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        require_path(path, "Scenario.save")
        write_text(path, self.to_toml(folder=Path(path).parent))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a scenario from a TOML file. The file of a mesh is named from the folder of the TOML file.

        Raises
        ------
        FileNotFoundError
            When there is no such file.
        IsADirectoryError
            When it is a folder.
        ValueError
            As `from_toml`, with the file's name and the line.
        """
        require_file(path, "Scenario.load")
        text = ""
        try:
            text = read_text(path)
            return cls.from_toml(text, folder=Path(path).parent)
        except ValueError as error:
            where = error.path if isinstance(error, Misplaced) else ()
            raise ValueError(placed(path, text, where, str(error))) from None

    def designed_observer(self) -> Observer | None:
        """Return the observer of a run, or None without one."""
        if isinstance(self.observer, Observer):
            return self.observer
        if not self.observer or not self.device.sensor.fitted:
            return None
        designed = Observer.of(self.device, self.timing)
        if isinstance(self.observer, str):
            return designed.replace(**NAMED_OBSERVERS[self.observer])
        return designed

    def setup(self) -> Setup:
        """Return what the C++ simulation takes.

        Raises
        ------
        ValueError
            When the device has too few axes for its environment or its hand.
        TypeError
            When a hand in Python cannot be copied.
        """
        check_axes(self)
        if is_own(self.hand.model):
            refuse_uncopyable(self.hand.model, "hand")
        return Setup(
            device=self.device,
            hand=self.hand,
            environment=self.environment,
            timing=self.timing,
            seconds=float(self.seconds),
            jitter=float(self.jitter),
            seed=self.seed,
            observer=self.designed_observer(),
        )


def scenario_of_log(text: str) -> Scenario | None:
    """Return the scenario that a log was written with; None without one.

    None with a warning, too, where a file or a package that it needs is missing, or it is that of another version: the
    rows are worth more than that.
    """
    if not text:
        return None
    try:
        return Scenario.from_toml(text)
    except (ValueError, OSError, ImportError) as error:
        warn(f"the scenario in the log is not used: {error}")
        return None
