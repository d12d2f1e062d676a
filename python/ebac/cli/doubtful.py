"""Notes on stderr of what is possible, but more likely not meant; the texts are those of the library."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._util.doubts import device as of_device
from ebac._util.doubts import length, motor, run, start, wall
from ebac.cli import output

if TYPE_CHECKING:
    from ebac._core import Device
    from ebac.drives import Network
    from ebac.hardware import Configuration
    from ebac.metrics import Contact
    from ebac.operators import Operators
    from ebac.scenario import Environment, Scenario
    from ebac.trace import Trace

#: Options that give what the library names otherwise.
NO_OBSERVER, STIFFNESS, POSITION = "--no-observer", "--wall-stiffness", "--wall-position"
TARGET, SECONDS, RATE = "--hand-target", "--seconds", "--rate"


def _print(*texts: str, where: Path | str = "") -> None:
    for text in filter(None, texts):
        output.note(f"{where}: {text}" if where else text)


def note_device(file: Path | str, device: Device) -> None:
    """Print what of the device of a file is doubtful."""
    _print(*of_device.doubts(device, no_observer=NO_OBSERVER), where=file)


def note_change(option: str, before: Device, after: Device) -> None:
    """Print what an option makes doubtful of a device."""
    _print(*of_device.of_change(before, after, no_observer=NO_OBSERVER), where=option)


def note_stiffness(option: float | None) -> None:
    """Print that --wall-stiffness is likely in a wrong unit."""
    if option is not None:
        _print(wall.doubt(option, STIFFNESS))


def note_world(file: Path | str, environment: Environment) -> None:
    """Print that the wall of a file is likely in a wrong unit."""
    _print(wall.of_world(environment), where=file)


def note_place(option: float | None, file: Path | None, scenario: Scenario) -> None:
    """Print that a wall stands behind the stops of the device; `option` [m] is that of --wall-position."""
    name = f"{file}: {wall.POSITION}" if option is None else POSITION
    _print(wall.behind_stops(scenario, option, name))


def note_start(option: float | None, file: Path | None, scenario: Scenario) -> None:
    """Print that the handle begins inside the world; `option` [m] is that of --wall-position."""
    name = POSITION if option is not None else f"{file}: environment" if file else "environment"
    _print(start.inside(scenario, name))


def note_left(trace: Trace) -> None:
    """Print that a handle was beyond the stops of its device."""
    _print(run.left(trace), where=trace.law)


def note_untouched(scenario: Scenario, contacts: Iterable[Contact]) -> None:
    """Print that no law met a wall before the stops of the device, as the hand does not lead there."""
    if all(contact.touched is False for contact in contacts):
        _print(wall.before_target(scenario, POSITION, TARGET))


def note_conditions(names: Iterable[str]) -> None:
    """Print which conditions that are written out are likely in a wrong unit."""
    from ebac.studies.condition_grammar import written_out

    for name in names:
        written = written_out(name)
        if written is None or not (text := wall.unusual(1e3 * written.kilo)):
            continue
        end = name.upper().rindex("K")
        other = f", so that {written.kilo:g} N/m is {name[:end]}K{written.kilo / 1e3:g}"
        hint = other if not wall.unusual(written.kilo) else ""
        output.note(f"condition {name}: {text}; the number after K is in kN/m{hint}")


def note_drives(file: Path | str, known: Configuration) -> None:
    """Print in what the drives are for another motor: a command that looks at the device alone goes on."""
    from ebac._util.doubts.drives import other_motor

    _print(*other_motor(known), where=file)


def note_profiles(network: Network) -> None:
    """Print what of the profiles of a network is likely not meant."""
    from ebac._util.doubts.profile import doubts

    _print(*doubts(network))


def note_configuration(file: Path | str, known: Configuration) -> None:
    """Print what of a configuration is likely not meant: of device, wall, force sensor, and their limits."""
    from ebac._util.doubts.configuration import all_doubts

    _print(*all_doubts(known, no_observer=NO_OBSERVER), where=file)


def note_rate(rate: float, known: Configuration) -> None:
    """Print that the drives have the SYNC period of another rate than that of --rate [Hz]."""
    from ebac._util.doubts.drives import of_sync

    _print(*of_sync(known, RATE), where=f"{RATE} {rate:g}")


def note_weak_motor(population: Operators, base: Scenario) -> None:
    """Print for how many hands the motor is too weak at their ideal rest."""
    _print(motor.of_many(population, base))


def note_weak_motor_at(stiffnesses: Iterable[float], population: Operators, base: Scenario) -> None:
    """Print from which wall [N/m] on the motor is too weak for hands."""
    _print(motor.of_walls(population, base, stiffnesses))


def note_short(base: Scenario) -> None:
    """Print that runs so short say nothing of a law."""
    _print(length.of_many(base, SECONDS))
