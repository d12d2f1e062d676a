"""What the tests share: cached runs of scenarios, hypothesis profiles, a bus.

More examples than usual: `pytest --hypothesis-profile=explore`.
"""

from collections.abc import Callable, Iterator
from functools import cache
from itertools import count
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import settings

import ebac

if TYPE_CHECKING:
    import can

settings.register_profile("ebac", deadline=None, derandomize=True, database=None)
settings.register_profile("explore", deadline=None, max_examples=5000, database=None)
settings.load_profile("ebac")


@cache
def _run(law: str, changes: tuple[tuple[str, Any], ...]) -> ebac.Trace:
    return ebac.simulate(ebac.Scenario(**dict(changes)), law)


@pytest.fixture(scope="session")
def run() -> Callable[..., ebac.Trace]:
    """`run("eba", seconds=1.0)`: the reference scenario, partly changed, simulated once."""

    def simulate(law: str, **changes: Any) -> ebac.Trace:
        return _run(law, tuple(sorted(changes.items())))

    return simulate


_CHANNELS = count()


@pytest.fixture
def open_bus() -> Iterator[Callable[[], "can.BusABC"]]:
    """A function that opens a bus with the simulated drives of the joystick on it, nodes 1 and 2."""
    from ebac.can_interface import EbacBus

    channel = f"joystick-{next(_CHANNELS)}"
    with EbacBus(channel):
        yield lambda: EbacBus(channel)
