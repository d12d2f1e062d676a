"""`ebac sensor bias`: what acts now is zero."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import output
from ebac.cli.sensor import options

if TYPE_CHECKING:
    from ebac.sensor import Sensor

_AXES = ("force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z")


def bias(
    which: options.SensorOptions,
    records: Annotated[
        int, typer.Option(help="Number of records to average.", min=1, max=1_000_000)
    ] = 500,
    inside: Annotated[
        bool,
        typer.Option(
            "--inside",
            help="Set the bias in the sensor itself, for every program, until it is switched off.",
        ),
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Measure the reading of the sensor with nobody at the handle, to be used as zero.

    The command prints the line with the mean to put under `[sensor]` in the configuration, so that every run starts
    from the same zero. With `--inside` the sensor's own software bias is set instead, and the table shows the
    remaining offset. Saturated records and those with an error do not count.

    **Examples**

    * `ebac sensor bias --host 192.168.1.1 --records 2000`

    * `ebac sensor bias --host 127.0.0.1 --inside`
    """
    found = options.configured(which)
    with options.opened(found.replace(bias=(0.0,) * 6), which.timeout) as sensor:
        if inside:
            _bias_inside(sensor, which.timeout)
        mean = sensor.bias(records, timeout=which.timeout)
    rows: list[dict[str, Any]] = [
        {"what": name, "value": value, "unit": "N" if name.startswith("force") else "N m"}
        for name, value in zip(_AXES, mean, strict=True)
    ]
    if as_json:
        more = {"host": found.host, "port": found.port, "records": records, "inside": inside}
        typer.echo(output.document("sensor bias", rows, **more))
        return
    grid = output.table(["in the sensor's axes", "mean", "unit"], numbers=[1])
    for row in rows:
        grid.add_row(row["what"].replace("_", " "), f"{row['value']:+.5f}", row["unit"])
    output.show(grid)
    if inside:
        output.say(f"The sensor takes this as zero now; {records} records, after its own bias.")
    else:
        output.say("To take this as zero, put under [sensor] of the configuration:")
        output.indented(f"bias = [{', '.join(f'{value:.6g}' for value in mean)}]")


def _bias_inside(sensor: Sensor, timeout: float) -> None:
    """Set the sensor's own bias, and let pass what it had measured before."""
    sensor.bias_inside()
    for _ in range(20):
        sensor.read(timeout)
