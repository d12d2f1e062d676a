"""`ebac sensor`: the force/torque sensor at the handle."""

from __future__ import annotations

import typer

from ebac.cli import sensor_bias, sensor_read, sensor_simulate

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode="markdown",
    help="The force/torque sensor: ATI Net F/T and what speaks like it, over UDP (RDT).",
)
app.command("read")(sensor_read.read)
app.command("bias")(sensor_bias.bias)
app.command("simulate")(sensor_simulate.simulate)
