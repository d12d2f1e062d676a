"""`ebac identify`: from logs to models and gains."""

from __future__ import annotations

import typer

from ebac.cli.command import Group, add
from ebac.cli.identify import arm, check, device, gains, log, scale

app = typer.Typer(
    cls=Group,
    no_args_is_help=True,
    help="Identify arm, device and gains from recorded logs.",
)
add(app, arm.arm)
add(app, device.device)
add(app, gains.gains)
add(app, scale.scale)
add(app, log.log)
add(app, check.check)
