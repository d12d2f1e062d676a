"""The result of a fit of a device: estimates, intervals, and what contradicts them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Compensation
from ebac.identify import motor_check
from ebac.identify.device_problem import Drive
from ebac.identify.estimate import Estimate
from ebac.identify.intervals import Z95
from ebac.identify.missing import left_for
from ebac.identify.parameters import BOUNDS
from ebac.identify.recording import Recording
from ebac.identify.signals import rough
from ebac.identify.validation import flip_advice, seems_flipped

#: Standard gravity [m/s^2].
GRAVITY = 9.80665
#: A parameter is determined where half of its interval is this share of its value at most. Friction and weight may be
#: none: they are, too, where half of the interval is this share of the force that moves the device.
SHARE, OF_FORCE = 0.25, 0.02
#: Noise of the force, as a share of what moves the device, with which a search may end anywhere.
NOISY = 0.5
UNITS = ("kg", "N s/m", "N", "N", "N")
ROTARY_UNITS = ("kg m^2", "N m s/rad", "N m", "N m", "N m")


@dataclass(frozen=True, kw_only=True, eq=False)
class DeviceResult:
    """The identified device; pass `result.compensation` to a `Device`.

    For a rotary recording all numbers refer to the joint: kg m^2, N m s/rad and N m.
    """

    recording: Recording
    drive: Drive
    names: tuple[str, ...]
    values: NDArray[np.float64]
    covariance: NDArray[np.float64]
    stribeck_speed: float | None
    explained: float
    converged: bool
    seconds: float
    #: Share explained with forces of the other sign, "force", "motor" or "force and motor", where this fit explains
    #: little or is impossible; only of devices that are possible.
    other_signs: Mapping[str, float] = field(default_factory=dict)
    #: Rows that were left out: the motor stands at a limit there and contradicts the others.
    cut_rows: int = 0
    #: Lever at which a rotary device was searched as a handle [m]; 1 for one in m.
    lever: float = 1.0

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each of `names`."""
        return ROTARY_UNITS if self.recording.rotary else UNITS

    @property
    def _effort(self) -> str:
        return "torque" if self.recording.rotary else "force"

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Every parameter by name: M_h, B_h, coulomb, weight (towards +x), stribeck (breakaway above Coulomb)."""
        half = Z95 * np.sqrt(np.diag(self.covariance))
        half[np.isnan(half)] = np.inf  # nothing is known
        rows = zip(self.names, self.values.tolist(), half.tolist(), self.units, strict=False)
        return {
            name: Estimate(
                name=name,
                value=value,
                unit=unit,
                low=value - h,
                high=value + h,
                fixed=False,
                determined=self._determined(name, value, h),
            )
            for name, value, h, unit in rows
        }

    def _determined(self, name: str, value: float, half: float) -> bool:
        if self.impossible:
            return False
        if name in ("M_h", "B_h"):
            return half <= SHARE * abs(value)
        reach = float(np.sqrt(np.mean(self.drive.force[self.drive.slides] ** 2)))
        return half <= max(SHARE * abs(value), OF_FORCE * reach)

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the parameters that the log does not determine."""
        return tuple(name for name, e in self.estimates.items() if not e.determined)

    @property
    def impossible(self) -> tuple[str, ...]:
        """Why no device can have these parameters, one sentence each; if not empty, the estimates are not a result."""
        deviations = np.sqrt(np.diag(self.covariance))
        rows = zip(self.names, self.values.tolist(), deviations, self.units, strict=False)
        out = []
        for name, value, deviation, unit in rows:
            low, high = (bound * scale(name, self.lever) for bound in BOUNDS[name])
            if value <= low + Z95 * deviation and name == "M_h":
                out.append(
                    f"{name} = {value:.4g} {unit}: a device has {'inertia' if self.recording.rotary else 'a mass'}"
                )
            elif value + Z95 * deviation < 0 and name in ("B_h", "coulomb"):
                out.append(f"{name} = {value:.4g} {unit}: friction that drives is none")
            elif not low < value < high:
                out.append(f"{name} = {value:.4g} {unit}: at the bound of the search")
        if self.explained < 0:
            out.append(f"the device explains less of the {self._effort} than none would")
        return tuple(out)

    @property
    def misses(self) -> tuple[str, ...]:
        """What the model does not explain, one sentence each."""
        turned = max(self.other_signs, key=lambda key: self.other_signs[key], default="")
        wrong = [f"This is no device: {'; '.join(self.impossible)}."] if self.impossible else []
        if wrong and self.recording.force is None:
            left = left_for("force", self.recording) if self.recording.unread else ""
            wrong.append(
                f"The log has no {self._effort} of the hand{left}. Without one nobody may touch the handle while the "
                "motor moves it."
            )
        elif wrong:
            wrong += [*self._noisy(), *motor_check.doubts([self.recording])]
        share = 0.0 if wrong else self.explained
        if turned and seems_flipped(share, self.other_signs[turned]):
            sentence = f"The device explains {{}} of the {self._effort} where it slides"
            said = max(0.0, self.explained)
            wrong.insert(0, flip_advice(sentence, said, self.other_signs[turned], turned))
        if self.cut_rows:
            wrong.append(
                f"The {self._effort} of the motor stands at a limit in {self.cut_rows} rows and contradicts the others "
                "there: the record seems to be cut. These rows were left out; record what the motor gave."
            )
        return tuple(wrong)

    def _noisy(self) -> list[str]:
        """Return a sentence where the force has more noise than what moves the device can stand."""
        unit = "N m" if self.recording.rotary else "N"
        if self.recording.force is None:
            return []
        noise = rough(self.recording.force)
        moving = float(np.sqrt(np.mean(self.drive.smooth_force[self.drive.slides] ** 2)))
        if noise < NOISY * moving:
            return []
        return [
            f"The {self._effort} has a noise of {noise:.2g} {unit} where {moving:.2g} {unit} move the device: move it "
            f"faster, or record a quieter {self._effort}; a filter needs its lag declared."
        ]

    @property
    def compensation(self) -> Compensation:
        """Return tau_static of eq. (2), from the lower bounds of the estimates.

        These are the lower bounds of friction and of the weight, and zero where they are not determined, and for an
        impossible device. A weight is carried
        with the sign of `Mechanics.gravity`, which `gravity` gives. Inertia is not compensated, because that costs
        damping; see `Compensation`.

        Raises
        ------
        ValueError
            For a rotary device, because a `Device` has a handle.
        """
        if self.recording.rotary:
            raise ValueError(
                f"{self.recording.name}: is of a rotary device, eq. (2) compensates a force at a handle; load the log "
                "with lever=0.05 or --lever 0.05, the radius of the handle [m]"
            )
        if self.impossible:
            return Compensation()
        rubs, found = self.estimates["coulomb"], self.estimates["weight"]
        friction = max(0.0, rubs.low) if rubs.determined else 0.0
        weight = max(0.0, found.low, -found.high) if found.determined else 0.0
        return Compensation(friction=friction, gravity_mass=weight / GRAVITY)

    @property
    def gravity(self) -> float:
        """`Mechanics.gravity` with which the weight is carried [m/s^2]: positive where it pulls along +x."""
        return GRAVITY if self.estimates["weight"].value > 0 else -GRAVITY

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers in SI units, for JSON."""
        return {
            "rows": [vars(e) for e in self.estimates.values()],
            f"stribeck_speed_{self.recording.units[0]}_per_s": self.stribeck_speed,
            "explained_share": self.explained,
            "undetermined": list(self.undetermined),
            "impossible": list(self.impossible),
            "misses": list(self.misses),
            "compensation": None if self.recording.rotary else self.compensation.as_dict(),
            "converged": self.converged,
            "seconds_s": self.seconds,
        }

    def _repr_html_(self) -> str:
        """Return the figure and the estimates, for a notebook."""
        from ebac._util import notebook
        from ebac.identify.figures import plot_device

        title = f"Device: explains {100 * self.explained:.2f} % of the {self._effort}"
        rows = [e.row() for e in self.estimates.values()]
        return notebook.result(title, rows, lambda: plot_device(self))

    def __repr__(self) -> str:
        """Return the estimates, one a line."""
        lines = ["Device:"] + [f"  {e}" for e in self.estimates.values()]
        lines.append(f"  explains {100 * self.explained:.2f} % of the {self._effort}")
        return "\n".join([*lines, *(f"  {text}" for text in self.misses)])


def scale(name: str, lever: float) -> float:
    """Return a parameter of a joint over that of a handle at a lever [m]."""
    return lever**2 if name in ("M_h", "B_h") else lever
