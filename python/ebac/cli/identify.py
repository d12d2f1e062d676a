"""`ebac identify`: from logs to models and gains."""

from __future__ import annotations

import typer

from ebac.cli import identify_arm, identify_check, identify_device, identify_gains, identify_log

app = typer.Typer(
    no_args_is_help=True,
    help="From logs to models and gains: the arm, the device, the force loop, and how far to trust them.",
)
app.command("arm")(identify_arm.arm)
app.command("device")(identify_device.device)
app.command("gains")(identify_gains.gains)
app.command("log")(identify_log.log)
app.command("check")(identify_check.check)
