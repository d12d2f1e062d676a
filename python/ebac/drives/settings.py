"""What a profile means for one drive: objects, raw numbers, and the order in which they are safe to write."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from ebac._util.plural import plural
from ebac.drives.objects import PDO_OFF, PDOS, Object, find
from ebac.drives.pdo import Pdo
from ebac.drives.profile import Profile
from ebac.drives.profile_fields import KEYS
from ebac.drives.setting import Setting

#: What a drive holds: raw bytes by (index, sub-index).
Held = Mapping[tuple[int, int], bytes]

#: Bits of a COB-ID that decide: off, and the 11-bit identifier. Bits 29 and 30 stay as the drive has them.
_COB = PDO_OFF | 0x7FF


@dataclass(frozen=True, kw_only=True)
class Group:
    """Settings that are written together. Those of a PDO take the remapping sequence of CiA 301."""

    name: str
    settings: tuple[Setting, ...]
    pdo: bool = False


@dataclass(frozen=True, kw_only=True)
class Write:
    """One SDO download."""

    object: Object
    data: bytes
    optional: bool = False  # whether the drive may refuse it
    ordered: bool = False  # whether it must come where it stands: part of a PDO

    def __str__(self) -> str:
        return f"{self.object.name} = {self.object.show(self.object.decode(self.data))}"


def groups(profile: Profile, node: int) -> list[Group]:
    """Return what a profile sets on a node, in the order to write it.

    Motor data and limits come first, what commands the drive after them, PDOs last: a drive that is
    left half way knows its limits before it knows a command.
    """
    plain = Group(name="objects", settings=tuple(_plain(profile, node)))
    return [plain, *_pdos(profile, node)]


def writes(group: Group, held: Held) -> list[Write]:
    """Return the SDO downloads that bring a drive from what it holds to what a group wants.

    None where it holds all of it. A PDO that differs anywhere is written whole: off, empty, type and
    times, entries, count, on (CiA 301, "PDO mapping").
    """
    there = [one for one in group.settings if one.object.key in held]
    if all(one.holds(held[one.object.key]) for one in there):
        return []
    if not group.pdo:
        return [_write(one, held) for one in there if not one.holds(held[one.object.key])]
    return [replace(one, ordered=True) for one in _remapped(there, held)]


def _remapped(there: list[Setting], held: Held) -> list[Write]:
    (cob,) = [one for one in there if one.object.name.endswith("_cob_id")]
    rest = [one for one in there if one is not cob]
    if not rest:
        return [_write(cob, held)]
    (count,) = [one for one in rest if one.object.name.endswith("_count")]
    entries = [one for one in rest if "_entry" in one.object.name]
    times = [one for one in rest if one is not count and one not in entries]
    last = _write(cob, held)
    off = cob.wanted(held[cob.object.key]) | PDO_OFF
    return [
        Write(object=cob.object, data=off.to_bytes(len(last.data), "little")),
        *(_write(one, held) for one in times if not one.holds(held[one.object.key])),
        Write(object=count.object, data=bytes(len(held[count.object.key]))),
        *(_write(one, held) for one in entries),
        _write(count, held),
        last,
    ]


def _write(setting: Setting, held: Held) -> Write:
    data = held[setting.object.key]
    value = setting.wanted(data)
    # The drive's own length: the same object is longer or shorter on other firmware.
    raw = setting.object.encode(value, size=len(data))
    return Write(object=setting.object, data=raw, optional=setting.optional)


def _plain(profile: Profile, node: int) -> Iterator[Setting]:
    values = profile.values
    yield Setting(
        object=find("torque_offset"),
        value=0,
        why="nothing is added to the loop's torque",
        optional=True,  # a drive without one adds nothing
    )
    for key in KEYS:
        if key.name == "emcy.on":
            yield from _identifiers(bool(values[key.name]), node)
        elif key.name in profile.without:
            continue
        elif key.name == "heartbeat.guard" and key.name in values:
            yield from _guarded(float(values[key.name]))
        elif key.name == "heartbeat.producer" and "heartbeat.guard" in values:
            yield Setting(
                object=find("heartbeat_producer"),
                value=0,
                why="a guarded drive sends no heartbeat",
                key="heartbeat.guard",
            )
        elif key.name == "heartbeat.consumer" and key.name in values:
            yield _consumer(float(values[key.name]), int(values["heartbeat.master"]))
        elif key.sets and key.name in values:
            name = key.sets
            if name.startswith("motor_") and values["motor.object"] == "0x6410":
                name += "_old"
            yield Setting(
                object=find(name),
                value=key.raw(values[key.name], values),
                why=key.why,
                optional=key.name == "sync.period",  # without it a drive only does not watch SYNC
                key=key.name,
            )
    yield from profile.objects


def _identifiers(emergencies: bool, node: int) -> Iterator[Setting]:
    yield Setting(
        object=find("sync_cob_id"),
        value=0x080,
        mask=1 << 30 | 0x7FF,
        why="the loop sends SYNC, the drive does not",
        optional=True,
    )
    yield Setting(
        object=find("emcy_cob_id"),
        value=0x080 + node if emergencies else PDO_OFF | 0x080 + node,
        mask=_COB,
        why="a fault is reported at once" if emergencies else "the profile wants no emergencies",
        optional=emergencies,  # a drive without the object, or that fixes it, sends them by CiA 301's default
        key="emcy.on",
    )


def _guarded(seconds: float) -> Iterator[Setting]:
    for name, value in (("guard_time", round(1e3 * seconds / 3)), ("life_time_factor", 3)):
        why = "stops when the loop no longer asks"
        yield Setting(object=find(name), value=value, why=why, key="heartbeat.guard")


def _consumer(seconds: float, master: int) -> Setting:
    watched = master << 16 | round(1e3 * seconds) if seconds else 0
    why = f"stops when node {master} is silent" if seconds else "watches nobody"
    return Setting(
        object=find("heartbeat_consumer"), value=watched, why=why, key="heartbeat.consumer"
    )


def _pdos(profile: Profile, node: int) -> Iterator[Group]:
    planned = {pdo.name: pdo for pdo in profile.pdos}
    for kind in ("rpdo", "tpdo"):
        for number in range(1, PDOS + 1):
            name = f"{kind}{number}"
            if name in planned:
                yield Group(
                    name=name, settings=tuple(_planned(planned[name], name, node)), pdo=True
                )
            elif profile.silence:
                off = Setting(
                    object=find(f"{name}_cob_id"),
                    value=PDO_OFF,
                    mask=PDO_OFF,
                    why="not in the profile: off, it would take bus time",
                    optional=True,
                )
                yield Group(name=name, settings=(off,), pdo=True)


def _planned(pdo: Pdo, name: str, node: int) -> Iterator[Setting]:
    way = "from the drive" if pdo.sent else "to the drive"
    key = f"pdo.{name}"
    carries = f"{way}: {', '.join(pdo.objects)}"
    yield Setting(
        object=find(f"{name}_cob_id"), value=pdo.cob_id(node), mask=_COB, why=carries, key=key
    )
    when = "with every SYNC" if pdo.type == 1 else f"transmission type {pdo.type}"
    yield Setting(object=find(f"{name}_type"), value=pdo.type, why=when, key=f"{key}.type")
    for part, unit, why in (
        ("inhibit", 1e-4, "least time between two"),
        ("event", 1e-3, "longest time between two"),
    ):
        value = round(getattr(pdo, part) / unit)
        yield Setting(
            object=find(f"{name}_{part}"),
            value=value,
            why=why,
            optional=value == 0,
            key=f"{key}.{part}",
        )
    entries = pdo.entries()
    yield Setting(
        object=find(f"{name}_count"),
        value=len(entries),
        why=plural(len(entries), "object"),
        key=key,
    )
    for i, entry in enumerate(entries, start=1):
        yield Setting(
            object=find(f"{name}_entry{i}"),
            value=entry,
            why=pdo.objects[i - 1],
            key=f"{key}.objects",
        )
