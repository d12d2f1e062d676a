"""Which column is what, and in which unit: given, or guessed and said."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

#: The signals of a recording and their SI unit.
UNITS_OF = {"t": "s", "x": "m", "force": "N", "motor": "N", "desired": "N", "target": "m"}

#: Names that a column may have, the surest first; compared in small letters without unit.
NAMES: dict[str, tuple[str, ...]] = {
    "t": ("t", "time", "timestamp", "zeit", "seconds", "sec"),
    "x": ("x", "x_0", "pos", "position", "px", "x_pos", "handle", "displacement"),
    "force": (
        "f_meas",
        "f_meas_0",
        "force",
        "f",
        "fx",
        "f_hand",
        "fh",
        "f_sensor",
        "ft",
        "force_x",
        "grip_force",
    ),
    "motor": ("f_applied", "f_applied_0", "motor", "motor_force", "f_motor", "actuator_force"),
    "desired": ("f_env", "f_env_0", "f_desired", "desired", "fd", "f_d"),
    "target": ("target", "x0", "goal", "reference", "ref", "setpoint"),
}

#: What one of a unit is in SI.
FACTORS = {
    "t": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9, "min": 60.0},
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "in": 0.0254},
    "force": {
        "N": 1.0,
        "mN": 1e-3,
        "kN": 1e3,
        "gf": 9.80665e-3,
        "kgf": 9.80665,
        "lbf": 4.4482216152605,
    },
}
_KIND = {
    "t": "t",
    "x": "length",
    "target": "length",
    "force": "force",
    "motor": "force",
    "desired": "force",
}


def split_heading(heading: str) -> tuple[str, str | None]:
    """Return name and unit of "pos [mm]", "pos (mm)"; the unit is None where there is none."""
    match = re.fullmatch(r"\s*(.*?)\s*[\[(]\s*([^\])]+?)\s*[\])]\s*", heading)
    return (match[1], match[2]) if match else (heading.strip(), None)


def unit_factor(file: str, signal: str, unit: str) -> float:
    """Return what one of `unit` is in SI.

    Raises
    ------
    ValueError
        For a unit that does not fit the signal.
    """
    known = FACTORS[_KIND[signal]]
    if unit not in known:
        raise ValueError(
            f"{file}: {signal} in {unit!r}: must be one of {', '.join(known)}; convert the column, or name the unit"
        )
    return known[unit]


def assign(
    file: str, headings: Sequence[str], given: Mapping[str, str]
) -> tuple[dict[str, str], list[str]]:
    """Return the column of each signal, and what was guessed.

    Raises
    ------
    ValueError
        For a given column that does not exist.
    """
    bare = {split_heading(h)[0].lower(): h for h in headings}
    chosen, remarks = {}, []
    for signal, name in given.items():
        if name not in headings and name.lower() not in bare:
            raise ValueError(
                f"{file}: there is no column {name!r} for {signal}; there are: {', '.join(headings)}"
            )
        chosen[signal] = name if name in headings else bare[name.lower()]
    for signal, names in NAMES.items():
        if signal in chosen:
            continue
        match = next((bare[n] for n in names if n in bare and bare[n] not in chosen.values()), None)
        if match is not None:
            chosen[signal] = match
            remarks.append(f"{signal}: guessed to be column {match!r}")
    return chosen, remarks
