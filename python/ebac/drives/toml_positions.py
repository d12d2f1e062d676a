"""TOML text that knows on which line each key stands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ebac._util.misplaced import Path, dotted
from ebac._util.toml import parsed
from ebac._util.toml_lines import placed
from ebac.drives.errors import ProfileError

__all__ = [
    "Path",
    "Source",
    "dotted",
]


@dataclass(frozen=True, kw_only=True)
class Source:
    """A TOML document and its name; `of` begins what is refused, as "node 2: "."""

    name: str
    text: str
    of: str = ""
    table: dict[str, Any] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        """Parse the text."""
        try:
            table = parsed(self.text)
        except ValueError as error:
            raise ProfileError(f"{self.name}: not a TOML document: {error}") from None
        object.__setattr__(self, "table", table)

    def refuse(self, path: Path, what: str) -> ProfileError:
        """Return the error for what stands at `path`."""
        return ProfileError(placed(self.name, self.text, path, f"{self.of}{what}"))
