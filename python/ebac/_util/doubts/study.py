"""What of a study is possible, but more likely not meant."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from ebac._util.doubts import device, length, motor

if TYPE_CHECKING:
    from ebac.operators import Operators
    from ebac.scenario import Scenario


def doubts(
    population: Operators, base: Scenario, stiffnesses: Iterable[float] = ()
) -> tuple[str, ...]:
    """Return a sentence for what is doubtful of many runs; `stiffnesses` [N/m] are those of several walls."""
    walls = tuple(stiffnesses)
    weak = motor.of_walls(population, base, walls) if walls else motor.of_many(population, base)
    return tuple(filter(None, [*device.doubts(base.device), length.of_many(base), weak]))
