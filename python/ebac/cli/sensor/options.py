"""The options of `ebac sensor`: which sensor, and what its counts are worth."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from ebac.cli import output, setting

if TYPE_CHECKING:
    from ebac.sensor import Sensor, SensorConfig

_SENSOR = "Sensor"


def _option(text: str, default: str, **more: Any) -> Any:
    return typer.Option(help=text, show_default=default, rich_help_panel=_SENSOR, **more)


Config: TypeAlias = Annotated[
    Path | None,
    _option("A file in TOML with a table [sensor]; other options come on top.", "none"),
]
Host: TypeAlias = Annotated[str | None, _option("Address or name of the sensor.", "192.168.1.1")]
Port: TypeAlias = Annotated[int | None, _option("Its UDP port.", "49152", min=1, max=65535)]
Model: TypeAlias = Annotated[
    str | None, _option("Whose status bits it has: net-ft, axia, other.", "net-ft")
]
Page: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--page",
        help="Take the counts of a unit from the sensor's own page.",
        rich_help_panel=_SENSOR,
    ),
]
HttpPort: TypeAlias = Annotated[
    int, typer.Option(help="Port of that page.", min=1, max=65535, rich_help_panel=_SENSOR)
]
Timeout: TypeAlias = Annotated[
    float,
    typer.Option(
        help="How long the first record may take [s].",
        min=0.01,
        max=600,
        rich_help_panel=_SENSOR,
    ),
]


@contextmanager
def telling() -> Iterator[None]:
    """Turn what goes wrong with a sensor into the end of the command."""
    from ebac.sensor import SensorError

    try:
        yield
    except SensorError as error:
        output.fail(str(error), code=output.FAILED)
    except OSError as error:
        output.fail(error.strerror or str(error), code=output.FAILED)


def configured(
    file: Path | None,
    host: str | None,
    port: int | None,
    model: str | None,
    page: bool,
    http_port: int,
    timeout: float,
) -> SensorConfig:
    """Return the sensor that the options name, its counts from its page where that was asked."""
    from ebac.sensor import SensorConfig, read_page

    with output.refusing():
        base = SensorConfig() if file is None else _table(file)
        config = base.replace(**setting.given(host=host, port=port, model=model))
        config.core()  # looks the name up
    if page:
        with telling():
            found = read_page(config.host, http_port=http_port, timeout=timeout)
        config = config.replace(
            counts_per_force=found.counts_per_force, counts_per_torque=found.counts_per_torque
        )
    return config


@contextmanager
def opened(config: SensorConfig, timeout: float) -> Iterator[Sensor]:
    """Give the open sensor; what goes wrong with it ends the command."""
    from ebac.sensor import Sensor

    with telling(), Sensor.open(config, timeout=timeout) as sensor:
        yield sensor


def _table(file: Path) -> SensorConfig:
    from ebac.sensor import SensorConfig
    from ebac.toml_text import parsed

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
