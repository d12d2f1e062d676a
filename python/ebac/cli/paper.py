"""`ebac paper`: the paper's numbers and figures, computed again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac._util.arguments import unknown
from ebac.cli import completion, interrupts, output
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.paper import Finding

STYLES = {
    "reproduced": "green",
    "reproduced in part": "yellow",
    "not reproduced": "red",
    "nothing to compute": "dim",
}


def paper(
    to: ResultOptions,
    item: Annotated[
        list[str] | None,
        typer.Argument(
            help="specs, eq1 to eq12, fig1 to fig11, table1, or all.",
            show_default="all",
            metavar="[ITEM]...",
            autocompletion=completion.paper_items,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Reproduce the numbers and figures of the paper.

    Everything is computed or simulated; nothing was measured on a device.

    **Examples**

    * `ebac paper eq1 specs`: two items

    * `ebac paper fig11 --out report`: three laws against the virtual wall

    * `ebac paper`: everything
    """
    from ebac.paper import find
    from ebac.paper.report import write

    with output.refusing():
        names = _names(item or ["all"])
    folder = to.folder("paper", as_json=as_json)
    interrupts.keeping("nothing was written; name the items you need, as in `ebac paper eq1 fig5`")
    files: list[str] = []
    with (
        output.results(folder) as draft,
        output.progress(len(names) + 1, quiet=as_json) as step,
    ):
        findings = []
        for name in names:
            step(f"computing {name}")
            findings.append(find(name))
        if draft is not None:
            step("writing the report")
            write(draft, findings)
            for finding in findings:
                if finding.figure is not None and finding.picture is not None:
                    to.save(finding.figure, draft, Path(finding.picture).stem)
            files = sorted((file.name for file in draft.iterdir()), key=_report_first)
    if as_json:
        typer.echo(output.document("paper", [f.document() for f in findings]))
        return
    for finding in findings:
        _show(finding)
    _show_verdicts(findings)
    output.say("Computed and simulated, not measured on a device.", style="bold")
    if folder is not None:
        output.list_files(folder, files)


def _names(given: list[str]) -> list[str]:
    from ebac.paper import ITEMS

    names: list[str] = []
    for word in given:
        name = word.lower()
        if name not in ITEMS and name != "all":
            raise ValueError(unknown(f"ITEM {word}", name, [*ITEMS, "all"], "item of the paper"))
        names += ITEMS if name == "all" else [name]
    return list(dict.fromkeys(names))


def _report_first(name: str) -> tuple[bool, str]:
    return not name.startswith("report"), name


def _show_verdicts(findings: list[Finding]) -> None:
    grid = output.table(["item", "verdict", "title"])
    for finding in findings:
        style = STYLES[finding.verdict]
        grid.add_row(finding.name, f"[{style}]{finding.verdict}[/]", finding.title)
    output.show(grid)


def _show(finding: Finding) -> None:
    from ebac.paper.report import cells, headings

    columns = headings(finding)
    grid = output.table(columns, numbers=(1, 2, 3))
    for row in finding.rows:
        grid.add_row(*cells(row)[: len(columns)])
    output.say(finding.title, style="bold")
    if finding.rows:
        output.show(grid)
    output.say(f"The paper: {finding.claim}")
    output.say(f"Verdict: {finding.verdict}.", style=STYLES[finding.verdict])
    output.say(finding.why)
    for claim in finding.claims:
        verdict = str(claim.row()["verdict"])
        output.say(f"  {verdict}: {claim.text} ({claim.evidence})", style=STYLES[verdict])
    output.say()
