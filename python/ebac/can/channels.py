"""Channels of the interface `ebac`: named buses of this process, and the nodes on them."""

from __future__ import annotations

import atexit
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from threading import RLock
from typing import TYPE_CHECKING

from ebac._core import LoopbackBus, LoopbackHub, LoopbackJoystick
from ebac._util.arguments import unknown

if TYPE_CHECKING:
    from ebac.scenario import Scenario

#: What builds the nodes of a channel: given the bus, a context in which they stand on it.
Nodes = Callable[[LoopbackHub], AbstractContextManager[object]]


def resting_joystick() -> Scenario:
    """Return the scenario of the joystick on a channel: the paper's device, with a hand that holds it still."""
    from ebac import presets
    from ebac.scenario import Scenario

    return Scenario(device=presets.device("joystick"), hand=presets.hand("resting"))


def joystick(hub: LoopbackHub) -> LoopbackJoystick:
    """Return the simulated joystick, nodes 1 and 2."""
    return LoopbackJoystick(hub, resting_joystick().setup())


#: Nodes by the start of a channel's name: "joystick" stands for joystick2 and joystick-left too, each with its own.
NODES: dict[str, Nodes] = {"joystick": joystick}
#: Nodes by a channel's whole name, as long as it is `standing`.
STANDING: dict[str, Nodes] = {}


def nodes_on(channel: str) -> Nodes | None:
    """Return the function that builds the nodes of a channel; None if the channel has no nodes of its own."""
    if channel in STANDING:
        return STANDING[channel]
    names = [name for name in NODES if channel.startswith(name)]
    return NODES[max(names, key=len)] if names else None


def populate(channel: str, hub: LoopbackHub) -> AbstractContextManager[object]:
    """Return the context in which the nodes of a channel run on its bus.

    It is entered when the first bus on the channel is open, which so receives their boot messages, and left after
    the last one shut down.
    """
    nodes = nodes_on(channel)
    return nullcontext() if nodes is None else nodes(hub)


@dataclass(kw_only=True)
class _Channel:
    """A bus by name, and how many hold it."""

    hub: LoopbackHub
    nodes: AbstractContextManager[object]
    users: int = 0


#: Those that somebody holds.
CHANNELS: dict[str, _Channel] = {}
#: Of who comes and goes.
LOCK = RLock()


def join(channel: str, queue: int, own: bool) -> LoopbackBus:
    """Open an end of the bus of a channel and return it. The first call creates the bus and starts its nodes."""
    with LOCK:
        entry = CHANNELS.get(channel)
        hub = LoopbackHub(stamps=True) if entry is None else entry.hub
        end = hub.open(frames=queue, own=own)
        if entry is None:
            try:
                nodes = populate(channel, hub)
                nodes.__enter__()
            except BaseException:
                end.close()
                raise
            entry = CHANNELS[channel] = _Channel(hub=hub, nodes=nodes)
        entry.users += 1
        return end


def leave(channel: str) -> None:
    """Close a channel. The last call stops its nodes."""
    with LOCK:
        entry = CHANNELS.get(channel)
        if entry is None:
            return  # all was left at the end of the program
        entry.users -= 1
        if entry.users:
            return
        del CHANNELS[channel]
    entry.nodes.__exit__(None, None, None)


def without_nodes(channel: str) -> str:
    """Return what is wrong with an open channel that only the caller holds, as with a misspelt one; else nothing."""
    with LOCK:
        alone = channel not in CHANNELS or CHANNELS[channel].users == 1
        if nodes_on(channel) is not None or not alone:
            return ""
        return unknown(f"the bus {channel!r} inside this process", channel, sorted(NODES))


@contextmanager
def hub_of(channel: str) -> Iterator[LoopbackHub]:
    """Keep a channel open and yield its bus, so that a C++ loop can use it together with Python programs."""
    end = join(channel, 1, False)
    try:
        yield CHANNELS[channel].hub
    finally:
        end.close()
        leave(channel)


@contextmanager
def standing(channel: str, nodes: Nodes) -> Iterator[LoopbackHub]:
    """Put your own nodes on a new channel, keep it open, and yield its bus.

    Raises
    ------
    ValueError
        When a channel of that name exists, or nodes are registered for it.
    """
    with LOCK:
        if channel in CHANNELS or nodes_on(channel) is not None:
            raise ValueError(f"channel = {channel!r}: has nodes of its own; choose another name")
        STANDING[channel] = nodes
    try:
        with hub_of(channel) as hub:
            yield hub
    finally:
        del STANDING[channel]


@atexit.register
def _leave_all() -> None:
    """Take off what a program forgot, before the interpreter ends."""
    while CHANNELS:
        _, entry = CHANNELS.popitem()
        entry.nodes.__exit__(None, None, None)
