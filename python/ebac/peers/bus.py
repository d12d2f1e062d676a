"""How many frames a bus inside a process carries: ebac in C++ and by python-can, and python-can's own `virtual`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from statistics import quantiles
from threading import Thread
from time import perf_counter
from typing import TYPE_CHECKING

from ebac.peers.row import PeerRow, quickest

if TYPE_CHECKING:
    import can

#: Subjects.
ONE = "sent and received, one thread"
TWO = "one thread sends, one receives"
MEDIAN, SLOW = "answer to a frame, p50", "answer to a frame, p99"
#: Frames of a run in C++, of a run in Python, and answers.
FRAMES, PYTHON_FRAMES, ANSWERS = 100_000, 5_000, 3_000
#: What each program does.
NOTES = {
    "C++": "LoopbackBus of ebac: a frame of 8 bytes between two ends, stamped with the time of day; no Python",
    "ebac": 'the same bus by python-can, can.Bus(interface="ebac"): a can.Message from send to recv',
    "virtual": 'python-can\'s own, can.Bus(interface="virtual"): a can.Message from send to recv',
}
_CPP, _OURS, _THEIRS = NOTES
_INTERFACES = {_OURS: "ebac", _THEIRS: "virtual"}

#: How often `compare_buses` calls `step`.
STEPS = 5


def compare_buses(
    *, repeats: int = 5, step: Callable[[str], None] = lambda name: None
) -> list[PeerRow]:
    """Time frames over buses inside this process, all in one run.

    Parameters
    ----------
    repeats : int
        Runs of each measurement; the quickest counts, for answers one run.
    step : callable
        Called with what comes next, `STEPS` times.

    Returns
    -------
    list of PeerRow
        Frames per second [1/s], and how long an answer takes that another thread gives [s]. `times_ebac` compares with
        ebac by python-can.
    """
    from ebac._core import _time_bus, _time_bus_threads

    step("C++")
    rates = {
        ONE: {_CPP: 1e9 / _time_bus(FRAMES, repeats)},
        TWO: {_CPP: 1e9 / _time_bus_threads(FRAMES, repeats)},
    }
    for whose, interface in _INTERFACES.items():
        step(whose)
        for subject, run in ((ONE, _one_thread), (TWO, _two_threads)):
            with _pair(interface) as (mine, other):
                taken = quickest(repeats, partial(run, mine, other))
            rates[subject][whose] = PYTHON_FRAMES / taken
    answers: dict[str, dict[str, float]] = {MEDIAN: {}, SLOW: {}}
    for whose, interface in _INTERFACES.items():
        step(f"{whose}, answers")
        with _pair(interface) as (mine, other):
            cuts = quantiles(_answers(mine, other), n=100)
        answers[MEDIAN][whose], answers[SLOW][whose] = cuts[49], cuts[98]
    return [*_rows(rates, "1/s"), *_rows(answers, "s")]


def _rows(values: dict[str, dict[str, float]], unit: str) -> Iterator[PeerRow]:
    for subject, of in values.items():
        for whose, value in of.items():
            yield PeerRow(
                subject=subject, program=whose, value=value, unit=unit, times_ebac=value / of[_OURS], note=NOTES[whose],
            )  # fmt: skip


@contextmanager
def _pair(interface: str) -> Iterator[tuple[can.BusABC, can.BusABC]]:
    """Give two buses on one channel of an interface."""
    import can

    def one() -> can.BusABC:
        return can.Bus(interface=interface, channel="ebac-bench", ignore_config=True)

    with one() as mine, one() as other:
        yield mine, other


def _message() -> can.Message:
    import can

    return can.Message(arbitration_id=0x181, is_extended_id=False, data=bytes(8))


def _one_thread(mine: can.BusABC, other: can.BusABC) -> None:
    message = _message()
    for _ in range(PYTHON_FRAMES):
        mine.send(message)
        other.recv(0)


def _two_threads(mine: can.BusABC, other: can.BusABC) -> None:
    message = _message()

    def send() -> None:
        for _ in range(PYTHON_FRAMES):
            mine.send(message)

    sender = Thread(target=send)
    sender.start()
    for _ in range(PYTHON_FRAMES):
        other.recv(5)
    sender.join()


def _answers(mine: can.BusABC, other: can.BusABC) -> list[float]:
    """Return how long each answer took that another thread gave [s]."""
    message, taken = _message(), []

    def answer() -> None:
        for _ in range(ANSWERS):
            if (asked := other.recv(5)) is not None:
                other.send(asked)

    answering = Thread(target=answer)
    answering.start()
    for _ in range(ANSWERS):
        start = perf_counter()
        mine.send(message)
        mine.recv(5)
        taken.append(perf_counter() - start)
    answering.join()
    return taken
