"""`ebac paper`: the paper's numbers and figures, computed again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.paper import Finding

DEFAULT_OUT = Path("ebac-paper")
STYLES = {"reproduced": "green", "reproduced in part": "yellow", "not reproduced": "red"}


def paper(
    item: Annotated[
        list[str] | None,
        typer.Argument(
            help="eq1, specs, fig5, fig6, fig7, fig11, or all.",
            show_default="all",
            metavar="[ITEM]...",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder for report.md, report.json and the figures; with --json only when given.",
            show_default=str(DEFAULT_OUT),
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Compute the paper's numbers and figures again and say which are reproduced, and why not.

    Everything is computed or simulated; nothing is measured on a device.

    **Examples**

    * `ebac paper`: everything, into ebac-paper/.

    * `ebac paper fig11 --out report/`: the three laws against the virtual wall.

    * `ebac paper eq1 specs --json`: two items as JSON.
    """
    from ebac.paper import find
    from ebac.paper.report import write

    with output.refusing():
        names = _names(item or ["all"])
    folder = out or (None if as_json else DEFAULT_OUT)
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
    from ebac.document import unknown
    from ebac.paper import ITEMS

    names: list[str] = []
    for name in given:
        if name not in ITEMS and name != "all":
            raise ValueError(unknown(f"ITEM {name}", name, [*ITEMS, "all"]))
        names += ITEMS if name == "all" else [name]
    return list(dict.fromkeys(names))


def _report_first(name: str) -> tuple[bool, str]:
    return not name.startswith("report"), name


def _show_verdicts(findings: list[Finding]) -> None:
    grid = output.table(["item", "verdict", "title"])
    for finding in findings:
        style = STYLES[finding.verdict]
        grid.add_row(finding.name, f"[{style}]{finding.verdict}[/]", finding.title)
    output.console().print(grid)


def _show(finding: Finding) -> None:
    from ebac.paper.report import cells, headings

    columns = headings(finding)
    grid = output.table(columns, numbers=(1, 2, 3))
    for row in finding.rows:
        grid.add_row(*cells(row)[: len(columns)])
    output.say(finding.title, style="bold")
    output.console().print(grid)
    output.say(f"The paper: {finding.claim}")
    output.say(f"Verdict: {finding.verdict}.", style=STYLES[finding.verdict])
    output.say(finding.why)
    output.say()
