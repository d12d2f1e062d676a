"""`ebac doctor`: what of this machine matters to a loop, and what to do about it."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import output

_MARKS = {"good": "[green]good[/]", "fair": "[yellow]fair[/]", "bad": "[bold red]bad[/]"}


def doctor(
    priority: Annotated[
        int, typer.Option(help="Priority a loop's thread would ask for.", min=1, max=99)
    ] = 80,
    cpu: Annotated[int, typer.Option(help="CPU it would stay on; -1 for any.", min=-1)] = -1,
    as_json: output.AsJson = False,
) -> None:
    """Look at kernel, clock, limits and CAN interfaces, and say how to make them fit for a loop.

    "fair" costs lateness now and then; "bad" keeps a loop from being what it is asked to be, and gives
    exit code 1. Nothing is changed.

    **Example**

    * `ebac doctor --cpu 3`: would a thread get CPU 3?
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
        output.console().print(grid)
        if worst != "good":
            output.say("What to do:", style="bold")
        for finding in findings:
            if finding.remedy:
                output.indented(f"{finding.what}: {finding.remedy}")
    if worst == "bad":
        raise typer.Exit(output.FAILED)
