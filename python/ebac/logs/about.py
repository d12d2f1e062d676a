"""Metadata of a log: law, scenario, versions, machine."""

from __future__ import annotations

import functools
import os
import platform
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ebac._util.wrong_calls import plain_constructor
from ebac.scenario import Scenario
from ebac.scenario_text import text_for_file

SCENARIO_FILE = "scenario.toml"
#: Attached to the log of a run of a configuration: its text.
CONFIGURATION_FILE = "configuration.toml"
#: Attached to the log of a run on drives: where each axis stood before it had power, and the zero of its encoder.
POSITIONS_FILE = "positions.json"
#: Attached to the log of a run on simulated drives: what was simulated.
SIMULATED_FILE = "simulated.txt"
#: What titles call such a run.
SIMULATED_DRIVES = "real time on simulated drives"


@functools.cache
def versions() -> dict[str, str]:
    """Return versions and machine: ebac, the state of its checkout if it has one, Python, NumPy, system."""
    import numpy as np

    from ebac import __version__

    return {
        "ebac": __version__,
        "git": _checkout(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "machine": f"{platform.machine()}, {os.cpu_count()} processors",
        "system": platform.platform(),
    }


def _checkout() -> str:
    """Return commit and cleanness of the checkout the package runs from; empty for an installed one."""
    root = Path(__file__).resolve().parents[3]
    if not (root / ".git").exists():
        return ""
    command = ["git", "-C", str(root), "describe", "--always", "--dirty", "--abbrev=12"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=5, check=True)
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class About:
    """What stands beside the rows of a log.

    Attributes
    ----------
    axes : int
        Axes in use.
    law, law_repr : str
        Name of the law; the law with its parameters, as Python text.
    scenario : Scenario or None
        Attached as `scenario.toml`.
    changed : bool
        Whether law, world, delay or the hand's target were changed during the run; a log of a run has events of it.
    simulated : bool
        Whether a simulation made the rows, where their columns do not show it.
    start_ns : int
        When t was 0, in nanoseconds since 1970 (UTC); 0 for a simulation, whose time is its own.
    files : mapping of str to str
        Further attachments by file name, such as the configuration of the run.
    made_by : mapping of str to str
        Versions and machine.
    """

    axes: int
    law: str = ""
    law_repr: str = ""
    scenario: Scenario | None = None
    changed: bool = False
    simulated: bool = False
    start_ns: int = 0
    files: Mapping[str, str] = field(default_factory=dict)
    made_by: Mapping[str, str] = field(default_factory=versions)

    @property
    def origin(self) -> str:
        """The origin of the trace, see `Trace.origin`; empty where its columns show it."""
        if SIMULATED_FILE in self.files:
            return SIMULATED_DRIVES
        return "simulated" if self.simulated else ""

    @property
    def metadata(self) -> dict[str, str]:
        """The metadata record `ebac`."""
        return {
            "format": "1",
            "axes": str(self.axes),
            "law": self.law,
            "law_repr": self.law_repr,
            "start_ns": str(self.start_ns),
            **({"changed": "true"} if self.changed else {}),
            **({"simulated": "true"} if self.simulated else {}),
            **self.made_by,
        }

    @property
    def attachments(self) -> dict[str, str]:
        """Text files inside the log by their names."""
        text = text_for_file(self.scenario)
        return {**({SCENARIO_FILE: text} if text else {}), **self.files}

    def __repr__(self) -> str:
        """Return one line: law, version, attachments."""
        files = ", ".join(self.attachments) or "no files"
        axes = "1 axis" if self.axes == 1 else f"{self.axes} axes"
        version = self.made_by.get("ebac", "an unknown version")
        return f"<About: {self.law or 'no law'}, {axes}; by ebac {version}; {files}>"
