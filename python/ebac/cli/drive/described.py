"""Which drives, device and hand `ebac drive simulate` puts on a bus."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac.cli import output, setting

if TYPE_CHECKING:
    from ebac.scenario import Scenario
    from ebac.sensor import SensorConfig

#: Largest counts of a unit.
MOST_COUNTS = 1e9


@dataclass(frozen=True, kw_only=True)
class Described:
    """What is simulated.

    Attributes
    ----------
    scenario : Scenario
        Device, hand and seed.
    wiring : mapping
        Arguments of `ebac._core.DriveWiring`.
    sensor : SensorConfig or None
        The force sensor that --sensor simulates.
    sensor_port : int
        Its UDP port; 0 for any free one.
    bitrate : int or None
        Of the bus [bit/s], where a file has one.
    about : sequence of str
        One line for each drive.
    """

    scenario: Scenario
    wiring: Mapping[str, Any]
    sensor: SensorConfig | None
    sensor_port: int = 0
    bitrate: int | None = None
    about: Sequence[str] = ()


def refuse(elsewhere: Mapping[str, object], file: Path) -> None:
    """Refuse options for what a configuration gives.

    Raises
    ------
    ValueError
        For the first one that is given.
    """
    for name, value in elsewhere.items():
        if value is not None:
            raise ValueError(f"{name}: {file} gives this; change it there, or leave {name} out")


def by_configuration(file: Path, hand: str | None, seed: int | None, eds: Path | None) -> Described:
    """Return what a configuration of `ebac run` describes; hand, seed and data sheet may replace its own."""
    from ebac import presets
    from ebac.drives import read_eds
    from ebac.hardware import Configuration
    from ebac.hardware.wiring import wiring_of

    known = Configuration.load(file)
    wiring = wiring_of(known)
    if eds is not None:
        sheet = read_eds(eds)
        wiring["sheets"] = [sheet.rows(node) for node in wiring["nodes"]]
    parts = setting.given(hand=None if hand is None else presets.hand(hand), seed=seed)
    axes = known.device.axes
    signs = (known.simulated_signs or known.signs).of_all(axes)
    zero = (known.simulated_zero or known.zero).of_all(axes)
    about = [
        f"Node {node.id}{f' ({node.name})' if node.name else ''}: {node.profile.name}, "
        f"{_dictionary(node.sheet.name if node.sheet else None, eds)}; {counts} counts at its zero; "
        f"signs {motor} (motor), {encoder} (encoder)."
        for node, counts, motor, encoder in zip(
            known.drives.nodes, zero, signs.motor, signs.encoder, strict=True
        )
    ]
    return Described(
        scenario=known.scenario(seconds=10).replace(**parts),
        wiring=wiring,
        sensor=known.sensor,
        sensor_port=0 if known.sensor is None else known.sensor.port,
        bitrate=known.drives.bitrate,
        about=about,
    )


def by_options(
    plant: Scenario,
    first: int | None,
    zero: Sequence[int] | None,
    eds: Path | None,
    counts: tuple[float, float] | None,
    wiring: Path | None,
) -> Described:
    """Return the drives of a device, numbered from the first node on, or as a file has it that `ebac run` wrote."""
    from ebac.drives import read_eds
    from ebac.sensor import SensorConfig

    axes = plant.device.axes
    if zero and len(zero) != axes:
        raise ValueError(
            f"--zero: {output.plural(len(zero), 'number')} for {output.plural(axes, 'axis', 'axes')}; give it once for "
            "each axis"
        )
    per_force, per_torque = counts or (1e6, 1e6)
    if not (1 <= per_force <= MOST_COUNTS and 1 <= per_torque <= MOST_COUNTS):
        raise ValueError(
            f"--sensor-counts = {per_force:g} {per_torque:g}: each must lie in [1, {MOST_COUNTS:g}]"
        )
    nodes = [(first or 1) + axis for axis in range(axes)]
    if nodes[-1] > 127:
        raise ValueError(
            f"--first = {first}: must lie in [1, {128 - axes}] for {output.plural(axes, 'drive')}"
        )
    sheet = None if eds is None else read_eds(eds)
    own = {
        "nodes": nodes,
        "sheets": [] if sheet is None else [sheet.rows(node) for node in nodes],
        "zero": list(zero or []),
    }
    return Described(
        scenario=plant,
        wiring=own if wiring is None else _wiring(wiring),
        sensor=SensorConfig(counts_per_force=per_force, counts_per_torque=per_torque),
    )


def _wiring(file: Path) -> dict[str, Any]:
    """Return the wiring in a file that `ebac run` wrote for this command."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
        return {name: found[name] for name in ("nodes", "sheets", "zero")}
    except (ValueError, KeyError, TypeError):
        raise ValueError(f"--wiring {file}: is no file that `ebac run` wrote") from None


def _dictionary(sheet: str | None, given: Path | None) -> str:
    """Return where the objects of a drive come from."""
    name = sheet if given is None else given
    return "the objects its profile needs" if name is None else f"the objects of {name}"
