"""Which column of a file is which signal of a recording, in which unit: given, or guessed by the heading."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from ebac._util.headings import FACTORS, split_heading, standard_unit

#: What a signal may be; the first is meant where nothing else is said.
QUANTITIES: dict[str, tuple[str, ...]] = {
    "t": ("time",),
    "x": ("length", "angle", "count"),
    "force": ("force", "torque"),
    "motor": ("force", "torque", "current", "voltage"),
    "desired": ("force", "torque"),
    "target": ("length", "angle", "count"),
}

#: Names that a column may have, the surest first; compared in small letters without unit, words joined by "_".
NAMES: dict[str, tuple[str, ...]] = {
    "t": ("t", "time", "timestamp", "zeit", "seconds", "sec"),
    "x": (
        *("x", "x_0", "pos", "position", "weg", "px", "x_pos", "handle", "displacement"),
        *("handle_pos", "handle_position", "handle_x", "pos_x", "position_x", "x_position"),
        *("theta", "theta_0", "phi", "angle", "q", "q_0", "joint_angle", "joint_position"),
        *("knob", "encoder", "enc", "counts"),
    ),
    "force": (
        *("f_meas", "f_meas_0", "force", "f", "fx", "fy", "fz", "f_hand", "fh", "f_sensor", "ft"),
        *("force_x", "kraft", "hand_force", "handle_force", "handkraft"),
        *("grip_force", "tau_meas", "tau_hand", "hand_torque", "torque_hand", "torque_sensor"),
        *("torque", "tau", "tau_ext"),
    ),
    "motor": (
        *("f_applied", "f_applied_0", "motor", "motor_force", "f_motor", "actuator_force"),
        *("motor_torque", "torque_motor", "tau_motor", "tau_m", "tau_applied", "actuator_torque"),
        *("motor_current", "current", "i_motor", "motorkraft"),
    ),
    "desired": (
        *("f_env", "f_env_0", "f_desired", "desired", "fd", "f_d"),
        *("torque_desired", "desired_torque", "tau_desired", "tau_d"),
    ),
    "target": (
        *("target", "x0", "goal", "reference", "ref", "setpoint"),
        *("target_angle", "theta_ref", "theta_d", "q_ref", "q_d"),
    ),
}

#: What a name says of its quantity, where the heading has no unit.
_SAYS = {
    "angle": re.compile(r"(theta|phi|q)(_.*)?|.*(angle|joint|knob).*"),
    "count": re.compile(r"counts"),
    "torque": re.compile(r"(.*_)?tau(_.*)?|.*torque.*"),
    "current": re.compile(r".*current.*|i_.*"),
    "force": re.compile(r"f(_.*)?|f[a-z]|.*force.*|.*kraft.*"),
}


#: So many columns are named in a message.
SHOWN = 20


def listed(headings: Sequence[str]) -> str:
    """Return headings with commas between, the first of many."""
    more = len(headings) - SHOWN
    return ", ".join(headings[:SHOWN]) + (f" and {more} more" if more > 0 else "")


def _units(signal: str) -> list[str]:
    return [unit for quantity in QUANTITIES[signal] for unit in FACTORS[quantity]]


def name_and_unit(signal: str, heading: str) -> tuple[str, str | None]:
    """Return name and unit of a heading, were it that of a signal."""
    return split_heading(heading, _units(signal))


def _joined(signal: str, heading: str) -> str:
    """Return the name in a heading in small letters, its words joined: handle_pos of `Handle Pos [mm]`."""
    return "_".join(name_and_unit(signal, heading)[0].lower().split())


def quantity_of(
    file: str, signal: str, heading: str, unit: str | None
) -> tuple[str | None, str | None]:
    """Return quantity and unit of a column, each None where neither unit nor name says one.

    Raises
    ------
    ValueError
        For a unit that does not fit the signal.
    """
    if unit is not None:
        known = _units(signal)
        unit = standard_unit(unit, known)
        for quantity in QUANTITIES[signal]:
            if unit in FACTORS[quantity]:
                return quantity, unit
        raise ValueError(
            f"{file}: {signal} in {unit!r}: must be one of {', '.join(known)}; convert the column, or name the unit"
        )
    name = _joined(signal, heading)
    says = (q for q in QUANTITIES[signal] if q in _SAYS and _SAYS[q].fullmatch(name))
    return next(says, None), None


def assign(
    file: str, headings: Sequence[str], given: Mapping[str, str]
) -> tuple[dict[str, str], list[str]]:
    """Return the column of each signal, and what was guessed.

    Raises
    ------
    ValueError
        For a given column that does not exist, or that is given for two signals.
    """
    chosen: dict[str, str] = {}
    remarks = []
    for signal, name in given.items():
        bare = {name_and_unit(signal, h)[0].lower(): h for h in headings}
        if name not in headings and name.lower() not in bare:
            raise ValueError(
                f"{file}: there is no column {name!r} for {signal}; there are: {listed(headings)}"
            )
        column = name if name in headings else bare[name.lower()]
        if column in chosen.values():
            first = next(key for key, other in chosen.items() if other == column)
            raise ValueError(f"{file}: column {column!r} is given for {first} and for {signal}")
        chosen[signal] = column
    for signal, names in NAMES.items():
        if signal in chosen:
            continue
        bare = {_joined(signal, h): h for h in headings}
        match = next((bare[n] for n in names if n in bare and bare[n] not in chosen.values()), None)
        if match is not None:
            chosen[signal] = match
            remarks.append(f"{signal}: guessed to be column {match!r}")
    return chosen, remarks
