"""What of this machine matters to a loop of 1 kHz, and what to do about it."""

from __future__ import annotations

import os
import platform
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from ebac import _core

Verdict = Literal["good", "fair", "bad"]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing looked at.

    Attributes
    ----------
    what, found : str
        What was looked at, and what it is.
    verdict : "good", "fair" or "bad"
        "fair" costs lateness; "bad" keeps a loop from being what it was asked to be.
    remedy : str
        What to do; empty when nothing.
    """

    what: str
    found: str
    verdict: Verdict
    remedy: str = ""

    def row(self) -> dict[str, Any]:
        """Return it as a row of `--json`."""
        return {
            "what": self.what,
            "found": self.found,
            "verdict": self.verdict,
            "remedy": self.remedy or None,
        }


def examine(options: _core.RealTime | None = None, *, root: Path = Path("/")) -> list[Finding]:
    """Check kernel, clock, processor, limits and CAN interfaces for real-time problems.

    Parameters
    ----------
    options : RealTime, optional
        What a loop's thread would ask; a thread of this process asks for it and gives it back.
    root : Path
        Where /proc and /sys lie.
    """
    return [
        _kernel(root),
        _clock(root),
        *_governor(root),
        _throttling(root),
        *_grants(options or _core.RealTime()),
        *_can(root),
    ]


def _read(path: Path) -> str | None:
    try:
        return path.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return None


def preemption(root: Path = Path("/")) -> str:
    """Return the preemption model of the kernel: "PREEMPT_RT", "PREEMPT", ... or "unknown"."""
    if _read(root / "sys/kernel/realtime") == "1":
        return "PREEMPT_RT"
    version = _read(root / "proc/version") or ""
    found = re.search(r"PREEMPT[_A-Z]*", version)
    chosen = re.search(r"\((\w+)\)", _read(root / "sys/kernel/debug/sched/preempt") or "")
    model = found[0] if found else "unknown"
    return f"{model}, {chosen[1]}" if chosen else model


def _kernel(root: Path) -> Finding:
    model = preemption(root)
    found = f"{platform.system()} {platform.release()}, {model}"
    if model.startswith("PREEMPT_RT"):
        return Finding(what="kernel", found=found, verdict="good")
    return Finding(
        what="kernel",
        found=found,
        verdict="fair",
        remedy="ticks come late by milliseconds now and then; a kernel with PREEMPT_RT ends that "
        "(Debian: sudo apt install linux-image-rt-amd64)",
    )


def _clock(root: Path) -> Finding:
    folder = root / "sys/devices/system/clocksource/clocksource0"
    found = _read(folder / "current_clocksource")
    if found is None:
        return Finding(what="clock source", found="unknown", verdict="fair")
    if found in {"tsc", "kvm-clock", "arch_sys_counter", "hyperv_clocksource_tsc_page"}:
        return Finding(what="clock source", found=found, verdict="good")
    has_tsc = "tsc" in (_read(folder / "available_clocksource") or "").split()
    remedy = (
        f"echo tsc | sudo tee {folder / 'current_clocksource'}"
        if has_tsc
        else "start the kernel with clocksource=tsc tsc=reliable, if the processor's counter is steady"
    )
    return Finding(what="clock source", found=found, verdict="fair", remedy=remedy)


def _governor(root: Path) -> list[Finding]:
    files = sorted((root / "sys/devices/system/cpu").glob("cpu[0-9]*/cpufreq/scaling_governor"))
    found = sorted({text for file in files if (text := _read(file))})
    if not found:
        return [Finding(what="governor", found="none: the frequency is fixed", verdict="good")]
    if found == ["performance"]:
        return [Finding(what="governor", found="performance", verdict="good")]
    remedy = "sudo cpupower frequency-set -g performance"
    return [
        Finding(what="governor", found=", ".join(found), verdict="fair", remedy=remedy),
    ]


def _throttling(root: Path) -> Finding:
    runtime = _read(root / "proc/sys/kernel/sched_rt_runtime_us")
    period = _read(root / "proc/sys/kernel/sched_rt_period_us")
    what = "share of real-time threads"
    if runtime is None or period is None:
        return Finding(what=what, found="unknown", verdict="fair")
    if int(runtime) < 0:
        return Finding(what=what, found="no limit", verdict="good")
    share = int(runtime) / int(period)
    verdict: Verdict = "good" if share >= 0.5 else "bad"
    remedy = "" if verdict == "good" else "sudo sysctl kernel.sched_rt_runtime_us=950000"
    return Finding(what=what, found=f"{100 * share:.0f} %", verdict=verdict, remedy=remedy)


#: What a thread can do without, at the price of lateness.
_COSTS_TIME = ("sleep",)


def _grants(options: _core.RealTime) -> list[Finding]:
    return [
        Finding(
            what=f"thread: {grant.name}",
            found=f"{grant.asked}: {'granted' if grant.granted else grant.why}",
            verdict="good" if grant.granted else "fair" if grant.name in _COSTS_TIME else "bad",
            remedy=grant.remedy,
        )
        for grant in _core._ask_realtime(options)
    ]


#: ARPHRD_CAN of linux/if_arp.h.
_CAN = "280"


def _can(root: Path) -> list[Finding]:
    folders = sorted((root / "sys/class/net").glob("*"))
    found = [folder for folder in folders if _read(folder / "type") == _CAN]
    if not found:
        remedy = (
            "for hardware: plug the adapter in and load its driver (sudo modprobe can_raw); "
            "a simulation needs none"
        )
        return [Finding(what="CAN interface", found="none", verdict="fair", remedy=remedy)]
    return [_interface(folder) for folder in found]


def _interface(folder: Path) -> Finding:
    up = bool(int(_read(folder / "flags") or "0", 16) & 1)
    name = folder.name
    if up:
        return Finding(what=f"CAN interface {name}", found="up", verdict="good")
    virtual = os.path.realpath(folder).find("/virtual/") >= 0
    kind = "" if virtual else " type can bitrate 1000000"
    remedy = f"sudo ip link set {name} up{kind}"
    return Finding(what=f"CAN interface {name}", found="down", verdict="bad", remedy=remedy)
