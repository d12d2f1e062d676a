"""A process data object as a profile plans it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ebac._util.arguments import UnknownNameError, unknown
from ebac.drives.load import Traffic
from ebac.drives.objects import ENTRIES, PDOS, find
from ebac.drives.profile_fields import BY_NAME
from ebac.drives.toml_positions import Source

#: Names a PDO may have in a profile.
NAMES = tuple(f"{kind}{i}" for kind in ("rpdo", "tpdo") for i in range(1, PDOS + 1))
#: Types that go with SYNC: every n-th one, 0 with a change only (CiA 301).
_SYNCHRONOUS = range(241)
_EVENT = (254, 255)
#: inhibit time, event timer: longest [s], one raw unit [s].
TIMES = {"inhibit": (6.5535, 1e-4), "event": (65.535, 1e-3)}


@dataclass(frozen=True, kw_only=True)
class Pdo:
    """One PDO.

    Parameters
    ----------
    name : str
        rpdo1 to rpdo4 (to the drive), tpdo1 to tpdo4 (from it).
    objects : tuple of str
        What it carries, by name, at most 8 bytes.
    type : int
        0 to 240: with every n-th SYNC (0: with the next, on a change); 254, 255: on events (CiA 301).
    inhibit : float
        Least time between two from the drive [s], 0 to 6.5535.
    event : float
        Longest time between two [s], 0 to 65.535; 0 for no timer. A drive that waits longer for one
        reports it.
    """

    name: str
    objects: tuple[str, ...]
    type: int = 1
    inhibit: float = 0.0
    event: float = 0.0

    @property
    def size(self) -> int:
        """Data [bytes]."""
        return sum(find(name).bits for name in self.objects) // 8

    @property
    def sent(self) -> bool:
        """Whether the drive sends it: a TPDO."""
        return self.name.startswith("t")

    @property
    def synchronous(self) -> bool:
        """Whether it goes with SYNC."""
        return self.type in _SYNCHRONOUS

    def cob_id(self, node: int) -> int:
        """Return its identifier in the pre-defined connection set (CiA 301)."""
        number = int(self.name[-1])
        return (0x080 if self.sent else 0x100) + 0x100 * number + node

    def entries(self) -> tuple[int, ...]:
        """Return its mapping, index << 16 | sub << 8 | bits."""
        objects = (find(name) for name in self.objects)
        return tuple(obj.index << 16 | obj.sub << 8 | obj.bits for obj in objects)

    def traffic(self, node: int, period: float) -> Traffic:
        """Return how often it comes at most, with SYNC every `period` [s].

        A PDO to the drive comes with every SYNC, whatever its type: the loop sends it.
        """
        if not self.sent:
            rate = 1 / period
        elif self.synchronous:
            rate = 1 / (period * max(1, self.type))
        else:
            rate = 1 / self.inhibit
        return Traffic(name=f"{self.name} of node {node}", size=self.size, rate=rate)


def read_pdo(source: Source, name: str, table: Any) -> Pdo:
    """Return a PDO from its table in a profile.

    Raises
    ------
    ProfileError
        For what cannot be; the message names line, value, range and remedy.
    """
    path = ("pdo", name)
    if name not in NAMES:
        raise source.refuse(path, unknown(f"pdo.{name}", name, [*NAMES, "others"]))
    if not isinstance(table, Mapping):
        raise source.refuse(path, f"pdo.{name} = {table!r}: must be a table with `objects`")
    known = ["objects", "type", *TIMES]
    for key in table:
        if key not in known:
            raise source.refuse((*path, key), unknown(f"pdo.{name}.{key}", key, known))
    pdo = Pdo(
        name=name,
        objects=_objects(source, name, table.get("objects")),
        type=_type(source, name, table.get("type", 1)),
        **{key: _time(source, name, key, table.get(key, 0.0)) for key in TIMES},
    )
    if not pdo.sent and pdo.inhibit:
        raise source.refuse(
            (*path, "inhibit"),
            f"pdo.{name}.inhibit = {pdo.inhibit:g} s: only what the drive sends has one; leave it out",
        )
    if pdo.sent and not pdo.synchronous and pdo.inhibit == 0:
        raise source.refuse(
            path,
            f"pdo.{name}.type = {pdo.type}: an event may come at any rate and flood the bus; give "
            f"pdo.{name}.inhibit in s, (0, 6.5535], or a type of 1 to 240",
        )
    return pdo


def _objects(source: Source, name: str, given: Any) -> tuple[str, ...]:
    path = ("pdo", name, "objects")
    if not isinstance(given, list) or not 1 <= len(given) <= ENTRIES:
        where = path if given is not None else path[:2]
        raise source.refuse(
            where,
            f"pdo.{name}.objects = {given!r}: must be a list of 1 to {ENTRIES} names of objects",
        )
    for i, item in enumerate(given):
        try:
            if not isinstance(item, str) or find(item).kind == "str":
                raise UnknownNameError(f"object {item!r}: is no number that can be mapped")
        except KeyError as error:
            message = f"pdo.{name}.objects[{i}]: {error.args[0]}"
            raise source.refuse((*path, i), message) from None
    size = sum(find(item).bits for item in given)
    if size > 64:
        raise source.refuse(
            path, f"pdo.{name}.objects: {size / 8:g} bytes, a PDO carries at most 8; use two"
        )
    return tuple(given)


def _type(source: Source, name: str, given: Any) -> int:
    if isinstance(given, bool) or given not in [*_SYNCHRONOUS, *_EVENT]:
        raise source.refuse(
            ("pdo", name, "type"),
            f"pdo.{name}.type = {given!r}: must be 0 to 240 (with SYNC) or 254, 255 (on events); "
            "1 comes with every SYNC",
        )
    return int(given)


def _time(source: Source, name: str, key: str, given: Any) -> float:
    longest, unit = TIMES[key]
    wrong = isinstance(given, bool) or not isinstance(given, (int, float))
    if wrong or not 0 <= given <= longest or (0 < given < unit):
        raise source.refuse(
            ("pdo", name, key),
            f"pdo.{name}.{key} = {given!r} s: must be 0 or lie in [{unit:g}, {longest:g}] s",
        )
    return float(given)


def sync_period(values: Mapping[str, Any]) -> float:
    """Return the SYNC period of a profile [s]."""
    return float(values.get("sync.period", BY_NAME["sync.period"].default))
