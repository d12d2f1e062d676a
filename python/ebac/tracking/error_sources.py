"""The error sources of the paper's discussion (IV.D), and what a joystick with them shows of a true path."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from math import isfinite, radians
from typing import Any

import numpy as np

from ebac._core import Device, Gimbal
from ebac._util.arguments import named, number
from ebac._util.arrays import Values
from ebac._util.wrong_calls import plain_constructor

#: Names of the sources, and the fields of `ErrorSources` that belong to each.
GROUPS = {
    "encoder": (),
    "installation": ("zero", "skew", "axis_offset", "lever", "ratio"),
    "cable slack": ("slack",),
}
_RANGES = {
    "zero": (0.0, 0.2, "rad"),
    "skew": (0.0, 0.2, "rad"),
    "axis_offset": (0.0, 0.02, "m"),
    "lever": (0.0, 0.02, "m"),
    "ratio": (0.0, 0.2, "1"),
    "slack": (0.0, 0.02, "m"),
}


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class ErrorSources:
    """How inaccurate a joystick is. The paper names the sources and no size: the defaults are assumptions.

    Parameters
    ----------
    encoder : bool
        Whether counts are whole; one is 0.0307 mm at the handle (paper, IV.D).
    zero : float
        Standard deviation of each joint's zero [rad], [0, 0.2]; default 0.5 deg.
    skew : float
        Standard deviation of the angle by which the two axes are not square [rad], [0, 0.2]; default 0.5 deg.
    axis_offset : float
        Standard deviation of the distance between the two axes [m], [0, 0.02]; default 0.5 mm.
    lever : float
        Standard deviation of the lever's length [m], [0, 0.02]; default 0.5 mm.
    ratio : float
        Standard deviation of each capstan's ratio, a share, [0, 0.2]; default 1 %, 0.05 mm of the drum's 5 mm.
    slack : float
        Play of each cable at the handle, end to end [m], [0, 0.02]; default 0.5 mm, drawn evenly from half to one and
        a half of it.

    Raises
    ------
    ValueError
        When a number is out of its range.
    """

    encoder: bool = True
    zero: float = radians(0.5)
    skew: float = radians(0.5)
    axis_offset: float = 0.5e-3
    lever: float = 0.5e-3
    ratio: float = 0.01
    slack: float = 0.5e-3

    def __post_init__(self) -> None:
        """Check ranges."""
        if not isinstance(self.encoder, bool):
            raise TypeError(f"ErrorSources.encoder = {self.encoder!r}: must be bool")
        for name, (low, high, unit) in _RANGES.items():
            value = getattr(self, name)
            number(f"ErrorSources.{name}", value)
            if not (isfinite(value) and low <= value <= high):
                shown = "" if unit == "1" else f" {unit}"
                raise ValueError(
                    f"ErrorSources.{name} = {value}{shown}: must lie in [{low:g}, {high:g}]{shown}"
                )

    def only(self, group: str) -> ErrorSources:
        """Return one of the groups "encoder", "installation", "cable slack" without the others."""
        mine = named("error source", group, GROUPS)
        kept = {name: getattr(self, name) if name in mine else 0.0 for name in _RANGES}
        return ErrorSources(encoder=self.encoder and group == "encoder", **kept)

    def replace(self, **changes: Any) -> ErrorSources:
        """Return a copy with some sizes changed."""
        return dataclasses.replace(self, **changes)


@dataclass(frozen=True, kw_only=True)
class Joystick:
    """One joystick as it was built: the paper's gimbal with the errors that were drawn for it, SI units."""

    radius: float
    count: float
    zero: Values
    ratio: Values
    slack: Values
    skew: float
    axis_offset: float
    lever: float
    phase: Values
    encoder: bool

    @classmethod
    def draw(cls, device: Device, sources: ErrorSources, random: np.random.Generator) -> Joystick:
        """Draw a joystick from the sizes of its errors.

        Raises
        ------
        ValueError
            When the device is no gimbal.
        """
        if not isinstance(device.kinematics, Gimbal):
            raise ValueError(
                f"the device has {device.kinematics!r}: an error budget needs a Gimbal"
            )
        normal, even = random.standard_normal(7), random.uniform(-0.5, 0.5, 4)
        return cls(
            radius=device.kinematics.radius,
            count=device.count / device.kinematics.radius,
            zero=sources.zero * normal[:2],
            ratio=1 + sources.ratio * normal[2:4],
            slack=sources.slack * (1 + even[:2]),
            skew=sources.skew * float(normal[4]),
            axis_offset=sources.axis_offset * float(normal[5]),
            lever=sources.lever * float(normal[6]),
            phase=even[2:],
            encoder=sources.encoder,
        )

    def handle(self, q: Values) -> Values:
        """Return where the handle truly is [m] at joint angles [rad], shapes (n, 3) and (n, 2).

        p = Ry(q1) [(0, 0, a) + Rz(e) Rx(-q2) (0, 0, R + dR)], with the axes a apart and e from square; without errors
        it is the Gimbal of the core.
        """
        length = self.radius + self.lever
        s2, c2 = np.sin(q[:, 1]), np.cos(q[:, 1])
        inner = np.stack(
            [-np.sin(self.skew) * length * s2, np.cos(self.skew) * length * s2, self.axis_offset + length * c2],
            axis=1,
        )  # fmt: skip
        s1, c1 = np.sin(q[:, 0]), np.cos(q[:, 0])
        return np.stack(
            [c1 * inner[:, 0] + s1 * inner[:, 2], inner[:, 1], c1 * inner[:, 2] - s1 * inner[:, 0]],
            axis=1,
        )

    def joints(self, x: Values) -> Values:
        """Return the joint angles [rad] that bring the handle to x, y [m], shapes (n, 2), by Newton's steps."""
        q = nominal_joints(x, self.radius)
        for _ in range(20):
            miss = self.handle(q)[:, :2] - x
            h = 1e-6
            a, b = (
                (self.handle(q + h * axis)[:, :2] - self.handle(q - h * axis)[:, :2]) / (2 * h)
                for axis in np.eye(2)
            )
            det = a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]
            step = np.stack(
                [b[:, 1] * miss[:, 0] - b[:, 0] * miss[:, 1], a[:, 0] * miss[:, 1] - a[:, 1] * miss[:, 0]],
                axis=1,
            ) / det[:, None]  # fmt: skip
            q = q - step
            if float(np.abs(step).max()) < 1e-13:
                break
        return q

    def shown(self, x: Values) -> Values:
        """Return what the joystick shows [m] while its handle follows x, y [m], shapes (n, 2).

        Each motor is taken along by its cable when the play is used up, its encoder counts, and the nominal kinematics
        make a position of the counts.
        """
        q = self.joints(x)
        motor = np.stack([_dragged(q[:, i], self.slack[i] / self.radius) for i in range(2)], axis=1)
        read = self.ratio * motor + self.zero
        if self.encoder:
            read = self.count * (np.rint(read / self.count + self.phase) - self.phase)
        return np.stack(
            [
                self.radius * np.sin(read[:, 0]) * np.cos(read[:, 1]),
                self.radius * np.sin(read[:, 1]),
            ],
            axis=1,
        )


def nominal_joints(x: Values, radius: float) -> Values:
    """Return the joint angles [rad] of a perfect gimbal at x, y [m], shapes (n, 2).

    Raises
    ------
    ValueError
        When a point lies outside the sphere.
    """
    if not (np.hypot(x[:, 0], x[:, 1]) < radius).all():
        raise ValueError(f"the path leaves the sphere of radius {1e3 * radius:g} mm")
    q2 = np.arcsin(x[:, 1] / radius)
    return np.stack([np.arcsin(x[:, 0] / (radius * np.cos(q2))), q2], axis=1)


def _dragged(angle: Values, play: float) -> Values:
    """Return the angle of what is dragged through a play, end to end, from the middle of it."""
    if play == 0:
        return angle
    half, follows = play / 2, np.empty_like(angle)
    last = float(angle[0])
    for i, value in enumerate(angle.tolist()):
        last = min(max(last, value - half), value + half)
        follows[i] = last
    return follows
