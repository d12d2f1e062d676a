"""`ebac drive`: look at CANopen drives, set them up, take it back, power them."""

from __future__ import annotations

import typer

from ebac.cli.command import Group, add
from ebac.cli.drive import enable as drive_power
from ebac.cli.drive import inject as drive_inject
from ebac.cli.drive import look, setup
from ebac.cli.drive import profile as drive_profile
from ebac.cli.drive import signs as drive_signs
from ebac.cli.drive import simulate as drive_simulate
from ebac.cli.drive import zero as drive_zero

app = typer.Typer(
    cls=Group,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def drive() -> None:
    """Scan, set up and power CANopen drives.

    `--interface` and `--channel` select the bus, or python-can's own configuration (CAN_INTERFACE and CAN_CHANNEL, or
    ~/.canrc). `ebac drive simulate` puts simulated drives on a bus; `--interface ebac --channel joystick` is a bus
    within the process, with new simulated drives for every command.

    **Examples**, in this order on a new machine; here with simulated drives

    * `ebac drive scan --interface ebac --channel joystick`: which drives answer

    * `ebac drive plan joystick --interface ebac --channel joystick`: what would be changed

    * `ebac drive apply joystick --yes --interface ebac --channel joystick`: write the settings. A real drive keeps
      them; these simulated ones are gone when the command ends
    """


add(app, drive_profile.profile)
add(app, look.scan)
add(app, look.show)
add(app, look.plan)
add(app, look.timing)
add(app, setup.apply)
add(app, look.verify)
add(app, setup.restore)
add(app, drive_power.enable)
add(app, drive_power.disable)
add(app, drive_power.reset_fault)
add(app, drive_signs.signs)
add(app, drive_zero.zero)
add(app, drive_simulate.simulate)
add(app, drive_inject.inject)
