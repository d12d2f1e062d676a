"""`ebac drive`: look at CANopen drives, set them up, take it back, power them."""

from __future__ import annotations

import typer

from ebac.cli import drive_look, drive_power, drive_setup, drive_simulate

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def drive() -> None:
    """Look at CANopen drives, set them up from a profile, take it back, power them.

    Which bus: `--interface` and `--channel`, or python-can's own configuration (CAN_INTERFACE and
    CAN_CHANNEL, or ~/.canrc). `ebac drive simulate` puts simulated drives on one; `--interface ebac
    --channel joystick` is a bus within the process, with new simulated drives for every command.

    **In this order**, on a new machine

    * `ebac drive scan`: who answers?

    * `ebac drive plan joystick`: what would change? Nothing is written.

    * `ebac drive apply joystick`, then `ebac drive verify joystick`; `ebac drive restore` takes it back.

    * `ebac drive enable --node 1`: power on the motor, at zero torque; `ebac drive disable`.
    """


app.command()(drive_look.scan)
app.command()(drive_look.show)
app.command()(drive_look.plan)
app.command()(drive_setup.apply)
app.command()(drive_look.verify)
app.command()(drive_setup.restore)
app.command()(drive_power.enable)
app.command()(drive_power.disable)
app.command("reset-fault")(drive_power.reset_fault)
app.command()(drive_simulate.simulate)
