"""`ebac doctor`: what of this machine matters to a loop, and what to do about it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.realtime import Finding
    from ebac.realtime.doctor import Verdict

#: Least share of the time the loop waits that the slowest answer leaves.
_MARGIN = 0.1
_MARKS = {"good": "[green]good[/]", "fair": "[yellow]fair[/]", "bad": "[bold red]bad[/]"}


def doctor(
    configuration: Annotated[
        Path | None,
        typer.Argument(
            help="Configuration of a run: also report limits beyond the motor, what its drives do when the loop "
            "stalls, and the time on its bus."
        ),
    ] = None,
    priority: Annotated[
        int, typer.Option(help="Priority that the control thread would request.", min=1, max=99)
    ] = 80,
    cpu: Annotated[
        int, typer.Option(help="CPU that the thread would be pinned to; -1 for any.", min=-1)
    ] = -1,
    as_json: output.AsJson = False,
) -> None:
    """Check this machine for real-time problems.

    Prints how to fix each one. Kernel, clock, limits and CAN interfaces are checked; nothing is changed. "fair" means
    that some ticks will be late, that answers on the bus may be, that the drives may hold another SYNC period than the
    run writes, that a drive lets through more than its motor is to take, that the time constant of another motor's
    winding is not given, or that a drive whose loop stalls can throw the handle to the end of the workspace, "bad" that
    a control loop cannot run as requested or that `ebac run` refuses a limit, with exit code 1.

    **Examples**

    * `ebac doctor`

    * `ebac doctor --cpu 0`: also check whether a thread can be pinned to CPU 0

    * `ebac demo joystick`, then `ebac doctor joystick.toml`: also how long its drives hold a torque when the loop
      stalls
    """
    from ebac.realtime import RealTime, examine

    with output.refusing():
        findings = examine(RealTime(priority=priority, cpu=cpu))
        if configuration is not None:
            findings = [
                *findings,
                *_rating(configuration),
                *_drive_limits(configuration),
                *_stalls(configuration),
                *_sync(configuration),
                _bus(configuration),
            ]
    verdicts = [finding.verdict for finding in findings]
    worst = next(v for v in ("bad", "fair", "good") if v in verdicts)
    if as_json:
        typer.echo(output.document("doctor", [f.row() for f in findings], verdict=worst))
    else:
        grid = output.table(["what", "found", ""])
        for finding in findings:
            grid.add_row(finding.what, finding.found, _MARKS[finding.verdict])
        output.show(grid)
        if worst != "good":
            output.say("What to do:", style="bold")
        for finding in findings:
            if finding.remedy:
                output.indented(f"{finding.what}: {finding.remedy}")
    if worst == "bad":
        raise typer.Exit(output.FAILED)


def _bus(path: Path) -> Finding:
    """Return how long an exchange takes on the bus of a configuration, against the time the loop waits."""
    from ebac.hardware.configuration import Configuration
    from ebac.hardware.drive_setup import nodes_of
    from ebac.hardware.timed_bus import exchange_times
    from ebac.realtime import Finding

    known = Configuration.load(path)
    dt = known.timing.dt
    load = replace(known.drives, nodes=nodes_of(known, simulate=False)).bus_load()
    least, most = exchange_times(known)
    waits = known.answer_share * dt
    in_time = most <= (1 - _MARGIN) * waits
    verdict: Verdict = "good" if in_time else "fair" if least <= waits else "bad"
    share = f"{100 * load.share:.0f} % of {load.bitrate / 1000:g} kbit/s"
    return Finding(
        what="the bus, one tick",
        found=f"answers after {1e6 * least:.0f} to {1e6 * most:.0f} us, the loop waits {1e6 * waits:.0f} us "
        f"of {1e6 * dt:.0f}; load at most {share} (the most with a stuff bit wherever one fits)",
        verdict=verdict,
        remedy=""
        if in_time
        else f"the slowest answer must leave {100 * _MARGIN:.0f} % of the time the loop waits: raise bus.answer_share "
        f"({known.answer_share:g} now, at most 0.9) or the bit rate, lengthen timing.dt"
        + (", or use a second bus" if len(known.drives.nodes) > 1 else ""),
    )


def _sync(path: Path) -> list[Finding]:
    """Return the drives whose profile has another SYNC period than the loop: a run wants that of the loop in 0x1006."""
    from ebac.hardware.configuration import Configuration
    from ebac.hardware.drive_setup import other_sync
    from ebac.realtime import Finding

    return [
        Finding(
            what=f"node {node}, period of SYNC",
            found=text,
            verdict="fair" if remedy else "good",
            remedy=remedy,
        )
        for node, text, remedy in other_sync(Configuration.load(path))
    ]


def _rating(path: Path) -> list[Finding]:
    """Return each limit that the motor may not bear: `ebac run` refuses one beyond the data sheet."""
    from ebac.hardware import rating
    from ebac.hardware.configuration import Configuration
    from ebac.realtime import Finding

    known = Configuration.load(path)
    refused = [
        Finding(
            what=f"limits.{name}",
            found=f"{text}: `ebac run` refuses it, the motor may burn",
            verdict="bad",
            remedy=rating.remedy(name),
        )
        for name, text in rating.beyond_rating(known)
    ]
    unknown = [
        Finding(what="limits.thermal_time", found=text, verdict="fair", remedy=remedy)
        for text, remedy in rating.unknown_winding(known)
    ]
    return refused + unknown


def _drive_limits(path: Path) -> list[Finding]:
    """Return each limit of a drive that lets through more than the motor of a configuration is to take."""
    from ebac.hardware.configuration import Configuration
    from ebac.hardware.drive_limits import above_peak
    from ebac.realtime import Finding

    known = Configuration.load(path)
    return [
        Finding(what=f"the drives' {key}", found=text, verdict="fair", remedy=remedy)
        for key, text, remedy in above_peak(known.drives, known.device)
    ]


def _stalls(path: Path) -> list[Finding]:
    """Return what each drive of a configuration does when its loop stalls."""
    from ebac.drives.stall import LONGEST, REACTION, watches
    from ebac.hardware.configuration import Configuration
    from ebac.hardware.drive_limits import thrown
    from ebac.hardware.drive_setup import nodes_of
    from ebac.realtime import Finding

    found = []
    known = Configuration.load(path)
    for axis, node in enumerate(nodes_of(known, simulate=False)):
        acting = watches(node.profile)
        worst = min(acting.values(), default=float("inf"))
        text = ", ".join(f"{key} {1e3 * after:g} ms" for key, after in acting.items())
        then = REACTION[int(node.profile.values["drive.connection_lost"])]
        force, way, to_the_end = thrown(known, axis, worst)
        verdict: Verdict = "bad" if worst > LONGEST else "fair" if worst >= to_the_end else "good"
        mass = f"a free handle of {known.device.mass:.3g} kg"
        moved = (
            f"{force:.1f} N move {mass} by {1e3 * way:.2g} mm"
            if verdict == "good"
            else f"{force:.1f} N have moved {mass} to the end of the workspace, after {1e3 * to_the_end:.2g} ms"
        )
        found.append(
            Finding(
                what=f"node {node.id}, a loop that stalls",
                found=f"{then} after {1e3 * worst:g} ms at worst ({text}); by then {moved}"
                if acting
                else "holds its torque for ever",
                verdict=verdict,
                remedy=_stall_remedy(verdict, to_the_end),
            )
        )
    return found


def _stall_remedy(verdict: Verdict, to_the_end: float) -> str:
    if verdict == "bad":
        return "give pdo.rpdo1.event = 0.005 or heartbeat.consumer = 0.1, best both"
    if verdict == "fair":
        return (
            "give pdo.rpdo1.event = 0.005 where the drive has 0x1400:5, or a heartbeat.consumer of less than "
            f"{to_the_end:.2g} s; a lower limits.max_torque of the profile and limits.peak_current leave more time"
        )
    return ""
