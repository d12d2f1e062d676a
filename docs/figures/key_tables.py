"""Tables of every key of the files that describe a run, as `ebac keys` lists them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from printed import Printed, code, table

from ebac.hardware.keys import CONFIGURATION, NETWORK, PROFILE, FileKey, file_keys

#: Tables of a configuration that have a place of their own, by the name of the place.
_APART: dict[str, tuple[str, ...]] = {
    "limits": ("limits",),
    "sensor": ("sensor",),
    "observer": ("observer",),
    "simulated": ("simulated.signs", "simulated.zero", "simulated.bus"),
    "world": ("environment", "engine"),
    "hand": ("simulated.hand", "simulated.hand.path", "simulated.hand.model"),
}


def place(key: FileKey) -> str:
    """Return the name of the table of the page that has a key."""
    if PROFILE in key.files:
        return "profile"
    if NETWORK in key.files:
        return "network"
    if CONFIGURATION not in key.files:
        return "scenario"
    if key.table.partition(".")[0] == "device":
        return "device"
    return next((name for name, tables in _APART.items() if key.table in tables), "run")


PLACES = ("run", "limits", "sensor", "observer", "simulated", "world", "hand", "scenario", "device", "profile",
          "network")  # fmt: skip


def rows(name: str) -> list[FileKey]:
    """Return the keys of one table of the page."""
    return [one for one in file_keys() if place(one) == name]


def keys(name: str) -> Callable[[Printed | None], str]:
    """Return what writes one table of the page."""

    def made(source: Printed | None) -> str:
        found = rows(name)
        several = len({one.heading for one in found}) > 1
        sets = any(one.sets for one in found)
        heads = ["key", "unit", "default", "range", *(["sets"] if sets else []), "meaning"]
        lines = list(_lines(found, several=several, sets=sets))
        return table([*(["table"] if several else []), *heads], lines)

    return made


def _lines(found: Sequence[FileKey], *, several: bool, sets: bool) -> Iterator[list[str]]:
    before = ""
    for one in found:
        typed = f', `type = "{one.type}"`' if one.type else ""
        where = f"{code(one.heading)}{typed}" if one.table else one.heading
        warned = f". **{one.warning_text}**" if one.warning else ""
        cells = [
            code(one.name),
            one.unit,
            _typed(one.default_text),
            ", ".join(map(_typed, one.range_text.split(", "))) if one.choices else one.range_text,
            *([one.sets] if sets else []),
            f"{one.text}{warned}",
        ]
        yield [*([where if where != before else ""] if several else []), *map(_cell, cells)]
        before = where


def _typed(text: str) -> str:
    """Return text or a list as it is typed; a number as it is."""
    return code(text) if text[:1] in ('"', "[") and "in a configuration" not in text else text


def _cell(text: str) -> str:
    return text.replace("|", r"\|")


TABLES = {f"keys-{name}": keys(name) for name in PLACES}
