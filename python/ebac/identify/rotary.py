"""Logs of knobs and joints: angles, counts, torques and currents of a file in SI units, of one kind."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

from ebac._util.arguments import number
from ebac._util.headings import FACTORS
from ebac.identify.columns import QUANTITIES, name_and_unit, quantity_of

if TYPE_CHECKING:
    from ebac.identify.files import Columns

#: Signals that are forces or torques.
FORCES = ("force", "motor", "desired")
#: Of the same kind of device, in the order position, force; and their SI units.
LINEAR, ROTARY = ("length", "force"), ("angle", "torque")
SI = {"length": "m", "angle": "rad", "force": "N", "torque": "N m", "time": "s"}
#: Range and unit of each option.
RANGES = {
    "lever": (1e-4, 10.0, "m"),
    "counts_per_turn": (1.0, 1e10, ""),
    "torque_constant": (1e-6, 1e4, "N m/A"),
    "force_constant": (1e-6, 1e6, "N for one A or V"),
    "count": (0.0, 1.0, "m or rad"),
}
#: What a drive logs in place of a force or a torque, and its unit.
COMMANDS = {"current": "A", "voltage": "V"}


@dataclass(frozen=True, kw_only=True)
class Conversion:
    """What turns columns of a joint into those a fit needs.

    `lever` [m] sees angle and torque as motion and force of a handle, `torque_constant` [N m/A or N m/V] sees a
    current or a voltage as torque, `force_constant` [N/A or N/V] as force, `counts_per_turn` counts as an angle,
    `count` [m] counts as a way.
    """

    lever: float | None = None
    torque_constant: float | None = None
    force_constant: float | None = None
    counts_per_turn: float | None = None
    count: float | None = None

    def __post_init__(self) -> None:
        """Check the ranges."""
        for name, (low, high, unit) in RANGES.items():
            value = getattr(self, name)
            if value is not None and not low <= number(name, value) <= high:
                unit = f" {unit}" if unit else ""
                raise ValueError(f"{name} = {value:g}{unit}: must lie in [{low:g}, {high:g}]{unit}")
        if self.force_constant is not None and self.torque_constant is not None:
            raise ValueError(
                f"force_constant = {self.force_constant:g}, torque_constant = {self.torque_constant:g}: give one of "
                "them, as the motor drives a slide or a joint"
            )

    @property
    def step(self) -> float | None:
        """Step of an encoder of these counts per turn, as `in_si` returns the position [rad or m]; None without one."""
        if self.counts_per_turn is None:
            return None
        return 2 * pi / self.counts_per_turn * (self.lever or 1.0)


def in_si(
    file: str,
    raw: Columns,
    chosen: Mapping[str, str],
    units: Mapping[str, str],
    how: Conversion,
    *,
    guessed: Collection[str] = (),
) -> tuple[Columns, bool, list[str]]:
    """Return the signals in SI units, whether they are those of a rotary device, and what was taken for granted.

    A signal that was `guessed` by its heading, and that nothing needs, is left out where it does not fit the others.

    Raises
    ------
    ValueError
        For a unit that does not fit, angles with forces or ways with torques and no lever, counts or currents without
        what turns them, or such an option without use.
    """
    found, remarks = {}, []
    for key, column in chosen.items():
        says = name_and_unit(key, column)[1]
        found[key] = quantity_of(file, key, column, units.get(key, says))
        if says is not None and found[key] != quantity_of(file, key, column, says):
            remarks.append(
                f"{key}: taken as {found[key][1]} as asked, column {column!r} says {says}"
            )
    for key, (quantity, unit) in found.items():
        if unit is not None:
            if key not in units:
                remarks.append(f"{key}: in {unit}, as its heading says")
            continue
        kind = quantity or QUANTITIES[key][0]
        if quantity is None and key != "x" and found["x"][0] in ("angle", "count"):
            rotary = found["x"][0] == "angle" or how.counts_per_turn is not None
            kind = (ROTARY if rotary else LINEAR)[key in FORCES]
        found[key] = kind, next(iter(FACTORS[kind]))
        remarks.append(f"{key}: no unit given, taken as {found[key][1]}")
    _refuse_without_use(file, {quantity for quantity, _ in found.values()}, how)
    signals: Columns = {}
    kinds: dict[str, str] = {}
    for key in sorted(found, key=lambda key: key != "x"):
        quantity, unit = found[key]
        assert quantity is not None
        assert unit is not None
        spare = key in guessed and key not in ("t", "x", "force") and "force" in found
        if spare and quantity in COMMANDS and how.torque_constant is how.force_constant is None:
            options = "--torque-constant or --force-constant"
            remarks.append(_left_out(key, chosen[key], f"a {quantity}", options))
            continue
        kind, factor = _converted(file, key, chosen[key], quantity, how)
        kinds[key] = kind
        if kind in ("time", *(ROTARY if kinds["x"] == "angle" else LINEAR)):
            signals[key] = raw[chosen[key]] * (FACTORS[quantity][unit] * factor)
        elif spare:
            what = f"{_words(kind, unit)} with x in {found['x'][1]}"
            remarks.append(_left_out(key, chosen[key], what, "--lever"))
        else:
            fits = SI[(ROTARY if kinds["x"] == "angle" else LINEAR)[key in FORCES]]
            raise ValueError(
                f"{file}: x (column {chosen['x']!r}) is {_words(kinds['x'], found['x'][1])} and {key} "
                f"(column {chosen[key]!r}) {_words(kind, unit)}: eq. (6) needs motion and force of one place. "
                "Give the lever between them [m], lever=0.05 or --lever 0.05, or the right unit, "
                f"--unit {key}={fits.replace(' ', '')}"
            )
    rotary = kinds["x"] == "angle"
    return signals, rotary, remarks


def _left_out(key: str, column: str, what: str, option: str) -> str:
    return f"{key}: column {column!r} is left out, {what}; {option} takes it"


def _words(kind: str, unit: str | None) -> str:
    article = "an" if kind == "angle" else "a"
    return f"{article} {kind} in {unit}"


def _converted(
    file: str, key: str, column: str, quantity: str, how: Conversion
) -> tuple[str, float]:
    """Return what a signal becomes, and by which factor."""
    factor = 1.0
    if quantity == "count":
        if how.counts_per_turn is None and how.count:
            return "length", how.count
        if how.counts_per_turn is None:
            raise ValueError(
                f"{file}: {key} (column {column!r}) is in counts: give counts_per_turn=4096 or --counts-per-turn 4096 "
                "of a knob or a joint, or the step at the handle [m], count=1e-5 or --count 1e-5"
            )
        quantity, factor = "angle", 2 * pi / how.counts_per_turn
    elif quantity in COMMANDS:
        if how.force_constant is not None:
            quantity, factor = "force", how.force_constant
        elif how.torque_constant is not None:
            quantity, factor = "torque", how.torque_constant
        else:
            unit = COMMANDS[quantity]
            raise ValueError(
                f"{file}: {key} (column {column!r}) is a {quantity}: give the torque at the joint for one {unit} "
                f"[N m/{unit}], gear included: torque_constant=0.06 or --torque-constant 0.06; or the force of a "
                f"slide [N/{unit}]: force_constant=35 or --force-constant 35"
            )
    if how.lever is None:
        return quantity, factor
    if quantity == "angle":
        return "length", factor * how.lever
    if quantity == "torque":
        return "force", factor / how.lever
    return quantity, factor


def _refuse_without_use(file: str, quantities: set[str | None], how: Conversion) -> None:
    angles = bool(quantities & {"angle", "count"})
    commands = bool(quantities & set(COMMANDS))
    no_command = "current in A or mA, and no voltage in V or mV"
    for option, value, used, why in (
        ("lever", how.lever, angles or commands or "torque" in quantities, "angle or torque"),
        ("torque_constant", how.torque_constant, commands, no_command),
        ("force_constant", how.force_constant, commands, no_command),
        ("counts_per_turn", how.counts_per_turn, angles, "angle, and no counts"),
    ):
        if value is not None and not used:
            raise ValueError(f"{file}: {option} = {value:g}: the file has no {why}; leave it out")
