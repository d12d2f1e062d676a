"""Electronic data sheets (CiA 306) in the shapes that makers give them; written here, none is a maker's file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

#: Objects of a torque drive by CiA 402: index, data type, access, mappable, default.
_TORQUE = (
    (0x1000, 7, "ro", 0, "0x00020192"), (0x1001, 5, "ro", 1, "0"), (0x1008, 9, "const", 0, ""),
    (0x1017, 6, "rw", 0, "0"), (0x603F, 6, "ro", 1, ""), (0x6040, 6, "rww", 1, "0"), (0x6041, 6, "ro", 1, ""),
    (0x605A, 3, "rw", 0, "2"), (0x605E, 3, "rw", 0, "2"), (0x6060, 2, "rww", 1, "0"), (0x6061, 2, "ro", 1, ""),
    (0x6064, 4, "ro", 1, ""), (0x606C, 4, "ro", 1, ""), (0x6071, 3, "rww", 1, "0"), (0x6077, 3, "ro", 1, ""),
    (0x60B2, 3, "rww", 1, "0"), (0x6502, 7, "ro", 0, "0x3ED"),
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Shape:
    """How a maker writes its sheets, and what stands in them."""

    vendor: int
    ends: str = "\r\n"
    more: tuple[tuple[int, int, str, int, str], ...] = ()
    lacks: tuple[int, ...] = ()
    groups: tuple[
        tuple[int, tuple[tuple[int, str, str], ...]], ...
    ] = ()  # sub 1..n: type, access, default
    entries: int = 8  # of a mapping
    rpdo_event: bool = False
    decimal: bool = False
    lower: bool = False
    plain_types: bool = False
    head: str = ""
    renamed: dict[int, tuple[int, str]] = field(default_factory=dict)  # index: type, access


_MOTOR = tuple((7, "rw", "") if sub in (12, 13, 14, 23) else (0, "", "") for sub in range(1, 24))
_HEARTBEAT = (0x1016, ((7, "rw", "0"),))
SHAPES = {
    # hexadecimal throughout, "rww", fixed SYNC and EMCY, no 0x6072, 0x6073, 0x6075, motor data at 0x3001
    "epos4": Shape(
        vendor=0xFB,
        more=((0x1005, 7, "const", 0, "0x80"), (0x1014, 7, "ro", 0, "$NODEID+0x00000080"),
              (0x6007, 3, "rw", 0, "3"), (0x6076, 7, "rw", 0, "0")),
        groups=(_HEARTBEAT, (0x3001, ((7, "rww", "5000"), (7, "rww", "15000"), (5, "rw", "1"), (6, "rw", "40"),
                                      (7, "rw", "0")))),
        entries=12,
        plain_types=True,
    ),
    # no SYNC and EMCY identifiers, limits of the heartbeat that no heartbeat fits, limits far above any motor
    "elmo": Shape(
        vendor=0x9A,
        more=((0x1006, 7, "rw", 0, "0"), (0x6007, 3, "rw", 0, "1"), (0x6072, 6, "rw", 0, "50000"),
              (0x6073, 6, "rw", 0, "50000"), (0x6075, 7, "rw", 0, "0"), (0x6076, 7, "rw", 0, "0"),
              (0x6087, 7, "rww", 1, "10000000")),
        groups=(_HEARTBEAT,),
    ),
    # three entries of a mapping, SYNC with bit 31, COB-IDs with bit 30, types as "5" and "0x0005"
    "tmcm": Shape(
        vendor=0x286,
        ends="\n",
        more=((0x1005, 7, "rw", 0, "0x80000080"), (0x1014, 7, "ro", 0, "$NODEID+0x80"),
              (0x6072, 6, "rw", 0, "0x0000")),
        groups=(_HEARTBEAT,),
        entries=3,
    ),
    # comments first, sections in lower case, decimal identifiers, an unsigned mode, no heartbeat consumer
    "copley": Shape(
        vendor=0xAB,
        ends="\n",
        more=((0x1002, 7, "ro", 1, ""), (0x1005, 7, "rw", 0, "128"), (0x1006, 7, "rw", 0, ""),
              (0x100C, 6, "rw", 0, "0"), (0x100D, 5, "rw", 0, "0"), (0x1014, 7, "rw", 0, ""),
              (0x2183, 7, "rw", 1, ""), (0x2300, 6, "rw", 1, ""), (0x6072, 6, "rw", 0, ""),
              (0x6076, 7, "rw", 0, ""), (0x6087, 7, "rw", 1, "")),
        groups=((0x6410, _MOTOR),),
        lacks=(0x605E,),
        entries=4,
        decimal=True,
        lower=True,
        head="; This file describes an amplifier\n;\n\n",
        renamed={0x6060: (5, "rw")},
    ),
    # the sample of CiA 402: the mode cannot be read, no identifiers, no offset
    "cia402": Shape(
        vendor=0,
        ends="\n",
        more=((0x6007, 3, "rw", 0, ""), (0x6072, 6, "rw", 1, "1000"), (0x6073, 6, "rw", 1, "1000"),
              (0x6075, 7, "rw", 0, ""), (0x6076, 7, "rw", 0, ""), (0x6087, 7, "rw", 1, "")),
        groups=(_HEARTBEAT,),
        lacks=(0x60B2,),
        rpdo_event=True,
        renamed={0x6060: (2, "wo")},
    ),
    # a position drive without torque
    "position": Shape(
        vendor=0x147,
        more=((0x1005, 7, "rw", 0, "0x80"), (0x1014, 7, "ro", 0, "$NODEID+0x80")),
        lacks=(0x1017, 0x6071, 0x6077, 0x60B2, 0x605A),
        entries=1,
    ),
}  # fmt: skip


def sheet(maker: str, *, note: str = "") -> str:
    """Return the text of a sheet in the shape of a maker; `note` is its description."""
    shape = SHAPES[maker]
    text = "\n".join(_lines(shape, note)) + "\n"
    return (shape.head + text).replace("\n", shape.ends)


def _lines(shape: Shape, note: str) -> Iterator[str]:
    yield from ("[FileInfo]", "FileName=sheet.eds", "EDSVersion=4.0", f"Description={note}", "")
    yield from (
        "[DeviceInfo]",
        "VendorName=A maker",
        f"VendorNumber=0x{shape.vendor:X}",
        "ProductNumber=0",
        "",
    )
    rows = [row for row in (*_TORQUE, *shape.more) if row[0] not in shape.lacks]
    for index, kind, access, mappable, default in sorted(rows):
        own_kind, own_access = shape.renamed.get(index, (kind, access))
        yield from _entry(shape, f"{index:04X}", own_kind, own_access, default, mappable)
    identity = (0x1018, ((7, "ro", f"{shape.vendor}"), (7, "ro", ""), (7, "ro", ""), (7, "ro", "")))
    for index, subs in (identity, *shape.groups, *_pdos(shape)):
        yield from (
            f"[{_title(shape, f'{index:04X}')}]",
            f"ParameterName=Group {index:X}",
            "ObjectType=0x9",
        )
        writable = "rw" if index & 0xFE00 in (0x1600, 0x1A00) and index < 0x2000 else "ro"
        yield from _entry(shape, f"{index:04X}sub0", 5, writable, str(len(subs)), 0)
        for sub, (kind, access, default) in enumerate(subs, start=1):
            if kind:
                yield from _entry(shape, f"{index:04X}sub{sub:X}", kind, access, default, 0)


def _pdos(shape: Shape) -> Iterator[tuple[int, tuple[tuple[int, str, str], ...]]]:
    for i in range(4):
        for comm, mapping, cob in ((0x1400, 0x1600, 0x200), (0x1800, 0x1A00, 0x180)):
            base = cob + 0x100 * i
            identifier = f"$NODEID+{base}" if shape.decimal else f"$NODEID+0x{base:X}"
            times = ((6, "rw", "0"), (0, "", ""), (6, "rw", "0"))
            sent = comm == 0x1800 or shape.rpdo_event
            yield comm + i, ((7, "rw", identifier), (5, "rw", "255"), *(times if sent else ()))
            yield mapping + i, tuple((7, "rw", "") for _ in range(shape.entries))


def _entry(
    shape: Shape, title: str, kind: int, access: str, default: str, mappable: int
) -> Iterator[str]:
    types = f"0x{kind:X}" if shape.plain_types else f"0x{kind:04X}"
    yield from (f"[{_title(shape, title)}]", f"ParameterName=Object {title}", "ObjectType=0x7")
    yield from (f"DataType={types}", f"AccessType={access}", f"PDOMapping={mappable}")
    if default:
        yield f"DefaultValue={default}"
    if title == "1016sub1":
        yield from ("LowLimit=0", "HighLimit=65535")
    yield ""


def _title(shape: Shape, title: str) -> str:
    return title.lower() if shape.lower else title
