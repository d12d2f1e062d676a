"""Bus, network, bus: a joystick on drives, a network, and a gastroscope on drives, in three processes."""

from __future__ import annotations

import json
import subprocess
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ebac._core import Link
from ebac._util.arguments import nearest_float
from ebac._util.child_processes import (
    Child,
    end,
    first_lines,
    last_report,
    link_options,
    started,
    text,
)

NAMES = ("slave", "network", "master")
#: The longest a process may take to start [s].
_START = 60.0
#: The slave and the network live longer than the master by this [s].
_AFTER = 30.0
#: States of a drive without power.
OFF = ("switch on disabled", "not ready to switch on", "fault")


@dataclass(frozen=True, kw_only=True)
class Chain:
    """What three processes have met.

    Attributes
    ----------
    reports : dict of str to dict
        What `ebac gastroscopy master`, `ebac teleop network` and `ebac gastroscopy slave --json` print at their end;
        without those that printed nothing.
    codes : dict of str to int
        With which each ended.
    said : dict of str to str
        What each said while it ran.
    faults : list of str
        What was not reported, or not at rest at the end; empty for a good run.
    """

    reports: dict[str, dict[str, Any]]
    codes: dict[str, int]
    said: dict[str, str] = field(repr=False)
    faults: list[str]


def chain(
    seconds: float = 30.0,
    *,
    link: Link | None = None,
    law: str | None = None,
    seed: int = 1,
    consent_after: float = 1.0,
    give_up: float = 10.0,
    folder: str | Path | None = None,
    master: Sequence[str] = (),
    slave: Sequence[str] = (),
    meanwhile: Callable[[dict[str, subprocess.Popen[bytes]], float], None] | None = None,
) -> Chain:
    """Run joystick, network and gastroscope in three processes of this machine, all drives simulated.

    Parameters
    ----------
    seconds : float
        How long the joystick has power [s], 1 to 3600.
    link : Link, optional
        The network, the same both ways; default: 50 ms.
    law : str, optional
        Of the joystick, as `ebac gastroscopy master --law` takes it; default: that of its configuration.
    seed : int
        Of the network.
    consent_after, give_up : float
        A simulated hand consents so long after the link is back; after so long without it a side ends [s].
    folder : str or Path, optional
        Where logs go; default: none.
    master, slave : sequence of str
        Further words of the two commands.
    meanwhile : callable
        Called 20 times a second with the processes by name and the time since the joystick was started [s].

    Raises
    ------
    ValueError
        For a time out of its range.
    TypeError
        For a link that is none.
    RuntimeError
        Where a process does not start.
    """
    if not 1 <= seconds <= 3600:
        raise ValueError(f"seconds = {nearest_float(seconds):g} s: must lie in [1, 3600] s")
    network = link_options(link or Link(delay=0.05))
    known = ["--give-up", str(give_up), "--json"]
    logs: dict[str, list[str]] = {"slave": [], "master": []}
    if folder is not None:
        where = Path(folder)
        where.mkdir(parents=True, exist_ok=True)
        logs = {name: ["--log", str(where / f"{name}.mcap")] for name in logs}
    with ExitStack() as stack:
        running: dict[str, Child] = {}

        def begin(name: str, words: Sequence[str]) -> None:
            running[name] = stack.enter_context(started(words))

        last = str(seconds + _AFTER)
        begin(
            "slave",
            [
                *("gastroscopy", "slave", "--simulated", "--port", "0", "--announce"),
                *("--seconds", last, *known, *logs["slave"], *slave),
            ],
        )
        at_slave = _announced("slave", running["slave"])
        begin(
            "network",
            [
                *("teleop", "network", "--port", "0", "--slave", f"127.0.0.1:{at_slave}"),
                *("--seconds", last, "--seed", str(seed), "--json", "--announce", *network),
            ],
        )
        at_network = _announced("network", running["network"])
        begin(
            "master",
            [
                *("gastroscopy", "master", "--simulated", "--peer", f"127.0.0.1:{at_network}"),
                *("--seconds", str(seconds), "--consent-after", str(consent_after)),
                *(() if law is None else ("--law", law)),
                *(*known, *logs["master"], *master),
            ],
        )
        _wait({name: one.process for name, one in running.items()}, seconds, give_up, meanwhile)
        texts = {name: (text(one.out), text(one.err)) for name, one in running.items()}
        codes = {name: int(one.process.wait()) for name, one in running.items()}
    reports = {name: found for name in texts if (found := last_report(texts[name][0]))}
    said = {name: texts[name][1] for name in texts}
    return Chain(reports=reports, codes=codes, said=said, faults=_faults(reports, codes, said))


def _faults(
    reports: dict[str, dict[str, Any]], codes: dict[str, int], said: dict[str, str]
) -> list[str]:
    """Return a sentence for each thing that was not reported, or is not at rest."""
    found = []
    for name in NAMES:
        if name not in reports:
            words = " ".join(said[name].split())[-300:]
            found.append(f"the {name} ended with {codes[name]} and no report: {words}")
    for name in ("slave", "master"):
        report = reports.get(name)
        if report is None:
            continue
        seen = sum(1 for one in report["events"] if one["what"] == "lost")
        if seen < report["losses"]:
            found.append(f"{name}: reported {seen} of {report['losses']} lost links")
        wanted = 4 if name == "slave" else 3
        off = [state for state in report["drives"] if state in OFF]
        if len(off) < wanted:
            found.append(f"{name}: {len(off)} of {wanted} drives without power: {report['drives']}")
        # The master's goodbye may have been lost with the link.
        late = name == "slave" and report["ended_by"] == "link lost"
        if codes[name] and not (late and reports.get("master", {}).get("ended_by") == "time"):
            found.append(f"{name}: ended by {report['ended_by']}")
    return found


def _announced(name: str, child: Child) -> int:
    """Return the UDP port that a process prints when it is ready."""
    line = "".join(first_lines(child, 1, _START))
    try:
        return int(json.loads(line)["port"])
    except (ValueError, KeyError):
        raise RuntimeError(f"the {name} did not start: {line} {text(child.err)}") from None


def _wait(
    processes: dict[str, subprocess.Popen[bytes]],
    seconds: float,
    give_up: float,
    meanwhile: Callable[[dict[str, subprocess.Popen[bytes]], float], None] | None,
) -> None:
    """Wait for both sides; the network is ended then."""
    begun = time.monotonic()
    while any(processes[name].poll() is None for name in ("master", "slave")):
        passed = time.monotonic() - begun
        if passed > seconds + give_up + _AFTER + _START:
            break
        if meanwhile is not None:
            meanwhile(processes, passed)
        time.sleep(0.05)
    for process in processes.values():
        end(process)
