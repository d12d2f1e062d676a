"""What an electronic data sheet of a drive says: its objects, and who may write them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ebac._util.wrong_calls import plain_constructor
from ebac.drives.objects import place

#: Index of PDO parameters, and of what CiA 301 itself bounds: limits of a sheet are often wrong there.
_COMMUNICATION = range(0x1000, 0x2000)
#: One row of the C++ core: index, sub-index, access, mappable, bytes, low, high, initial, text.
Row = tuple[int, int, str, bool, int, int, int, int | None, str]


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class SheetEntry:
    """One entry of a data sheet.

    Parameters
    ----------
    index, sub : int
        Where it stands.
    name : str
        As the maker calls it; of a sub-entry "object.entry".
    kind : str
        u8, i8, u16, i16, u32, i32, or "str" for everything else.
    size : int
        Its length [bytes]; 0 where it has none of its own.
    access : str
        "ro", "wo" or "rw".
    mappable : bool
        Whether a PDO may carry it.
    default : int, optional
        Value after power-on; for an identifier that depends on the node, without the node id.
    plus_node : bool
        Whether the node id is added to the default.
    text : str
        Default of a text.
    low, high : int, optional
        Limits of a number.
    """

    index: int
    sub: int = 0
    name: str = ""
    kind: str = "u32"
    size: int = 4
    access: str = "rw"
    mappable: bool = False
    default: int | None = None
    plus_node: bool = False
    text: str = ""
    low: int | None = None
    high: int | None = None

    @property
    def where(self) -> str:
        """Index and sub-index as people write them."""
        return place(self.index, self.sub)

    def row(self, node: int) -> Row:
        """Return it as the simulated drive takes it."""
        signed = self.kind.startswith("i")
        bits = 8 * self.size
        low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
        if self.index not in _COMMUNICATION and self.kind != "str":
            low = low if self.low is None else max(low, self.low)
            high = high if self.high is None else min(high, self.high)
            if low > high or (signed and low >= 0):  # given in the wrong sign
                low, high = (
                    (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
                )
        if self.kind == "str":
            low, high = 0, (1 << 63) - 1
        default = self.default
        if default is not None and self.plus_node:
            default += node
        if default is not None and not low <= default <= high:
            default = None
        return (
            self.index, self.sub, self.access, self.mappable, self.size, low, min(high, (1 << 63) - 1),
            default, self.text,
        )  # fmt: skip


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Sheet:
    """An electronic data sheet.

    Parameters
    ----------
    name : str
        The file it came from.
    vendor, product : int
        Numbers of maker and product (0x1018); 0 where the sheet leaves them open.
    vendor_name, product_name : str
        The same in words.
    entries : mapping of (int, int) to SheetEntry
        Every entry by index and sub-index.
    """

    name: str
    vendor: int = 0
    product: int = 0
    vendor_name: str = ""
    product_name: str = ""
    entries: Mapping[tuple[int, int], SheetEntry] = field(default_factory=dict, repr=False)

    def find(self, name: str) -> SheetEntry | None:
        """Return the entry of that name, "Motor data.Torque constant"; None where there is none."""
        return next((entry for entry in self.entries.values() if entry.name == name), None)

    def rows(self, node: int) -> list[Row]:
        """Return what a simulated drive with this dictionary is made from (`ebac drive simulate --eds`)."""
        return [entry.row(node) for entry in self.entries.values()]
