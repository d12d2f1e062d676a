"""Every key of the files that describe a run: unit, default, range, meaning. Only what is not known elsewhere is here.

Numbers of the core have unit, range and meaning in its lists of fields, keys of a profile in `drives.profile_fields`,
parts of a configuration in the docstrings of their classes. `notes` adds what a user needs to know besides.
"""

from __future__ import annotations

import dataclasses

from ebac._core import Fault
from ebac.hardware.keys.drive_keys import network_keys, profile_keys
from ebac.hardware.keys.file_key import (
    CONFIGURATION,
    NETWORK,
    PROFILE,
    SCENARIO,
    FileKey,
    as_toml,
)
from ebac.hardware.keys.notes import FAULTS, NOTES, WARNINGS
from ebac.hardware.keys.run_keys import run_keys

__all__ = [
    "CONFIGURATION",
    "NETWORK",
    "PROFILE",
    "SCENARIO",
    "FileKey",
    "as_toml",
    "file_keys",
]


def file_keys() -> tuple[FileKey, ...]:
    """Return every key of a configuration, a scenario, a drive profile and a network file."""
    return tuple(_noted(one) for one in (*run_keys(), *profile_keys(), *network_keys()))


def _noted(key: FileKey) -> FileKey:
    """Return a key with its note and its warning."""
    table = f"profile.{key.table}" if PROFILE in key.files else key.table
    of_type = f"{table}.{key.type}.{key.name}"
    where = of_type if of_type in NOTES else f"{table}.{key.name}"
    said = [key.note, NOTES.get(where, "")]
    if key.table == "limits" and CONFIGURATION in key.files and key.name in FAULTS:
        numbers = ", ".join(str(int(Fault[name])) for name in FAULTS[key.name])
        said.append(f"the run then ends by fault {numbers}")
    return dataclasses.replace(
        key, note="; ".join(one for one in said if one), warning=WARNINGS.get(where, "")
    )
