"""`ebac drive inject`: faults of simulated drives."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import output
from ebac.cli.drive.options import BusOptions, opened


def inject(
    where: BusOptions,
    fault: Annotated[
        list[str] | None,
        typer.Argument(
            help="over-voltage, under-voltage, short-circuit, over-temperature, motor-temperature, encoder-lost, "
            "brake-stuck, torque-off (STO), enable-missing, silent.",
            show_default="none: all are over",
        ),
    ] = None,
    node: Annotated[
        int, typer.Option("--node", "-n", help="Node id of the simulated drive.", min=1, max=127)
    ] = 1,
    as_json: output.AsJson = False,
) -> None:
    """Put a simulated drive into the named faults, and clear all others. Real drives are refused.

    **Examples**, with `ebac drive simulate` in another terminal

    * `ebac drive inject under-voltage --node 1 --interface socketcan --channel vcan0`

    * `ebac drive inject --interface ebac --channel joystick`: no fault
    """
    from ebac.drives import inject as put

    with opened(where) as bus:
        put(bus.drive(node, timeout=where.timeout), fault or [])
    if as_json:
        typer.echo(output.document("drive inject", [{"node": node, "faults": fault or []}]))
    else:
        output.say(f"Node {node}: {', '.join(fault) if fault else 'no fault is injected'}.")
