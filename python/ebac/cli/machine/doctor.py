"""`ebac doctor`: what of this machine matters to a loop, and what to do about it."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import output

_MARKS = {"good": "[green]good[/]", "fair": "[yellow]fair[/]", "bad": "[bold red]bad[/]"}


def doctor(
    priority: Annotated[
        int, typer.Option(help="Priority the control thread would ask for.", min=1, max=99)
    ] = 80,
    cpu: Annotated[
        int, typer.Option(help="CPU the thread would stay on; -1 for any.", min=-1)
    ] = -1,
    as_json: output.AsJson = False,
) -> None:
    """Check this machine for real-time problems.

    Prints how to fix each one. Kernel, clock, limits and CAN interfaces are looked at; nothing is changed. "fair":
    ticks come late now and then. "bad": a control loop cannot run as asked; exit code 1.

    **Examples**

    * `ebac doctor`

    * `ebac doctor --cpu 0`: would a thread get CPU 0?
    """
    from ebac.realtime import RealTime, examine

    with output.refusing():
        findings = examine(RealTime(priority=priority, cpu=cpu))
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
