"""What of a configuration must fit together: drives, profiles, device and world."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ebac._core import Device
from ebac._util.file_kinds import SCENARIO, kind_of
from ebac._util.plural import plural
from ebac.drives.network import BUILT_IN, Network, Node
from ebac.drives.profile import builtin, read_profile, read_source
from ebac.drives.profile_fields import BY_NAME
from ebac.drives.toml_positions import Source
from ebac.hardware.tables import refusing
from ebac.hardware.world_place import never_reached
from ebac.scenario import Scenario

#: Values that profile and device must agree on: key of the profile, value of the device, its name.
_SAME: tuple[tuple[str, Callable[[Device], float], str], ...] = (
    ("motor.torque_constant", lambda d: d.motor.torque_constant, "motor.torque_constant"),
    ("limits.rated_torque", lambda d: d.motor.rated_torque, "motor.rated_torque"),
    ("motor.counts_per_turn", lambda d: d.encoder.counts_per_turn, "encoder.counts_per_turn"),
)


def check_fit(source: Source, values: Mapping[str, Any], *, device_alone: bool = False) -> None:
    """Refuse what does not fit together; with `device_alone` the drives may be those of another device.

    Raises
    ------
    ProfileError
        With the line of what to change.
    """
    if not device_alone:
        _check_drives(source, values["device"], values["drives"])
    refusing(
        source,
        ("environment",),
        lambda: Scenario(
            device=values["device"],
            environment=values["environment"],
            hand=values["hand"],
            timing=values["timing"],
        ).setup(),
    )
    beyond = never_reached(values["device"], values["limits"], values["environment"])
    if beyond is not None:
        raise source.refuse(*beyond)


def _check_drives(source: Source, device: Device, drives: Network) -> None:
    axes = device.axes
    if len(drives.nodes) != axes:
        raise source.refuse(
            ("bus", "drives"),
            f"bus.drives: {drives.name} has {plural(len(drives.nodes), 'drive')}, the device "
            f"{plural(axes, 'axis', 'axes')}: must be as many; give another network file, or a device with as many axes"
            + _maybe_scenario(source),
        )
    if found := other_motor(device, drives):
        raise source.refuse(("bus", "drives"), f"bus.drives: {found}{_without_a_bus(source)}")


def other_motor(device: Device, drives: Network) -> str:
    """Return in words what profiles and device do not agree on, and the remedy; "" where they agree on all."""
    alike: dict[str, list[str]] = {}
    beside = False
    for key, mine, name in _SAME:
        own, unit = mine(device), BY_NAME[key].unit
        for node in drives.nodes:
            theirs = node.profile.values.get(key)
            if theirs is not None and abs(float(theirs) - own) > 0.01 * own:
                text = f"{key} = {float(theirs):g} {unit}, the device {name} = {own:g} {unit}"
                alike.setdefault(text, []).append(str(node.id))
                beside |= _stands_beside(node, key)
    if not alike:
        return ""
    listed = "; ".join(
        f"{'node' if len(ids) == 1 else 'nodes'} {', '.join(ids)}: {text}"
        for text, ids in alike.items()
    )
    return (
        f"{drives.name} and the device are for different motors. {listed}. Each must be the same within 1 %, or every "
        f"force or position is wrong; correct the device or the profile"
        + (_written_again(drives) if beside else _from_files(drives))
    )


def _stands_beside(node: Node, key: str) -> bool:
    """Return whether a network file gives a key beside a profile that comes with the package."""
    name = node.profile.name
    return name in builtin() and (
        read_profile(read_source(name)).values.get(key) != node.profile.values[key]
    )


def _written_again(drives: Network) -> str:
    """Return how the keys of the motor beside the nodes of a network file are replaced."""
    same = [(node.id, node.profile.name) for node in drives.nodes]
    tables = {name: read_source(name).table.get("node", []) for name in builtin()}
    made = [
        name
        for name, nodes in tables.items()
        if [(node["id"], node["profile"]) for node in nodes] == same
    ]
    again = "".join(
        f", or write it again for the motor of FILE: `ebac drive profile {name} --motor FILE > {drives.name}`"
        for name in made[:1]
    )
    return f"; the values stand in {drives.name}, beside the profile of each node: change them there{again}"


def _from_files(drives: Network) -> str:
    """Return how what comes with the package is written for another motor; "" where all of it is in files."""
    network = drives.name.removeprefix(BUILT_IN)
    if network != drives.name:
        return (
            f"; `ebac drive profile {network} --motor FILE > my-network.toml` writes the drives for the motor of FILE, "
            'then give drives = "my-network.toml" in [bus]'
        )
    profiles = sorted({node.profile.name for node in drives.nodes} & set(builtin()))
    if not profiles:
        return ""
    files = ["my-drive.toml"] if len(profiles) == 1 else [f"my-{name}.toml" for name in profiles]
    steps = " and ".join(
        f"`ebac drive profile {name} --motor FILE > {file}`"
        for name, file in zip(profiles, files, strict=True)
    )
    named = " and ".join(f'profile = "{file}"' for file in files)
    return f"; {steps} writes it for the motor of FILE, then give {named} in {drives.name}"


def _maybe_scenario(source: Source) -> str:
    """Return a hint where nothing but the parts of a scenario is there; "" otherwise."""
    if kind_of(source.table) != SCENARIO:
        return ""
    return (
        ". It has no table of a configuration of `ebac run`, such as [bus]: if it is a scenario or a device, `ebac "
        "wall --scenario` takes it, and `ebac demo joystick` writes a configuration for its tables"
    )


def _without_a_bus(source: Source) -> str:
    """Return a hint where the drives are those that no [bus] names."""
    if "bus" in source.table:
        return ""
    return ". The file has no [bus], so its drives are the built-in joystick's" + _maybe_scenario(
        source
    )
