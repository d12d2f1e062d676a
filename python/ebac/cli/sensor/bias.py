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
        int, typer.Option(help="Records to take the mean of.", min=1, max=1_000_000)
    ] = 500,
    inside: Annotated[
        bool,
        typer.Option(
            "--inside",
            help="Have the sensor itself do it: for every program, until it loses its power.",
        ),
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Measure what the sensor shows with nobody at the handle, to be taken as zero.

    The mean goes into the configuration, so that every run starts from the same zero: the line to
    put under `[sensor]` is printed. With `--inside` the sensor's own software bias is set instead, and
    the table shows what is left. Saturated records and those with an error do not count.

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
