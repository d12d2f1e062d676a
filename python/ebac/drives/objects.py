"""The objects of a drive this package knows: one table of name, index, type and unit.

Sources: CiA 301 (0x1000 to 0x1FFF), CiA 402-2 (0x6000 on), Copley's object dictionary (0x2000 on).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from ebac._util.arguments import UnknownNameError, did_you_mean, whole
from ebac._util.wrong_calls import plain_constructor

#: Type of CiA 301: its struct code. The length is that of the type.
NUMBERS = {"u8": "B", "i8": "b", "u16": "H", "i16": "h", "u32": "I", "i32": "i"}
#: Most PDOs of either direction this package looks at, and entries of one.
PDOS, ENTRIES = 4, 8
#: Set in the COB-ID of a PDO that is off (CiA 301).
PDO_OFF = 1 << 31


def place(index: int, sub: int) -> str:
    """Return index and sub-index as people write them: 0x6040, 0x2383:12."""
    return f"0x{index:04X}" + (f":{sub}" if sub else "")


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Object:
    """One entry of an object dictionary.

    Parameters
    ----------
    name : str
        As this package calls it.
    index, sub : int
        Where it stands, 0 to 0xFFFF and 0 to 0xFF.
    kind : str
        Type: u8, i8, u16, i16, u32, i32, or "str".
    unit : str
        Unit of the raw number; empty for a pure one.
    meaning : str
        What it is, for people.
    """

    name: str
    index: int
    sub: int = 0
    kind: str = "u32"
    unit: str = ""
    meaning: str = ""

    @property
    def key(self) -> tuple[int, int]:
        """Index and sub-index."""
        return self.index, self.sub

    @property
    def where(self) -> str:
        """Index and sub-index as people write them."""
        return place(self.index, self.sub)

    @property
    def bits(self) -> int:
        """Its length in a PDO [bit]."""
        return 8 * struct.calcsize("<" + NUMBERS[self.kind])

    @property
    def hexadecimal(self) -> bool:
        """Whether people read it as bits: identifiers, words, masks."""
        return self.unit == "bits"

    def __str__(self) -> str:
        return f"{self.name} ({self.where})"

    def decode(self, data: bytes) -> int | str:
        """Decode the bytes of the drive; the drive's own length counts."""
        if self.kind == "str":
            return data.decode("ascii", errors="replace").rstrip("\0")
        return int.from_bytes(data, "little", signed=self.kind.startswith("i"))

    def encode(self, value: int, *, size: int | None = None) -> bytes:
        """Return the bytes of a number, in `size` bytes or those of the type.

        Raises
        ------
        TypeError
            For what is no whole number.
        ValueError
            When it does not fit; the message contains the range.
        """
        if self.kind not in NUMBERS:
            raise ValueError(f"{self}: is text and cannot be written as a number")
        value = whole(str(self), value)
        length = size or struct.calcsize("<" + NUMBERS[self.kind])
        signed = self.kind.startswith("i")
        low = -(1 << 8 * length - 1) if signed else 0
        high = (1 << 8 * length - (1 if signed else 0)) - 1
        if not low <= value <= high:
            raise ValueError(
                f"{self} = {self.show(value)}: must lie in [{low}, {high}] {self.unit}".rstrip()
            )
        return value.to_bytes(length, "little", signed=signed)

    def show(self, value: int | str) -> str:
        """Return a value with its unit."""
        if isinstance(value, str):
            return value
        if self.name == "heartbeat_consumer":  # node << 16 | ms
            return f"node {value >> 16}, {value & 0xFFFF} ms" if value > 0 else "none"
        if self.hexadecimal:
            return f"0x{value:X}" if value >= 0 else str(value)
        return f"{value} {self.unit}".rstrip()


#: Name, index, sub-index, type, unit, meaning. "bits" marks what people read in hexadecimal.
_TABLE: tuple[tuple[str, int, int, str, str, str], ...] = (
    ("device_type", 0x1000, 0, "u32", "bits", "profile of the device: 0x192 is CiA 402"),
    ("error_register", 0x1001, 0, "u8", "bits", "what kinds of error there are"),
    ("event_status", 0x1002, 0, "u32", "bits", "what the drive sees now (Copley)"),
    ("sync_cob_id", 0x1005, 0, "u32", "bits", "identifier of SYNC"),
    ("sync_period", 0x1006, 0, "u32", "us", "time between two SYNC"),
    ("device_name", 0x1008, 0, "str", "", "name the maker gave"),
    ("hardware_version", 0x1009, 0, "str", "", "of the drive"),
    ("software_version", 0x100A, 0, "str", "", "firmware of the drive"),
    ("guard_time", 0x100C, 0, "u16", "ms", "time between two requests of node guarding"),
    ("life_time_factor", 0x100D, 0, "u8", "", "guard times without a request until it stops"),
    ("store_all", 0x1010, 1, "u32", "bits", "write 'save' to keep all in flash"),
    ("emcy_cob_id", 0x1014, 0, "u32", "bits", "identifier of emergencies"),
    ("heartbeat_consumer", 0x1016, 1, "u32", "bits", "node << 16 | ms: whose heartbeat it watches"),
    ("heartbeat_producer", 0x1017, 0, "u16", "ms", "how often it sends its heartbeat"),
    ("vendor_id", 0x1018, 1, "u32", "bits", "who made it"),
    ("product_code", 0x1018, 2, "u32", "bits", "what it is"),
    ("revision", 0x1018, 3, "u32", "bits", "which firmware"),
    ("serial_number", 0x1018, 4, "u32", "", "which one"),
    ("latched_faults", 0x2183, 0, "u32", "bits", "faults that stay until reset (Copley)"),
    ("desired_state", 0x2300, 0, "u16", "", "who commands the drive: 30 is CANopen (Copley)"),
    ("motor_torque_constant", 0x2383, 12, "u32", "1e-5 N m/A", "torque per current (Copley)"),
    ("motor_peak_torque", 0x2383, 13, "u32", "1e-5 N m", "largest torque (Copley)"),
    ("motor_continuous_torque", 0x2383, 14, "u32", "1e-5 N m", "rated torque (Copley)"),
    ("motor_counts_per_turn", 0x2383, 23, "u32", "counts", "of the encoder (Copley)"),
    ("motor_torque_constant_old", 0x6410, 12, "u32", "1e-5 N m/A", "as 0x2383:12, older firmware"),
    ("motor_peak_torque_old", 0x6410, 13, "u32", "1e-5 N m", "as 0x2383:13, older firmware"),
    ("motor_continuous_torque_old", 0x6410, 14, "u32", "1e-5 N m", "as 0x2383:14, older firmware"),
    ("motor_counts_per_turn_old", 0x6410, 23, "u32", "counts", "as 0x2383:23, older firmware"),
    ("connection_option", 0x6007, 0, "i16", "", "what it does when it loses its loop"),
    ("error_code", 0x603F, 0, "u16", "bits", "emergency code of the last fault"),
    ("controlword", 0x6040, 0, "u16", "bits", "what is asked of the state machine"),
    ("statusword", 0x6041, 0, "u16", "bits", "state of the state machine"),
    ("quick_stop_option", 0x605A, 0, "i16", "", "how a quick stop brakes"),
    ("shutdown_option", 0x605B, 0, "i16", "", "how a shutdown takes the torque off"),
    ("disable_option", 0x605C, 0, "i16", "", "how disabling takes the torque off"),
    ("halt_option", 0x605D, 0, "i16", "", "how a halt takes the torque off"),
    ("fault_reaction_option", 0x605E, 0, "i16", "", "how a fault takes the torque off"),
    ("mode", 0x6060, 0, "i8", "", "mode asked: 4 profile torque, 10 cyclic torque"),
    ("mode_display", 0x6061, 0, "i8", "", "mode that acts"),
    ("position", 0x6064, 0, "i32", "counts", "of the encoder"),
    ("velocity", 0x606C, 0, "i32", "raw units", "of the motor, in a unit of the maker"),
    ("target_torque", 0x6071, 0, "i16", "per mille of rated", "torque asked"),
    ("max_torque", 0x6072, 0, "u16", "per mille of rated", "largest torque"),
    ("max_current", 0x6073, 0, "u16", "per mille of rated", "largest current"),
    ("torque_demand", 0x6074, 0, "i16", "per mille of rated", "torque after ramp and limits"),
    ("rated_current", 0x6075, 0, "u32", "mA", "what per mille of current means"),
    ("rated_torque", 0x6076, 0, "u32", "mN m", "what per mille of torque means"),
    ("actual_torque", 0x6077, 0, "i16", "per mille of rated", "torque that acts"),
    ("actual_current", 0x6078, 0, "i16", "per mille of rated", "current that flows"),
    ("torque_slope", 0x6087, 0, "u32", "per mille of rated/s", "ramp of profile torque"),
    ("torque_offset", 0x60B2, 0, "i16", "per mille of rated", "added to the target"),
    ("supported_modes", 0x6502, 0, "u32", "bits", "bit n - 1: mode n"),
)  # fmt: skip

#: Units of a maker that are not those of the table: by vendor id (0x1018:1) and name.
OWN_UNITS: dict[object, dict[str, str]] = {
    0: {"velocity": "0.1 counts/s"},  # the simulated drive
    0xAB: {"velocity": "0.1 counts/s"},  # Copley
    0xFB: {"rated_torque": "1e-6 N m"},  # maxon EPOS4
}


def _pdo_objects() -> Iterator[Object]:
    for kind, comm, mapping in (("rpdo", 0x1400, 0x1600), ("tpdo", 0x1800, 0x1A00)):
        for i in range(PDOS):
            name = f"{kind}{i + 1}"
            title = f"{kind.upper()} {i + 1}"
            rows: list[tuple[str, int, int, str, str, str]] = [
                ("cob_id", comm, 1, "u32", "bits", "identifier; bit 31: off"),
                ("type", comm, 2, "u8", "", "0 to 240: with SYNC; 254, 255: on events"),
                ("inhibit", comm, 3, "u16", "100 us", "least time between two"),
                ("event", comm, 5, "u16", "ms", "longest time between two"),
                ("count", mapping, 0, "u8", "", "objects in it"),
            ]
            rows += [
                (f"entry{n}", mapping, n, "u32", "bits", "index << 16 | sub << 8 | bits")
                for n in range(1, ENTRIES + 1)
            ]
            for part, index, sub, type_, unit, meaning in rows:
                yield Object(
                    name=f"{name}_{part}",
                    index=index + i,
                    sub=sub,
                    kind=type_,
                    unit=unit,
                    meaning=f"{title}: {meaning}",
                )


@cache
def known() -> dict[str, Object]:
    """Return every object of the table by its name, PDO parameters last."""
    rows = [
        Object(name=name, index=index, sub=sub, kind=kind, unit=unit, meaning=meaning)
        for name, index, sub, kind, unit, meaning in _TABLE
    ]
    return {row.name: row for row in [*rows, *_pdo_objects()]}


@cache
def _by_key() -> dict[tuple[int, int], Object]:
    return {row.key: row for row in known().values()}


def find(what: str | int | tuple[int, int] | Object) -> Object:
    """Return an object by name, index, or (index, sub-index).

    An index the table does not know becomes an unsigned number of the drive's length.

    Parameters
    ----------
    what : str, int, tuple or Object
        Name, as `ebac drive show --all` lists them; index; (index, sub-index); or an object, which is returned.

    Raises
    ------
    KeyError
        For an unknown name; the message suggests the nearest.
    TypeError
        For what is none of these.
    """
    if isinstance(what, Object):
        return what
    if isinstance(what, str):
        if what not in known():
            raise UnknownNameError(
                f"object {what!r}: no such name{did_you_mean(what, known())}; `ebac drive show --all` lists them, "
                "and any object goes by its index, 0x6041 or (0x2383, 12)"
            )
        return known()[what]
    given: tuple[Any, ...] = what if isinstance(what, tuple) else (what, 0)
    if len(given) != 2:
        raise TypeError(f"object {given}: must be a name, an index, or (index, sub-index)")
    key = index, sub = whole("index of an object", given[0]), whole("sub-index", given[1])
    if not (0 <= index <= 0xFFFF and 0 <= sub <= 0xFF):
        raise UnknownNameError(
            f"object {key}: index must lie in [0, 0xFFFF], sub-index in [0, 0xFF]"
        )
    return _by_key().get(key) or Object(name=f"object_{index:04X}_{sub}", index=index, sub=sub)


def mapped(entry: int) -> str:
    """Return what an entry of a PDO mapping holds, by name: 0x60400010 is "controlword"."""
    found = _by_key().get((entry >> 16, entry >> 8 & 0xFF))
    return found.name if found else f"0x{entry >> 16:04X}:{entry >> 8 & 0xFF}"
