"""Devices and hands with a source. `indicative` means from memory of the literature, not confirmed."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from ebac._core import (
    Device,
    FingerPad,
    Gimbal,
    Hand,
    LetGo,
    Mechanics,
    NonlinearGrip,
    Reflex,
    SlidingGimbal,
    Step,
)
from ebac._util.arguments import named

__all__ = [
    "DEVICES",
    "HANDS",
    "DevicePreset",
    "HandPreset",
    "device",
    "hand",
]


def __dir__() -> list[str]:
    return __all__


@dataclass(frozen=True, kw_only=True)
class HandPreset:
    """A hand and where its numbers come from."""

    hand: Hand
    source: str
    indicative: bool


@dataclass(frozen=True, kw_only=True)
class DevicePreset:
    """A device and where its numbers come from."""

    device: Device
    source: str


#: Operators by name. Stiffness, damping and mass are those of eq. (4); the target is part of the task.
HANDS: dict[str, HandPreset] = {
    "reference": HandPreset(
        hand=Hand(),
        source="this project's reference: 0.15 kg, 6 N s/m, 300 N/m; target 40 mm as in the paper, Fig. 5",
        indicative=False,
    ),
    "arm-hapticmaster": HandPreset(
        hand=Hand(mass=0.554, damping=6.45, stiffness=135),
        source="van Beek et al., Scientific Reports 2016, Fig. 3 (one trial on a HapticMaster)",
        indicative=False,
    ),
    "arm-hogan": HandPreset(
        hand=Hand(mass=0.8, damping=5.5, stiffness=568),
        source="Hogan 1989",
        indicative=True,
    ),
    "wall-study": HandPreset(
        hand=Hand(mass=0.8, damping=5.5, stiffness=30, path=Step(target=0.08)),
        source="parameters of a virtual-wall study in public code",
        indicative=False,
    ),
    "finger": HandPreset(
        hand=Hand(mass=0.006, damping=5.5, stiffness=600),
        source="Hajian and Howe 1997, index finger, middle of the ranges",
        indicative=True,
    ),
    "resting": HandPreset(
        hand=Hand(path=Step(target=0)),
        source="the reference hand, holding the device where it is",
        indicative=False,
    ),
    "reflex": HandPreset(
        hand=Hand(model=Reflex()),
        source="the reference hand with a stretch reflex of 40 ms, after van der Helm et al. 2002",
        indicative=True,
    ),
    "finger-pad": HandPreset(
        hand=Hand(model=FingerPad()),
        source="the reference hand behind the pulp of its fingers, after Pawluk and Howe 1999",
        indicative=True,
    ),
    "nonlinear-grip": HandPreset(
        hand=Hand(model=NonlinearGrip()),
        source="the reference hand, twice as stiff at 20 N, after Van Doren 1998, Hajian and Howe 1997",
        indicative=True,
    ),
    "let-go": HandPreset(
        hand=Hand(model=LetGo()),
        source="the reference hand, which lets go at 2 s and grips again at 2.5 s",
        indicative=True,
    ),
    "open": HandPreset(
        hand=Hand(mass=0, damping=0, stiffness=0),
        source="nobody holds the device",
        indicative=False,
    ),
}

#: Devices by name.
DEVICES: dict[str, DevicePreset] = {
    "reference": DevicePreset(
        device=Device(),
        source="one straight axis, 0.25 kg and 2 N s/m, from the paper's motor, encoder and capstan",
    ),
    "joystick": DevicePreset(
        device=Device(
            kinematics=Gimbal(radius=0.1, limit=pi / 6),
            mechanics=Mechanics(handle_mass=0.114, damping=2.0, gravity=9.81),
        ),
        source="the paper's 2-DOF joystick: R = 100 mm, +-30 deg, eq. (11); masses as the reference",
    ),
    "joystick-3": DevicePreset(
        device=Device(
            kinematics=SlidingGimbal(radius=0.1, limit=pi / 6, slide_radius=0.1, slide_limit=0.04),
            mechanics=Mechanics(handle_mass=0.114, damping=2.0),
        ),
        source="the paper's joystick with a lever that slides +-40 mm, its outlook to three axes: this project's "
        "design, nothing like it was built; the third drive is as the first two, springs carry the weight",
    ),
}


def hand(name: str) -> Hand:
    """Return the hand of that name.

    Parameters
    ----------
    name : str
        A name of `HANDS`.

    Raises
    ------
    KeyError
        For an unknown name; the message lists the names.
    """
    return named("hand", name, HANDS).hand


def device(name: str) -> Device:
    """Return the device of that name.

    Parameters
    ----------
    name : str
        A name of `DEVICES`.

    Raises
    ------
    KeyError
        For an unknown name; the message lists the names.
    """
    return named("device", name, DEVICES).device
