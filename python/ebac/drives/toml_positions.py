"""TOML text that knows on which line each key stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from ebac._util.toml import parsed
from ebac.drives.errors import ProfileError

#: Where a value stands: names of tables and keys, and places in lists.
Path: TypeAlias = tuple[str | int, ...]


@dataclass(frozen=True, kw_only=True)
class Source:
    """A TOML document and its name.

    The standard library's parser keeps no positions, and no kept-up parser of Python does. But the
    first n lines of a document are a document themselves unless they end within a value: a key
    stands where it first appears among them.
    """

    name: str
    text: str
    table: dict[str, Any] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        """Parse the text."""
        try:
            table = parsed(self.text)
        except ValueError as error:
            raise ProfileError(f"{self.name}: not a TOML document: {error}") from None
        object.__setattr__(self, "table", table)

    def line(self, path: Path) -> int | None:
        """Return the line on which a key stands, from 1; None when it stands nowhere."""
        lines = [f"{line}\n" for line in self.text.split("\n")]
        begin = 1
        for end in range(1, len(lines) + 1):
            try:
                table = parsed("".join(lines[:end]))
            except ValueError:
                continue  # within a value of several lines
            if path in set(_paths(table)):
                return begin
            begin = end + 1
        return None

    def refuse(self, path: Path, what: str) -> ProfileError:
        """Return the error for what stands at `path`."""
        line = self.line(path)
        where = self.name if line is None else f"{self.name}, line {line}"
        return ProfileError(f"{where}: {what}")


def dotted(path: Path) -> str:
    """Return a path as people write it: node[0].motor.torque_constant."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def _paths(value: Any, path: Path = ()) -> Iterator[Path]:
    if path:
        yield path
    if isinstance(value, Mapping):
        for name, item in value.items():
            yield from _paths(item, (*path, name))
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from _paths(item, (*path, i))
