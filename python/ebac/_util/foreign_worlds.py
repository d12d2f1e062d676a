"""Worlds of `ebac.worlds` that are not made of bodies: functions and engines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac._core import _World

if TYPE_CHECKING:
    from ebac.worlds.engines import ForeignWorld


def foreign(environment: Any) -> ForeignWorld | None:
    """Return a world of `ebac.worlds` that is no `World` of bodies, as such; None for anything else."""
    if not isinstance(environment, _World):
        return None
    from ebac.worlds.engines import ForeignWorld

    return environment if isinstance(environment, ForeignWorld) else None


def refuse_python(environment: Any) -> None:
    """Refuse a world that calls Python in a tick, where ticks are in real time.

    Raises
    ------
    ValueError
        For a function; an engine has a thread of its own instead.
    """
    world = foreign(environment)
    if world is not None and not world.in_real_time:
        raise ValueError(
            f"environment = {world!r}: calls Python in a tick, which cannot wait for it; give the world of a "
            "worlds.EngineThread, which calls the function beside the loop"
        )
