"""The drives before a run and after it, over SDO: Python configures slowly, the C++ loop runs quickly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from ebac.drives import Backups, DriveBus, DriveError, Node, NotApplied, apply, verify
from ebac.drives.state import State
from ebac.drives.who_answers import naming_who_answers

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ebac.drives import Drive
    from ebac.hardware.backends import Backend
    from ebac.hardware.configuration import Configuration

#: The shortest period of SYNC written to a simulated drive [s]. It takes the silence of twenty for a broken bus, and an
#: ordinary kernel under load, or in a virtual machine, pauses a loop for 20 ms now and then.
_SHORTEST = 10e-3
#: What makes a drive watch the loop's heartbeat, or its requests (node guarding); 0 where it does not (CiA 301).
_WATCHES = ("heartbeat_consumer", "life_time_factor")
#: Periods of SYNC that a simulated drive may miss, and torques that any drive may.
_SYNCS, _MISSED = 20, 5


def nodes_of(configuration: Configuration, *, simulate: bool) -> tuple[Node, ...]:
    """Return the drives, their SYNC period that of the loop, no deadline of a torque shorter than five of its ticks.

    Simulated drives wait at least 0.2 s for a heartbeat or request, too.
    """
    dt = configuration.timing.dt
    if simulate:
        dt = max(dt, _SHORTEST)
    torque = _SYNCS * dt if simulate else _MISSED * dt
    heartbeat = _SYNCS * _SHORTEST if simulate else 0.0
    return tuple(
        replace(
            node,
            profile=node.profile.with_patience(torque=torque, heartbeat=heartbeat).replace(
                sync__period=dt
            ),
        )
        for node in configuration.drives.nodes
    )


def other_sync(known: Configuration, option: str = "") -> list[tuple[int, str, str]]:
    """Return the drives whose profile has another SYNC period than the loop; `option` is what gives that of the loop.

    Returns
    -------
    list of (node, sentence, remedy)
        The remedy is empty where a run writes the period of the loop.
    """
    dt, verifies = known.timing.dt, known.setup == "verify"
    then = "refuses a drive that holds anything else there" if verifies else "writes it"
    found = []
    for node in known.drives.nodes:
        period = float(node.profile.values["sync.period"])
        if abs(period - dt) <= 0.5e-6:  # as finely as 0x1006 counts
            continue
        text = (
            f"sync.period = {period:g} s in its profile, timing.dt = {dt:g} s: `ebac run` takes timing.dt for 0x1006, "
            f'and {then}, because of bus.setup = "{known.setup}"'
        )
        own = f"leave out {option}" if option else f"timing.dt = {period:g}"
        remedy = f"give sync.period = {dt:g} in the profile and `ebac drive apply` it, or {own}"
        found.append((node.id, text, remedy if verifies else ""))
    return found


@contextmanager
def drives_at(backend: Backend, nodes: Sequence[Node]) -> Iterator[list[Drive]]:
    """Give the drives of a backend; the bus is closed after the block, so that Python receives no process data."""
    with (
        DriveBus.open(interface=backend.interface, channel=backend.channel) as bus,
        naming_who_answers(bus),
    ):
        yield [bus.drive(node.id, eds=node.sheet, timeout=backend.patience) for node in nodes]


def set_up(
    backend: Backend, nodes: Sequence[Node], *, write: bool, backups: Backups | None = None
) -> None:
    """Bring every drive to its profile, without power.

    Parameters
    ----------
    backend : Backend
        Where they are.
    nodes : sequence of Node
        What they are to be set to.
    write : bool
        Whether to write what differs; without, a drive that holds something else is refused.
    backups : Backups, optional
        Where what they held before is kept.

    Raises
    ------
    DriveFault
        When a drive is in fault: that is reset by `ebac drive reset-fault`, not by a run.
    NotVerified
        When a drive holds something else than its profile.
    DriveError
        When a drive does not answer or obey, or is by another maker than its data sheet.
    """
    with drives_at(backend, nodes) as drives:
        for drive, node in zip(drives, nodes, strict=True):
            _rest(drive)
            drive.check_sheet()
            if write:
                with _with_longer_times(backend):
                    apply(drive, node, backups=backups)
            else:
                verify(drive, node)


@contextmanager
def _with_longer_times(backend: Backend) -> Iterator[None]:
    """Note on an error that lists what was written to simulated drives that some of it is in no profile."""
    try:
        yield
    except NotApplied as error:
        if backend.aim is not None:
            error.add_note(
                f"Simulated drives get longer times than their profile has: sync_period at least {1e3 * _SHORTEST:g} "
                f"ms, a watch over the loop at least {1e3 * _SYNCS * _SHORTEST:g} ms"
            )
        raise


def start(
    backend: Backend,
    nodes: Sequence[Node],
    check: Callable[[list[int]], None] = lambda counts: None,
) -> None:
    """Let the drives take process data; they stay without power until the loop enables them. Raises as `set_up`.

    All that sets, adds to, scales or limits their torque is read back first. What `check` raises, given the position
    of each drive [counts], keeps them as they are.
    """
    with drives_at(backend, nodes) as drives:
        for drive, node in zip(drives, nodes, strict=True):
            _rest(drive)
            _begin_watch_anew(drive)
            drive.zero_torque()
            verify(drive, node)
        drives[0].bus.check_alone([node.id for node in nodes])
        check([drive.number("position") for drive in drives])
        for drive in drives:
            drive.nmt("start")


def _rest(drive: Drive) -> None:
    """Leave a drive without power; one in fault is reported, not reset."""
    if drive.disable() is State.FAULT:
        raise drive.fault("being set up")


def _begin_watch_anew(drive: Drive) -> None:
    """Let a drive without power watch the loop only from its next heartbeat or request on (CiA 301).

    A loop that has ended is silent. Its drive would report that as an error, and end a run that begins just then.
    """
    for name in _WATCHES:
        if held := drive.look(name):
            drive.write(name, 0)
            drive.write(name, int(held))


def power_off(backend: Backend, nodes: Sequence[Node]) -> list[str]:
    """See that no drive has power, asked one by one, nor misses the loop; return the state of each.

    Raises
    ------
    DriveError
        When a drive does not obey or answer, after all were commanded. Then cut the power.
    """
    failed: list[DriveError] = []
    states: list[str] = []
    with drives_at(backend, nodes) as drives:
        resting = []
        for drive in drives:
            try:
                states.append(drive.disable().value)
                resting.append(drive)
            except DriveError as error:
                failed.append(error)
        for drive in resting:
            # Whatever fails: it has no power, and the next start writes it again and reads it back.
            with suppress(DriveError):
                _begin_watch_anew(drive)
    if failed:
        for other in failed[1:]:
            failed[0].add_note(str(other))
        raise failed[0]
    return states
