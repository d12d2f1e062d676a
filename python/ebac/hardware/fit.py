"""What of a configuration must fit together: drives, profiles, device and world."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ebac._core import Device
from ebac._util.file_kinds import SCENARIO, kind_of
from ebac._util.plural import plural
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


def check_fit(source: Source, values: Mapping[str, Any]) -> None:
    """Refuse what does not fit together.

    Raises
    ------
    ProfileError
        With the line of what to change.
    """
    axes, drives = values["device"].axes, values["drives"]
    if len(drives.nodes) != axes:
        raise source.refuse(
            ("bus", "drives"),
            f"bus.drives: {drives.name} has {plural(len(drives.nodes), 'drive')}, the device "
            f"{plural(axes, 'axis', 'axes')}: must be as many; give another network file, or a device with as many axes"
            + _maybe_scenario(source),
        )
    for node in drives.nodes:
        for key, mine, name in _SAME:
            theirs, own = node.profile.values.get(key), mine(values["device"])
            if theirs is not None and abs(float(theirs) - own) > 0.01 * own:
                what = "position" if name.startswith("encoder.") else "force"
                raise source.refuse(
                    ("bus", "drives"),
                    f"bus.drives: node {node.id} of {drives.name} has {key} = {float(theirs):g}, the device "
                    f"{name} = {own:g}: must be the same within 1 %, or every {what} is wrong; set one of them"
                    + _without_a_bus(source),
                )
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
