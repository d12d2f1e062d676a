"""The findings as a folder: figures, a Markdown page and a JSON document."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from ebac._util import formatting
from ebac._util.arguments import require_path
from ebac._util.atomic_folder import filled
from ebac._util.sequences import several
from ebac.paper.finding import Finding, Row
from ebac.paper.items import find


def report(out_dir: str | Path, items: Iterable[str | Finding]) -> list[Path]:
    """Write `report.md`, `report.json` and one PNG per figure.

    Parameters
    ----------
    out_dir : str or Path
        The folder; it is made when it does not exist, and stays as it was when anything fails.
    items : iterable of str or Finding
        Names of items, or findings at hand.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    KeyError
        For a name that is no item.
    OSError
        When the folder cannot be written.
    """
    require_path(out_dir, "ebac.paper.report", "the path of a folder")
    wanted = several("items", items, least=0)
    with filled(out_dir) as draft:
        findings = [item if isinstance(item, Finding) else find(item) for item in wanted]
        write(draft, findings)
        names = sorted(file.name for file in draft.iterdir())
    return [Path(out_dir) / name for name in names]


def write(folder: Path, findings: list[Finding]) -> None:
    """Write the files of a report into a folder that exists."""
    for finding in findings:
        if finding.figure is not None and finding.picture is not None:
            finding.figure.savefig(folder / finding.picture)
    text = json.dumps(document(findings), indent=2, allow_nan=False)
    (folder / "report.json").write_text(text + "\n", encoding="utf-8")
    (folder / "report.md").write_text(page(findings), encoding="utf-8")


def document(findings: list[Finding]) -> dict[str, object]:
    """Return the findings as `ebac paper --json` prints them."""
    from ebac import __version__

    return {
        "command": "paper",
        "version": __version__,
        "rows": [finding.document() for finding in findings],
    }


def page(findings: list[Finding]) -> str:
    """Return the findings as Markdown."""
    lines = [
        "# The paper's numbers and figures, computed again",
        "",
        "Of *2-DOF Haptic Device based on Closed-loop EBA Controller for Gastroscope "
        "Intervention*. Everything below is computed or simulated; nothing was measured on a "
        "device.",
        "",
        "| item | verdict |",
        "|---|---|",
        *(f"| [{finding.title}](#{finding.name}) | {finding.verdict} |" for finding in findings),
        "",
    ]
    for finding in findings:
        lines += _section(finding)
    return "\n".join(lines)


def _section(finding: Finding) -> list[str]:
    picture = [f"![{finding.title}]({finding.picture})", ""] if finding.picture else []
    return [
        f'<a id="{finding.name}"></a>',
        "",
        f"## {finding.title}",
        "",
        f"**The paper:** {finding.claim}",
        "",
        f"**Verdict: {finding.verdict}.** {finding.why}",
        "",
        *_claims(finding),
        *_table(finding),
        "",
        *picture,
    ]


def _claims(finding: Finding) -> list[str]:
    if not finding.claims:
        return []
    lines = ["| claim | verdict | evidence |", "|---|---|---|"]
    lines += ["| " + " | ".join(claim.row().values()) + " |" for claim in finding.claims]
    return [*lines, ""]


def _table(finding: Finding) -> list[str]:
    if not finding.rows:
        return []
    lines = [headings(finding), ["---", *["---:"] * (len(headings(finding)) - 1)]]
    lines += [cells(row)[: len(lines[0])] for row in finding.rows]
    return ["| " + " | ".join(line) + " |" for line in lines]


def headings(finding: Finding) -> list[str]:
    """Return the headings of its table; only two where the paper gives no number at all."""
    compared = any(row["paper"] is not None for row in finding.rows)
    return ["quantity", "here", "paper", "difference"] if compared else ["quantity", "here"]


def cells(row: Row) -> list[str]:
    """Return a row in words: quantity, value, paper's value, difference."""
    unit = str(row["unit"])
    value, paper, difference = (
        item if isinstance(item, (int, float)) else None
        for item in (row["value"], row["paper"], row["difference"])
    )
    return [
        str(row["quantity"]),
        formatting.quantity(value, unit),
        formatting.quantity(paper, unit),
        formatting.quantity(difference, unit, signed=True),
    ]
