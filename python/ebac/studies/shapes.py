"""Laws at worlds of several shapes and stiffnesses, on devices of one to three axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ebac import presets
from ebac._core import Device, Hand, Step, Timing
from ebac._util.atomic_file import write_text
from ebac._util.sequences import several, several_numbers
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw, law_name
from ebac.metrics import allowed_deviation, contact
from ebac.metrics.world_rest import world_rest
from ebac.scenario import Scenario
from ebac.simulation import LoopFault, simulate
from ebac.studies.measures import SPARE
from ebac.studies.random_scenario import LAG
from ebac.worlds import PRESETS, World, preset
from ebac.worlds.grid import cache_folder, needed

#: Laws, worlds, stiffnesses [N/m] and devices that are compared unless others are given.
LAWS = ("direct", "tca", "tca-damped", "eba", "passivity-control", "ebac")
WORLDS = ("plane", "sphere", "box", "edge", "inside", "corner", "lumen", "mesh")
STIFFNESSES = (2e3, 10e3)
DEVICES = ("reference", "joystick", "joystick-3")
#: Where the surface is, and the hand's target: inside and a little aside [m].
SURFACE = 0.01
TARGET = (0.028, 0.006, 0.004)
SECONDS = 4.0


@dataclass(frozen=True, kw_only=True)
class ShapeRow:
    """One run.

    Attributes
    ----------
    world, device, law : str
        Names.
    stiffness_N_per_m : float or None
        Of the surface; None for a world with a material of its own.
    axes : int
        Of the device.
    still, quiet : bool
        As in `ebac.contact`, on every axis.
    exact : bool or None
        Whether it rests as near to a balance of hand and world as `ebac.contact` asks for, on every axis; None where
        there is none.
    passive : bool
        The port gave out at most 1 mJ.
    swing_m, perceived : float or None
        As in `ebac.contact`, of the axis with the most; None for a run that a fault ended.
    deviation_m : float or None
        Largest distance along an axis from the balance next to it; facets have several.
    allowed_m : float
        Largest that is `exact`.
    least_energy_J : float or None
        Of all axes together, as in `ebac.contact`.
    """

    world: str
    stiffness_N_per_m: float | None
    device: str
    axes: int
    law: str
    still: bool
    quiet: bool
    exact: bool | None
    passive: bool
    swing_m: float | None = None
    perceived: float | None = None
    deviation_m: float | None = None
    allowed_m: float
    least_energy_J: float | None = None

    @property
    def good(self) -> bool:
        """Whether it is quiet, passive, and exact where that can be said."""
        return self.quiet and self.passive and self.exact is not False


@dataclass(frozen=True, kw_only=True)
class Shapes:
    """What `shapes` found.

    Attributes
    ----------
    rows : tuple of ShapeRow
        For each world, stiffness and device: each law.
    timing : Timing
        Sample time and delay.
    missing : tuple of str
        What was left out, and why.
    noise_N, lag_s : float
        Noise of the force sensor, standard deviation, and the time constant of its filter.
    """

    rows: tuple[ShapeRow, ...]
    timing: Timing
    missing: tuple[str, ...] = ()
    noise_N: float = 0.0
    lag_s: float = LAG

    def table(self) -> list[dict[str, Any]]:
        """Return the rows as dictionaries, units in the keys."""
        return [asdict(row) for row in self.rows]


@plain_function
def shapes(
    laws: Sequence[AnyLaw] = LAWS,
    *,
    worlds: Sequence[str] = WORLDS,
    stiffnesses: Sequence[float] = STIFFNESSES,
    devices: Sequence[str] = DEVICES,
    timing: Timing | None = None,
    noise: float = 0.0,
    lag: float = LAG,
    progress: Callable[[int, int], None] | None = None,
) -> Shapes:
    """Simulate each law in each world, at each stiffness, on each device: a hand of 300 N/m presses, 4 s.

    Parameters
    ----------
    laws : sequence of laws
        As `simulate` takes them.
    worlds : sequence of str
        Names as in `ebac worlds`, mesh:FILE, or `mesh`: a ball of 1,280 triangles. By default worlds that need the
        extra `worlds` are left out where it is not installed.
    stiffnesses : sequence of float
        Of the surface [N/m], [0, 1e7].
    devices : sequence of str
        Names as in `ebac.presets.DEVICES`.
    timing : Timing, optional
        Sample time and delay; default 1 ms and one sample.
    noise : float
        Of the force sensor, standard deviation [N], [0, 100]; by default it has none.
    lag : float
        Time constant of its filter [s], [0, 0.1].
    progress : callable, optional
        Called with runs done and all.

    Raises
    ------
    ValueError
        For an unknown world, a stiffness, noise or lag out of its range, or nothing to compare.
    KeyError
        For an unknown device.
    ImportError
        For a mesh without the extra `worlds`.
    """
    several("laws", laws)
    several("worlds", worlds)
    several_numbers("stiffnesses", stiffnesses)
    several("devices", devices)
    clock = Timing() if timing is None else timing
    chosen = {name: _sensed(presets.device(name), noise, lag) for name in devices}
    places, missing = _scenarios(worlds, stiffnesses, chosen, clock)
    rows: list[ShapeRow] = []
    for known, scenario in places:
        for law in laws:
            rows.append(_row(known, scenario, law))
            if progress is not None:
                progress(len(rows), len(places) * len(laws))
    return Shapes(rows=tuple(rows), timing=clock, missing=missing, noise_N=noise, lag_s=lag)


def _sensed(device: Device, noise: float, lag: float) -> Device:
    return device.replace(sensor=device.sensor.replace(noise=noise, lag=lag))


def _scenarios(
    worlds: Sequence[str],
    stiffnesses: Sequence[float],
    devices: dict[str, Device],
    timing: Timing,
) -> tuple[list[tuple[dict[str, Any], Scenario]], tuple[str, ...]]:
    places, missing = [], []
    for world in worlds:
        try:
            known = _worlds(world, stiffnesses)
        except ImportError as error:
            if worlds is not WORLDS:
                raise
            missing.append(f"world {world} left out: {error}")
            continue
        places += [
            (
                {"world": world, "stiffness_N_per_m": k, "device": name, "axes": device.axes},
                _pressed(device, one, timing),
            )
            for k, one in known.items()
            for name, device in devices.items()
        ]
    return places, tuple(missing)


def _worlds(name: str, stiffnesses: Sequence[float]) -> dict[float | None, World]:
    """Return the world at each stiffness; of one with a material of its own that alone."""
    full = f"mesh:{ball_file()}" if name == "mesh" else name
    if name in PRESETS and PRESETS[name].material is not None:
        return {None: preset(name, position=SURFACE)}
    return {k: preset(full, stiffness=k, position=SURFACE) for k in stiffnesses}


def ball_file() -> Path:
    """Return a mesh file, a ball of 1,280 triangles; written where the grids of meshes are kept."""
    file = cache_folder() / "ball-1280.off"
    if not file.exists():
        ball = needed("trimesh", "trimesh").creation.icosphere(subdivisions=3)
        file.parent.mkdir(parents=True, exist_ok=True)
        write_text(file, ball.export(file_type="off"))
    return file


def _pressed(device: Device, world: World, timing: Timing) -> Scenario:
    hand = Hand(path=[Step(target=x) for x in TARGET[: device.axes]])
    return Scenario(device=device, hand=hand, environment=world, timing=timing, seconds=SECONDS)


def _row(known: dict[str, Any], scenario: Scenario, law: AnyLaw) -> ShapeRow:
    known = known | {
        "law": law_name(law),
        "allowed_m": allowed_deviation(scenario),
    }
    try:
        trace = simulate(scenario, law)
    except LoopFault as fault:
        if fault.__cause__ is not None:  # an error in Python code of a user's own
            raise
        return ShapeRow(**known, still=False, quiet=False, exact=None, passive=False)
    axes = [contact(trace, axis=axis) for axis in range(trace.axes)]
    rests = np.array([one.rest_m for one in axes])
    ideal = world_rest(scenario, rests)
    away = None if ideal is None else float(np.abs(rests - ideal.place).max())
    least = float(axes[0].least_energy_J or 0.0)
    return ShapeRow(
        **known,
        still=all(one.still for one in axes),
        quiet=all(one.quiet for one in axes),
        exact=None if away is None else away <= known["allowed_m"],
        passive=least >= -SPARE,
        swing_m=max(one.swing_m for one in axes),
        perceived=max(one.perceived or 0.0 for one in axes),
        deviation_m=away,
        least_energy_J=least,
    )
