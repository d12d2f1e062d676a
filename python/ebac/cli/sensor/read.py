"""`ebac sensor read`: what the sensor measures, live or as rows."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from math import inf
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import output
from ebac.cli.sensor import options

if TYPE_CHECKING:
    from rich.console import RenderableType

    from ebac.sensor import Sensor, SensorConfig

#: Length of a reading as JSON [s], where none is given.
_BRIEF = 1.0
#: How long records may wait [s]: a queue of the system holds some 250.
_SLICE = 0.01


def read(
    which: options.SensorOptions,
    seconds: Annotated[
        float | None,
        typer.Option(
            help="Stop after this time [s].",
            show_default="until Ctrl-C; 1 with --json",
            min=0,
            max=1e7,
        ),
    ] = None,
    rate: Annotated[float, typer.Option(help="Rows per second [Hz].", min=0.1, max=1000)] = 10.0,
    as_json: output.AsJson = False,
) -> None:
    """Show force and torque at the handle, their age, and the number of lost packets.

    A sensor streams to one program at a time: this command takes the stream from a running loop, which then stops
    with the fault FORCE_STALE.

    **Examples**

    * `ebac sensor read --host 192.168.1.1 --page`

    * `ebac sensor simulate --hand-force 3 0 0`, and in another terminal `ebac sensor read --host 127.0.0.1`

    * `ebac sensor read --host 127.0.0.1 --seconds 2 --rate 100 --json > force.json`
    """
    found = options.configured(which)
    if seconds is None:
        seconds = _BRIEF if as_json else inf
    rows: list[dict[str, Any]] = []
    with options.opened(found, which.timeout) as sensor:
        begun, before = time.monotonic(), sensor.counts.received
        with _view(shown=not as_json) as show:
            try:
                for now in _ticks(sensor, begun, seconds, rate):
                    row = {"t_s": now - begun, **sensor.latest.row(), **sensor.counts.row()}
                    if as_json:
                        rows.append(row)
                    else:
                        show(_picture(found, sensor, row))
            except KeyboardInterrupt:
                pass
        counts, state = sensor.counts, sensor.state.name.lower()
        lasted = time.monotonic() - begun
    if as_json:
        more = {
            "host": found.host,
            "port": found.port,
            "counts_per_force_per_N": found.counts_per_force,
            "counts_per_torque_per_Nm": found.counts_per_torque,
            "state": state,
            "records_per_s": (counts.received - before) / lasted if lasted > 0 else None,
        }
        typer.echo(output.document("sensor read", rows, **more))
    else:
        output.say(
            f"{output.plural(counts.received, 'record')} in {lasted:.1f} s; {counts.lost:,} lost, "
            f"{counts.late:,} late, {counts.duplicate:,} doubled, {counts.malformed:,} malformed, "
            f"{counts.foreign:,} foreign."
        )


def _ticks(sensor: Sensor, begun: float, seconds: float, rate: float) -> Iterator[float]:
    """Give the time at each tick, at the first at once. Reads in between, so that no queue runs over."""
    for tick in count():
        if tick / rate > seconds:
            return
        while (left := begun + tick / rate - time.monotonic()) > 0:
            time.sleep(min(left, _SLICE))
            sensor.latest  # noqa: B018
        yield time.monotonic()


@contextmanager
def _view(*, shown: bool) -> Iterator[Callable[[RenderableType], None]]:
    """Give what shows a picture; the last one stays, and is all there is where nobody looks."""
    console = output.console()
    if shown and console.is_terminal:
        from rich.live import Live

        with Live(console=console, auto_refresh=False) as live:
            yield lambda picture: live.update(picture, refresh=True)
        return
    last: list[RenderableType] = []

    def keep(picture: RenderableType) -> None:
        last[:] = [picture]

    yield keep
    if shown and last:
        console.print(last[0])


def _picture(config: SensorConfig, sensor: Sensor, row: dict[str, Any]) -> RenderableType:
    from rich.console import Group
    from rich.text import Text

    from ebac.sensor import explain

    grid = output.table(["", "x", "y", "z", "unit"], numbers=range(1, 4))
    for what, unit, digits in (("force", "N", 3), ("torque", "Nm", 4)):
        numbers = [f"{row[f'{what}_{axis}_{unit}']:+.{digits}f}" for axis in "xyz"]
        grid.add_row(what, *numbers, "N m" if unit == "Nm" else unit)
    causes = "; ".join(explain(row["status"], config.model))
    health = row["health"] + (f" ({causes})" if causes else "")
    good = row["health"] == "good"
    lines = [
        Text(
            f"{config.host}:{config.port}, {sensor.state.name.lower()}, {1e3 * row['age_s']:.1f} ms old"
        ),
        Text(f"the sensor is {health}", style="" if good else "bold red"),
        Text(
            f"{output.plural(row['received'], 'record')}, {row['lost']:,} lost",
            style="" if not row["lost"] else "yellow",
        ),
    ]
    return Group(grid, *lines)
