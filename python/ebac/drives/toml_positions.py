"""TOML text that knows on which line each key stands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ebac._util.toml import parsed
from ebac._util.toml_lines import Path, line_of
from ebac.drives.errors import ProfileError

__all__ = [
    "Path",
    "Source",
    "dotted",
]


@dataclass(frozen=True, kw_only=True)
class Source:
    """A TOML document and its name."""

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
        return line_of(self.text, path)

    def refuse(self, path: Path, what: str) -> ProfileError:
        """Return the error for what stands at `path`."""
        line = self.line(path)
        where = self.name if line is None else f"{self.name}, line {line}"
        return ProfileError(f"{where}: {what}")


def dotted(path: Path) -> str:
    """Return a path as people write it: node[0].motor.torque_constant."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")
