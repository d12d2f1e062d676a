"""`ebac sensor`: the force/torque sensor at the handle."""

from __future__ import annotations

import typer

from ebac.cli.command import Group, add
from ebac.cli.sensor import bias as sensor_bias
from ebac.cli.sensor import read as sensor_read
from ebac.cli.sensor import simulate as sensor_simulate

app = typer.Typer(
    cls=Group,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    help="Read, zero and simulate a force/torque sensor.",
)
add(app, sensor_read.read)
add(app, sensor_bias.bias)
add(app, sensor_simulate.simulate)
