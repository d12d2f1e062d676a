"""Stiffnesses and places of walls that are possible, but more likely in a wrong unit."""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, sin
from pathlib import Path
from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac._core import Device
    from ebac.metrics import Contact
    from ebac.scenario import Environment, Scenario

#: What walls have [N/m]: a hand has 300, and no device of this package renders half a meganewton per metre.
USUAL = (50.0, 500e3)
#: A wall beyond is refused [N/m].
MOST = 1e7


def note_option(stiffness: float | None) -> None:
    """Say on stderr where --wall-stiffness is likely in a wrong unit."""
    if stiffness is not None and (text := doubt(stiffness)):
        other = f"; {stiffness:g} kN/m is {1e3 * stiffness:g}" if stiffness < USUAL[0] else ""
        output.note(f"--wall-stiffness: {text}; the option is in N/m{other}")


def note_file(file: Path | str, environment: Environment) -> None:
    """Say on stderr where the wall of a scenario file is likely in a wrong unit."""
    from ebac._core import Wall

    if isinstance(environment, Wall) and (text := doubt(environment.stiffness)):
        output.note(f"{file}: environment.stiffness: {text}; it is in N/m (kN/m x 1e3)")


def note_place(option: float | None, file: Path | None, scenario: Scenario) -> None:
    """Say on stderr where a wall stands behind the stops of the device; `option` [m] is that of --wall-position."""
    from ebac._core import Wall

    wall = scenario.environment
    if isinstance(wall, Wall):
        end = _end(scenario.device, wall.angle) + wall.motion_amplitude
        place = wall.position
    elif option is not None:
        end, place = _end(scenario.device), option
    else:
        return
    if place < end:
        return
    where = f"{file}: environment.position" if option is None else "--wall-position"
    output.note(
        f"{where} = {place:g} m: the handle never reaches the wall, the stops of the device stand at {end:.4g} m "
        f"(device.kinematics.limit){_in_metres(place, end)}"
    )


def note_untouched(scenario: Scenario, contacts: Iterable[Contact]) -> None:
    """Say on stderr where no law met a wall before the stops of the device, as the hand does not lead there."""
    import numpy as np

    from ebac._core import Wall

    wall, device = scenario.environment, scenario.device
    if not isinstance(wall, Wall) or any(contact.touched is not False for contact in contacts):
        return
    if wall.angle != 0 or wall.position >= _end(device) + wall.motion_amplitude:  # noted before
        return
    times = np.linspace(0, scenario.seconds, 1001)
    most = max(scenario.hand.target(t) for t in times)
    if most > wall.position:
        return
    output.note(
        f"the wall stands at {wall.position:g} m (--wall-position), and the target of the hand comes to {most:.4g} m "
        f"at most: no law meets the wall; give a nearer wall, or a target behind it by --hand-target"
        f"{_in_metres(wall.position, most)}"
    )


def _end(device: Device, angle: float = 0.0) -> float:
    """Return how far the handle comes along the normal of a wall, before its stops [m]."""
    normal = (abs(cos(angle)), abs(sin(angle)))
    ways = device.kinematics.travel * device.kinematics.stops
    return float(sum(share * way for share, way in zip(normal, ways, strict=False)))


def _in_metres(place: float, end: float) -> str:
    """Return what a place [m] would be that was meant in millimetres, where the handle could come to that."""
    shown = f", {place:g} mm are {place / 1e3:g}" if 0 < place / 1e3 < end else ""
    return f"; positions are in metres{shown}"


def note_conditions(names: Iterable[str]) -> None:
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
