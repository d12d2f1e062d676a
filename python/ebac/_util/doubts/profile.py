"""Numbers of a drive's profile that are possible, but more likely not meant."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.drives import Network
    from ebac.drives.profile import Profile

_PEAK = "motor.peak_torque"
#: Limits of a drive, and the rated value of each.
_OF_RATED = (
    ("limits.max_torque", "limits.rated_torque"),
    ("limits.max_current", "limits.rated_current"),
    (_PEAK, "limits.rated_torque"),
)
#: How many times the rated value makes a limit doubtful: the drive of the paper's motor gives 4 times.
PEAK = 5.0
#: How long a drive may wait for a torque [s]: a loop sends a thousand or so a second.
WAIT = 0.1


def doubts(network: Network) -> list[str]:
    """Return a sentence for each number that is likely not meant, with the remedy and the nodes it is of."""
    from ebac.hardware.drive_limits import above_peak

    strong = [f"{text}; {remedy}" for _, text, remedy in above_peak(network)]
    found: dict[str, list[str]] = {}
    for node in network.nodes:
        for text in (*_above_rated(node.profile), *_long_waits(node.profile)):
            found.setdefault(text, []).append(str(node.id))
    return strong + [
        f"{'node' if len(ids) == 1 else 'nodes'} {', '.join(ids)} of {network.name}: {text}"
        for text, ids in found.items()
    ]


def _above_rated(profile: Profile) -> Iterator[str]:
    from ebac.drives.profile_fields import BY_NAME

    has_peak = {_PEAK, "limits.rated_torque"} <= profile.values.keys()
    for name, per in _OF_RATED:
        if has_peak and name != _PEAK:  # `above_peak` compares it with the peak of the motor
            continue
        value, rated = profile.values.get(name), profile.values.get(per)
        if value is None or rated is None or float(value) <= PEAK * float(rated):
            continue
        yield (
            f"{name} = {BY_NAME[name].show(value)}: {float(value) / float(rated):.3g} times {per} = "
            f"{BY_NAME[per].show(rated)}; usual are at most {PEAK:g} times. It must be no more than the motor takes, "
            f"device.drive.peak_ratio (4 for the joystick) times {per}: lower it, or correct {per}"
        )


def _long_waits(profile: Profile) -> Iterator[str]:
    for pdo in profile.pdos:
        if not pdo.sent and pdo.event > WAIT:
            yield (
                f"pdo.{pdo.name}.event = {pdo.event:g} s: for so long the drive waits for the next one from the loop; "
                f"usual are at most {WAIT:g} s. The key is in s: 5 ms is 0.005 s"
            )
