"""Numbers and words of a configuration that belong to no part of the core: unit, range, default."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ebac._util.arguments import nearest_float, unknown
from ebac.drives.profile_fields import Key
from ebac.drives.toml_positions import Path, Source, dotted
from ebac.hardware.tables import table

#: Ticks in a row without process data that are a fault where the key is not given: of real drives, and of simulated
#: ones, which share the processors with their loop [samples].
SILENT, SILENT_SIMULATED = 3, 10

BUS = (
    Key(
        name="silent",
        unit="samples",
        low=1,
        high=1000,
        whole=True,
        remedy="ticks in a row without process data that are a fault; leave it out for "
        f"{SILENT} on hardware and {SILENT_SIMULATED} with simulated drives",
    ),
    Key(
        name="answer_share",
        low=0.05,
        high=0.9,
        default=0.7,
        remedy="the share of a tick the drives may take to answer",
    ),
)
RUN = (
    Key(name="seconds", unit="s", low=0.01, high=1e5, default=10.0),
    Key(name="soft_start", unit="s", low=0.0, high=60.0, default=0.2),
    Key(name="ramp_down", unit="s", low=0.0, high=10.0, default=0.2),
)
RECORDING = (
    Key(name="memory", unit="s", low=1.0, high=3600.0, default=60.0),
    Key(name="sync", unit="s", low=0.1, high=3600.0),
)


def check_seconds(seconds: float) -> None:
    """Refuse a length of a run that no configuration may have.

    Raises
    ------
    ValueError
        Then.
    """
    if (wrong := RUN[0].check(nearest_float(seconds))) is not None:
        raise ValueError(wrong)


def number(source: Source, path: Path, key: Key) -> Any:
    """Return a number of the table at `path`, its default where it is not given.

    Raises
    ------
    ProfileError
        When it is no number, or out of range.
    """
    found = table(source, path)
    if key.name not in found:
        return key.default
    wrong = key.check(found[key.name])
    if wrong is not None:
        raise source.refuse((*path, key.name), f"{dotted(path)}.{wrong}")
    return found[key.name]


def word(
    source: Source, path: Path, value: Any, choices: Sequence[str] = (), hint: str = ""
) -> Any:
    """Return a word, one of `choices` where there are any; `hint` follows where it is none of them.

    Raises
    ------
    ProfileError
        When it is none.
    """
    if not isinstance(value, str) or not value:
        raise source.refuse(path, f"{dotted(path)} = {value!r}: must be text")
    if choices and value not in choices:
        wrong = unknown(f"{dotted(path)} = {value!r}", value, list(choices))
        raise source.refuse(path, wrong + hint)
    return value
