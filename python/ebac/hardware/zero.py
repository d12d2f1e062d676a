"""The zero of the encoders: the counts of each drive with the handle at the origin of the virtual world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from ebac.hardware.toml_table import with_table

#: What a drive counts in: 0x6064 has 32 bits and wraps around.
LEAST, MOST = -(2**31), 2**31 - 1


@dataclass(frozen=True, kw_only=True)
class Zero:
    """Counts that each drive shows (0x6064) with the handle at its zero.

    Attributes
    ----------
    counts : tuple of int
        Counts of each axis with the handle at its zero, -2147483648 to 2147483647, as the drive shows them (0x6064),
        before `[signs]`; empty if all are 0.
    absolute : bool
        Whether these counts stay valid, as those of an absolute encoder do. An incremental encoder begins at another
        count whenever its drive is switched on; a run on hardware then asks whether the zero is correct.
    """

    counts: tuple[int, ...] = ()
    absolute: bool = False

    @classmethod
    def from_table(cls, table: Mapping[str, Any], axes: int) -> Self:
        """Return the zero of a table of a configuration.

        Raises
        ------
        ValueError
            When there is not one 32-bit integer for each axis, and for an absolute encoder without counts.
        """
        counts, absolute = table.get("counts", []), table.get("absolute", False)
        fits = isinstance(counts, list) and ("counts" not in table or len(counts) == axes)
        if not fits or any(type(one) is not int or not LEAST <= one <= MOST for one in counts):
            raise ValueError(
                f"zero.counts = {counts!r}: must be a list of {axes} whole numbers in [{LEAST}, {MOST}] counts, one "
                "for each axis; `ebac drive zero FILE --write` reads them from the drives"
            )
        if type(absolute) is not bool:
            raise ValueError(f"zero.absolute = {absolute!r}: must be true or false")
        if absolute and not counts:
            raise ValueError(
                "zero.absolute = true: needs zero.counts; `ebac drive zero FILE --write` reads them from the drives"
            )
        return cls(counts=tuple(counts), absolute=absolute)

    def of_all(self, axes: int) -> tuple[int, ...]:
        """Return the counts of every axis, given explicitly."""
        return self.counts or (0,) * axes

    def written_into(self, text: str, *, simulated: bool = False) -> str:
        """Return the TOML text of a configuration with these counts; every other line stays as it is.

        With `simulated`, a comment says that they are of the simulated device; without it such a comment goes.

        Raises
        ------
        ValueError
            When the zero is written in a form that cannot be changed line by line.
        """
        note = "counts of each drive with the handle at its zero, by `ebac drive zero`"
        return with_table(text, "zero", {"counts": self.counts}, note, simulated=simulated)


def from_zero(counts: int, zero: int) -> int:
    """Return how far a drive's position lies from its zero [counts], through the wrap-around of 32 bits."""
    return (counts - zero - LEAST) % 2**32 + LEAST
