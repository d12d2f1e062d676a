"""Values of the core from the tables of a configuration: every refusal names file and line."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ebac._util import serialisation
from ebac._util.misplaced import Misplaced, misplaced
from ebac.drives.errors import ProfileError
from ebac.drives.toml_positions import Path, Source, dotted

#: Where a number stands that a law is designed for.
_CAUSES: dict[str, Path] = {
    "Motor.rated_torque": ("device", "motor", "rated_torque"),
    "ForceSensor.noise": ("device", "sensor", "noise"),
    "Timing.dt": ("timing", "dt"),
}


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
    refusing(source, path, lambda: serialisation.refuse_keys(found, names, path, kind))
    return found


def on_top(source: Source, path: Path, base: Any, *, apart: tuple[str, ...] = ()) -> Any:
    """Return a value of the core with the table at `path` on top of it; keys `apart` mean something else.

    Raises
    ------
    ProfileError
        For what cannot be.
    """
    found = table(source, path)
    return refusing(source, path, lambda: serialisation.on_top(base, found, path, apart=apart))


def on_its_preset(source: Source, path: Path, make: Callable[[str], Any], usual: str) -> Any:
    """Return a device or hand with the table at `path` on top of the one that its `preset` names, `usual` without.

    Raises
    ------
    ProfileError
        For what cannot be.
    """
    found = {"preset": usual, **table(source, path)}
    return refusing(source, path, lambda: serialisation.on_its_preset(make, found, path))


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
        wrong = misplaced(path, table(source, path), error)
        raise source.refuse(wrong.path, str(wrong) + _remedy(wrong)) from None


def _remedy(wrong: Misplaced) -> str:
    """Return where to look up a number of the device that is out of range."""
    said = str(wrong)
    if wrong.path[0] != "device" or "must lie in" not in said or ";" in said:
        return ""
    return f"; `ebac keys {dotted(wrong.path[:2])}` shows where it stands in a data sheet, and how to convert it"
