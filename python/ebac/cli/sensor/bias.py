"""`ebac sensor bias`: what acts now is zero."""

from __future__ import annotations

from math import hypot
from typing import Annotated, Any

import typer

from ebac.cli import output
from ebac.cli.sensor import options

#: Largest force that is taken as zero without a word [N]: the observer falls back where the zero is wrong by as much.
_SILENT = 0.2
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
    accept_load: Annotated[
        bool,
        typer.Option(
            "--accept-load",
            help="Take a load as zero that is more than 5 % of the range, such as a heavy handle.",
        ),
    ] = False,
    accept_unsteady: Annotated[
        bool,
        typer.Option(
            "--accept-unsteady",
            help="Take the mean of a reading as zero that is not still, such as that of a noisy sensor.",
        ),
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Measure the reading of the sensor with nobody at the handle, to be used as zero.

    The table shows the reading before and after. Refused, with exit code 1, are a load of more than 5 % of the range
    and a reading whose standard deviation is more than 0.1 % of it, as with a hand at the handle. The range is
    `force_range` and `torque_range` in `[sensor]`; where these are 0, it is 145 N and 5 N m.

    The command prints the line with the mean to put under `[sensor]` in the configuration, so that every run starts
    from the same zero. With `--inside` the sensor's own software bias is set instead. Saturated records and those
    with an error do not count. A note says so when the new zero is more than 0.2 N from the one before.

    **Examples**

    * `ebac sensor bias --host 192.168.1.1 --records 2000`

    * `ebac sensor bias --host 127.0.0.1 --inside`

    * `ebac sensor bias --host 127.0.0.1 --accept-load`: with a heavy tool that stays at the handle
    """
    found = options.configured(which)
    if inside:  # what this program took off would be taken off twice
        found = found.replace(bias=(0.0,) * 6)
    accepted = {"accept_load": accept_load, "accept_unsteady": accept_unsteady}
    with options.opened(found, which.timeout) as sensor:
        before = sensor.rest(records, timeout=which.timeout)
        if inside:
            sensor.bias_inside(records, timeout=which.timeout, **accepted)
            for _ in range(20):  # what it had measured before
                sensor.read(which.timeout)
            mean = None
        else:
            mean = sensor.bias(records, timeout=which.timeout, **accepted)
        after = sensor.rest(records, timeout=which.timeout)
    _note_zero(hypot(*before.mean[:3]), beyond=any(found.bias))
    rows: list[dict[str, Any]] = [
        {
            "what": name,
            "value": zero,
            "before": was,
            "after": now,
            "unit": "N" if name.startswith("force") else "N m",
        }
        for name, zero, was, now in zip(
            _AXES, mean or after.mean, before.mean, after.mean, strict=True
        )
    ]
    if as_json:
        more = {"host": found.host, "port": found.port, "records": records, "inside": inside}
        typer.echo(output.document("sensor bias", rows, **more))
        return
    grid = output.table(["in the sensor's axes", "before", "after", "unit"], numbers=[1, 2])
    for row in rows:
        grid.add_row(
            row["what"].replace("_", " "),
            f"{row['before']:+.5f}",
            f"{row['after']:+.5f}",
            row["unit"],
        )
    output.show(grid)
    output.say(
        f"Standard deviation before: {before.force_spread:.4f} N, {before.torque_spread:.5f} N m."
    )
    if mean is None:
        output.say(
            "The sensor itself takes this as zero now, for every program, until it is switched off."
        )
    else:
        output.say("To take this as zero, put under [sensor] of the configuration:")
        output.indented(f"bias = [{', '.join(f'{value:.6g}' for value in mean)}]")


def _note_zero(force: float, *, beyond: bool) -> None:
    """Note which force is taken as zero, where it may be that of a hand; `beyond` is a bias in the configuration."""
    if force > _SILENT:
        more = " beyond the bias of the configuration" if beyond else ""
        output.note(
            f"a force of {force:.2f} N{more} is taken as zero; make sure that nobody touches the handle. Where the "
            f"zero is wrong by {_SILENT:g} N or more, `ebac` with the observer falls back at contacts right after the "
            "start of a run"
        )
