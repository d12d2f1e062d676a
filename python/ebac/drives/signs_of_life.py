"""What a loop sends so that its drives know it is alive: its heartbeat, and requests of node guarding (CiA 301)."""

from __future__ import annotations

from collections.abc import Sequence

from ebac._core import _beat_period
from ebac.drives.load import Traffic
from ebac.drives.profile import REQUESTS, Profile


def watched_heartbeat(profiles: Sequence[Profile]) -> float:
    """Return the shortest time for which a drive waits for the loop's heartbeat [s]; 0 where none does."""
    waits = [float(one.values.get("heartbeat.consumer", 0.0)) for one in profiles]
    return min((one for one in waits if one > 0), default=0.0)


def own_beat(profiles: Sequence[Profile]) -> float:
    """Return the time between two heartbeats of the loop of these drives [s]; 0 where it sends none."""
    watched = watched_heartbeat(profiles)
    return _beat_period(watched) if watched > 0 else 0.0


def guards(profiles: Sequence[Profile]) -> list[float]:
    """Return how long each drive waits for a request of node guarding [s]; 0 for one that does not."""
    return [float(one.values.get("heartbeat.guard", 0.0)) for one in profiles]


def request_period(profiles: Sequence[Profile]) -> float:
    """Return the time between two requests of node guarding [s], which go to every drive; 0 without any."""
    return min((one for one in guards(profiles) if one > 0), default=0.0) / REQUESTS


def loop_traffic(nodes: Sequence[tuple[int, Profile]]) -> list[Traffic]:
    """Return the signs of life that are not in `Profile.traffic`: what the loop sends because of all drives together.

    Parameters
    ----------
    nodes : sequence of (int, Profile)
        The drives of a bus.
    """
    profiles = [profile for _, profile in nodes]
    found = []
    if beat := own_beat(profiles):
        found.append(Traffic(name="heartbeat of the loop", size=1, rate=1 / beat))
    if not (every := request_period(profiles)):
        return found
    for (node, _), guard in zip(nodes, guards(profiles), strict=True):
        # One loop asks all drives alike; one that is not guarded does not answer.
        more = 1 / every - (REQUESTS / guard if guard else 0.0)
        if more > 0:
            frames = 2 if guard else 1
            found.append(Traffic(name=f"guarding of node {node}", size=1, rate=frames * more))
    return found
