"""How long a parameter of a drive takes to read by SDO: over the interface `ebac` and over python-can's `virtual`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from statistics import quantiles
from time import perf_counter
from typing import TYPE_CHECKING

from ebac.peers.row import PeerRow

if TYPE_CHECKING:
    import can

#: Subjects.
MEDIAN, SLOW = "SDO read, p50", "SDO read, p99"
#: Reads of one run.
READS = 2_000
#: What each program does.
NOTES = {
    "ebac, served by C++": 'canopen reads the statusword over can.Bus(interface="ebac", channel="joystick")',
    "virtual, served by Python": (
        "canopen reads it over python-can's virtual bus; the same simulated drives behind a thread of Python"
    ),
}
_OURS, _THEIRS = NOTES
_CHANNEL = "joystick-bench"

#: How often `compare_reads` calls `step`.
STEPS = 2


def compare_reads(*, step: Callable[[str], None] = lambda name: None) -> list[PeerRow]:
    """Time SDO reads of a simulated drive, one after the other.

    Parameters
    ----------
    step : callable
        Called with what comes next, `STEPS` times.

    Returns
    -------
    list of PeerRow
        Median and 99th percentile of one run [s]; `times_ebac` compares with the interface `ebac`.
    """
    cuts = {}
    for whose, served in ((_OURS, _by_cpp), (_THEIRS, _by_python)):
        step(f"SDO, {whose}")
        with served() as bus:
            cuts[whose] = quantiles(_reads(bus), n=100)
    return [
        PeerRow(
            subject=subject, program=whose, value=cut[at], unit="s", times_ebac=cut[at] / cuts[_OURS][at],
            note=NOTES[whose],
        )
        for subject, at in ((MEDIAN, 49), (SLOW, 98))
        for whose, cut in cuts.items()
    ]  # fmt: skip


@contextmanager
def _by_cpp() -> Iterator[can.BusABC]:
    import can

    with can.Bus(interface="ebac", channel=_CHANNEL, ignore_config=True) as bus:
        yield bus


@contextmanager
def _by_python() -> Iterator[can.BusABC]:
    import can

    from ebac._core import Joystick
    from ebac.can.channels import resting_joystick
    from ebac.drives.simulate import Simulation

    with ExitStack() as stack:
        ours, theirs = (
            stack.enter_context(can.Bus(interface="virtual", channel=_CHANNEL, ignore_config=True))
            for _ in range(2)
        )
        stack.enter_context(Simulation(theirs, Joystick(resting_joystick().setup())))
        yield ours


def _reads(bus: can.BusABC) -> list[float]:
    """Return how long each read took [s]."""
    import canopen

    network = canopen.Network(bus)
    network.NOTIFIER_CYCLE = 0.01  # s; the end waits for it
    network.connect()
    node = network.add_node(1, canopen.ObjectDictionary())  # type: ignore[no-untyped-call]
    node.sdo.RESPONSE_TIMEOUT = 5  # s
    taken = []
    for _ in range(READS):
        start = perf_counter()
        node.sdo.upload(0x6041, 0)
        taken.append(perf_counter() - start)
    network.disconnect()
    return taken
