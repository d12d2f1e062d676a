"""The command `ebac`. Every command prints a table, or one JSON document with `--json`."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import bus, demo, drive, gastroscopy, identify, live, paper, sensor, teleop, track
from ebac.cli.bench import bench
from ebac.cli.catalogue import laws, presets, specs, worlds
from ebac.cli.command import Group, add
from ebac.cli.log import log
from ebac.cli.machine import doctor, jitter
from ebac.cli.run import run
from ebac.cli.studies import (
    ablation,
    conditions,
    engines,
    faults,
    maps,
    random_worlds,
    shapes,
    study,
    tissue,
    tune,
    worst,
    zwidth,
)
from ebac.cli.wall import wall

TRY, STUDY, DATA, HARDWARE, MACHINE = (
    "Try",
    "Study a controller",
    "Your data",
    "Hardware",
    "Machine",
)

app = typer.Typer(
    name="ebac",
    cls=Group,
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
    """Simulate and run haptic controllers: virtual walls, energy-bounding laws, a 1 kHz loop.

    Start with `ebac wall`: a hand against a virtual wall of 10 kN/m under four laws.

    Tables show mm, N, mJ, s and Hz. Options and `--json` are in SI units throughout.
    """


add(app, wall.wall, panel=TRY)
add(app, demo.demo, panel=TRY)
add(app, laws.laws, panel=TRY)
add(app, presets.presets, panel=TRY)
add(app, worlds.worlds, panel=TRY)
add(app, live.live, panel=TRY)
add(app, paper.paper, panel=TRY)
add(app, study.study, panel=STUDY)
add(app, conditions.conditions, panel=STUDY)
add(app, ablation.ablation, panel=STUDY)
add(app, worst.worst, panel=STUDY)
add(app, zwidth.zwidth, panel=STUDY)
add(app, tune.tune, panel=STUDY)
add(app, maps.map_, "map", panel=STUDY)
add(app, shapes.shapes, panel=STUDY)
add(app, random_worlds.random_worlds, panel=STUDY)
add(app, engines.engines, panel=STUDY)
add(app, tissue.tissue, panel=STUDY)
add(app, faults.faults, panel=STUDY)
app.add_typer(gastroscopy.app, name="gastroscopy", rich_help_panel=STUDY)
app.add_typer(teleop.app, name="teleop", rich_help_panel=STUDY)
app.add_typer(identify.app, name="identify", rich_help_panel=DATA)
add(app, track.track, panel=DATA)
app.add_typer(log.log, name="log", rich_help_panel=DATA)
add(app, run.run, panel=HARDWARE, defaults="as configured")
app.add_typer(drive.app, name="drive", rich_help_panel=HARDWARE)
app.add_typer(sensor.app, name="sensor", rich_help_panel=HARDWARE)
app.add_typer(bus.bus, name="bus", rich_help_panel=HARDWARE)
add(app, specs.specs, panel=HARDWARE)
add(app, doctor.doctor, panel=MACHINE)
add(app, jitter.jitter, panel=MACHINE)
add(app, bench.bench, panel=MACHINE)
