"""One object of a drive and the number it is to hold."""

from __future__ import annotations

from dataclasses import dataclass

from ebac._util.wrong_calls import plain_constructor
from ebac.drives.objects import Object


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Setting:
    """One object and the number it is to hold.

    Parameters
    ----------
    object : Object
        Which.
    value : int
        Raw number.
    why : str
        For people.
    mask : int or None
        Bits that count, None for all; the others stay as the drive has them.
    optional : bool
        Whether a drive without the object, or one that keeps another value, is right as it is.
    key : str
        The key of the profile that wants it; empty where every profile does.
    of : str
        The key of the profile that `value` follows from; empty where it is given as it is.
    unit : float
        What of that key one raw unit is, in SI units.
    """

    object: Object
    value: int
    why: str
    mask: int | None = None
    optional: bool = False
    key: str = ""
    of: str = ""
    unit: float = 1.0

    def holds(self, data: bytes) -> bool:
        """Return whether the drive holds it already."""
        return self.wanted(data) == self.object.decode(data)

    def wanted(self, data: bytes) -> int:
        """Return the number to write over what the drive holds."""
        if self.mask is None:
            return self.value
        return (int.from_bytes(data, "little") & ~self.mask) | self.value
