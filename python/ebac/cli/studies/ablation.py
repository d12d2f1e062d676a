"""`ebac ablation`: each piece of a law off, one at a time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, from_options, interrupts, options, output, setting
from ebac.cli.files import ResultOptions
from ebac.cli.studies import replaced, study_results

if TYPE_CHECKING:
    from ebac.studies import Ablation, AblationRow, Piece

_WHAT = "Law and parts"
#: Measures of one table on the screen.
ABREAST = 7
#: Differences named in a line; the tables show all.
NAMED = 4


def ablation(
    to: ResultOptions,
    device: options.DeviceOptions,
    length: options.RunOptions,
    hands: options.PopulationOptions,
    law: Annotated[str, options.one_law(panel=_WHAT, own=options.OWN)] = "ebac",
    change: Annotated[
        list[str] | None,
        typer.Option(
            help="Add a row: NAME=VALUE in SI units, on or off; several separated by commas; repeat it. "
            "`ebac laws NAME` lists the parameters.",
            rich_help_panel=_WHAT,
        ),
    ] = None,
    beside: Annotated[
        list[str] | None,
        typer.Option(
            help="Other laws to compare with; several separated by commas.",
            show_default="tca, eba",
            rich_help_panel=_WHAT,
        ),
    ] = None,
    threads: options.Threads = None,
    resume: Annotated[bool, options.resume("ablation")] = False,
    as_json: output.AsJson = False,
) -> None:
    """Switch off each part of a controller and measure what gets worse.

    An ablation study, simulated.

    The parts are the on/off parameters of the law, which are switched one at a time, and its gains kp and
    fast_stiffness, which are set to zero. The measures are the share of good hands under hard conditions, energy given
    out, and force swing.

    **Examples**

    * `ebac ablation`: EBAC without each of its parts, 60 hands

    * `ebac ablation --change pull=40 --change kp=0,guard=off`: two more rows

    * `ebac ablation --population random --hands 20 --seed 7 --json`
    """
    from ebac.studies.measures import MEASURES, conditions_of

    folder = to.folder("ablation", as_json=as_json, resume=study_results.BUNDLES * resume)
    with output.refusing():
        given: dict[str, Any] = {
            "law": by_name.any_law(law, python=True),
            "changes": [setting.parse_change(one) for one in change or []],
            "beside": by_name.law_names(beside or ("tca", "eba"), "--beside"),
            "base": from_options.scenario(device, length),
            "seed": hands.seed,
            "threads": threads,
            "resume": resume,
            "out": None if folder is None else folder / study_results.BUNDLES,
        }
        people = hands.operators()
        replaced.note(given["base"], conditions_of(MEASURES))
    found = _run(people, given, folder, quiet=as_json)
    to.report(
        folder, "ablation", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=lambda: _show(found),
    )  # fmt: skip


def _run(people: Any, given: dict[str, Any], folder: Path | None, *, quiet: bool) -> Ablation:
    from ebac.studies import ablation as run_ablation

    with (
        interrupts.resumable(folder),
        output.refusing(folder),
        output.counting("simulating", quiet=quiet) as progress,
    ):
        return run_ablation(people, progress=progress, **given)


def _document(found: Ablation) -> str:
    return output.document("ablation", [row.row() for row in found.rows])


def _fill(draft: Path, found: Ablation, to: ResultOptions) -> None:
    from ebac.plot import plot_ablation

    to.save(plot_ablation(found), draft, "ablation")
    rows = [
        {**row.row(), "changes": row.label if row.piece else ""} | {
            name: " ".join(getattr(row, name)) for name in ("worse", "better")
        }
        for row in found.rows
    ]  # fmt: skip
    output.csv_table(draft / "ablation.csv", rows)
    found.study.operators.to_csv(draft / "population.csv")
    found.study.result().to_csv(draft / "runs.csv")


def _show(found: Ablation) -> None:
    from ebac._util import formatting

    for start in range(0, len(found.measures), ABREAST):
        part = found.measures[start : start + ABREAST]
        headings = [f"{m.heading} \\[{formatting.shown(m.unit)}]" for m in part]
        grid = output.table(["law", *headings], numbers=range(1, len(part) + 1))
        grid.columns[0].no_wrap = True
        for i, row in enumerate(found.rows):
            if i in (1, 1 + len(found.pieces)):
                grid.add_section()
            cells = (_cell(row, m.key, formatting.cell(row.values[m.key], m.unit)) for m in part)
            grid.add_row(row.label, *cells)
        output.show(grid)
    for piece, row in zip(found.pieces, found.rows[1:], strict=False):
        _show_piece(piece, row, found)
    hands = len(found.study.operators)
    output.say(
        f"Simulated, not measured; {output.plural(hands, 'hand')}. Red, in the figure orange: worse than {found.law} "
        "as it is; green, in the figure blue: better.",
        style="bold",
    )


def _cell(row: AblationRow, key: str, text: str) -> str:
    style = "red" if key in row.worse else "green" if key in row.better else ""
    return f"[{style}]{text}[/]" if style else text


def _show_piece(piece: Piece, row: AblationRow, found: Ablation) -> None:
    verdict = "worse" if row.earns else "nothing gets worse"
    lines = [verdict + (f": {_list(row, found, row.worse)}" if row.worse else "")]
    if row.better:
        lines.append(f"better: {_list(row, found, row.better)}")
    what = f" ({piece.meaning})" if len(piece.changes) == 1 else ""
    output.say(f"{row.label}{what}: {'; '.join(lines)}")


def _list(row: AblationRow, found: Ablation, keys: Sequence[str]) -> str:
    from ebac._util import formatting

    known = {measure.key: measure for measure in found.measures}
    named = [
        f"{known[key].heading} {formatting.cell(found.rows[0].values[key], known[key].unit)} -> "
        f"{formatting.quantity(row.values[key], known[key].unit)}"
        for key in keys[:NAMED]
    ]
    return ", ".join(named) + (f" and {len(keys) - NAMED} more" if len(keys) > NAMED else "")
