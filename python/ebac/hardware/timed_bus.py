"""The time that the bus of a configuration takes: for its simulation, and as `ebac doctor` reports it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ebac._core import TimedBus
from ebac.drives.frame_length import frame_bits, least_bits
from ebac.drives.network import Network
from ebac.drives.signs_of_life import own_beat, request_period
from ebac.drives.stall import watches
from ebac.hardware.configuration_fields import SILENT
from ebac.hardware.drive_limits import allowed_ratio

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration


def timed_bus(
    network: Network, *, silent: int | None, answer_share: float, changes: Mapping[str, Any]
) -> TimedBus:
    """Return the bus of a network for a simulated run: bit rate, waiting time, watches, limits of torque.

    Parameters
    ----------
    network : Network
        The drives. The shortest watch and the least torque that any allows are those of all.
    silent : int or None
        Ticks in a row without process data that are a fault [samples]; None for as many as on hardware, 3.
    answer_share : float
        How long the loop waits for answers, as a share of the sample time.
    changes : mapping
        Fields of `TimedBus` on top of that.

    Raises
    ------
    TypeError, ValueError
        For a field that is not there, or out of range.
    """
    profiles = [node.profile for node in network.nodes]
    acting = [watches(profile) for profile in profiles]
    torque = [after for one in acting for key, after in one.items() if key.startswith("pdo.")]
    loop = [one["heartbeat.consumer"] for one in acting if "heartbeat.consumer" in one]
    lowest, highest = next(
        (one.low, one.high) for one in TimedBus.fields() if one.name == "peak_ratio"
    )
    known = {
        "bit_rate": float(network.bitrate),
        "silent_ticks": SILENT if silent is None else silent,
        "answer_share": answer_share,
        "drive_heartbeat": max(float(one.values["heartbeat.producer"]) for one in profiles),
        "loop_silence": min(loop, default=0.0),
        "torque_silence": min(torque, default=0.0),
        "peak_ratio": min(max(allowed_ratio(network)[0], lowest), highest),
    }
    return TimedBus(**{**known, **changes})


def exchange_times(known: Configuration) -> tuple[float, float]:
    """Return the least and the greatest time from a tick to its last answer [s].

    The least has no stuff bit. The greatest has all there can be, and in between each frame of other traffic, a
    heartbeat of every drive or a request of node guarding with its answer, and the loop's own heartbeat, which a late
    tick sends just before the next one. No frame is destroyed.
    """
    network, bus = known.drives, known.timed_bus()
    profiles = [node.profile for node in network.nodes]
    sizes = [0, *(pdo.size for node in network.nodes for pdo in node.profile.pdos)]
    # A drive sends its heartbeat, or answers a request instead.
    between = [*(1 for _ in profiles), *(other.size for other in network.others)]
    if own_beat(profiles) > 0:
        between.append(1)
    if request_period(profiles) > 0:
        between += [0 for _ in profiles]
    least = sum(least_bits(size) for size in sizes) / network.bitrate
    most = sum(frame_bits(size) for size in [*sizes, *between]) / network.bitrate
    return least + bus.response, most + bus.response
