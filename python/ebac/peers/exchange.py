"""What a tick on the bus takes: `CanopenDevice.exchange` over a bus inside this process."""

from __future__ import annotations

from collections.abc import Callable

from ebac import _core
from ebac.peers.row import PeerRow

EXCHANGE = "exchange with two drives"
#: Ticks of each run.
TICKS = 20_000
#: How often `compare` calls `step`.
STEPS = 2
#: A tick of 1 ms, of which the bus itself needs 515 us.
AIM = "below 100 µs"


def compare(*, repeats: int = 20, step: Callable[[str], None] = lambda name: None) -> list[PeerRow]:
    """Time the exchange of process data with two drives, in C++.

    Parameters
    ----------
    repeats : int
        Runs of 20,000 ticks each; the quickest counts.
    step : callable
        Called with what comes next, `STEPS` times.

    Returns
    -------
    list of PeerRow
    """
    step("exchange, simulated drives")
    drives = 1e-9 * _core._time_exchange(TICKS, repeats)
    step("exchange, the loop's side alone")
    alone = 1e-9 * _core._time_own_exchange(TICKS, repeats)
    return [
        PeerRow(
            subject=EXCHANGE,
            program="ebac, LoopbackBus",
            value=drives,
            unit="s",
            target=AIM,
            note="commands and SYNC out, two simulated CANopen drives, their answers in; five frames, one thread",
        ),
        PeerRow(
            subject=EXCHANGE,
            program="ebac, the loop's side",
            value=alone,
            unit="s",
            target=AIM,
            note="the same frames made, read and judged, the answers from memory: no bus, no drives",
        ),
    ]
