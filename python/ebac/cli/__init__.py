"""The command `ebac`. Every command prints a table, or one JSON document with `--json`."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import (
    ablation,
    bench,
    bus,
    conditions,
    doctor,
    drive,
    faults,
    identify,
    jitter,
    laws,
    log,
    maps,
    paper,
    presets,
    run,
    sensor,
    specs,
    study,
    track,
    wall,
    worst,
    zwidth,
)

app = typer.Typer(
    name="ebac",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    pretty_exceptions_show_locals=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from ebac import __version__

        typer.echo(f"ebac {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    """Stable haptic rendering with energy-bounding control, simulated at 1 kHz.

    Start with **ebac wall**: the paper's virtual wall of 10 kN/m under three laws.

    Tables show mm, N, mJ, s and Hz; options and `--json` are in SI units throughout.
    """


app.command("wall")(wall.wall)
app.command("study")(study.study)
app.command("ablation")(ablation.ablation)
app.command("worst")(worst.worst)
app.command("conditions")(conditions.conditions)
app.command("zwidth")(zwidth.zwidth)
app.command("map")(maps.map_)
app.command("track")(track.track)
app.command("run")(run.run)
app.command("paper")(paper.paper)
app.command("laws")(laws.laws)
app.command("specs")(specs.specs)
app.command("presets")(presets.presets)
app.command("bench")(bench.bench)
app.command("doctor")(doctor.doctor)
app.command("jitter")(jitter.jitter)
app.command("faults")(faults.faults)
app.add_typer(drive.app, name="drive")
app.add_typer(bus.bus, name="bus")
app.add_typer(sensor.app, name="sensor")
app.add_typer(identify.app, name="identify")
app.add_typer(log.log, name="log")
