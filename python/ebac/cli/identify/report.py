"""The report of the commands of `ebac identify`: its folder, its rows, its page and figures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output
from ebac.cli.files import PANEL, FigureOptions, Force, free_folder

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ebac.identify import Estimate


@dataclass(frozen=True, kw_only=True)
class ReportOptions(FigureOptions):
    """The folder of the report."""

    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Folder for the report page and figures, new or empty.",
            show_default=False,
            rich_help_panel=PANEL,
        ),
    ] = None
    force: Force = False

    def folder(self) -> Path | None:
        """Return the folder to write to, None for none; one that has files ends the command."""
        self.check()
        return None if self.out is None else free_folder(self.out, force=self.force)


def line(e: Estimate) -> dict[str, str]:
    """Return an estimate as a row of a report."""
    return {
        "parameter": e.name,
        "estimate": f"{e.value:.5g}",
        "95 % interval": "given" if e.fixed else f"{e.low:.5g} to {e.high:.5g}",
        "unit": e.unit,
    }


def report(
    to: ReportOptions,
    name: str,
    *,
    title: str,
    rows: list[dict[str, str]],
    careful: list[str],
    notes: list[str],
    draw: Sequence[Callable[[], Figure]],
) -> list[str]:
    """Write `name`.html, which holds everything, and its figures beside it; return the names of the files."""
    from ebac.identify.figures import page

    with output.results(to.folder()) as draft:
        if draft is None:
            return []
        figures = [one() for one in draw]
        for i, figure in enumerate(figures, 1):
            to.save(figure, draft, f"{name}-{i}" if len(figures) > 1 else name)
        text = page(title, rows, careful, notes, figures)
        (draft / f"{name}.html").write_text(text, encoding="utf-8")
        return sorted(file.name for file in draft.iterdir())
