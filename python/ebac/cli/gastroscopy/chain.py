"""`ebac gastroscopy drives`: joystick, network and gastroscope as three processes, on simulated drives."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ebac.cli import by_name, options, output
from ebac.cli.gastroscopy.drives import GiveUp, check_law
from ebac.cli.gastroscopy.side_table import show
from ebac.cli.teleop.options import LinkOptions


def drives(
    over: LinkOptions,
    law: Annotated[
        str | None, options.one_law(default="as configured", own=options.COMPILED)
    ] = None,
    seconds: Annotated[
        float, typer.Option(help="How long the joystick has power [s].", min=1, max=3600)
    ] = 30.0,
    give_up: GiveUp = 10.0,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for the logs of all drives.", show_default="none"),
    ] = None,
    seed: options.Seed = None,
    as_json: output.AsJson = False,
) -> None:
    """Run joystick, network and gastroscope as three processes, on simulated drives: bus, network, bus.

    A simulated hand bends the tip to and fro and advances it; it consents 1 s after a lost link is back. Exit code 1
    when a lost link was not reported, a drive kept its power, or a side ended for another reason than its own time or
    the end of the master.

    **Examples**

    * `ebac gastroscopy drives --seconds 10`

    * `ebac gastroscopy drives --seconds 10 --delay 0.1 --jitter 0.01 --loss 0.05 --cut-every 6 --cut-length 1 --json`
    """
    from ebac.gastroscope.chain import chain
    from ebac.gastroscope.on_drives import configuration

    with output.refusing():
        if law is not None:  # whose word the joystick's process reads again
            check_law(by_name.any_law(law), configuration("master"))
        found = chain(
            seconds,
            link=over.link(),
            law=law,
            give_up=give_up,
            folder=out,
            seed=1 if seed is None else seed,
        )
    rows = [{"process": name, **one} for name, one in found.reports.items()]
    if as_json:
        typer.echo(output.document("gastroscopy drives", rows, faults=found.faults))
    else:
        show(found.reports, found.faults)
        if out is not None:
            output.list_files(out, sorted(one.name for one in out.glob("*.mcap")))
    if found.faults:
        raise typer.Exit(1)
