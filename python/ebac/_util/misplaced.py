"""What is wrong with a part of a document, and the key that it is about."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, TypeAlias

#: Where a value stands: names of tables and keys, and places in lists.
Path: TypeAlias = tuple[str | int, ...]

#: "Motor.torque_constant = -1 N m/A: ..." or "Motor.torque_constant: ...", as the core writes.
_FIELD = re.compile(r"\b([A-Z]\w*)\.([a-z]\w*)(?= = |: )")
#: "Motor has no parameter 'torqe_constant', did you mean ...", as constructors write.
_NO_SUCH = re.compile(r"(\w+) has no parameter '(\w+)'")
#: What a message says for Python: "give mechanics=ebac.Mechanics(damping=...)".
_IN_PYTHON = re.compile(r"give (\w+)=ebac\.\w+\((\w+)=\.\.\.\)")


class Misplaced(ValueError):
    """What is wrong with a part of a document.

    Parameters
    ----------
    path : tuple of str or int
        Where the part stands; empty for the document.
    what : str
        The message behind the name of the part.
    """

    def __init__(self, path: Path, what: str) -> None:
        super().__init__(f"{dotted(path)}{what}" if path else what.removeprefix(": "))
        self.path = path


def dotted(path: Path) -> str:
    """Return a path as people write it: node[0].motor.torque_constant."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def misplaced(path: Path, table: Mapping[str, Any], error: Exception) -> Misplaced:
    """Return an error of the value that a table was to become, with the key that it is about.

    Parameters
    ----------
    path : tuple of str or int
        Where the table stands.
    table : mapping
        The table. A field of a class is named as its key, if the table or one in it has that key.
    error : Exception
        What the constructor of the value raised.
    """
    if isinstance(error, Misplaced):
        return error
    said = str(error.args[0]) if error.args else str(error)
    said = re.sub(": must be bool$", ": must be true or false", said)
    said = _IN_PYTHON.sub(lambda found: f"give {found[2]} in [{_table(path, found[1])}]", said)
    if path and (found := re.match(rf"{re.escape(dotted(path))}(?:\.(\w+))?(?= = |: )", said)):
        return Misplaced((*path, *filter(None, found.groups())), said[found.end() :])
    if found := _NO_SUCH.match(said):
        of = "" if found[1].lower() in path[-1:] else f" in {found[1]}"
        return Misplaced((*path, found[2]), f": no such name{of}{said[found.end() :]}")
    for found in _FIELD.finditer(said):
        if key := _key(found[1], found[2], table):
            return Misplaced((*path, *key), f": {said}" if found.start() else said[found.end() :])
    return Misplaced(path, f": {said}")


def _table(path: Path, part: str) -> str:
    """Return the name of a table of a part, seen from a path in it or above it."""
    return dotted(path if path[-1:] == (part,) else (*path, part))


def _key(kind: str, field: str, table: Mapping[str, Any]) -> tuple[str, ...]:
    """Return where a field of a class stands: in the table, or in the one in it that is called like the class."""
    if field in table:
        return (field,)
    inner = table.get(kind.lower())
    return (kind.lower(), field) if isinstance(inner, Mapping) and field in inner else ()
