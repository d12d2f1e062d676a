"""A scenario as TOML text, written and read."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac import presets
from ebac._util import serialisation
from ebac._util.file_kinds import CONFIGURATION, NETWORK, PROFILE, kind_of
from ebac._util.foreign_worlds import foreign
from ebac._util.mesh_paths import seen_from, seen_from_here
from ebac._util.text_file import read_text
from ebac._util.toml import parsed
from ebac.hands import is_own

if TYPE_CHECKING:
    from ebac.scenario import Scenario

#: What a table may start from, by `preset`.
_PRESETS: Mapping[str, Callable[[str], Any]] = {"device": presets.device, "hand": presets.hand}


def text_of(scenario: Scenario, folder: Path | None) -> str:
    """Return the text, see `Scenario.to_toml`."""
    import tomli_w

    if reason := _why_not(scenario):
        raise ValueError(reason)
    values = {f.name: getattr(scenario, f.name) for f in dataclasses.fields(scenario)}
    numbers = {k: v for k, v in values.items() if isinstance(v, (int, float, str))}
    others = {k: serialisation.to_document(v) for k, v in values.items() if k not in numbers}
    document = numbers | others
    if folder is not None:
        document = seen_from(document, folder)
    return "# ebac scenario; SI units throughout\n" + tomli_w.dumps(document)


def text_for_file(scenario: Scenario | None) -> str:
    """Return the text that goes into the file of a trace; empty without a scenario, or where it has no text."""
    return "" if scenario is None or _why_not(scenario) else scenario.to_toml()


def warn_without_text(scenario: Scenario | None, path: str | Path, stacklevel: int) -> None:
    """Warn that a trace is saved without its scenario, where code of one's own is part of it."""
    if scenario is not None and (reason := _why_not(scenario)):
        warnings.warn(f"{path}: saved without its scenario. {reason}", stacklevel=stacklevel + 1)


def _why_not(scenario: Scenario) -> str:
    """Return why a scenario cannot be written to TOML, empty if it can."""
    if is_own(scenario.hand.model):
        return (
            f"Scenario.hand.model = {scenario.hand.model!r}: a hand of your own cannot be written to TOML; "
            "write the scenario with a model of ebac.hands, or none"
        )
    world = foreign(scenario.environment)
    if world is not None and not world.has_text:
        return (
            f"Scenario.environment = {scenario.environment!r}: a function cannot be written to TOML; write the "
            "scenario with a World, a wall, or a Bridge to a World"
        )
    return ""


def is_configuration(file: Path) -> bool:
    """Return whether a file that can be read has a table of a configuration of `ebac run`."""
    return kind_of(parsed(read_text(file))) == CONFIGURATION


def parts_of(text: str, kind: type[Scenario], folder: Path | None) -> dict[str, Any]:
    """Return the parts of a scenario that a text names, see `Scenario.from_toml`."""
    try:
        table = parsed(text)
    except ValueError as error:
        raise ValueError(f"not a TOML document: {error}") from None
    found = kind_of(table)
    if found in (NETWORK, PROFILE):
        raise ValueError(f"this is {found}, not a scenario, which describes a device in [device]")
    if found == CONFIGURATION:
        raise ValueError(
            "this is a configuration of `ebac run`, not a scenario: `ebac run FILE --virtual` simulates it; for a "
            "scenario copy its tables [device], [timing], [environment], and [simulated.hand] as [hand]"
        )
    if folder is not None:
        table = seen_from_here(table, folder)
    started = {
        name: serialisation.on_its_preset(make, given, (name,))
        for name, make in _PRESETS.items()
        if isinstance(given := table.get(name), Mapping) and "preset" in given
    }
    rest = {name: item for name, item in table.items() if name not in started}
    return started | serialisation.read_table(rest, dataclasses.fields(kind), ())
