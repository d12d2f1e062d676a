"""The spec sheet of a device, computed from its parts, beside the paper's figures."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isnan, nan, pi, sin

from ebac._core import Device, SlidingGimbal
from ebac._util import formatting
from ebac._util.arguments import require

__all__ = [
    "Spec",
    "spec_sheet",
]


def __dir__() -> list[str]:
    return __all__


@dataclass(frozen=True, kw_only=True)
class Spec:
    """One line of a spec sheet, SI units; `value` is nan where there is no such number, and `how` says why."""

    name: str
    value: float
    unit: str
    paper: float | None
    how: str
    remark: str = ""

    def row(self) -> dict[str, str | float | None]:
        """Return it as a plain row."""
        return asdict(self)

    def __repr__(self) -> str:
        """Return "<Spec resolution: 3.068e-05 m, paper 3e-05 m>"."""
        paper = "" if self.paper is None else f", paper {self.paper:.4g} {self.unit}"
        value = "-" if isnan(self.value) else f"{self.value:.4g} {self.unit}"
        return f"<Spec {self.name}: {value}{paper}>"


class _Sheet(list[Spec]):
    """A spec sheet: a list that prints as a table."""

    def __str__(self) -> str:
        """Return one number with its unit a line, and how it comes about."""
        rows = [(one.name, formatting.quantity(one.value, one.unit), one.how) for one in self]
        name, value = (max((len(row[i]) for row in rows), default=0) for i in (0, 1))
        return "\n".join(f"{row[0]:<{name}}  {row[1]:>{value}}  {row[2]}" for row in rows)

    def _repr_html_(self) -> str:
        """Return the same for a notebook."""
        from ebac._util import notebook

        rows = [
            {"quantity": s.name, "value": formatting.quantity(s.value, s.unit), "how": s.how}
            for s in self
        ]
        return notebook.result("Spec sheet", rows)


def spec_sheet(device: Device) -> list[Spec]:
    """Compute the spec sheet of a device.

    Parameters
    ----------
    device : Device
        Any device; the paper's column belongs to its joystick.

    Returns
    -------
    list of Spec
        `print` shows it as a table.
    """
    require(device, Device, "ebac.spec_sheet", "a Device")
    radius, limit = device.radius, device.kinematics.limit
    motor, drive, gravity = device.motor, device.drive, device.mechanics.gravity
    return _Sheet([
        Spec(name="resolution", value=device.count, unit="m", paper=0.03e-3,
             how="2 pi / counts per turn, through capstan and lever"),
        Spec(name="continuous force", value=device.continuous_force, unit="N", paper=10.6,
             how="rated torque through capstan and lever",
             remark="holds at the handle only if the cable's sector is as large as the lever"),
        Spec(name="peak force", value=device.peak_force, unit="N", paper=42.4,
             how=_limit_of_peak(device),
             remark="the ratio is chosen to give the paper's 42.4 N over 10.6 N: no check of it"),
        Spec(name="continuous current", value=motor.current(motor.rated_torque), unit="A", paper=1.0,
             how="rated torque over torque constant",
             remark="the paper rounds the motor's continuous current to 1 A"),
        Spec(name="peak current", value=drive.peak_current(motor), unit="A", paper=None,
             how="the stall current" if _stalls(device) else "peak torque over torque constant"),
        Spec(name="travel, chord", value=2 * radius * sin(limit) if limit <= pi / 2 else nan, unit="m", paper=0.2,
             how="2 R sin(limit)" if limit <= pi / 2 else _no_chord(limit),
             remark="the paper's 200 mm is the diameter of the sphere the handle moves on, not its reach"),
        Spec(name="travel, arc", value=2 * radius * limit, unit="m", paper=None, how="2 R limit"),
        Spec(name="joint range", value=2 * limit, unit="rad", paper=2 * pi / 6,
             how="2 limit", remark="eq. (11) of the paper"),
        Spec(name="mass at the handle", value=device.mass, unit="kg", paper=None,
             how="lever and handle plus reflected rotor",
             remark="the paper's 1.7 kg is the weight of the whole device"),
        Spec(name="of which rotor", value=device.reflected_mass, unit="kg", paper=None,
             how="rotor inertia over squared drum radius, through the lever",
             remark="rotor inertia is indicative"),
        Spec(name="weight", value=device.mechanics.handle_mass * gravity, unit="N", paper=None,
             how=f"handle_mass times gravity of {gravity:g} m/s^2" if gravity else "gravity = 0 m/s^2: carried"),
        Spec(name="viscous damping", value=device.mechanics.damping, unit="N s/m", paper=None,
             how="declared", remark="B_h in eq. (6) of the paper"),
        Spec(name="Coulomb friction", value=device.mechanics.coulomb, unit="N", paper=None,
             how="declared", remark="not given in the paper"),
        *_of_the_slide(device),
    ])  # fmt: skip


def _stalls(device: Device) -> bool:
    """Return whether the motor's stall current is below the peak current of the drive."""
    motor = device.motor
    return motor.current(device.drive.peak_ratio * motor.rated_torque) > motor.stall_current


def _limit_of_peak(device: Device) -> str:
    """Return what limits the peak force, and what to check where it is below the continuous force."""
    motor, ratio = device.motor, f"{device.drive.peak_ratio:g} times rated torque"
    if not _stalls(device):
        return ratio
    how = f"stall current of {motor.stall_current:g} A times torque constant, less than {ratio}"
    if device.peak_force >= device.continuous_force:
        return how
    return (
        f"{how} and less than the continuous force: one of rated_torque = {motor.rated_torque:g} N m, "
        f"torque_constant = {motor.torque_constant:g} N m/A and stall_current is wrong; 1 mN m is 0.001 N m"
    )


def _no_chord(limit: float) -> str:
    return (
        f"none: a lever has a chord up to limit = pi/2 = 1.571 rad, and this is {limit:g} rad; limit is in rad, from "
        "the middle to the stop (30 degrees are 0.5236 rad); a straight axis travels the arc"
    )


def _of_the_slide(device: Device) -> list[Spec]:
    """Compute what is other on a third axis; none of it is in the paper."""
    lever = device.kinematics
    if not isinstance(lever, SlidingGimbal):
        return []
    ratio = lever.slide_radius / lever.radius
    facts, handle = device.facts, device.mechanics.handle_mass

    def spec(name: str, value: float, unit: str, how: str) -> Spec:
        return Spec(name=name, value=value, unit=unit, paper=None, how=how)

    return [
        spec("slide, travel", 2 * lever.slide_limit, "m", "2 slide_limit"),
        spec("slide, resolution", device.count * ratio, "m", "the drum's count times slide_radius"),
        spec(
            "slide, continuous force", device.continuous_force / ratio, "N", "through slide_radius"
        ),
        spec("slide, peak force", device.peak_force / ratio, "N", "through slide_radius"),
        spec("slide, mass", handle + device.reflected_mass / ratio**2, "kg", "handle plus rotor"),
        spec("worst resolution", facts.count, "m", "of all axes, with the longest lever"),
        spec("least peak force", facts.peak_force, "N", "of all axes, with the longest lever"),
    ]
