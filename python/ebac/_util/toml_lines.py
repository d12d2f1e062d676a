"""On which line of a TOML document a key stands."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, TypeAlias

from ebac._util.toml import parsed

#: Where a value stands: names of tables and keys, and places in lists.
Path: TypeAlias = tuple[str | int, ...]

#: How an error of a scenario begins: "scenario.hand.path[0]: ...".
_PLACE = re.compile(r"scenario((?:\.\w+|\[\d+\])+)")
#: The key that it is about: "Motor.torque_constant = ...", "Motor has no parameter 'torqe_constant'".
_KEY = re.compile(r"\b[A-Z]\w*\.([a-z]\w*)|\b(\w+) has no parameter '(\w+)'")

#: What a message says for Python: "give mechanics=ebac.Mechanics(damping=...)".
_IN_PYTHON = re.compile(r"give (\w+)=ebac\.\w+\((\w+)=\.\.\.\)")


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


def located(file: object, text: str, message: str) -> str:
    """Return a message of a scenario with its file and, where it names a key of the text, the line.

    A key that stands in the text is named as there: environment.stiffness, hand.mas, not the field of a class.
    """
    place, key = _PLACE.match(message), _KEY.search(message)
    begin, at = ("", "") if place is None else (f"{place[0]}: ", place[1].removeprefix(".") + ".")
    message = _IN_PYTHON.sub(lambda found: f"give {found[2]} in [{at}{found[1]}]", message)
    parts = re.findall(r"\w+", at)
    table = tuple(int(part) if part.isdigit() else part for part in parts)
    line = None
    if key is not None:
        name = key[1] or key[3]
        line = line_of(text, (*table, name))
        if line is not None and message.startswith(field := f"{begin}{key[0]}"):
            of = f" of {key[2]}" if key[2] and key[2].lower() not in parts[-1:] else ""
            wrong = f": no such key{of}" if key[2] else ""
            message = f"{at}{name}{wrong}{message.removeprefix(field)}"
    if line is None and table:
        line = line_of(text, table)
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
