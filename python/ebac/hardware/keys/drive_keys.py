"""Keys of the files of drives: profile and network file."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

from ebac.drives.load import BITRATES, Traffic
from ebac.drives.network import Network, Node
from ebac.drives.objects import find
from ebac.drives.pdo import NAMES, TIMES, Pdo
from ebac.drives.profile_fields import KEYS, Key, Value
from ebac.hardware.keys.file_key import NETWORK, PROFILE, FileKey, said_of

#: Objects of the keys that set one in a way of their own.
_OBJECTS = {
    "emcy.on": ("emcy_cob_id",),
    "heartbeat.consumer": ("heartbeat_consumer",),
    "heartbeat.master": ("heartbeat_consumer",),
    "heartbeat.guard": ("guard_time", "life_time_factor"),
}


def profile_keys() -> Iterator[FileKey]:
    """Give the keys of a drive profile."""
    files = (PROFILE,)
    yield FileKey(files=files, table="", name="about", default="", meaning="which drives it is for")
    yield FileKey(
        files=files,
        table="",
        name="vendor",
        unit="1",
        default=0,
        low=0,
        high=0xFFFFFFFF,
        meaning="the maker's number in 0x1018:1, for the simulated drive; 0 for any maker",
    )
    yield FileKey(
        files=files,
        table="",
        name="without",
        default=[],
        meaning="keys that `ebac` needs for scaling but the drive has no object for; a drive that has the object is "
        "refused",
    )
    for key in KEYS:
        table, _, name = key.name.partition(".")
        pure = key.choices is None
        yield FileKey(
            files=files,
            table=table,
            name=name,
            unit=(key.unit or "1") if pure else "",
            default=key.default,
            low=key.low if pure else None,
            high=key.high if pure else None,
            choices=() if key.choices is None else tuple(key.choices),
            meaning="; ".join(part for part in (key.why, key.remedy) if part),
            sets=_sets(key),
        )
    yield FileKey(
        files=files,
        table="objects",
        name='"0x3001:1"',
        meaning="an object of the maker's own, by index and sub-index: `985`, the number as the drive holds "
        'it; `{ value = -5, type = "i16", why = "..." }`; or a number that follows from a key, '
        '`{ of = "limits.rated_current", unit = 1e-3 }`, with the drive\'s unit in SI units. Nothing that commands',
    )
    yield FileKey(
        files=files,
        table="pdo",
        name="others",
        default="off",
        choices=("off", "keep"),
        meaning="whether PDOs that the profile does not list are switched off or stay as they are",
    )
    yield from _pdo(files)


def _pdo(files: tuple[str, ...]) -> Iterator[FileKey]:
    said = said_of(Pdo)
    table = f"pdo.{NAMES[0]}"
    yield FileKey(
        files=files, table=table, name="objects", sets="0x1600, 0x1A00",
        meaning=f"{said['objects']}; names as `ebac drive show` prints them",
    )  # fmt: skip
    yield FileKey(
        files=files, table=table, name="type", unit="1", default=1,
        meaning=said["type"], sets="0x1400:2, 0x1800:2",
    )  # fmt: skip
    for name, (longest, _) in TIMES.items():
        where = {"inhibit": "0x1800:3", "event": "0x1400:5, 0x1800:5"}[name]
        yield FileKey(
            files=files, table=table, name=name, unit="s", default=0.0, low=0.0, high=longest,
            meaning=said[name], sets=where,
        )  # fmt: skip


def _sets(key: Key) -> str:
    """Return the objects of a key, each with its unit on the drive."""
    names: tuple[Value, ...] = _OBJECTS.get(key.name, (key.sets,) if key.sets else ())
    objects = [find(str(name)) for name in names]
    return ", ".join(
        f"{one.where} [{one.unit}]" if one.unit and not one.hexadecimal else one.where
        for one in objects
    )


def network_keys() -> Iterator[FileKey]:
    """Give the keys of a network file."""
    files = (NETWORK,)
    bus, node, other = said_of(Network), said_of(Node), said_of(Traffic)
    rate = next(one.default for one in dataclasses.fields(Network) if one.name == "bitrate")
    yield FileKey(
        files=files, table="bus", name="bitrate", unit="bit/s", default=rate, choices=BITRATES,
        meaning=bus["bitrate"], note="without it what --bitrate gives",
    )  # fmt: skip
    yield FileKey(
        files=files, table="node", name="id", unit="1", low=1, high=127, meaning=node["id"]
    )
    yield FileKey(files=files, table="node", name="name", default="", meaning=node["name"])
    yield FileKey(
        files=files,
        table="node",
        name="profile",
        meaning=node["profile"],
        note="the name of a profile, or of a file beside this one; keys of the profile but its PDOs may stand in the "
        "table of the node and replace those of the profile",
    )
    yield FileKey(
        files=files,
        table="node",
        name="eds",
        meaning=node["sheet"],
        note="checked whenever this file is read",
    )
    yield FileKey(files=files, table="bus.other", name="name", default="", meaning=other["name"])
    yield FileKey(
        files=files,
        table="bus.other",
        name="size",
        unit="bytes",
        low=0,
        high=8,
        meaning=other["size"],
    )
    yield FileKey(
        files=files,
        table="bus.other",
        name="rate",
        unit="Hz",
        low=0,
        high=1e5,
        meaning=other["rate"],
    )
