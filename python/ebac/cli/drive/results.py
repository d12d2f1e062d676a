"""What `ebac drive` shows: plans, drives, objects."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.drives import Change, Drive, Network, Object


#: Columns of a terminal below which what an object means stands below its name.
WIDE = 130


def changes(found: Sequence[Change], none: str) -> None:
    """Show what differs, or say that nothing does."""
    if not found:
        output.say(none)
        return
    alike: dict[tuple[str, ...], list[str]] = {}
    for one in found:
        row = (one.object.where, one.object.name, *one.shown, one.why)
        alike.setdefault(row, []).append(str(one.node))
    grid = output.table(["object", "", "node", "now", "wanted", "why"], numbers=(3, 4))
    for (where, name, *values), nodes in alike.items():
        grid.add_row(where, name, ", ".join(nodes), *values)
    grid.columns[1].min_width = max(len(one.object.name) for one in found)
    output.show(grid)


def load(network: Network) -> None:
    """Say how busy the bus will be."""
    found = network.bus_load()
    output.say(f"{found.describe()[0].upper()}{found.describe()[1:]}.")


def states(rows: Sequence[dict[str, Any]]) -> None:
    """Show the state of each drive."""
    grid = output.table(["node", "state"], numbers=(0,))
    for row in rows:
        grid.add_row(str(row["node"]), row["state"])
    output.show(grid)


def found(rows: Sequence[dict[str, Any]]) -> None:
    """Show who is on a bus."""
    grid = output.table(
        ["node", "NMT", "name", "vendor", "product", "revision", "serial", "state"], numbers=(0,)
    )
    for row in rows:
        ids = [_hex(row[name]) for name in ("vendor_id", "product_code", "revision")]
        serial = "-" if row["serial_number"] is None else str(row["serial_number"])
        state = row["state"] or "no CiA 402 drive"
        if row["latched"]:
            state += f" ({'; '.join(row['latched'])})"
        name = row["name"] or "-"
        grid.add_row(str(row["node"]), row["nmt"] or "-", name, *ids, serial, state)
    output.show(grid)


def objects(rows: Sequence[dict[str, Any]]) -> None:
    """Show the objects of drives; their names whole, as these are what one types."""
    from rich.markup import escape

    wide = output.console().width >= WIDE
    more = ["unit", "meaning"] if wide else []
    grid = output.table(["node", "object", "", "value", *more], numbers=(0, 3))
    for row in rows:
        node, where, name, unit = (str(row[n]) for n in ("node", "object", "name", "unit"))
        text, meaning = escape(row["text"]), escape(row["meaning"])
        if wide:
            grid.add_row(node, where, name, text, unit, meaning)
        else:
            grid.add_row(node, where, f"{name}\n[dim]{meaning}[/]", f"{text} {unit}".rstrip())
    output.show(grid)


def who(drive: Drive) -> dict[str, Any]:
    """Return who a node is and how it stands, as a plain row."""
    from ebac.cli.drive.options import is_drive
    from ebac.drives import DriveError

    row: dict[str, Any] = {"node": drive.node, "nmt": drive.bus.monitor.nmt(drive.node)}
    names = ("device_name", "vendor_id", "product_code", "revision", "serial_number")
    for name in names:
        try:
            row[name.removeprefix("device_")] = drive.look(name)
        except DriveError:
            row[name.removeprefix("device_")] = None
    known = is_drive(drive)
    row["state"], row["latched"] = None, []
    if known:
        with suppress(DriveError, ValueError):  # what it is stands in the row all the same
            row["state"], row["latched"] = drive.state.value, drive.latched()
    return row


def holdings(drive: Drive, everything: bool) -> Iterator[dict[str, Any]]:
    """Yield the objects of a drive that the table knows and the drive has, as plain rows.

    One that the drive refuses to read, or answers wrongly, is a row without a value.

    Raises
    ------
    NoAnswer, BusError
        When the drive does not answer any more; all before has been yielded.
    """
    from ebac.drives import Refused, WrongAnswer
    from ebac.drives.objects import OWN_UNITS

    own: dict[str, str] = {}
    for obj in _objects(drive, everything):
        try:
            value = drive.look(obj)
        except Refused as error:
            value, text = None, f"not read: 0x{error.code:08X}"
        except WrongAnswer:
            value, text = None, "not read: wrong answer"
        else:
            if value is None:
                continue
            text = _text(obj, value)
        if obj.name == "vendor_id":  # comes before what has a unit
            own = OWN_UNITS.get(value, {})
        yield {
            "node": drive.node,
            "object": obj.where,
            "name": obj.name,
            "value": value,
            "unit": "" if obj.hexadecimal or value is None else own.get(obj.name, obj.unit),
            "meaning": obj.meaning,
            "text": text,
        }


def _objects(drive: Drive, everything: bool) -> Iterator[Object]:
    """Yield the objects of the table, and those that only the drive's data sheet has."""
    from ebac.drives import Object
    from ebac.drives.objects import known

    named = {obj.key for obj in known().values()}
    yield from (obj for obj in known().values() if everything or "pdo" not in obj.name)
    for key, entry in () if drive.sheet is None else drive.sheet.entries.items():
        if key in named or entry.access == "wo" or (0x1400 <= key[0] < 0x1C00 and not everything):
            continue
        kind = entry.kind if entry.size <= 4 else "str"
        yield Object(
            name=entry.name,
            index=entry.index,
            sub=entry.sub,
            kind=kind,
            meaning="of the data sheet",
        )


def _text(obj: Object, value: int | str) -> str:
    """Return a value as people read it, without its unit."""
    from ebac.drives.faults import BITS
    from ebac.drives.objects import mapped
    from ebac.drives.state import State

    text = obj.show(value).removesuffix(obj.unit).rstrip()
    if obj.name == "statusword" and isinstance(value, int):
        try:
            return f"{text} ({State.of(value).value})"
        except ValueError:
            return f"{text} (no state of CiA 402)"
    decode = BITS.get(obj.name)
    if decode is not None and isinstance(value, int) and value:
        return f"{text}: {'; '.join(decode(value))}"
    if "_entry" in obj.name and isinstance(value, int) and value:
        return mapped(value)
    return text


def _hex(value: object) -> str:
    return f"0x{value:X}" if isinstance(value, int) else "-"
