"""`ebac gastroscopy study`: feedback, laws and delays over simulated physicians."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import by_name, options, output
from ebac.cli.files import ResultOptions
from ebac.cli.gastroscopy.navigate import MasterOptions

if TYPE_CHECKING:
    from ebac.gastroscope import GastroscopyStudy


def study(
    to: ResultOptions,
    how: MasterOptions,
    law: Annotated[list[str] | None, options.laws("direct, ebac")] = None,
    delay: Annotated[
        list[float] | None,
        typer.Option(
            help="Delay of the link in each direction [s]; several separated by commas.",
            show_default="0, 0.05, 0.1",
        ),
    ] = None,
    physicians: Annotated[
        int, typer.Option(min=2, max=10000, help="Physicians in each cell.")
    ] = 100,
    heed: Annotated[
        float,
        typer.Option(
            min=0,
            max=100,
            help="Force on the hand at which a physician stops advancing [N]; 0 for never.",
        ),
    ] = 3.0,
    seconds: Annotated[float, typer.Option(help="Longest duration of a run [s].")] = 120.0,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the population.")] = 1,
    threads: options.Threads = None,
    as_json: output.AsJson = False,
) -> None:
    """Compare gastroscopies with and without force feedback over simulated physicians.

    Each physician runs every law at every delay without and with feedback. The tables show duration, distance,
    largest and integrated force on the tissue, perforations and energy, and the effect of feedback with its
    confidence interval and statistical power. The joystick has three straight axes here.

    **Examples**

    * `ebac gastroscopy study --physicians 2 --delay 0 --law ebac --seconds 3`: a quick look

    * `ebac gastroscopy study --physicians 2 --delay 0.1 --law ebac --seconds 2 --json`
    """
    from ebac.gastroscope import Physician, Procedure, gastroscopy_study
    from ebac.gastroscope.study import STRAIGHT

    with output.refusing():
        laws = by_name.laws(law or ["direct", "ebac"])
        delays = delay or [0.0, 0.05, 0.1]
        base = Procedure(
            master=how.master(0.0),
            physician=Physician(heed=heed),
            device=STRAIGHT,
            seconds=seconds,
            seed=seed,
        )
        folder = to.folder("gastroscopy-study", as_json=as_json)
        with output.counting("simulating", quiet=as_json) as progress:
            found = gastroscopy_study(
                laws,
                delays=delays,
                count=physicians,
                seed=seed,
                procedure=base,
                threads=threads,
                progress=progress,
            )
    to.report(
        folder, "gastroscopy-study", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=lambda: _show(found),
    )  # fmt: skip


def _document(found: GastroscopyStudy) -> str:
    return output.document("gastroscopy study", found.table(), effects=found.effect_table())


def _fill(draft: Path, found: GastroscopyStudy, to: ResultOptions) -> None:
    from ebac.plot import plot_gastroscopy_study

    to.save(plot_gastroscopy_study(found), draft, "gastroscopy-study")
    output.csv_table(draft / "gastroscopy-study.csv", found.table())


def _show(found: GastroscopyStudy) -> None:
    columns = ["law", "delay", "feedback", "reached", "touched", "time", "force 50 %", "force 90 %"]
    more = ["impulse", "over limit", "perforated", "least energy"]
    grid = output.table([*columns, *more], numbers=range(3, 12))
    for row in found.rows:
        grid.add_row(
            row.law,
            f"{1e3 * row.delay_s:g} ms",
            "yes" if row.feedback else "no",
            f"{row.reached_share:.0%}",
            f"{row.touched_mean:.2f}",
            f"{row.seconds_s:.1f} s",
            f"{row.most_force_N:.2f} N",
            f"{row.most_force_90_N:.2f} N",
            f"{row.impulse_N_s:.1f} N s",
            f"{row.over_limit_share:.0%}",
            f"{row.perforated_share:.0%}",
            f"{1e3 * row.least_energy_J:z.0f} mJ",
        )
    output.show(grid)
    for one in found.effects:
        output.say(
            f"{one.law}, {1e3 * one.delay_s:g} ms: feedback changes the largest force by {one.difference_N:+.2f} N "
            f"(95 %: {one.low_N:+.2f} to {one.high_N:+.2f} N); power for 1 N: {one.power:.0%}, "
            f"80 % for {one.detectable_N:.2f} N."
        )
    output.say(
        "Simulated physicians, patients and devices. Force: the largest of a run, of half and of 90 % of the "
        "runs; time and impulse: medians; least energy: at the master's port, of all runs."
    )
