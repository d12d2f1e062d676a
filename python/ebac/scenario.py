"""A scenario: everything of a simulated run but the law."""

from __future__ import annotations

import dataclasses
import warnings
from dataclasses import dataclass, field
from math import cos
from pathlib import Path
from typing import Any, Final, Literal, Self, TypeAlias

from ebac._core import (
    Corner,
    Device,
    Disc,
    Free,
    Hand,
    Observer,
    Setup,
    Step,
    Timing,
    Wall,
    _World,
)
from ebac._util.arguments import (
    did_you_mean,
    keywords_only,
    refuse_unknown,
    require,
    require_file,
    require_path,
    shown,
)
from ebac._util.atomic_file import write_text
from ebac._util.copying import refuse_uncopyable
from ebac._util.misplaced import Misplaced, misplaced
from ebac._util.plural import plural
from ebac._util.serialisation import SHAPES
from ebac._util.text_file import read_text
from ebac._util.toml_lines import placed
from ebac.hands import as_hand, is_own
from ebac.scenario_text import parts_of, text_of

__all__ = [
    "Environment",
    "Scenario",
]


def __dir__() -> list[str]:
    return __all__


Environment: TypeAlias = Free | Wall | Corner | Disc | _World

#: The observer that every law acts on.
EVERY_LAW: Final = "every-law"
LEARNS_SCALE: Final = "learns-scale"
#: What a name changes of the observer that is designed from device and timing.
_NAMED_OBSERVERS: Final = {EVERY_LAW: {"every_law": True}, LEARNS_SCALE: {"learn_scale": True}}
_NAMES: Final = " or ".join(map(repr, _NAMED_OBSERVERS))
#: What its numbers are.
_NUMBERS = {"seconds": "a number in s", "jitter": "a number", "seed": "a whole number"}
_PARTS = ("device", "hand", "environment", "timing", "seconds", "jitter", "seed", "observer")


def as_environment(given: Any) -> Any:
    """Return the world of a solid or body of `ebac.worlds`, and anything else as it is."""
    if not type(given).__module__.startswith("ebac.worlds") and not isinstance(given, SHAPES):
        return given
    from ebac.worlds import World

    return given if isinstance(given, _World) else World(given)


def _part_of(name: str) -> str:
    """Return where a parameter belongs that people look for in a scenario."""
    if name == "law":
        return "a law is an argument of ebac.simulate"
    owners = [("environment", kind) for kind in (Wall, Free, Corner, Disc)]
    for part, kind in (("timing", Timing), ("hand", Hand), ("device", Device), *owners):
        if name.lower() == kind.__name__.lower():
            return f"give {part}=ebac.{kind.__name__}(...)"
        if name in kind().as_dict():
            return f"it belongs to {kind.__name__}, {part}=ebac.{kind.__name__}({name}=...)"
    return ""


@keywords_only(_PARTS, _part_of)
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
        for name in (*_NUMBERS, "observer"):
            value = getattr(self, name)  # of NumPy, which is not loaded for it
            if getattr(value, "ndim", None) == 0:
                object.__setattr__(self, name, value.item())
        parts: dict[str, tuple[type, ...]] = {
            "device": (Device,),
            "hand": (Hand,),
            "environment": (Free, Wall, Corner, Disc, _World),
            "timing": (Timing,),
            "seconds": (float, int),
            "jitter": (float, int),
            "seed": (int,),
            "observer": (Observer, bool, str),
        }
        for name, types in parts.items():
            value = getattr(self, name)
            if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
                names = _NUMBERS.get(name) or " or ".join(
                    _NAMES if t is str else t.__name__.lstrip("_") for t in types
                )
                given = shown(value) if isinstance(value, type) else repr(value)
                raise TypeError(f"Scenario.{name} = {given}: must be {names}")
        if isinstance(self.observer, str) and self.observer not in _NAMED_OBSERVERS:
            raise ValueError(
                f"Scenario.observer = {self.observer!r}: must be True, False, {_NAMES}, or an Observer"
                f"{did_you_mean(self.observer, _NAMED_OBSERVERS)}"
            )
        if not isinstance(self.observer, bool) and not self.device.sensor.fitted:
            raise ValueError(
                "Scenario.observer: estimates the state from a measured force, but the device has no force sensor; "
                "leave the observer out, or give the device one"
            )
        if not 0 < self.seconds <= 1e5:
            raise ValueError(f"Scenario.seconds = {self.seconds} s: must lie in (0, 100000] s")
        if not 0 <= self.jitter <= 0.45:
            raise ValueError(f"Scenario.jitter = {self.jitter}: must lie in [0, 0.45] of a sample")
        if not 0 <= self.seed < 2**63:
            raise ValueError(f"Scenario.seed = {self.seed}: must lie in [0, 2^63)")
        if self.seconds < self.timing.dt:
            raise ValueError(
                f"Scenario.seconds = {self.seconds} s: must be at least one sample, {self.timing.dt} s"
            )

    def _check_axes(self) -> None:
        """Refuse an environment or path on axes the device does not have."""
        axes = self.device.axes
        world = self.environment
        across = isinstance(world, Wall) and abs(cos(world.angle)) < 1e-3
        if axes < 2 and (across or isinstance(world, (Corner, Disc))):
            raise ValueError(
                f"Scenario.environment = {world!r}: needs 2 axes, the device has {axes}; "
                "give a device with Linear(axes=2) or Gimbal(), or a Wall across the first axis"
            )
        for axis, path in enumerate(self.hand.path[axes:], start=axes):
            if path != Step(target=0):
                raise ValueError(
                    f"Scenario.hand.path[{axis}] = {path!r}: the device has {plural(axes, 'axis', 'axes')}; "
                    "give it one path for each, or a device with more"
                )

    @property
    def known_timing(self) -> Timing:
        """Timing that a law for this scenario is designed from; its jitter is included."""
        if self.jitter <= self.timing.jitter:
            return self.timing
        return self.timing.replace(jitter=self.jitter)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some parts changed."""
        refuse_unknown("Scenario", changes, _PARTS, _part_of)
        return dataclasses.replace(self, **changes)

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
            return designed.replace(**_NAMED_OBSERVERS[self.observer])
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
        self._check_axes()
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
        warnings.warn(f"the scenario in the log is not used: {error}", stacklevel=2)
        return None
