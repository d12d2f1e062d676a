"""The table `[objects]` of a profile: objects of a maker's own, as raw numbers."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from typing import Any

from ebac.drives.objects import NUMBERS, Object, find, known
from ebac.drives.profile_fields import Value
from ebac.drives.setting import Setting
from ebac.drives.toml_positions import Path as Where
from ebac.drives.toml_positions import Source

_WHERE = re.compile(r"0x([0-9A-Fa-f]{1,4})(?::(\d{1,3}))?$")
#: What commands the motor, or belongs to a key of its own: never a raw number of a profile.
_COMMANDS = frozenset(
    {0x6040, 0x6042, 0x6060, 0x6071, 0x607A, 0x60B0, 0x60B1, 0x60B2, 0x60C1, 0x60FF}
)
_RESERVED = frozenset({0x1005, 0x1010, 0x1011, 0x1014, 0x1016, 0x1017})


def read_vendor(source: Source, table: Mapping[str, Any], base: int) -> int:
    """Return the maker's number that a profile names; `base` where it names none, as the table of a node.

    Raises
    ------
    ProfileError
        For what is no number of CiA's list.
    """
    found = table.get("vendor", base)
    if isinstance(found, bool) or not isinstance(found, int) or not 0 <= found < 1 << 32:
        raise source.refuse(
            ("vendor",),
            f"vendor = {found!r}: must be a whole number in [0, 0xFFFFFFFF], what the drive has in 0x1018:1 (0xFB is "
            "maxon); leave it out for any maker",
        )
    return found


def read_objects(
    source: Source,
    table: Any,
    path: Where,
    taken: Mapping[str, str],
    values: Mapping[str, Value],
) -> list[Setting]:
    """Return the objects of a table: "0x3001:1" = 985, or "0x2001" = { value = -5, type = "i16", why = "..." }.

    A value of a key of the profile, in units of the maker's own, is { of = "limits.rated_current", unit = 1e-3 }.

    Parameters
    ----------
    source : Source
        The document.
    table : mapping
        As TOML has it.
    path : tuple
        Where it stands.
    taken : mapping
        Names of objects that keys of the profile set, and those keys.
    values : mapping
        Values of the profile by key.

    Raises
    ------
    ProfileError
        For what is no object, or one that a profile must not set by its number.
    """
    if not isinstance(table, Mapping):
        raise source.refuse(path, f"objects = {table!r}: must be a table")
    reserved = {
        known()[name + old].key: key
        for name, key in taken.items()
        for old in ("", "_old")
        if name + old in known()
    }
    found = []
    for name, given in table.items():
        at = (*path, name)
        match = _WHERE.match(name)
        if match is None or int(match[2] or 0) > 0xFF:
            raise source.refuse(
                at,
                f'objects: "{name}": must be an index, "0x3001", or with a sub-index, "0x3001:1"',
            )
        key = int(match[1], 16), int(match[2] or 0)
        if key[0] in _COMMANDS or 0x1400 <= key[0] < 0x1C00 or key[0] in _RESERVED:
            raise source.refuse(
                at,
                f"objects: {name}: commands the motor or the bus, which is not a matter of [objects]: PDOs have "
                "[pdo], heartbeats and SYNC their own keys",
            )
        if key in reserved:
            raise source.refuse(at, f"objects: {name}: is set by {reserved[key]}: use that key")
        found.append(_own(source, at, name, find(key), given, values))
    return found


def following(setting: Setting, values: Mapping[str, Value]) -> Setting:
    """Return an object that follows from a key of the profile with the number of these values.

    Raises
    ------
    ValueError
        Where there is no such value, or the unit is too coarse for it.
    """
    if not setting.of:
        return setting
    value = values.get(setting.of)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"of = {setting.of!r}: the profile has no number of that name; give one")
    exact = value / setting.unit
    if abs(round(exact) - exact) > 0.01 * abs(exact):
        raise ValueError(
            f"{setting.of} = {value:g} is {exact:.4g} units of {setting.unit:g}, more than 1 % off a whole number: "
            f"give {max(round(exact), 1) * setting.unit:g}, or the unit of the drive if it is a smaller one"
        )
    return dataclasses.replace(setting, value=round(exact))


def _own(
    source: Source, at: Where, name: str, obj: Object, given: Any, values: Mapping[str, Value]
) -> Setting:
    parts = given if isinstance(given, Mapping) else {"value": given}
    if "of" in parts:
        return _derived(source, at, name, obj, parts, values)
    value, why = parts.get("value"), parts.get("why", "set by the profile")
    if unknown := set(parts) - {"value", "type", "why"}:
        raise source.refuse(
            at, f"objects: {name}: {unknown.pop()}: must be value, type or why, or of, unit and why"
        )
    kind = _kind(source, at, name, parts.get("type", obj.kind))
    if isinstance(value, bool) or not isinstance(value, int) or not isinstance(why, str):
        raise source.refuse(
            at, f"objects: {name} = {given!r}: must be a whole number, as the drive holds it"
        )
    # A maker may count in another unit than the standard: the EPOS4 has its rated torque in 1e-6 N m.
    unit = obj.unit if obj.hexadecimal and kind == obj.kind else ""
    typed = dataclasses.replace(obj, kind=kind, unit=unit)
    try:
        typed.encode(value)
    except ValueError as error:
        hint = (
            ""
            if "type" in parts
            else '; a negative number needs its type, { value = -5, type = "i16" }'
        )
        raise source.refuse(at, f"objects: {name}: {error}{hint}") from None
    return Setting(object=typed, value=value, why=why, key=f"objects.{typed.where}")


def _derived(
    source: Source,
    at: Where,
    name: str,
    obj: Object,
    parts: Mapping[str, Any],
    values: Mapping[str, Value],
) -> Setting:
    of, unit = parts["of"], parts.get("unit")
    why = parts.get("why", f"follows from {of}")
    if unknown := set(parts) - {"of", "unit", "type", "why"}:
        raise source.refuse(at, f"objects: {name}: {unknown.pop()}: must be of, unit, type or why")
    if isinstance(unit, bool) or not isinstance(unit, (int, float)) or not 1e-9 <= unit <= 1e3:
        raise source.refuse(
            at,
            f"objects: {name}: unit = {unit!r}: must lie in [1e-9, 1000], what one unit of the drive is in SI units",
        )
    kind = _kind(source, at, name, parts.get("type", obj.kind))
    typed = dataclasses.replace(obj, kind=kind, unit="")
    key = f"objects.{typed.where}"
    blank = Setting(object=typed, value=0, why=str(why), key=key, of=str(of), unit=unit)
    try:
        made = following(blank, values)
        typed.encode(made.value)
    except ValueError as error:
        raise source.refuse(at, f"objects: {name}: {error}") from None
    return made


def _kind(source: Source, at: Where, name: str, kind: Any) -> str:
    if kind not in NUMBERS:
        raise source.refuse(
            at, f"objects: {name}: type = {kind!r}: must be one of {', '.join(NUMBERS)}"
        )
    return str(kind)
