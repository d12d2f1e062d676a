"""Who else is on a bus on which a drive did not answer: new drives say nothing until they are asked."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ebac.drives.bus_monitor import NO_FRAME
from ebac.drives.errors import BusError, NoAnswer

if TYPE_CHECKING:
    from ebac.drives.bus import DriveBus


@contextmanager
def naming_who_answers(bus: DriveBus) -> Iterator[None]:
    """Ask all node ids before a `NoAnswer` of a silent bus leaves the block, and name those that answer in it."""
    try:
        yield
    except NoAnswer as error:
        if error.traffic != NO_FRAME:
            raise
        try:
            others = bus.scan()
        except BusError:
            others = []
        if not others:
            raise
        raise error.beside(others) from None
