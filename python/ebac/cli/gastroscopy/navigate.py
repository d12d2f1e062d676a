"""`ebac gastroscopy`: from the teeth to the pylorus with three targets."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac._util.arguments import unknown
from ebac._util.headings import with_units
from ebac.cli import by_name, completion, options, output
from ebac.cli.files import PANEL, ResultOptions
from ebac.cli.gastroscopy.watch import watch
from ebac.cli.wall.results import log_names

if TYPE_CHECKING:
    from ebac._core import Master
    from ebac.gastroscope import Gastroscopy

MASTER = "Master"
LIVE = "Live"
INSERTION = ("pedals", "rate", "clutch")
BENDING = ("position", "rate")
#: Ticks from row to row of the record that lies in the folder.
EVERY = 10


@dataclass(frozen=True, kw_only=True)
class MasterOptions:
    """Mapping of the joystick, and the line."""

    insertion: Annotated[
        str,
        typer.Option(
            help="pedals, or the third axis as a rate or as a place with a clutch.",
            rich_help_panel=MASTER,
            autocompletion=completion.one_of(*INSERTION),
        ),
    ] = "rate"
    bending: Annotated[
        str,
        typer.Option(
            help="Whether the position of the handle commands a position or a rate.",
            rich_help_panel=MASTER,
        ),
    ] = "position"
    feedback: Annotated[
        float,
        typer.Option(
            min=0,
            max=10,
            help="Share of the force that is fed back; 0 for none.",
            rich_help_panel=MASTER,
        ),
    ] = 1.0

    def master(self, delay: float) -> Master:
        """Return the mapping."""
        from ebac._core import Master

        if self.insertion not in INSERTION:
            output.fail(unknown(f"--insertion {self.insertion}", self.insertion, INSERTION))
        if self.bending not in BENDING:
            output.fail(unknown(f"--bending {self.bending}", self.bending, BENDING))
        return Master(
            insertion=INSERTION.index(self.insertion),
            bend_by_rate=self.bending == "rate",
            feedback=self.feedback,
            delay=delay,
        )


def gastroscopy(
    ctx: typer.Context,
    to: ResultOptions,
    how: MasterOptions,
    law: Annotated[str, options.one_law(own=options.COMPILED)] = "ebac",
    delay: Annotated[
        float,
        typer.Option(
            min=0, max=2, help="Delay of the link in each direction [s].", rich_help_panel=MASTER
        ),
    ] = 0.0,
    heed: Annotated[
        float,
        typer.Option(
            min=0,
            max=100,
            help="Force on the hand at which the physician stops advancing [N]; 0 for never.",
        ),
    ] = 3.0,
    seconds: Annotated[float, typer.Option(help="Longest duration [s].")] = 120.0,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the physician.")] = 1,
    log: Annotated[
        Path | None,
        typer.Option(
            "--log",
            help="Also write a row for each tick to this file: .mcap (PlotJuggler, Foxglove, `ebac log`), .npz, .csv, "
            ".parquet, .mat or .h5.",
            show_default=False,
            rich_help_panel=PANEL,
        ),
    ] = None,
    live: Annotated[
        bool,
        typer.Option(
            "--live",
            help="Show it in a browser in real time: view from outside, camera image and forces. Writes no files.",
            rich_help_panel=LIVE,
        ),
    ] = False,
    port: Annotated[
        int,
        typer.Option(
            min=0, max=65535, help="With --live: port; 0 for a free one.", rich_help_panel=LIVE
        ),
    ] = 0,
    no_browser: Annotated[
        bool,
        typer.Option(
            "--no-browser", help="With --live: do not open a browser.", rich_help_panel=LIVE
        ),
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Run a gastroscopy: from the teeth to the pylorus, touching three targets.

    A simulation of joystick, hand and law as everywhere in `ebac`, a link with a delay, a gastroscope with its motors
    and tendons, a patient, and a physician who steers by the camera image. Its results do not apply to patients.

    **Examples**

    * `ebac gastroscopy --seconds 5`: the first five seconds

    * `ebac gastroscopy --live`: watch it in your browser

    * `ebac gastroscopy --delay 0.1 --law direct --seconds 5 --json`

    * `ebac gastroscopy --seconds 5 --log run.mcap`, then `ebac log info run.mcap`
    """
    if ctx.invoked_subcommand is not None:
        return
    from ebac.gastroscope import Physician, Procedure
    from ebac.gastroscope import gastroscopy as run
    from ebac.laws import law_name

    with output.refusing():
        wanted = by_name.any_law(law)
        procedure = Procedure(
            master=how.master(delay), physician=Physician(heed=heed), seconds=seconds, seed=seed
        )
        if live:
            if log is not None or to.out is not None:
                output.fail("--live: writes no files; leave --log and --out out")
            watch(wanted, procedure, port, no_browser=no_browser, as_json=as_json)
            return
        if port or no_browser:
            output.fail("--port and --no-browser belong to --live")
        folder = to.folder("gastroscopy", as_json=as_json)
        if log is not None:
            log_names(log, [law_name(wanted)], force=to.force)
        full = run(wanted, procedure, every=EVERY if log is None else 1)
    if log is not None:
        _write_log(full, log)
    found = full if log is None else full.thinned(EVERY)
    files = _write(folder, found, to) if folder else []
    if as_json:
        typer.echo(_document(found))
        return
    _show(found)
    if log is not None:
        output.path(log)
    if folder is not None:
        output.list_files(folder, files)


def _document(found: Gastroscopy) -> str:
    row = with_units(found.findings, found.units)
    return output.document("gastroscopy", [{"law": found.law, **row}])


def _write(folder: Path, found: Gastroscopy, to: ResultOptions) -> list[str]:
    from ebac.plot import plot_gastroscopy

    with output.results(folder) as draft:
        if draft is None:
            return []
        figures = to.save(plot_gastroscopy(found), draft, "gastroscopy")
        (draft / "gastroscopy.json").write_text(_document(found) + "\n", encoding="utf-8")
        found.save(draft / "gastroscopy.csv")
    return [*figures, "gastroscopy.json", "gastroscopy.csv"]


def _write_log(found: Gastroscopy, log: Path) -> None:
    with output.refusing(), output.writing(f"--log {log}"):
        found.save(log)


def _show(found: Gastroscopy) -> None:
    f, patient = found.findings, found.procedure.lumen.patient
    grid = output.table(["quantity", "value"], numbers=(1,))
    for name, value in (
        ("time", f"{f['seconds']:.1f} s"),
        ("pylorus", "passed" if f["reached"] else "not passed"),
        ("targets touched", f"{f['touched']:g} of {len(found.procedure.polyps())}"),
        ("way of the camera", f"{f['path']:.2f} m"),
        ("largest force, tip and bending section", f"{f['most_section']:.2f} N"),
        ("largest force, tube", f"{f['most_tube']:.2f} N"),
        ("force integrated", f"{f['impulse']:.1f} N s"),
        (f"time above {patient.force_limit:g} N", f"{f['over_limit']:.3f} s"),
        (f"times above {patient.perforation:g} N", f"{f['perforations']:g}"),
        ("largest force on the hand", f"{f['most_felt']:.2f} N"),
        ("least energy of the joystick's port", f"{1e3 * f['least_energy']:.1f} mJ"),
    ):
        grid.add_row(name, value)
    output.show(grid)
    output.say("Simulated, with measures and assumptions that the documentation names.")
