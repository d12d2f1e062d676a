"""`ebac teleop endurance`: three processes, a link that is cut again and again, memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import completion, options, output
from ebac.cli.teleop.options import NAMES

if TYPE_CHECKING:
    from ebac.teleop import Endurance


def endurance(
    seconds: Annotated[float, typer.Option(help="Length [s].", min=5, max=86400)] = 600.0,
    scheme: Annotated[
        str,
        typer.Option(help=f"Scheme: {NAMES}.", autocompletion=completion.schemes),
    ] = "ebac",
    delay: Annotated[
        float, typer.Option(help="Delay in each direction [s].", min=0, max=0.3)
    ] = 0.05,
    loss: Annotated[float, typer.Option(help="Share of packets lost.", min=0, max=1)] = 0.05,
    cut_every: Annotated[
        float,
        typer.Option(help="Interval between cuts of the link [s]; 0 for none.", min=0, max=1e6),
    ] = 20.0,
    cut_length: Annotated[
        float, typer.Option(help="Length of each cut [s].", min=0, max=1e6)
    ] = 2.0,
    seed: options.Seed = None,
    as_json: output.AsJson = False,
) -> None:
    """Run master, network and slave as three processes with link cuts; check forces, positions, messages and memory.

    The hand swings the stick and consents 1 s after the link is back. Exit code 1 when a lost link was not reported,
    a force or position exceeded its limit, or the memory of master or slave grew by more than 1 MB over the last two
    thirds of the run (of the network, whose queues fill, by 10 MB); the first 10 s do not count.

    **Examples**

    * `ebac teleop endurance`

    * `ebac teleop endurance --seconds 6 --cut-every 4 --cut-length 1 --json`
    """
    from ebac import teleop

    with output.refusing():
        link = teleop.Link(
            delay=delay,
            jitter=0.01,
            loss=loss,
            corrupt=0.01,
            cut_every=cut_every,
            cut_length=cut_length,
        )
        found = teleop.endurance(
            seconds, scheme=scheme, link=link, seed=1 if seed is None else seed
        )
    rows = [_row(found, name) for name in found.reports]
    if as_json:
        typer.echo(output.document("teleop endurance", rows, faults=found.faults))
    else:
        _show(rows, found.faults)
    if found.faults:
        raise typer.Exit(1)


def _row(found: Endurance, name: str) -> dict[str, Any]:
    report = {key: value for key, value in found.reports[name].items() if key != "command"}
    return {
        "process": name,
        **report,
        "reported": found.reported[name],
        "memory_B": max(found.memory[name], default=0),
        "growth_B": found.growth(name),
        "events": [{"t_s": t, "text": text} for t, text in found.events.get(name, [])],
    }


def _show(rows: list[dict[str, Any]], faults: list[str]) -> None:
    from ebac._util.formatting import quantity

    columns = ["process", "lost", "reported", "largest force", "at", "farthest", "memory", "growth"]
    grid = output.table(columns, numbers=range(1, 8))
    for row in rows:
        grid.add_row(
            row["process"],
            "-" if row["losses"] is None else str(row["losses"]),
            str(row["reported"]),
            quantity(row["most_force_N"], "N"),
            quantity(row["most_force_at_s"], "s"),
            quantity(row["farthest_m"], "m"),
            f"{row['memory_B'] / 1e6:.1f} MB",
            f"{row['growth_B'] / 1e3:.0f} kB",
        )
    output.show(grid)
    for fault in faults:
        output.say(f"Fault: {fault}")
    output.say(
        f"{output.plural(len(faults), 'fault')}. Simulated stick, hand and slave; UDP of this machine."
    )
