"""Signs of motors and encoders: what a configuration turns, so that a positive force resists motion along +x."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

_TABLE = re.compile(r"^\s*\[signs\]\s*(#.*)?$")
_ANY_TABLE = re.compile(r"^\s*\[")


@dataclass(frozen=True, kw_only=True)
class Signs:
    """1 or -1 for each axis; empty for all 1.

    Attributes
    ----------
    motor, encoder : tuple of int
        What the current of each motor and the counts of each encoder are turned by.
    """

    motor: tuple[int, ...] = ()
    encoder: tuple[int, ...] = ()

    @classmethod
    def from_table(cls, table: Mapping[str, Any], axes: int) -> Self:
        """Return the signs of a table of a configuration.

        Raises
        ------
        ValueError
            For what is not 1 or -1 for each of the axes.
        """
        for name, given in table.items():
            fits = isinstance(given, list) and len(given) == axes
            if not fits or any(type(one) is not int or one not in (1, -1) for one in given):
                such = [-1] + [1] * (axes - 1)
                raise ValueError(
                    f"signs.{name} = {given!r}: must be a list of 1 or -1 for each of the {axes} axes, such as {such}"
                )
        return cls(**{name: tuple(given) for name, given in table.items()})

    def of_all(self, axes: int) -> Self:
        """Return the same, with every sign written out."""
        return type(self)(motor=self.motor or (1,) * axes, encoder=self.encoder or (1,) * axes)

    def against(self, needed: Signs | None) -> Signs:
        """Return what is left to turn on a device that needs other signs; nothing where they are the same."""
        if needed is None:
            return Signs()
        return Signs(
            motor=_product(self.motor, needed.motor), encoder=_product(self.encoder, needed.encoder)
        )

    def written_into(self, text: str) -> str:
        """Return the TOML text of a configuration with these signs; every other line stays as it is.

        Raises
        ------
        ValueError
            When the signs stand there in a way that cannot be changed line by line.
        """
        wanted = {"motor": list(self.motor), "encoder": list(self.encoder)}
        lines = text.splitlines(keepends=True)
        start = next((i for i, line in enumerate(lines) if _TABLE.match(line)), None)
        if start is None:
            block = "".join(f"{name} = {signs}\n" for name, signs in wanted.items())
            gap = "" if not text or text.endswith("\n") else "\n"
            made = f"{text}{gap}\n[signs] # one for each axis, found by `ebac drive signs`\n{block}"
        else:
            after = range(start + 1, len(lines))
            end = next((i for i in after if _ANY_TABLE.match(lines[i])), len(lines))
            made = "".join(
                [*lines[: start + 1], *_changed(lines[start + 1 : end], wanted), *lines[end:]]
            )
        try:
            right = tomllib.loads(made).get("signs") == wanted
        except tomllib.TOMLDecodeError:
            right = False
        if not right:
            raise ValueError(f"signs cannot be written line by line: set {wanted} by hand")
        return made


def _product(one: Sequence[int], other: Sequence[int]) -> tuple[int, ...]:
    if not one or not other:
        return tuple(one or other)
    return tuple(a * b for a, b in zip(one, other, strict=True))


def _changed(lines: list[str], wanted: Mapping[str, list[int]]) -> list[str]:
    """Return the lines of the table with the wanted values; comments stay."""
    kept = list(lines)
    for name, signs in wanted.items():
        key = re.compile(rf"^(\s*{name}\s*=\s*)\[[^\]]*\]")
        at = next((i for i, line in enumerate(kept) if key.match(line)), None)
        if at is None:
            kept.insert(0, f"{name} = {signs}\n")
        else:
            kept[at] = key.sub(rf"\g<1>{signs}", kept[at])
    return kept
