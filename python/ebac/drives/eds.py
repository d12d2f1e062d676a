"""Electronic data sheets of CANopen devices (CiA 306), read from their text."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from ebac._util.arguments import require
from ebac.drives.data_sheet import Sheet, SheetEntry
from ebac.drives.errors import ProfileError

#: Data types of CiA 301, 7.4.7: name and bytes; 0 bytes is text or raw data.
TYPES: Mapping[int, tuple[str, int]] = {
    0x01: ("u8", 1), 0x02: ("i8", 1), 0x03: ("i16", 2), 0x04: ("i32", 4), 0x05: ("u8", 1), 0x06: ("u16", 2),
    0x07: ("u32", 4), 0x08: ("u32", 4), 0x09: ("str", 0), 0x0A: ("str", 0), 0x0B: ("str", 0), 0x0C: ("str", 6),
    0x0D: ("str", 6), 0x0F: ("str", 0), 0x10: ("i32", 3), 0x11: ("str", 8), 0x12: ("str", 5), 0x13: ("str", 6),
    0x14: ("str", 7), 0x15: ("str", 8), 0x16: ("u32", 3), 0x18: ("str", 5), 0x19: ("str", 6), 0x1A: ("str", 7),
    0x1B: ("str", 8),
}  # fmt: skip
_SECTION = re.compile(r"([0-9a-f]{4})(?:sub([0-9a-f]{1,2}))?$")
_NODE = "$nodeid"


def read_eds(path: str | Path) -> Sheet:
    """Read an EDS or DCF file, in UTF-8, UTF-16, Windows-1252 or Latin-1, with or without a byte order mark.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Sheet
        Its objects and the identity of the drive.

    Raises
    ------
    ProfileError
        When it cannot be read, or holds no object dictionary.
    """
    try:
        data = Path(path).read_bytes()
    except FileNotFoundError:
        raise ProfileError(f"{path}: no such file") from None
    except OSError as error:
        raise ProfileError(f"{path}: cannot be read ({error.strerror or error})") from None
    return parse_eds(decoded(data), name=str(path))


def decoded(data: bytes) -> str:
    """Return the text of a data sheet, whatever its encoding."""
    for mark, encoding in (
        (codecs.BOM_UTF8, "utf-8-sig"),
        (codecs.BOM_UTF16_LE, "utf-16"),
        (codecs.BOM_UTF16_BE, "utf-16"),
    ):
        if data.startswith(mark):
            return data.decode(encoding, errors="replace")
    if data[1:2] == b"\0" or data[:1] == b"\0":
        return data.decode("utf-16-le" if data[1:2] == b"\0" else "utf-16-be", errors="replace")
    for encoding in ("utf-8", "cp1252"):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return data.decode("latin-1")


def parse_eds(text: str, *, name: str = "EDS") -> Sheet:
    """Read the text of a data sheet.

    Parameters
    ----------
    text : str
        Of an EDS or DCF file (CiA 306).
    name : str
        Its name in messages.

    Raises
    ------
    ProfileError
        When it holds no object dictionary.
    TypeError
        For what is no text.
    """
    require(text, str, "parse_eds", "the text of an EDS")
    sections = _sections(text)
    device = sections.get("deviceinfo", {})
    entries: dict[tuple[int, int], SheetEntry] = {}
    for title, fields in sections.items():
        found = _SECTION.match(title)
        if found is None:
            continue
        index, sub = int(found[1], 16), int(found[2] or "0", 16)
        parent = sections.get(found[1], {}) if found[2] else None
        for entry in _entries(index, sub, fields, parent, sections):
            entries[entry.index, entry.sub] = entry
    if not entries:
        raise ProfileError(
            f"{name}: is no electronic data sheet: it has no object, as a section [1000] would be "
            "(CiA 306; of an XDD or ESI file, ask the maker for the EDS)"
        )
    identity = {sub: entries.get((0x1018, sub)) for sub in (1, 2)}
    vendor, product = (
        (known.default or 0)
        if (known := identity[sub]) is not None and known.default
        else number(device.get(key, "")) or 0
        for sub, key in ((1, "vendornumber"), (2, "productnumber"))
    )
    return Sheet(
        name=name,
        vendor=vendor,
        product=product,
        vendor_name=device.get("vendorname", ""),
        product_name=device.get("productname", ""),
        entries=dict(sorted(entries.items())),
    )


def number(text: str) -> int | None:
    """Return a number as CiA 306 writes it: decimal, 0x hexadecimal, or octal with a leading 0; None for none."""
    word = re.split(r"[\s;#,]", text.strip(), maxsplit=1)[0].lower()
    for base in (
        0,
        8,
        10,
    ):  # 0 takes "12" and "0x0C", 8 takes "014", 10 takes "08", which makers write
        try:
            return int(word, base)
        except ValueError:
            continue
    return None


def _sections(text: str) -> dict[str, dict[str, str]]:
    """Return sections and keys in lower case; of two of one name the first counts, and no other line does."""
    found: dict[str, dict[str, str]] = {}
    here: dict[str, str] = {}
    for raw in text.splitlines():
        line = raw.strip().lstrip("\ufeff")
        if line.startswith("[") and "]" in line:
            here = {}
            here = found.setdefault(line[1 : line.index("]")].strip().lower(), here)
        elif line and line[0] not in ";#" and "=" in line:
            key, _, value = line.partition("=")
            here.setdefault(key.strip().lower(), value.strip())
    return found


def _entries(
    index: int,
    sub: int,
    fields: Mapping[str, str],
    parent: Mapping[str, str] | None,
    sections: Mapping[str, Mapping[str, str]],
) -> Iterator[SheetEntry]:
    """Yield what one section means: an entry, none for the head of a group, or all of a compact array."""
    group = parent is None and (number(fields.get("objecttype", "7")) or 7) not in (0x2, 0x7)
    compact = number(fields.get("compactsubobj", "")) if group else None
    if compact:
        names = sections.get(f"{index:04x}name", {})
        values = sections.get(f"{index:04x}value", {})
        head = fields.get("parametername", "")
        size = {"parametername": "Highest sub-index", "datatype": "5", "accesstype": "ro"}
        yield _entry(index, 0, {**size, "defaultvalue": str(compact)}, head)
        for i in range(1, min(compact, 0xFE) + 1):
            own = {"parametername": names.get(str(i), f"{head}{i}")}
            value = {"defaultvalue": values[str(i)]} if str(i) in values else {}
            yield _entry(index, i, {**fields, **own, **value}, head)
    elif not group:
        yield _entry(
            index, sub, fields, None if parent is None else parent.get("parametername", "")
        )


def _entry(index: int, sub: int, fields: Mapping[str, str], head: str | None) -> SheetEntry:
    kind, size = TYPES.get(number(fields.get("datatype", "7")) or 7, ("str", 0))
    own = fields.get("parametername", "")
    access = re.split(r"[\s;#]", fields.get("accesstype", "rw").lower(), maxsplit=1)[0]
    given = fields.get("parametervalue") or fields.get("defaultvalue", "")
    plus_node = _NODE in given.lower()
    plain = re.sub(r"(?i)\s*\+?\s*\$nodeid\s*\+?\s*", "", given)
    default = number(plain) if kind != "str" else None
    if plus_node and default is None:
        default = 0
    low, high = (number(fields.get(key, "")) for key in ("lowlimit", "highlimit"))
    return SheetEntry(
        index=index,
        sub=sub,
        name=own if head is None else f"{head}.{own}",
        kind=kind,
        size=size,
        access="rw" if access.startswith("rw") else "wo" if access == "wo" else "ro",
        mappable=bool(number(fields.get("pdomapping", "0"))),
        default=_signed(default, kind, size),
        plus_node=plus_node,
        text=given if kind == "str" else "",
        low=None if _NODE in fields.get("lowlimit", "").lower() else _signed(low, kind, size),
        high=None if _NODE in fields.get("highlimit", "").lower() else _signed(high, kind, size),
    )


def _signed(value: int | None, kind: str, size: int) -> int | None:
    """Return a negative number that was written as its bits, 0xFFFF for -1."""
    if value is None or not kind.startswith("i") or value < 1 << 8 * size - 1:
        return value
    return value - (1 << 8 * size) if value < 1 << 8 * size else None
