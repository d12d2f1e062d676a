"""On which line of a TOML document a key stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ebac._util.misplaced import Path
from ebac._util.toml import parsed


def line_of(text: str, path: Path) -> int | None:
    """Return the line on which a key stands, from 1; None when it stands nowhere.

    The standard library's parser keeps no positions, and no kept-up parser of Python does. But the first n lines of a
    document are a document themselves unless they end within a value: a key stands where it first appears among them.
    """
    lines = [f"{line}\n" for line in text.split("\n")]
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


def placed(file: object, text: str, path: Path, message: str) -> str:
    """Return a message with its file and the line of a key, or of the nearest table around it that is there."""
    around = (path[:n] for n in range(len(path), 0, -1))
    line = next((line for one in around if (line := line_of(text, one)) is not None), None)
    return f"{file}: {message}" if line is None else f"{file}, line {line}: {message}"


def _paths(value: Any, path: Path = ()) -> Iterator[Path]:
    if path:
        yield path
    if isinstance(value, Mapping):
        for name, item in value.items():
            yield from _paths(item, (*path, name))
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from _paths(item, (*path, i))
