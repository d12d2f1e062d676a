"""One key of a file that describes a run, and how it is written."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from math import isinf
from typing import Any

from ebac._util.docstrings import parameters

CONFIGURATION, SCENARIO, PROFILE, NETWORK = "configuration", "scenario", "profile", "network file"
BOTH = (CONFIGURATION, SCENARIO)
#: Tables that may stand in a file several times: [[node]].
ARRAYS = frozenset({"simulated.hand.path", "bus.other", "node"})


@dataclass(frozen=True, kw_only=True)
class FileKey:
    """One key of a file.

    Parameters
    ----------
    files : tuple of str
        Kinds of files that have it: "configuration" of `ebac run`, "scenario", drive "profile", "network file".
    table : str
        Its table, as "device.motor"; empty for the top of the file.
    type : str
        Value of the key `type` with which the table has it; empty if it always has.
    name : str
        The key.
    unit : str
        Unit of a number, "1" for a pure one; empty for what is no number.
    default : number, bool, str, list or None
        None for a key without a default.
    configuration_default : number, str or None
        Default in a configuration, which starts from the joystick, where it differs from that of a scenario.
    low, high : float or None
        Range of a number.
    choices : tuple
        Values it may have, where they are few.
    meaning, note, warning : str
        What it is, what to know besides, and what must not be overlooked.
    sets : str
        Object of the drive that a key of a profile sets, with the unit there.
    """

    files: tuple[str, ...] = (CONFIGURATION,)
    table: str
    type: str = ""
    name: str
    unit: str = ""
    default: Any = None
    configuration_default: Any = None
    low: float | None = None
    high: float | None = None
    choices: tuple[Any, ...] = ()
    meaning: str
    note: str = ""
    warning: str = ""
    sets: str = ""

    @property
    def heading(self) -> str:
        """Return the heading of its table in a file."""
        if not self.table:
            return "top of the file"
        return f"[[{self.table}]]" if self.table in ARRAYS else f"[{self.table}]"

    @property
    def default_text(self) -> str:
        """Return the default as a file has it."""
        text, other = as_toml(self.default), as_toml(self.configuration_default)
        return f"{text}; in a configuration {other}" if other else text

    @property
    def range_text(self) -> str:
        """Return what it may be."""
        if self.choices:
            return ", ".join(as_toml(one) for one in self.choices)
        if self.low is None or self.high is None or (isinf(self.low) and isinf(self.high)):
            return ""
        if isinf(self.high):
            return f"from {_short(self.low)}"
        return f"{_short(self.low)} to {_short(self.high)}"

    @property
    def text(self) -> str:
        """Return meaning and note in one line."""
        return "; ".join(part for part in (self.meaning, self.note) if part)

    @property
    def warning_text(self) -> str:
        """Return the warning as a sentence."""
        return f"{self.warning[:1].upper()}{self.warning[1:]}." if self.warning else ""

    def row(self) -> dict[str, Any]:
        """Return it as plain values, as JSON takes them; a bound or default that is infinite as text."""
        plain = dataclasses.asdict(self)
        return {name: _finite(value) for name, value in plain.items()}


def as_toml(value: Any) -> str:
    """Return a value as a file has it, numbers with four digits; "" for None."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(as_toml(one) for one in value)}]"
    if isinstance(value, float):
        return f"{value:.4g}"
    return f'"{value}"' if isinstance(value, str) else str(value)


def said_of(kind: type) -> dict[str, str]:
    """Return the parameters of a docstring, worded as the meanings of the core are: without capital and full stop."""
    said = {name: text.removesuffix(".") for name, text in parameters(kind).items()}
    return {
        name: text[:1].lower() + text[1:] if text[1:2].islower() or text[1:2] == " " else text
        for name, text in said.items()
    }


def _short(bound: float) -> str:
    """Return a bound with all its digits, in few."""
    if isinstance(bound, int):
        return str(bound)
    return f"{bound:g}" if float(f"{bound:g}") == bound else f"{bound:.17g}"


def _finite(value: Any) -> Any:
    return str(value) if isinstance(value, float) and isinf(value) else value
