"""The loop of a log: hand, device and wall, for which gains are chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Device, Hand, Step, Timing, Wall
from ebac._util.arguments import number, refuse_unknown, require
from ebac._util.wrong_calls import plain_constructor, plain_function
from ebac.identify.arm import fit_arm
from ebac.identify.device import fit_device
from ebac.identify.device_result import DeviceResult
from ebac.identify.missing import name_if_unread
from ebac.identify.recording import Recording
from ebac.identify.recording_list import require_recordings
from ebac.identify.result import ArmResult
from ebac.identify.signals import rough
from ebac.identify.target import Target
from ebac.scenario import Scenario

#: Length of the free motion of a hand before contact with the wall [m].
APPROACH = 0.01
#: How deep it wants to press unless known [m], and its largest pull as a share of the motor's force.
DEPTH, PULL = 0.03, 0.8
#: What `fit_loop` takes for `fit_arm`.
OF_ARM = ("fixed", "bounds", "free", "own", "starts", "robust", "seed")
#: Fewest rows with a commanded force from which a wall is estimated.
LEAST_TOUCHED = 50


@plain_constructor
@dataclass(frozen=True, kw_only=True, eq=False)
class LoopModel:
    """Arm, device, wall and timing of a log, as far as it determines them; `scenario` simulates a press on the wall."""

    arm: ArmResult
    device: Device
    found: DeviceResult | None
    wall: Wall
    timing: Timing
    remarks: tuple[str, ...]

    @property
    def scenario(self) -> Scenario:
        """The identified hand pressing on the wall after a short way through free air."""
        return self.pressing(self.arm.hand)

    def pressing(self, hand: Hand, *, depth: float | None = None, seed: int = 1) -> Scenario:
        """Return a scenario in which a hand presses on this wall, its target `depth` [m] behind the surface.

        Less deep where the hand would pull with more than the motor can hold.
        """
        if depth is not None and not 0 < number("depth", depth) < np.inf:
            raise ValueError(f"depth = {depth:g} m: must be positive and finite")
        most = PULL * min(self.device.peak_force, 35.0)
        deep = min(DEPTH if depth is None else depth, most / max(hand.stiffness, 1e-9))
        return Scenario(
            hand=hand.replace(path=Step(target=APPROACH + deep)),
            device=self.device,
            environment=self.wall.replace(position=APPROACH),
            timing=self.timing,
            seconds=3.0,
            seed=seed,
        )

    def __repr__(self) -> str:
        """Return the arm, and what else stands in the loop, one a line."""
        lines = [repr(self.arm), f"  {self.wall!r}", f"  {self.timing!r}", "  device in .device"]
        return "\n".join([*lines, *(f"  {text}" for text in self.remarks)])


@plain_function
def fit_loop(
    recordings: Recording | Sequence[Recording],
    targets: Target | Sequence[Target] | None = None,
    *,
    device: Device | None = None,
    wall: Wall | None = None,
    timing: Timing | None = None,
    **arm: Any,
) -> LoopModel:
    """Identify arm, device and wall in the loop of eq. (2) from logged steps.

    Parameters
    ----------
    recordings, targets
        As for `fit_arm`.
    device : Device, optional
        The known parts of the device: motor, drive, encoder. Mass, damping, friction and noise are taken from the log
        where it determines them. Default: the reference device.
    wall : Wall, optional
        The virtual wall. Default: estimated from the column `desired`, or the paper's wall if that column is missing.
    timing : Timing, optional
        Sample time [s] and transport delay [samples]; default: one sample.
    **arm
        As for `fit_arm`: fixed, bounds, free, own, starts, robust, seed.

    Raises
    ------
    TypeError
        For a parameter that does not exist, or a part of another type.
    ValueError
        As for `fit_arm`.
    """
    require_recordings(recordings, "fit_loop", several=True)
    refuse_unknown("fit_loop", arm, OF_ARM)
    for part, kind in ((device, Device), (wall, Wall), (timing, Timing)):
        require(part, (kind, type(None)), "ebac.identify.fit_loop", f"a {kind.__name__}")
    result = fit_arm(recordings, targets, **arm)
    first = recordings if isinstance(recordings, Recording) else recordings[0]
    remarks: list[str] = []
    found = _device_of(first, remarks, "the reference device" if device is None else "as given")
    known = _merged(device or Device(), found, first, remarks)
    if wall is None:
        wall = wall_of(first)
        named = "" if first.desired is not None else name_if_unread("desired", [first], ";")
        remarks.append(
            f"wall: of 10 kN/m, not known, as the log has no force asked for (column desired){named}"
            if wall is None
            else f"wall: {wall.stiffness:.4g} N/m, from the force asked for"
        )
    if timing is None:
        timing = Timing(dt=round(first.dt, 9))
        remarks.append(f"timing: a tick of {1e3 * timing.dt:.4g} ms, the step of the log")
    return LoopModel(
        arm=result,
        device=known,
        found=found,
        wall=wall or Wall(),
        timing=timing,
        remarks=tuple(remarks),
    )


def _device_of(r: Recording, remarks: list[str], whose: str) -> DeviceResult | None:
    if r.motor is None:
        named = name_if_unread("motor", [r], ";")
        remarks.append(f"device: {whose}, the log has no force of the motor{named}")
        return None
    try:
        return fit_device(r, current_lag=r.current_lag)
    except ValueError as error:
        remarks.append(f"device: {whose}, not determined by this log ({error})")
        return None


def _merged(device: Device, found: DeviceResult | None, r: Recording, remarks: list[str]) -> Device:
    """Return the device with the parameters the log determines."""
    assert r.force is not None
    sensor = device.sensor.replace(noise=rough(r.force), lag=r.lag)
    mechanics = device.mechanics
    if found is not None:
        estimates = found.estimates
        determined_values = {
            name: e.value for name, e in estimates.items() if e.determined and e.value > 0
        }
        if "M_h" in determined_values:
            handle = max(determined_values["M_h"] - device.reflected_mass, 1e-3)
            mechanics = mechanics.replace(handle_mass=handle)
        if "B_h" in determined_values:
            mechanics = mechanics.replace(damping=determined_values["B_h"])
        if "coulomb" in determined_values:
            mechanics = mechanics.replace(coulomb=determined_values["coulomb"])
        values = [f"{n} = {v:.4g} {estimates[n].unit}" for n, v in determined_values.items()]
        remarks.append(f"device: {', '.join(values) or 'as given, the log determines none of it'}")
    return device.replace(sensor=sensor, mechanics=mechanics)


def wall_of(r: Recording) -> Wall | None:
    """Return the wall whose force was asked for, F = K (x - surface) where it is touched; None where none shows."""
    if r.desired is None:
        return None
    touched = r.desired > 0.01 * float(np.abs(r.desired).max(initial=0.0))
    x = r.x if r.met is None else r.met
    if touched.sum() < LEAST_TOUCHED or np.ptp(x[touched]) <= 3 * r.count:
        return None
    A: NDArray[np.float64] = np.array([x[touched], np.ones(touched.sum())]).T
    (stiffness, offset), *_ = np.linalg.lstsq(A, r.desired[touched], rcond=None)
    if not 0 < stiffness < 1e6:
        return None
    return Wall(stiffness=float(stiffness), position=float(-offset / stiffness))
