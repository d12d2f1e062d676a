"""Stiffnesses of walls that are possible, but more likely in a wrong unit."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.scenario import Environment

#: What walls have [N/m]: a hand has 300, and no device of this package renders half a meganewton per metre.
USUAL = (50.0, 500e3)
#: A wall beyond is refused [N/m].
MOST = 1e7


def tell_option(stiffness: float | None) -> None:
    """Say on stderr where --wall-stiffness is likely in a wrong unit."""
    if stiffness is not None and (text := doubt(stiffness)):
        other = f"; {stiffness:g} kN/m is {1e3 * stiffness:g}" if stiffness < USUAL[0] else ""
        output.note(f"--wall-stiffness: {text}; the option is in N/m{other}")


def tell_file(file: Path | str, environment: Environment) -> None:
    """Say on stderr where the wall of a scenario file is likely in a wrong unit."""
    from ebac._core import Wall

    if isinstance(environment, Wall) and (text := doubt(environment.stiffness)):
        output.note(f"{file}: environment.stiffness: {text}; it is in N/m (kN/m x 1e3)")


def tell_conditions(names: Iterable[str]) -> None:
    """Say on stderr which conditions that are written out are likely in a wrong unit."""
    from ebac.studies.condition_grammar import written_out

    for name in names:
        written = written_out(name)
        if written is None or not (text := doubt(1e3 * written.kilo)):
            continue
        end = name.upper().rindex("K")
        other = f", so that {written.kilo:g} N/m is {name[:end]}K{written.kilo / 1e3:g}"
        hint = other if not doubt(written.kilo) else ""
        output.note(f"condition {name}: {text}; the number after K is in kN/m{hint}")


def doubt(stiffness: float) -> str:
    """Return what is unusual about a stiffness [N/m]; nothing where it is usual."""
    if not (
        0 < stiffness < USUAL[0] or USUAL[1] < stiffness <= MOST
    ):  # others are usual, or refused
        return ""
    return f"a wall of {stiffness:g} N/m: usual are {USUAL[0]:g} to {USUAL[1]:g} N/m"
