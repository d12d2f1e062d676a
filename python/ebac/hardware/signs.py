"""Signs of motors and encoders, by which a configuration makes a positive force resist motion along +x."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

from ebac.hardware.toml_table import with_table


@dataclass(frozen=True, kw_only=True)
class Signs:
    """Signs of motors and encoders, 1 or -1 for each axis; empty if all are 1.

    Attributes
    ----------
    motor : tuple of int
        Factor of the current of each motor: -1 turns it.
    encoder : tuple of int
        Factor of the counts of each encoder: -1 turns them.
    """

    motor: tuple[int, ...] = ()
    encoder: tuple[int, ...] = ()

    @classmethod
    def from_table(cls, table: Mapping[str, Any], axes: int) -> Self:
        """Return the signs of a table of a configuration.

        Raises
        ------
        ValueError
            When it does not contain 1 or -1 for each of the axes.
        """
        for name, given in table.items():
            fits = isinstance(given, list) and len(given) == axes
            if not fits or any(type(one) is not int or one not in (1, -1) for one in given):
                such = [-1] + [1] * (axes - 1)
                each = "the one axis" if axes == 1 else f"each of the {axes} axes"
                raise ValueError(
                    f"signs.{name} = {given!r}: must be a list of 1 or -1 for {each}, such as {such}"
                )
        return cls(**{name: tuple(given) for name, given in table.items()})

    def of_all(self, axes: int) -> Self:
        """Return the same signs, with the sign of every axis given explicitly."""
        return type(self)(motor=self.motor or (1,) * axes, encoder=self.encoder or (1,) * axes)

    def against(self, needed: Signs | None) -> Signs:
        """Return the signs that remain on a device that needs other signs; all 1 if they are the same."""
        if needed is None:
            return Signs()
        return Signs(
            motor=_product(self.motor, needed.motor), encoder=_product(self.encoder, needed.encoder)
        )

    def written_into(self, text: str, *, simulated: bool = False) -> str:
        """Return the TOML text of a configuration with these signs; every other line stays as it is.

        With `simulated`, a comment says that they are of the simulated device; without it such a comment goes.

        Raises
        ------
        ValueError
            When the signs are written in a form that cannot be changed line by line.
        """
        wanted = {"motor": self.motor, "encoder": self.encoder}
        note = "one for each axis, found by `ebac drive signs`"
        return with_table(text, "signs", wanted, note, simulated=simulated)


def _product(one: Sequence[int], other: Sequence[int]) -> tuple[int, ...]:
    if not one or not other:
        return tuple(one or other)
    return tuple(a * b for a, b in zip(one, other, strict=True))
