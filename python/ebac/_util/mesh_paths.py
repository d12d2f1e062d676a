"""Files of meshes in a TOML document: written and read relative to the folder of the document."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any


def seen_from_here(document: Any, folder: Path) -> Any:
    """Return a document that lies in `folder` with the files of its meshes as this process finds them."""
    return _changed(document, lambda file: str(folder / file))


def seen_from(document: Any, folder: Path) -> Any:
    """Return a document to be written to `folder`: files below it by their path from there, others by their whole."""

    def written(file: str) -> str:
        whole, there = Path(file).absolute(), folder.absolute()
        return str(whole.relative_to(there) if whole.is_relative_to(there) else whole)

    return _changed(document, written)


def _changed(item: Any, change: Callable[[str], str]) -> Any:
    if isinstance(item, (list, tuple)):
        return [_changed(one, change) for one in item]
    if not isinstance(item, Mapping):
        return item
    table = {name: _changed(one, change) for name, one in item.items()}
    file = table.get("file")
    if table.get("type") == "Mesh" and isinstance(file, str) and file:
        table["file"] = change(file)
    return table
