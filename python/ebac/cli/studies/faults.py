"""`ebac faults`: a campaign of fault injection."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import interrupts, options, output
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.faults import FaultCampaign, FaultRow

#: What people want to see: the first case of these, and every first failure.
PICTURES = ("lost_answer", "silent_node", "encoder_jump", "nan_law", "overruns", "stop")


def faults(
    to: ResultOptions,
    cases: Annotated[
        int,
        typer.Option(
            help="Number of runs with an injected fault; every kind in turn.", min=1, max=10_000_000
        ),
    ] = 10_000,
    seed: Annotated[int, typer.Option(help="Seed; the same one gives the same cases.", min=0)] = 1,
    threads: options.Threads = None,
    as_json: output.AsJson = False,
) -> None:
    """Inject faults into the control loop and check how it stops.

    A simulation. Two simulated CANopen drives, a hand at a wall, EBAC, limits and states, in virtual time. Each case
    checks that the torque on the bus is zero within 2 ticks of the fault, that every drive is disabled at the end,
    that the drives' own currents exceed no limit at any tick, that the right fault is reported, that there is no
    restart without a reset, and that there is no false alarm. Exit code 1 when a case fails.

    **Examples**

    * `ebac faults --cases 1000 --seed 7`

    * `ebac faults --cases 460 --json`
    """
    from ebac.faults import run_campaign

    folder = to.folder("faults", as_json=as_json)
    interrupts.keeping(
        f"nothing was written; fewer --cases take less time, and --seed {seed} gives the same ones"
    )
    with output.refusing(), output.counting("injecting faults", quiet=as_json) as progress:
        found = run_campaign(cases, seed=seed, threads=threads, progress=progress)
    files: list[str] = []
    with output.results(folder) as draft:
        if draft is not None:
            files = _write(draft, found, to)
    if as_json:
        typer.echo(_document(found))
    else:
        _show(found)
        if folder is not None:
            output.list_files(folder, files)
    if found.passed < found.cases:
        raise typer.Exit(output.FAILED)


def _document(found: FaultCampaign) -> str:
    rows = [row.row() for row in found.rows]
    more = {"seed": found.seed, "cases": found.cases, "passed": found.passed}
    return output.document("faults", rows, **more)


def _write(draft: Path, found: FaultCampaign, to: ResultOptions) -> list[str]:
    from ebac.faults import run_case
    from ebac.plot import plot_fault

    (draft / "faults.json").write_text(_document(found) + "\n", encoding="utf-8")
    files = ["faults.json"]
    for i, row in enumerate(found.rows):
        chosen = {i} if row.kind in PICTURES else set()
        if row.first_failure is not None:
            chosen.add(row.first_failure)
        for index in sorted(chosen):
            figure = plot_fault(run_case(index, seed=found.seed))
            files += to.save(figure, draft, f"{row.kind}-{index}")
    return files


def _show(found: FaultCampaign) -> None:
    heads = [
        "what goes wrong",
        "cases",
        "fault found",
        "to zero torque",
        "to no current",
        "failures",
    ]
    grid = output.table(heads, numbers=range(1, 6))
    for row in found.rows:
        ticks = [output.plural(n, "tick") if row.found else "-" for n in _worst(row)]
        grid.add_row(row.what, f"{row.cases:,}", f"{row.found:,}", *ticks, _failures(row))
    output.show(grid)
    output.say(
        f"{found.passed:,} of {found.cases:,} cases passed, seed {found.seed}. Times are the worst ones, in ticks of "
        "1 ms from the row with the fault: torque on the bus, current in the simulated motors."
    )


def _worst(row: FaultRow) -> tuple[int, int]:
    return row.worst_ticks_to_zero, row.worst_ticks_to_off


def _failures(row: FaultRow) -> str:
    counts = ", ".join(f"{n} {name}" for name, n in row.reasons.items()) or "0"
    return counts if row.first_breach is None else f"{counts}: {row.first_breach}"
