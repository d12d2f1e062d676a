"""What conditions replace of a scenario that was given: a note on stderr."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.scenario import Scenario

#: Parts of a scenario that a condition may change; the hand is that of the population or of the search.
PARTS = ("device", "environment", "timing", "seconds", "jitter")
_UNITS = {"seconds": "s"}


def note(base: Scenario, names: Sequence[str]) -> None:
    """Print which values that differ from the reference scenario the conditions replace, and by what."""
    lines = replaced(base, names)
    if not lines:
        return
    by = f"condition {names[0]} replaces" if len(names) == 1 else "the conditions replace"
    output.note(f"of the scenario {by} {'; '.join(lines)}")


def replaced(base: Scenario, names: Sequence[str]) -> list[str]:
    """Return each value of a scenario that conditions replace, with its new values."""
    from ebac.scenario import Scenario
    from ebac.studies import conditions

    usual, given = dict(_values(Scenario())), dict(_values(base))
    news: dict[str, list[str]] = {}
    for condition in conditions(names):
        try:
            changed = dict(_values(condition.change(base)))
        except (TypeError, ValueError):  # whoever runs it says what is wrong
            continue
        for name, value in given.items():
            new = changed.get(name)
            if value != usual.get(name) and new is not None and new != value:
                news.setdefault(name, []).append(f"{new[0]:g}")
    return [
        f"{name} = {given[name][0]:g} {given[name][1]} by {' or '.join(dict.fromkeys(values))}"
        for name, values in news.items()
    ]


def _values(base: Scenario) -> Iterator[tuple[str, tuple[float, str]]]:
    """Give every number of a scenario by its name in the file, with its unit."""
    for part in PARTS:
        yield from _flat(part, getattr(base, part), _UNITS.get(part, ""))


def _flat(name: str, item: Any, unit: str) -> Iterator[tuple[str, tuple[float, str]]]:
    if hasattr(item, "as_dict"):
        units = {f.name: f.unit for f in item.fields()} if hasattr(item, "fields") else {}
        for key, value in item.as_dict().items():
            yield from _flat(f"{name}.{key}", value, units.get(key, ""))
    elif isinstance(item, (int, float)):
        yield name, (float(item), "" if unit == "1" else unit)
