"""`ebac jitter`: how late a thread wakes on this machine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.arguments import unknown
from ebac.cli import interrupts, output
from ebac.cli.files import ResultOptions
from ebac.cli.machine.grants import show_refused

if TYPE_CHECKING:
    from ebac.realtime import Cyclictest, Jitter


def jitter(
    to: ResultOptions,
    seconds: Annotated[float, typer.Option(help="Length of the measurement [s].")] = 10.0,
    rate: Annotated[float, typer.Option(help="Ticks per second [Hz].")] = 1000.0,
    realtime: Annotated[
        str,
        typer.Option(
            help="Real-time priority: auto (use it if granted), enforce (fail without it) or off (do not request it)."
        ),
    ] = "auto",
    priority: Annotated[int, typer.Option(help="Priority under SCHED_FIFO.", min=1, max=99)] = 80,
    cpu: Annotated[int, typer.Option(help="CPU to pin the thread to; -1 for any.", min=-1)] = -1,
    stay_awake: Annotated[
        bool,
        typer.Option("--stay-awake/--no-stay-awake", help="Keep idle CPUs from sleeping."),
    ] = True,
    alone: Annotated[
        bool, typer.Option("--alone", help="Do not run cyclictest, even where it is installed.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Measure how late this machine wakes a real-time thread.

    If `cyclictest` (Debian: rt-tests) is installed, the two alternate every 2 s, with the same priority. On a virtual
    machine the longest delays come from the host.

    **Examples**

    * `ebac jitter --seconds 4`

    * `ebac jitter --seconds 4 --cpu 0`: on one CPU

    * `ebac jitter --seconds 4 --no-stay-awake`: the effect of letting idle CPUs sleep; cyclictest never lets them.
    """
    from ebac.realtime import RealTime, beside_cyclictest, measure
    from ebac.realtime.mode import MODES

    folder = to.folder("jitter", as_json=as_json)
    if realtime not in MODES:
        output.fail(unknown(f"--realtime {realtime}", realtime, MODES))
    interrupts.keeping("nothing was written; a shorter measurement: --seconds")
    with output.refusing():
        asked = RealTime(priority=priority, cpu=cpu, stay_awake=stay_awake)
        what: Any = {"seconds": seconds, "rate": rate, "mode": realtime, "options": asked}
        other: Cyclictest | None = None
        try:
            if alone:
                found = measure(**what)
            else:
                with output.counting("turns", quiet=as_json) as progress:
                    found, other = beside_cyclictest(**what, progress=progress)
        except RuntimeError as refused:
            output.fail(str(refused), code=output.FAILED)
    rows = [found.row()] + ([other.row()] if other else [])
    more = _more(found, rows, rate, realtime)
    figures: list[str] = []
    with output.results(folder) as draft:
        if draft is not None:
            from ebac.plot import plot_jitter

            figures = to.save(plot_jitter(found, other), draft, "jitter")
            text = output.document("jitter", rows, **more)
            (draft / "jitter.json").write_text(text + "\n", encoding="utf-8")
    if as_json:
        typer.echo(output.document("jitter", rows, **more))
        return
    _show(rows, found, more)
    if folder is not None:
        output.list_files(folder, [*figures, "jitter.json"])


def _more(found: Jitter, rows: list[dict[str, Any]], rate: float, mode: str) -> dict[str, Any]:
    from ebac.hardware.report import grant_row

    ratio = (
        rows[0]["p99_9_s"] / rows[1]["p99_9_s"] if len(rows) > 1 and rows[1]["p99_9_s"] else None
    )
    grants = [grant_row(grant) for grant in found.grants]
    return {"rate_Hz": rate, "mode": mode, "grants": grants, "times_cyclictest_p99_9": ratio}


def _show(rows: list[dict[str, Any]], found: Jitter, more: dict[str, Any]) -> None:
    heads = ["program", "wake-ups", "mean", "p50", "p99", "p99.9", "latest", "ticks skipped"]
    grid = output.table(heads, numbers=range(1, 8))
    for row in rows:
        times = [row[f"{name}_s"] for name in ("mean", "p50", "p99", "p99_9", "most")]
        skipped = "-" if row["skipped"] is None else f"{row['skipped']:,}"
        shown = [f"{1e6 * value:,.0f} µs" for value in times]
        grid.add_row(row["program"], f"{row['wakeups']:,}", *shown, skipped)
    output.show(grid)
    if more["times_cyclictest_p99_9"] is not None:
        output.say(f"p99.9 is {more['times_cyclictest_p99_9']:.2f} times that of cyclictest.")
    for grant in found.grants:
        if grant.granted:
            output.say(f"{grant.name}: {grant.asked}, granted")
    show_refused(found.grants)
