"""Values of the core from the tables of a configuration: every refusal names file and line."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, TypeVar

from ebac._util import serialisation
from ebac._util.arguments import ELSEWHERE, unknown
from ebac.drives.errors import ProfileError
from ebac.drives.toml_positions import Path, Source, dotted

Value = TypeVar("Value")

#: "Wall.stiffness = -3 N/m: ...", where the core names what is out of range.
_NAMED = re.compile(r"\b[A-Za-z]\w*\.([a-z]\w*)(?: = |:)")
#: Where the number of a device stands that a law is designed for.
_CAUSES: dict[str, Path] = {"ForceSensor.noise": ("device", "sensor", "noise")}


class ConfigurationError(ProfileError):
    """An invalid configuration; the message contains file, line, key, value, unit, range and remedy."""


def table(source: Source, path: Path) -> Mapping[str, Any]:
    """Return the table at a path; an empty one where there is none.

    Raises
    ------
    ProfileError
        When something else stands there.
    """
    found: Mapping[str, Any] = source.table
    for part in path:
        if part not in found:
            return {}
        inner = found[str(part)]
        if not isinstance(inner, Mapping):
            raise source.refuse(path, f"{dotted(path)} = {inner!r}: must be a table")
        found = inner
    return found


def known(source: Source, path: Path, names: list[str], kind: str = "") -> Mapping[str, Any]:
    """Return the table at a path, which may have these keys only; `kind` is the class that takes them.

    Raises
    ------
    ProfileError
        For a key nobody knows; the message suggests the nearest.
    """
    found = table(source, path)
    for name in found:
        if name not in names:
            here = dotted((*path, name))
            better = ELSEWHERE.get((kind, name))
            wrong = unknown(here, name, names) if better is None else f"{here}: {better}"
            raise source.refuse((*path, name), wrong)
    return found


def on_top(source: Source, path: Path, base: Value, *, apart: tuple[str, ...] = ()) -> Value:
    """Return a value of the core with the table at `path` on top of it.

    Parameters
    ----------
    source : Source
        The document.
    path : tuple
        Where the table stands.
    base : value of the core
        What is not named keeps its value.
    apart : tuple of str
        Keys of the table that mean something else.

    Raises
    ------
    ProfileError
        For what cannot be.
    """
    given: Any = base
    names = [*given.as_dict(), *apart]
    changes: dict[str, Any] = {}
    for name, item in known(source, path, names).items():
        if name in apart:
            continue
        here = (*path, name)
        part = given.as_dict()[name]
        nested = isinstance(item, Mapping) and hasattr(part, "as_dict") and "type" not in item
        if nested:
            changes[name] = on_top(source, here, part)
        else:
            changes[name] = _made(source, here, name, item)
    return refusing(source, path, lambda: given.replace(**changes))  # type: ignore[no-any-return]


def _made(source: Source, path: Path, name: str, item: Any) -> Any:
    return refusing(source, path, lambda: serialisation.from_document(name, item, dotted(path)))


def refusing(source: Source, path: Path, make: Any) -> Any:
    """Return what `make()` returns; an error is raised with the line of its cause.

    Raises
    ------
    ProfileError
        When `make` raises ValueError, TypeError or KeyError.
    """
    try:
        return make()
    except (ValueError, TypeError, KeyError) as error:
        message = str(error.args[0]) if error.args else str(error)
        for name, cause in _CAUSES.items():
            if message.startswith(f"{name} "):
                raise source.refuse(cause, dotted(cause) + message.removeprefix(name)) from None
        names = _NAMED.findall(message)
        at = (*path, names[-1]) if names and names[-1] in table(source, path) else path
        if at != path:
            message = re.sub(rf"^(?:[\w.\[\]]+: )?[A-Z]\w*\.{at[-1]}\b", dotted(at), message)
        raise source.refuse(at, message + _remedy(at, message)) from None


def _remedy(at: Path, message: str) -> str:
    """Return where to look up a number of the device that is out of range."""
    if at[0] != "device" or "must lie in" not in message or ";" in message:
        return ""
    return "; the page Describe your device says where it stands in a data sheet, and how to convert it"
