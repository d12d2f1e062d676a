"""The configuration of `ebac run`: that of its file, with options on top."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac.cli import by_name, doubtful, from_options, options, setting

if TYPE_CHECKING:
    from ebac.hardware import Configuration
    from ebac.hardware.schedule import Schedule


def chosen(
    file: Path,
    law: str | None,
    seconds: float | None,
    rate: float | None,
    observer: bool | None,
    wall: options.WallOptions,
    person: options.HandOptions,
) -> Configuration:
    """Return the configuration of a file, with what the command line changes in it."""
    from ebac.hardware import Configuration
    from ebac.hardware.world_place import check_reached

    known = Configuration.load(file)
    doubtful.note_configuration(file, known)
    changes: dict[str, Any] = {
        "environment": from_options.wall(known.environment, wall),
        "hand": from_options.hand(known.hand, person),
        "timing": setting.choose_timing(known.timing, rate, None),
        **setting.given(seconds=seconds),
        **observer_change(known, observer),
    }
    name = None if law is None else by_name.any_law(law)
    if name is not None and name != known.law:
        changes |= {"law": name, "changes": {}}
    made = known.replace(**changes)
    made.scenario()
    check_reached(made.device, made.limits, made.environment)
    made.design()
    if rate is not None and made.timing.dt != known.timing.dt:  # else the file has it, and is noted
        doubtful.note_rate(rate, made)
    return made


def first_run(
    known: Configuration, wall: options.WallOptions, engine: str | None, schedule: Schedule
) -> tuple[Configuration, tuple[str, ...]]:
    """Return the configuration of --first, and a line for each value that it changes.

    Raises
    ------
    ValueError
        Where other options ask for a virtual world or a force loop.
    """
    from ebac.hardware.first_run import differences
    from ebac.laws.making import FORCE_GAINS

    given = {**vars(wall), "engine_command": engine}
    asked = [f"--{name.replace('_', '-')}" for name, value in given.items() if value is not None]
    if asked:
        raise ValueError(
            f"{', '.join(asked)}: --first has no virtual world; leave it out, or leave out --first"
        )
    for order in schedule.orders:
        asked = [f"environment.{name}" for name in order.environment]
        asked += [f"law.{name}" for name, gain in order.law.items() if gain and name in FORCE_GAINS]
        if asked:
            raise ValueError(
                f"--at {order.at:g} s: {', '.join(asked)}: --first has neither a virtual world nor a force loop; leave "
                "it out, or leave out --first"
            )
    first = known.first_run()
    return first, tuple(differences(known, first))


def observer_change(known: Configuration, wanted: bool | None) -> dict[str, Any]:
    """Return the change that turns the observer on or off; one that is configured stays as it is."""
    if wanted is None or wanted == bool(known.observer):
        return {}
    return {"observer": wanted}
