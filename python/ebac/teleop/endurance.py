"""Master, network and slave in three processes with link cuts: messages, forces, places and memory."""

from __future__ import annotations

import re
import socket
import subprocess
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ebac._core import Limits, Link
from ebac._util.arguments import number
from ebac._util.child_processes import (
    Child,
    end,
    last_report,
    link_options,
    started,
    text,
)
from ebac.scenario import Scenario
from ebac.teleop.schemes import Scheme
from ebac.teleop.schemes import scheme as scheme_of

#: Values of memory that are not judged: a process starts.
STARTED = 10
#: Rows of memory are written so often [s].
EVERY = 1.0
#: By how much memory may be larger at the end than after a third of the run [bytes].
GROWTH = 1_000_000
#: The same of the network, whose queues grow to what they may hold.
QUEUES = 10_000_000
#: Largest force of the master while the link is lost, after the fade [N].
CALM = 0.1
#: How far the hand swings the stick [m], and what a stick and a slave may go beyond.
FARTHEST = 0.05
#: The slave and the network live longer than the master by this [s].
BEFORE, AFTER = 1.0, 2.0
#: The others end by themselves within this after the first that ends in time [s].
PATIENCE = 60.0
NAMES = ("slave", "network", "master")


@dataclass(frozen=True, kw_only=True)
class Endurance:
    """What three processes have met.

    Attributes
    ----------
    reports : dict of str to dict
        What `ebac teleop slave`, `network` and `master --json` print at their end; without those that printed nothing.
    reported : dict of str to int
        How often each process said that its link was lost.
    events : dict of str to list of tuple
        When each process said what [s], of its own time: link lost, back, running.
    memory : dict of str to list of int
        Resident memory of each process [bytes], one value a second.
    faults : list of str
        What was not as it has to be; empty for a good run.
    """

    reports: dict[str, dict[str, Any]]
    reported: dict[str, int]
    memory: dict[str, list[int]] = field(repr=False)
    faults: list[str]
    events: dict[str, list[tuple[float, str]]] = field(default_factory=dict)

    def growth(self, name: str) -> int:
        """Return by how much the memory of a process grew over the last two thirds, without the first 10 s [bytes]."""
        values = self.memory[name]
        first = max(STARTED, len(values) // 3)
        return values[-1] - values[first] if first < len(values) else 0


def endurance(
    seconds: float = 600.0,
    *,
    scheme: str = "ebac",
    link: Link | None = None,
    seed: int = 1,
    consent_after: float = 1.0,
    progress: Callable[[float], None] | None = None,
) -> Endurance:
    """Run master, network and slave as three processes while the link is cut again and again.

    Parameters
    ----------
    seconds : float
        Length [s], 5 to 86400.
    scheme : str
        A name of `SCHEMES`.
    link : Link, optional
        Default: 50 ms, 10 ms of jitter, 5 % loss, 1 % damaged, 2 s of every 20 s cut.
    seed : int
        Of device and network.
    consent_after : float
        The simulated hand consents so long after the link is back [s].
    progress : callable, optional
        Called once a second with the time that has passed [s].

    Raises
    ------
    KeyError, ValueError
        For a scheme that does not exist, a time out of its range.
    TypeError
        For seconds that are no number, a link that is none.
    """
    seconds = number("seconds", seconds)
    if not 5 <= seconds <= 86400:
        raise ValueError(f"seconds = {seconds:g} s: must lie in [5, 86400] s")
    chosen = scheme_of(scheme)
    over = link or Link(
        delay=0.05, jitter=0.01, loss=0.05, corrupt=0.01, cut_every=20, cut_length=2
    )
    at_slave, at_network = _free_ports(2)
    words = {
        "slave": ["--port", str(at_slave), "--scheme", chosen.name],
        "network": [
            *("--port", str(at_network), "--slave", f"127.0.0.1:{at_slave}", "--seed", str(seed)),
            *link_options(over),
        ],
        "master": [
            *("--peer", f"127.0.0.1:{at_network}", "--scheme", chosen.name, "--seed", str(seed)),
            *("--consent-after", str(consent_after)),
        ],
    }
    lasts = {"slave": seconds + BEFORE + AFTER, "network": seconds + BEFORE + AFTER}
    memory: dict[str, list[int]] = {name: [] for name in NAMES}
    with ExitStack() as stack:
        running: dict[str, Child] = {}
        for name in NAMES:
            last = str(lasts.get(name, seconds))
            command = ["teleop", name, *words[name], "--seconds", last, "--json"]
            running[name] = stack.enter_context(started(command))
            if name == "network":
                time.sleep(BEFORE)
        processes = {name: one.process for name, one in running.items()}
        passed = _watch(processes, memory, seconds, progress)
        ended = _ended(processes, PATIENCE if passed >= seconds else 0.0)
        for process in processes.values():
            end(process)
        texts = {name: (text(one.out), text(one.err)) for name, one in running.items()}
    failed = []
    for name in NAMES:
        said = " ".join(texts[name][1].split())[-300:]
        if ended.get(name):
            failed.append(f"{name} ended with {ended[name]}: {said}")
        elif name in ended and passed < seconds:
            failed.append(f"{name} ended after {passed:.0f} s: must run for {seconds:g} s")
        elif name not in ended and passed >= seconds:
            failed.append(f"{name} had not ended {PATIENCE:g} s after the run: {said}")
        elif name in ended and not last_report(texts[name][0]):
            failed.append(f"{name} ended without a report: {said}")
    reports = {name: found for name in NAMES if (found := last_report(texts[name][0]))}
    reported = {name: texts[name][1].count("LINK LOST") for name in NAMES}
    events = {name: _events(texts[name][1], name) for name in NAMES}
    met = Endurance(reports=reports, reported=reported, memory=memory, faults=failed, events=events)
    if set(reports) < set(NAMES):
        return met
    return replace(met, faults=[*failed, *_faults(met, over, chosen)])


def _ended(processes: dict[str, subprocess.Popen[bytes]], patience: float) -> dict[str, int]:
    """Return the codes of those that have ended by themselves, after a wait of at most `patience` [s] for all."""
    latest = time.monotonic() + patience
    while time.monotonic() < latest and any(one.poll() is None for one in processes.values()):
        time.sleep(0.05)
    return {name: code for name, one in processes.items() if (code := one.poll()) is not None}


def _events(said: str, name: str) -> list[tuple[float, str]]:
    """Return time and words of each line such as "  12.3 s  slave: running"."""
    lines = re.findall(rf"^ *([0-9.]+) s  {name}: (.*)$", said, flags=re.M)
    return [(float(t), words) for t, words in lines]


def master_limit() -> float:
    """Return the largest force of the master's motor at the handle [N]."""
    device = Scenario().device
    return device.force(Limits.of(device).peak_current)


def _faults(found: Endurance, over: Link, scheme: Scheme) -> list[str]:
    """Return a sentence for each thing that is not as it has to be."""
    master, slave = found.reports["master"], found.reports["slave"]
    checks = [
        ("largest force of the master", master["most_force_N"], master_limit(), "N"),
        ("force of the master with the link lost", master["force_when_lost_N"], CALM, "N"),
        ("largest force of the slave", slave["most_force_N"], scheme.coupling.peak_force, "N"),
        ("way of the slave with the link lost", slave["moved_when_lost_m"], 0.0, "m"),
        ("way of the stick", master["farthest_m"], FARTHEST, "m"),
        ("way of the slave", slave["farthest_m"], FARTHEST, "m"),
        ("faults of the master", master["fault"], 0, ""),
        *(
            (
                f"growth of the {name}",
                found.growth(name),
                QUEUES if name == "network" else GROWTH,
                "B",
            )
            for name in NAMES
        ),
    ]
    faults = [
        f"{what} = {value:g} {unit}: must be at most {limit:g} {unit}".replace(" :", ":").strip()
        for what, value, limit, unit in checks
        if not value <= limit
    ]
    for name, report in (("master", master), ("slave", slave)):
        where = f"largest force of the {name} ="
        faults = [
            f"{one}; it was at {report['most_force_at_s']:.1f} s, {report['most_force_since_s']:.2f} s after the link "
            "began to run"
            if one.startswith(where)
            else one
            for one in faults
        ]
    for name in ("master", "slave"):
        losses = found.reports[name]["losses"]
        if found.reported[name] < losses:
            faults.append(f"{name}: reported {found.reported[name]} of {losses} lost links")
        if not losses and 0 < over.cut_every < found.reports["master"]["seconds_s"]:
            faults.append(f"{name}: the link was cut, but no loss was found")
    return faults


def _watch(
    processes: dict[str, subprocess.Popen[bytes]],
    memory: dict[str, list[int]],
    seconds: float,
    progress: Callable[[float], None] | None,
) -> float:
    """Note the memory of all until one of them ends; return after which time [s]."""
    begun = time.monotonic()
    while all(process.poll() is None for process in processes.values()):
        passed = time.monotonic() - begun
        if passed > seconds + PATIENCE:
            break
        for name, process in processes.items():
            value = _resident(process.pid)
            if value:
                memory[name].append(value)
        if progress is not None:
            progress(min(passed, seconds))
        time.sleep(EVERY)
    return time.monotonic() - begun


def _resident(pid: int) -> int:
    """Return the resident memory of a process [bytes]; 0 where it is not known."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return 0
    return next((1024 * int(one.split()[1]) for one in lines if one.startswith("VmRSS:")), 0)


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        sockets = [
            stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            for _ in range(count)
        ]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [int(one.getsockname()[1]) for one in sockets]
