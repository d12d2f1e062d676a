"""The keys of a profile: unit, range, and the object each one sets. Scaling to raw units is here and nowhere else."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import sqrt
from typing import TypeAlias

from ebac._util.arguments import nearest_float

#: What a key of a profile may hold.
Value: TypeAlias = float | int | bool | str


@dataclass(frozen=True, kw_only=True)
class Key:
    """One key of a profile.

    Parameters
    ----------
    name : str
        Table and key: "motor.torque_constant".
    unit : str
        SI unit of the value; empty for a pure number.
    low, high : float
        Range of the value, in that unit.
    default : float, int, bool, str or None
        None for a key that sets nothing unless it is given.
    whole : bool
        Whether only whole numbers are taken.
    choices : mapping, optional
        Words it may be, and the raw number of each; True and False for a switch.
    remedy : str
        Where to find the right value.
    sets : str
        The object it sets, by name; empty when it only decides on others.
    scale : float
        One raw unit in the unit of the key.
    per : str
        Name of a key the raw number is a share of.
    why : str
        Why it is set, for the plan.
    """

    name: str
    unit: str = ""
    low: float = 0.0
    high: float = 0.0
    default: Value | None = None
    whole: bool = False
    choices: Mapping[Value, int] | None = None
    remedy: str = ""
    sets: str = ""
    scale: float = 1.0
    per: str = ""
    why: str = ""

    def show(self, value: object) -> str:
        """Return a value with the unit of this key."""
        if isinstance(value, int) and abs(value) >= 10**20:  # nobody reads more digits
            value = nearest_float(value)
        text = f"{value:g}" if isinstance(value, float) else f"{value!r}"
        return f"{text} {self.unit}".rstrip()

    def check(self, value: object) -> str | None:
        """Return what is wrong with a value, None when nothing is."""
        if self.choices is not None:
            if isinstance(value, tuple(type(c) for c in self.choices)) and value in self.choices:
                return None
            allowed = " or ".join(_toml(choice) for choice in self.choices)
            return f"{self.name} = {_toml(value)}: must be {allowed}{self._remedy()}"
        kinds = int if self.whole else (int, float)
        if isinstance(value, bool) or not isinstance(value, kinds):
            kind = "a whole number" if self.whole else "a number"
            return f"{self.name} = {_toml(value)}: must be {kind} {self._in()}{self._remedy()}"
        if not self.low <= value <= self.high:
            return (
                f"{self.name} = {self.show(value)}: must lie in [{self.low:g}, {self.high:g}]"
                f"{' ' + self.unit if self.unit else ''}{self._remedy()}"
            )
        return None

    def raw(self, value: Value, values: Mapping[str, Value]) -> int:
        """Return the raw number of a value that `check` let pass.

        Parameters
        ----------
        value : float, int, bool or str
            In the unit of the key.
        values : mapping
            All values of the profile, for `per`.

        Raises
        ------
        ValueError
            When the drive's resolution turns it into another number by more than 1 %.
        """
        if self.choices is not None:
            return self.choices[value]
        number = float(value)
        exact = number / float(values[self.per]) * 1000 if self.per else number / self.scale
        rounded = round(exact)
        if abs(rounded - exact) > 0.01 * abs(exact):
            raise ValueError(
                f"{self.name} = {self.show(value)}: the drive holds {rounded} raw units instead of "
                f"{exact:.4g}, more than 1 % off; one unit is {self.show(number / exact)}: "
                f"{self._whole_units(rounded, number / exact)}"
            )
        return rounded

    def _whole_units(self, rounded: int, unit: float) -> str:
        nearest = f"give {self.show(max(rounded, 1) * unit)}, the nearest that it can hold"
        if not self.sets:
            return nearest
        return (
            f"{nearest}; or, where the drive counts in smaller units, name {self.name} under `without` and set the "
            "drive's own object under [objects], as the profile maxon-epos4 does"
        )

    def _in(self) -> str:
        return f"in {self.unit}" if self.unit else f"in [{self.low:g}, {self.high:g}]"

    def _remedy(self) -> str:
        return f"; {self.remedy}" if self.remedy else ""


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else repr(value)


_SHEET = "see the motor's data sheet"
_MODES: dict[Value, int] = {"cyclic synchronous torque": 10, "profile torque": 4}
_MOTOR_OBJECTS: dict[Value, int] = {"0x2383": 0x2383, "0x6410": 0x6410}
_SWITCH: dict[Value, int] = {True: 1, False: 0}
_TINY, _HUGE = 1e-5, 1e3

#: Every key of a profile, in the order the drive is written.
KEYS: tuple[Key, ...] = (
    Key(name="motor.object", choices=_MOTOR_OBJECTS, default="0x2383",
        remedy="older Copley firmware has its motor data at 0x6410", why="where the drive keeps its motor data"),
    Key(name="motor.torque_constant", unit="N m/A", low=_TINY, high=100, remedy=_SHEET,
        sets="motor_torque_constant", scale=1e-5, why="what current a torque takes, eq. (1)"),
    Key(name="motor.continuous_torque", unit="N m", low=_TINY, high=_HUGE, remedy=_SHEET,
        sets="motor_continuous_torque", scale=1e-5, why="what 1000 per mille are, eq. (1)"),
    Key(name="motor.peak_torque", unit="N m", low=_TINY, high=_HUGE, remedy=_SHEET,
        sets="motor_peak_torque", scale=1e-5, why="the most the motor gives for a moment"),
    Key(name="motor.counts_per_turn", unit="counts", low=1, high=2**31 - 1, whole=True,
        remedy="edges the drive counts in one turn of the motor",
        sets="motor_counts_per_turn", why="what a count of position is"),
    Key(name="limits.rated_torque", unit="N m", low=1e-3, high=_HUGE, remedy=_SHEET,
        sets="rated_torque", scale=1e-3, why="what per mille of torque are of"),
    Key(name="limits.rated_current", unit="A", low=1e-3, high=_HUGE, remedy=_SHEET,
        sets="rated_current", scale=1e-3, why="what per mille of current are of"),
    Key(name="limits.max_torque", unit="N m", low=1e-3, high=_HUGE, remedy=_SHEET,
        sets="max_torque", per="limits.rated_torque", why="never more torque than this"),
    Key(name="limits.max_current", unit="A", low=1e-3, high=_HUGE, remedy=_SHEET,
        sets="max_current", per="limits.rated_current", why="never more current than this"),
    Key(name="torque.slope", unit="N m/s", low=1e-3, high=1e6,
        remedy="steep, or the ramp lags behind the loop",
        sets="torque_slope", per="limits.rated_torque", why="ramp of profile torque"),
    Key(name="torque.mode", choices=_MODES, default="cyclic synchronous torque",
        remedy="profile torque for firmware before 2012",
        sets="mode", why="torque is what the loop commands"),
    Key(name="drive.quick_stop", low=0, high=8, whole=True,
        remedy="CiA 402-2, 0x605A: 0 coast, 2 brake by the quick stop ramp, 6 the same and stay",
        sets="quick_stop_option", why="how a quick stop brakes"),
    Key(name="drive.connection_lost", low=1, high=3, whole=True, default=1,
        remedy="CiA 402-2, 0x6007: 1 fault, 2 power off, 3 quick stop; 0 would hold the torque",
        sets="connection_option", why="without its loop the drive lets go"),
    Key(name="drive.desired_state", low=0, high=65535, whole=True,
        remedy="30 gives the drive to CANopen (Copley, 0x2300)",
        sets="desired_state", why="who commands the drive"),
    Key(name="sync.period", unit="s", low=1e-4, high=1.0, default=1e-3, remedy="1e-3 s for a 1 kHz loop",
        sets="sync_period", scale=1e-6, why="the loop's SYNC comes this often"),
    Key(name="emcy.on", choices=_SWITCH, default=True, remedy="a fault must be reported"),
    Key(name="heartbeat.producer", unit="s", low=0.005, high=60.0, default=0.1,
        remedy="0.1 s costs under 0.1 % of the bus",
        sets="heartbeat_producer", scale=1e-3, why="the loop sees a silent drive"),
    Key(name="heartbeat.consumer", unit="s", low=0.0, high=60.0,
        remedy="three times the loop's heartbeat period; 0 watches nobody",
        scale=1e-3, why="the drive stops when the loop falls silent"),
    Key(name="heartbeat.guard", unit="s", low=0.03, high=60.0, scale=1e-3,
        remedy="node guarding (0x100C, 0x100D), for a drive that watches no heartbeat; then it sends none",
        why="longest silence of the loop, in place of the heartbeat"),
    Key(name="heartbeat.master", low=1, high=127, whole=True, default=127,
        remedy="node id of the loop, one no drive has", why="whose heartbeat the drive watches"),
)  # fmt: skip

#: The same by name.
BY_NAME: dict[str, Key] = {key.name: key for key in KEYS}

#: What must hold between keys: the condition, the key to blame, what is wrong and what to do.
Rule: TypeAlias = tuple[
    Callable[[Mapping[str, Value]], bool], str, str | Callable[[Mapping[str, Value]], str]
]
#: Share by which a rated current may differ from rated torque over torque constant: all three are rounded.
_ROUNDED = 0.02
#: Factors by which the two differ where one of them is in other amperes: peak, effective, those of three phases.
_OTHER_AMPERES = (1.0, sqrt(2), 1.5, sqrt(3), sqrt(6))


def _number(values: Mapping[str, Value], name: str) -> float:
    return float(values[name])


def _same_torque(values: Mapping[str, Value]) -> bool:
    both = ("motor.continuous_torque", "limits.rated_torque")
    if not all(name in values for name in both):
        return True
    motor, rated = (_number(values, name) for name in both)
    return abs(motor - rated) <= 0.01 * rated


def _current_by_torque(values: Mapping[str, Value]) -> float | None:
    """Return rated torque over torque constant [A]; None where one is not given."""
    both = ("limits.rated_torque", "motor.torque_constant")
    if not all(name in values for name in both):
        return None
    return _number(values, both[0]) / _number(values, both[1])


def _same_current(values: Mapping[str, Value]) -> bool:
    current = _current_by_torque(values)
    if current is None or "limits.rated_current" not in values:
        return True
    ratio = _number(values, "limits.rated_current") / current
    return any(
        abs(ratio**sign / factor - 1) <= _ROUNDED for factor in _OTHER_AMPERES for sign in (1, -1)
    )


def _other_current(values: Mapping[str, Value]) -> str:
    current = _current_by_torque(values) or 0.0
    torque, constant = (values[n] for n in ("limits.rated_torque", "motor.torque_constant"))
    # A data sheet's nominal current also drives the motor's own friction, so that it is some per cent more.
    return (
        f"must be within {100 * _ROUNDED:g} % of limits.rated_torque / motor.torque_constant = {torque:g} N m / "
        f"{constant:g} N m/A = {current:.4g} A, the current of the rated torque, or every force is wrong; give "
        f"{current:.4g}, or correct the wrong one of the other two: {_SHEET} (1 mN m is 0.001 N m, 1 mN m/A is "
        "0.001 N m/A)"
    )


def _above_rated(kind: str) -> Callable[[Mapping[str, Value]], bool]:
    def holds(values: Mapping[str, Value]) -> bool:
        largest, rated = f"limits.max_{kind}", f"limits.rated_{kind}"
        if largest not in values:
            return True
        return rated in values and _number(values, largest) <= 65.535 * _number(values, rated)

    return holds


def _no_max_current(values: Mapping[str, Value]) -> str:
    per_mille = "is written to the drive in per mille of limits.rated_current, "
    if (rated := values.get("limits.rated_current")) is not None:
        most = 65.535 * float(rated)
        return f"{per_mille}at most 65535: must be at most {most:.4g} A; give less, or a right limits.rated_current"
    current = _current_by_torque(values)
    found = "" if current is None else f" = {current:.4g}"
    return (
        f"{per_mille}which is not given: give limits.rated_current{found}, which is limits.rated_torque / "
        "motor.torque_constant (a drive that works it out from these two takes the profile where it is the same), or "
        "leave out limits.max_current as well"
    )


RULES: tuple[Rule, ...] = (
    (_same_torque, "motor.continuous_torque",
     "differs from limits.rated_torque by more than 1 %: a torque in per mille would mean two things; "
     "give both the same value"),
    (_same_current, "limits.rated_current", _other_current),
    (_above_rated("torque"), "limits.max_torque",
     "is written to the drive in per mille of limits.rated_torque, at most 65535: give limits.rated_torque, "
     "or less"),
    (_above_rated("current"), "limits.max_current", _no_max_current),
    (lambda v: "torque.slope" not in v or "limits.rated_torque" in v, "torque.slope",
     "is written to the drive in per mille of limits.rated_torque per second: give limits.rated_torque"),
    (lambda v: v["torque.mode"] != "profile torque" or "torque.slope" in v, "torque.mode",
     "profile torque ramps by torque.slope: give torque.slope, steep"),
)  # fmt: skip
