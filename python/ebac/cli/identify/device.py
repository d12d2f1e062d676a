"""`ebac identify device`: mass, damping, friction and weight of a device."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output, setting
from ebac.cli.identify import options as given
from ebac.cli.identify import report as reporting

if TYPE_CHECKING:
    from ebac.identify import DeviceResult, Recording


def device(
    log: given.Log,
    reading: given.Reading,
    to: reporting.ReportOptions,
    scenario: Annotated[
        Path | None,
        typer.Option(
            help="A scenario, or a configuration of `ebac run`, in TOML with your device: the rotor of its motor is "
            "part of M_h, and not of handle_mass.",
            show_default="the device in the log, else the reference device",
            rich_help_panel=given.FIT,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Identify a device: mass, damping, Coulomb and Stribeck friction, weight, and tau_static of eq. (2).

    The log must contain the position and the force that moves the device to and fro, of the motor or of the hand.

    **Examples**

    * `ebac demo device`, then `ebac identify device device.csv`

    * `ebac identify device device.csv --out report`: with a page and figures

    Exit code 1 when the result is not a plausible device, such as one with negative friction; the message names the
    sign that fits.
    """
    from ebac.identify import fit_device
    from ebac.identify.device_lag import sensor_lag

    to.folder()
    with output.refusing():
        recording = reading.load(log)
        rotor = _rotor(recording, scenario)
        result = fit_device(recording)
        late = sensor_lag(result) if reading.lag is None else None
    table = _tables(result, *rotor)
    notes = [*_notes(result), *([] if late is None else [late.sentence])]
    files = _write(to, result, notes, table)
    if as_json:
        more = result.to_dict()
        rows = more.pop("rows")
        typer.echo(
            output.document(
                "identify device",
                rows,
                **more,
                remarks=list(recording.remarks),
                lag_seems_s=None if late is None else late.lag,
                device_toml=table or None,
            )
        )
        _end(result)
        return
    for text in recording.remarks:
        output.say(text, style="dim")
    grid = output.table(["", "estimate", "95 % interval", "unit", ""], numbers=(1, 2))
    for e in result.estimates.values():
        word = "" if e.determined else "[red]not determined[/]"
        grid.add_row(e.name, f"{e.value:.4g}", f"{e.low:.4g} to {e.high:.4g}", e.unit, word)
    output.show(output.filled(grid))
    for text in notes:
        if not (result.impossible and text in result.misses):  # the error says it
            output.say(text)
    if table:
        output.say(f"handle_mass is M_h less {rotor[0]:.4g} kg, the rotor {rotor[1]}.")
        output.say("In the file of the device:")
        typer.echo(textwrap.indent(table, "  "))  # no line of it may be broken
    if to.out is not None:
        output.list_files(to.out, files)
    _end(result)


def _end(result: DeviceResult) -> None:
    """End with an error where no device is like that."""
    if result.impossible:
        output.fail(f"{result.recording.name}: {' '.join(result.misses)}", code=output.FAILED)


def _notes(result: DeviceResult) -> list[str]:
    effort = "torque" if result.recording.rotary else "force"
    share = f"{100 * result.drive.slides.mean():.0f} % of the log"
    explained = (
        f"Explains {100 * result.explained:.2f} % of the {effort} where it slides, {share}."
        if result.explained > 0
        else f"Explains nothing of the {effort} where it slides, {share}: "
        f"eq. (6) with these {effort}s is no model of it."
    )
    alone = f"The log has no {effort} of the motor: true only of a device whose motor gave none."
    return [
        *(result.misses or [explained]),
        *([alone] if result.recording.motor is None else []),
    ]


def _rotor(recording: Recording, file: Path | None) -> tuple[float, str]:
    """Return the share of the mass that is the rotor [kg], and whose it is: of the file, the log, or the reference."""
    if file is not None:
        return setting.device_base(file).device.reflected_mass, f"of {file}"
    if recording.rotor is not None:
        return recording.rotor, "of the device in the log"
    return (
        setting.base_scenario(None).device.reflected_mass,
        "of the reference device, --scenario FILE takes yours",
    )


def _tables(result: DeviceResult, rotor: float, whose: str) -> str:
    """Return what was found as tables of a device file; "" for a joint, and where no device is like that.

    Damping and friction are those that are surely there, because laws and observer count with them; what a motor
    carries and compensates is at most that.
    """
    if result.recording.rotary or result.impossible:
        return ""
    lines = ["[device.mechanics]"]
    handle = 0.0  # kg
    for name, key in (("M_h", "handle_mass"), ("B_h", "damping"), ("coulomb", "coulomb")):
        found = result.estimates.get(name)
        if found is None:
            continue
        value, why = (
            found.low,
            ", the lower end of the interval" + ", not below 0" * (found.low < 0),
        )
        if name == "M_h":
            value, why = found.value - rotor, ": M_h less the rotor"
            handle = value if found.determined else 0.0
        if not found.determined:
            lines.append(f"# {key}: {name} is not determined by this log")
        elif name == "M_h" and value <= 0:
            lines.append(
                f"# {key}: M_h = {found.value:.4g} kg is less than {rotor:.4g} kg, the rotor {whose}"
            )
        else:
            lines.append(f"{key} = {max(value, 0.0):.4g} # {found.unit}{why}")
    weight = result.estimates["weight"]
    static = result.compensation
    carried = static.gravity_mass * result.gravity  # N
    gravity = weight.value / handle if carried and handle > 0 else result.gravity
    if carried:
        lines.append(f"gravity = {gravity:.4g} # m/s^2: with it the handle weighs what was found")
    compensated = []
    if static.friction > 0:
        compensated.append(f"friction = {static.friction:.4g} # N, as coulomb")
    if carried:
        least = f"kg: times gravity {abs(carried):.4g} N, the least weight"
        compensated.append(f"gravity_mass = {carried / gravity:.4g} # {least}")
    if compensated:
        lines += [
            "# The motors carry weight and friction, whatever the law does, where these lines count:",
            *(f"# {line}" for line in ("[device.compensation]", *compensated)),
        ]
    return "\n".join(lines)


def _write(
    to: reporting.ReportOptions, result: DeviceResult, said: list[str], table: str
) -> list[str]:
    from ebac.identify.figures import plot_device

    return reporting.report(
        to,
        "device",
        title="The device of eq. (6)",
        rows=[reporting.line(e) for e in result.estimates.values()],
        careful=[f"{name} is not determined by this log." for name in result.undetermined],
        notes=[*result.recording.remarks, *said, *([table] if table else [])],
        draw=[lambda: plot_device(result)],
    )
