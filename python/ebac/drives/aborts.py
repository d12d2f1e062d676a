"""SDO abort codes: what each means and what to do (CiA 301, table of SDO abort codes)."""

from __future__ import annotations

#: Code: meaning, remedy.
ABORTS: dict[int, tuple[str, str]] = {
    0x05030000: ("toggle bit not alternated", "is another program talking to this node by SDO?"),
    0x05040000: ("the drive waited in vain for the next segment", "try again; check the bus load"),
    0x05040001: ("command specifier not known", "is another program talking to this node by SDO?"),
    0x05040005: ("out of memory", "transfer less at once; restart the drive"),
    0x06010000: ("access not supported", "the object cannot be used this way"),
    0x06010001: ("write only", "it cannot be read; read its echo where there is one"),
    0x06010002: ("read only", "it cannot be written; leave it out of the profile"),
    0x06020000: ("the object does not exist", "is this the right profile for the firmware?"),
    0x06040041: ("the object cannot be mapped to a PDO", "map another object; see the drive's EDS"),
    0x06040042: ("the PDO would be longer than 8 bytes", "map fewer or shorter objects"),
    0x06040043: ("parameters do not fit each other", "check those the drive relates to this one"),
    0x06040047: ("the drive contradicts itself", "restart the drive; check its firmware"),
    0x06060000: ("a hardware error", "look at the latched faults and the drive's supply"),
    0x06070010: ("data type or length does not match", "the drive has another type there: see its EDS"),
    0x06070012: ("the data is too long", "the drive has another type there: see its EDS"),
    0x06070013: ("the data is too short", "the drive has another type there: see its EDS"),
    0x06090011: ("the sub-index does not exist", "is this the right profile for the firmware?"),
    0x06090030: ("the value is out of range", "see the drive's manual for its range"),
    0x06090031: ("the value is too high", "see the drive's manual for its range"),
    0x06090032: ("the value is too low", "see the drive's manual for its range"),
    0x06090036: ("maximum below minimum", "write the other limit first"),
    0x060A0023: ("resource not available", "close other connections to the drive; restart it"),
    0x08000000: ("general error", "look at the drive's error register and its manual"),
    0x08000020: ("the drive cannot store or use the data", "disable it first; check its supply"),
    0x08000021: ("local control forbids it", "another interface owns the drive; see 0x2300 on Copley"),
    0x08000022: ("not in the present state", "disable the drive, NMT pre-operational, then again"),
    0x08000023: ("no object dictionary present", "restart the drive; check its firmware"),
    0x08000024: ("no data available", "the object is empty"),
}  # fmt: skip


def meaning(code: int) -> str:
    """Return what an abort code means."""
    return ABORTS[code][0] if code in ABORTS else "not a code of CiA 301"


def remedy(code: int) -> str:
    """Return what to do about an abort code."""
    return ABORTS[code][1] if code in ABORTS else "see the drive's manual"


#: The object cannot be read.
WRITE_ONLY = 0x06010001
#: The object cannot be written.
READ_ONLY = 0x06010002
#: Codes that mean "there is no such thing here".
ABSENT = frozenset({0x06020000, 0x06090011})
