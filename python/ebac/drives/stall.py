"""What a drive does when the loop stalls or dies: how long it may hold its last torque."""

from __future__ import annotations

from math import inf

from ebac._core import _check_watch
from ebac.drives.errors import ProfileError
from ebac.drives.network import Network
from ebac.drives.profile import SIGNS_OF_LIFE, Profile
from ebac.drives.signs_of_life import own_beat, request_period

#: The longest a drive may hold a torque that nobody commands any more [s].
LONGEST = 0.5
#: What `drive.connection_lost` makes of it (CiA 402-2, 0x6007).
REACTION = {1: "fault, power off", 2: "power off", 3: "quick stop"}


def watches(profile: Profile) -> dict[str, float]:
    """Return the watches of a drive over its loop: key of the profile, and after how long [s] it acts.

    The watch over SYNC (0x1006) is not among them: whether a drive has one, and after how many periods it acts, is
    the maker's.
    """
    found = {
        f"pdo.{pdo.name}.event": pdo.event
        for pdo in profile.pdos
        if not pdo.sent and "target_torque" in pdo.objects and pdo.event > 0
    }
    for key in SIGNS_OF_LIFE:
        if (watched := float(profile.values.get(key, 0.0))) > 0:
            found[key] = watched
    return found


def hold_time(profile: Profile) -> float:
    """Return for how long a drive holds its torque at worst once the loop has stalled [s]; infinite without a watch.

    Parameters
    ----------
    profile : Profile
        What the drive is set to.

    Returns
    -------
    float
        Time [s].
    """
    return min(watches(profile).values(), default=inf)


def check_stall(network: Network) -> None:
    """Refuse drives that would hold a torque without their loop, or limit none, or watch different loops.

    Parameters
    ----------
    network : Network
        The drives of a bus.

    Raises
    ------
    ProfileError
        For the first such drive, with the remedy.
    """
    masters: dict[int, int] = {}
    for node in network.nodes:
        values, who = node.profile.values, f"{network.name}: node {node.id}"
        if (worst := hold_time(node.profile)) > LONGEST:
            held = "for ever" if worst == inf else f"for {worst:g} s"
            raise ProfileError(
                f"{who} would hold its last torque {held} when the loop stalls or dies: must be at most {LONGEST:g} s; "
                "give pdo.rpdo1.event = 0.005 (s without a torque) or heartbeat.consumer = 0.1 (s without the loop's "
                "heartbeat), best both"
            )
        if "limits.max_torque" not in values:
            raise ProfileError(
                f"{who} has no limits.max_torque: the torque the drive allows (0x6072) would be any; give it in N m"
            )
        if "heartbeat.consumer" in watches(node.profile):
            masters.setdefault(int(values["heartbeat.master"]), node.id)
    if len(masters) > 1:
        text = ", ".join(f"{master} on node {node}" for master, node in masters.items())
        raise ProfileError(
            f"{network.name}: heartbeat.master is {text}: one loop sends one heartbeat, and the others would not be "
            "watched; give all drives the same"
        )


def check_pace(network: Network, tick: float) -> None:
    """Refuse drives that a loop on time lets fault, because they watch it for less than it takes to send again.

    A simulated run on a `TimedBus` checks its watches by the same rule.

    Parameters
    ----------
    network : Network
        The drives of a bus.
    tick : float
        Sample time of the loop [s].

    Raises
    ------
    ProfileError
        For the first such watch, with the remedy.
    """
    profiles = [node.profile for node in network.nodes]
    sent = {
        "heartbeat.consumer": ("heartbeat", own_beat(profiles)),
        "heartbeat.guard": ("request", request_period(profiles)),
    }
    for node in network.nodes:
        for key, after in watches(node.profile).items():
            what, period = sent.get(key, ("torque", 0.0))
            name = f"{network.name}: node {node.id}: {key}"
            try:
                _check_watch(name, after, round(1e3 * after), what, period, tick)
            except ValueError as error:
                raise ProfileError(str(error)) from None
