"""The options of `ebac sensor`: which sensor, and what its counts are worth."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import output, setting

if TYPE_CHECKING:
    from ebac.sensor import Sensor, SensorConfig

_SENSOR = "Sensor"


def _option(text: str, default: str | bool = False, **more: Any) -> Any:
    return typer.Option(help=text, show_default=default, rich_help_panel=_SENSOR, **more)


@dataclass(frozen=True, kw_only=True)
class SensorOptions:
    """Which sensor, what its counts are worth, and how long a record may take."""

    config: Annotated[
        Path | None,
        _option("A file in TOML with a table [sensor]; other options come on top."),
    ] = None
    host: Annotated[str | None, _option("Address or name of the sensor.", "192.168.1.1")] = None
    port: Annotated[int | None, _option("UDP port of the sensor.", "49152", min=1, max=65535)] = (
        None
    )
    model: Annotated[
        str | None, _option("Model, for its status bits: net-ft, axia, other.", "net-ft")
    ] = None
    page: Annotated[
        bool,
        typer.Option(
            "--page",
            help="Read the counts per unit from the sensor's own web page.",
            rich_help_panel=_SENSOR,
        ),
    ] = False
    http_port: Annotated[int, _option("Port of that page.", True, min=1, max=65535)] = 80
    timeout: Annotated[
        float, _option("How long the first record may take [s].", True, min=0.01, max=600)
    ] = 2.0


@contextmanager
def reporting() -> Iterator[None]:
    """Turn what goes wrong with a sensor into the end of the command."""
    from ebac.sensor import SensorError

    try:
        yield
    except SensorError as error:
        output.fail(str(error), code=output.FAILED)
    except OSError as error:
        output.fail(error.strerror or str(error), code=output.FAILED)


def configured(which: SensorOptions) -> SensorConfig:
    """Return the sensor that the options name, its counts from its page where that was asked."""
    from ebac.sensor import SensorConfig, read_page

    with output.refusing():
        base = SensorConfig() if which.config is None else _table(which.config)
        config = base.replace(**setting.given(host=which.host, port=which.port, model=which.model))
        config.core()  # looks the name up
    if which.page:
        with reporting():
            found = read_page(config.host, http_port=which.http_port, timeout=which.timeout)
        config = config.replace(
            counts_per_force=found.counts_per_force, counts_per_torque=found.counts_per_torque
        )
    return config


@contextmanager
def opened(config: SensorConfig, timeout: float) -> Iterator[Sensor]:
    """Give the open sensor; what goes wrong with it ends the command."""
    from ebac.sensor import Sensor

    with reporting(), Sensor.open(config, timeout=timeout) as sensor:
        yield sensor


def _table(file: Path) -> SensorConfig:
    from ebac._util.toml import parsed
    from ebac.sensor import SensorConfig

    try:
        text = parsed(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"--config {file}: is no TOML ({error})") from None
    table = text.get("sensor")
    if not isinstance(table, dict):
        raise ValueError(f"--config {file}: has no table [sensor]")
    try:
        return SensorConfig.from_table(table)
    except (TypeError, ValueError) as error:
        raise ValueError(f"--config {file}: {error}") from None
