"""The command `ebac`. Every command prints a table, or one JSON document with `--json`."""

from __future__ import annotations

import warnings
from typing import Annotated, Any, ClassVar

import typer

from ebac.cli.by_need import GroupByNeed, Place

TRY, STUDY, DATA, HARDWARE, MACHINE = (
    "Try",
    "Study a controller",
    "Your data",
    "Hardware",
    "Machine",
)


class Ebac(GroupByNeed):
    """The command `ebac`."""

    places: ClassVar = {
        "wall": Place(TRY, "wall.wall:wall"),
        "demo": Place(TRY, "demo:demo"),
        "laws": Place(TRY, "catalogue.laws:laws"),
        "presets": Place(TRY, "catalogue.presets:presets"),
        "worlds": Place(TRY, "catalogue.worlds:worlds"),
        "live": Place(TRY, "live:live"),
        "paper": Place(TRY, "paper:paper"),
        "study": Place(STUDY, "studies.study:study"),
        "conditions": Place(STUDY, "studies.conditions:conditions"),
        "ablation": Place(STUDY, "studies.ablation:ablation"),
        "stiffest": Place(STUDY, "studies.stiffest:stiffest"),
        "worst": Place(STUDY, "studies.worst:worst"),
        "zwidth": Place(STUDY, "studies.zwidth:zwidth"),
        "tune": Place(STUDY, "studies.tune:tune"),
        "map": Place(STUDY, "studies.maps:map_"),
        "shapes": Place(STUDY, "studies.shapes:shapes"),
        "random-worlds": Place(STUDY, "studies.random_worlds:random_worlds"),
        "engines": Place(STUDY, "studies.engines:engines"),
        "tissue": Place(STUDY, "studies.tissue:tissue"),
        "faults": Place(STUDY, "studies.faults:faults"),
        "gastroscopy": Place(STUDY, "gastroscopy:app"),
        "teleop": Place(STUDY, "teleop:app"),
        "identify": Place(DATA, "identify:app"),
        "track": Place(DATA, "track:track"),
        "log": Place(DATA, "log.log:log"),
        "run": Place(HARDWARE, "run.run:run", defaults="as configured"),
        "keys": Place(HARDWARE, "catalogue.keys:keys"),
        "drive": Place(HARDWARE, "drive:app"),
        "sensor": Place(HARDWARE, "sensor:app"),
        "bus": Place(HARDWARE, "bus:bus"),
        "specs": Place(HARDWARE, "catalogue.specs:specs"),
        "doctor": Place(MACHINE, "machine.doctor:doctor"),
        "jitter": Place(MACHINE, "machine.jitter:jitter"),
        "bench": Place(MACHINE, "bench.bench:bench"),
    }


app = typer.Typer(
    name="ebac",
    cls=Ebac,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    pretty_exceptions_show_locals=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
Ebac.app = app


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
    warnings.showwarning = _noted


_plain = warnings.showwarning


def _noted(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
    """Print what the library warns of as every other note, without the line of code."""
    from ebac.cli import output

    if issubclass(category, UserWarning):
        output.note(str(message).removesuffix("."))
    else:
        _plain(message, category, *where, **more)
