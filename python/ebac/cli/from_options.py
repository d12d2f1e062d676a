"""The scenario that the options of a command describe, on top of a file or of the reference scenario.

`options` declares them, `setting` chooses each part.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac.cli import doubtful, output, setting

if TYPE_CHECKING:
    from ebac._core import Device, Hand
    from ebac.scenario import Environment, Scenario


def scenario(*groups: Any, seconds: float | None = None) -> Scenario:
    """Return the scenario that groups of options describe; `seconds` is its length where nothing gives one [s].

    A mesh that is met for the first time shows a bar.
    """
    given = {name: value for group in groups for name, value in vars(group).items()}
    with output.counting_meshes():
        return _scenario(given, seconds)


def _scenario(given: dict[str, Any], seconds: float | None) -> Scenario:
    file = given.get("scenario")
    base = setting.base_scenario(file)
    length = given.get("seconds")
    if length is None and not (file and setting.has_seconds(file)):
        length = seconds
    device = setting.choose_device(base.device, given)
    made = base.replace(
        device=device,
        hand=hand(base.hand, given),
        environment=setting.choose_engine(wall(base.environment, given), given),
        timing=setting.choose_timing(base.timing, given.get("rate"), given.get("delay")),
        **setting.given(
            jitter=given.get("jitter"), seconds=length, seed=given.get("seed"),
            observer=_observer(given, device),
        ),
    )  # fmt: skip
    doubtful.note_place(given.get("wall_position"), file, made)
    return made


def _observer(given: dict[str, Any], device: Device) -> Any:
    from ebac.scenario_checks import EVERY_LAW, LEARNS_SCALE

    observer = given.get("observer")
    names = {EVERY_LAW: "--observer-every-law", LEARNS_SCALE: "--observer-learns"}
    named = [name for name, option in names.items() if given.get(option[2:].replace("-", "_"))]
    if len(named) > 1:
        raise ValueError(
            f"{' and '.join(names.values())}: the command has no observer for both; "
            "Scenario.observer = Observer.of(device, timing).replace(every_law=True, learn_scale=True) is one"
        )
    if named and observer is False:
        raise ValueError(f"{names[named[0]]}: needs the observer that --no-observer turns off")
    if (named or observer) and not device.sensor.fitted:
        option = names[named[0]] if named else "--observer"
        raise ValueError(
            f"{option}: the observer needs a force sensor, and the device has none; leave it out"
        )
    return named[0] if named else observer


def wall(usual: Environment, group: Any) -> Environment:
    """Return the usual wall with what its options change, or the world of --world."""
    given = group if isinstance(group, dict) else vars(group)
    doubtful.note_stiffness(given.get("wall_stiffness"))
    if given.get("world") is not None:
        return setting.choose_world(
            given["world"],
            stiffness=given.get("wall_stiffness"),
            damping=given.get("wall_damping"),
            position=given.get("wall_position"),
            friction=given.get("world_friction"),
        )
    if given.get("world_friction") is not None:
        raise ValueError("--world-friction: a flat wall has none; add --world plane")
    return setting.choose_wall(
        usual, stiffness=given.get("wall_stiffness"),
        damping=given.get("wall_damping"), position=given.get("wall_position"),
    )  # fmt: skip


def hand(usual: Hand, group: Any) -> Hand:
    """Return the usual hand with what its options change."""
    given = group if isinstance(group, dict) else vars(group)
    return setting.choose_hand(
        usual, given.get("hand"), given.get("hand_target"), mass=given.get("hand_mass"),
        damping=given.get("hand_damping"), stiffness=given.get("hand_stiffness"),
    )  # fmt: skip
