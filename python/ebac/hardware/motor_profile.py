"""The text of a profile or network file that comes with the package, for the motor of a device."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping

from ebac._core import Device
from ebac._util.arguments import unknown
from ebac._util.rated_current import RATIO, contradiction
from ebac.drives.errors import ProfileError
from ebac.drives.profile import Profile, builtin, read_profile, read_source
from ebac.drives.profile_fields import BY_NAME
from ebac.drives.toml_positions import Source

#: Share by which the rated current of a drive that counts in a current of its own may differ from the motor's.
_SAME = 0.01
#: Keys whose value is the peak ratio times the rated one.
_PEAKS = ("motor.peak_torque", "limits.max_torque", "limits.max_current")
_KEY = re.compile(r"(?P<key>\w+) = (?P<value>[^#]*)(?P<comment>#.*)?$")
#: What an `about` says of the motor.
_OF_MOTOR = re.compile(
    r", with the paper's Maxon RE 30 motor|; replace the limits by those of your motor"
)


def profile_for(name: str, device: Device, *, file: str = "") -> str:
    """Return the TOML text of a profile or network file that comes with the package, for the motor of a device.

    Only the keys that describe the motor differ, as far as the profile has them: its torque constant, continuous and
    peak torque and counts per turn, and the rated and the largest torque and current. In a network file they stand
    beside the profile of each node.

    Parameters
    ----------
    name : str
        A name of `builtin`, such as "copley-accelnet" or "joystick".
    device : Device
        Its `motor` [N m, N m/A, A], its `encoder` [counts], and the `peak_ratio` of its `drive`.
    file : str
        Name of the file that describes the device, for comments.

    Raises
    ------
    ProfileError
        For a name that is none; for numbers of the motor that contradict each other or what the drive counts in, or
        that the drive cannot hold within 1 %. The message contains both values with their units.
    """
    if name not in builtin():
        raise ProfileError(unknown(f"name {name}", name, builtin(), "profile or network file"))
    source = read_source(name)
    whose = f"the motor of {file}" if file else "the motor of a device"
    lines = list(_lines(source, device, whose))
    made = Source(name=f"{name} with {whose}", text="\n".join(lines) + "\n")
    for i, node in enumerate(made.table.get("node", [])):
        read_profile(made, base=read_profile(read_source(node["profile"])), at=("node", i))
    if "node" not in made.table:
        read_profile(made)
    return made.text


def _lines(source: Source, device: Device, whose: str) -> Iterator[str]:
    """Yield the lines of a file with the keys of the motor."""
    values = {} if "node" in source.table else _values(read_profile(source), device)
    table = ""
    for line in source.text.splitlines():
        if line.startswith("# motor."):  # a key that is commented out, of another motor
            continue
        if heading := re.match(r"\[([\w.]+)\]", line):
            table = heading[1]
        found = _KEY.match(line)
        name = found["key"] if found else ""
        key = f"{table}.{name}"
        if found and name == "about" and not table:
            about = _OF_MOTOR.sub("", json.loads(found["value"]))
            yield f"about = {json.dumps(f'{about}, with {whose}', ensure_ascii=False)}"
        elif found and key in values:
            code = f"{name} = {values[key]!r}"
            comment = _comment(key, device) if key in _PEAKS else found["comment"] or ""
            yield f"{code.ljust(len(line) - len(found['comment'] or '') - 1)} {comment}".rstrip()
        else:
            yield line
        if found and name == "profile":
            base = read_profile(read_source(json.loads(found["value"])))
            for key, value in _values(base, device).items():
                yield f"{key} = {value!r} {_comment(key, device)}"


def _comment(key: str, device: Device) -> str:
    times = f", {_peak_ratio(device):.4g} times rated" if key in _PEAKS else ""
    return f"# {BY_NAME[key].unit}{times}"


def _peak_ratio(device: Device) -> float:
    return device.drive.peak_current(device.motor) / device.motor.current(device.motor.rated_torque)


def _values(profile: Profile, device: Device) -> Mapping[str, float]:
    """Return the keys of a profile that describe the motor, with those of the device."""
    motor = device.motor
    if wrong := contradiction(motor):
        raise ProfileError(wrong)
    current, ratio = motor.current(motor.rated_torque), _peak_ratio(device)
    if ratio < 1:
        raise ProfileError(
            f"{RATIO} = {current:.4g} A, but device.motor.stall_current = {motor.stall_current:g} A and "
            f"device.drive.peak_ratio = {device.drive.peak_ratio:g} allow a peak of {ratio * current:.4g} A: must be "
            "at least as much; give both as the data sheets have them"
        )
    rated = round(current, 3)  # drives count in mA
    torque = motor.rated_torque
    if (
        "limits.rated_torque" in profile.without
    ):  # the drive has none, or computes it from the current
        if not profile.objects:
            rated = float(profile.values["limits.rated_current"])
            _check_own_current(profile.name, rated, current)
        torque = rated * motor.torque_constant
    values = {
        "motor.torque_constant": motor.torque_constant,
        "motor.continuous_torque": torque,
        "motor.peak_torque": ratio * torque,
        "motor.counts_per_turn": device.encoder.counts_per_turn,
        "limits.rated_torque": torque,
        "limits.rated_current": rated,
        "limits.max_torque": ratio * torque,
        "limits.max_current": ratio * rated,
    }
    return {
        key: value if BY_NAME[key].whole else float(f"{value:.6g}")
        for key, value in values.items()
        if key in profile.values
    }


def _check_own_current(name: str, rated: float, current: float) -> None:
    """Refuse a motor whose rated current is not the one that the drive counts its torques in."""
    if abs(rated - current) > _SAME * current:
        raise ProfileError(
            f"{RATIO} = {current:.4g} A, but limits.rated_current of {name} = {rated:g} A, the current that this drive "
            f"counts its torques in: must agree within {100 * _SAME:g} %; give device.motor.rated_torque = "
            f"torque_constant x {rated:g} A, and what the motor takes for ever as limits.continuous_current of the run"
        )
