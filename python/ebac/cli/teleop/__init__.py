"""`ebac teleop`: a master and a slave through a network."""

from __future__ import annotations

import typer

from ebac.cli.command import Group, add
from ebac.cli.teleop import endurance, processes, run, study

app = typer.Typer(
    name="teleop",
    cls=Group,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    help="Teleoperation with delay: simulate schemes, or run master, network and slave over UDP.",
)
add(app, run.run)
add(app, study.study)
add(app, endurance.endurance)
add(app, processes.master)
add(app, processes.network)
add(app, processes.slave)
