"""`ebac track`: how well a recorded path follows a line or a circle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import interrupts, output
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.tracking import Budget, Tracking

_READ, _FIT, _SIMULATED = "Files", "Fit", "Error budget (--simulated)"


def track(
    to: ResultOptions,
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            help="CSV files, or traces (.npz), with columns x and y.", show_default=False
        ),
    ] = None,
    columns: Annotated[
        list[str] | None,
        typer.Option(
            "--column",
            "-c",
            help="Columns of the position, separated by commas.",
            show_default="x,y or x,y,z",
            rich_help_panel=_READ,
        ),
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(
            help="Unit of the columns: m, mm, cm, um.",
            show_default="that of the heading",
            rich_help_panel=_READ,
        ),
    ] = None,
    shape: Annotated[
        str, typer.Option(help="line, circle, or auto for the one that fits.", rich_help_panel=_FIT)
    ] = "auto",
    robust: Annotated[
        bool, typer.Option("--robust", help="Leave outliers out.", rich_help_panel=_FIT)
    ] = False,
    simulated: Annotated[
        bool,
        typer.Option(
            "--simulated",
            help="Compute the error budget of the paper's joystick instead of reading files.",
            rich_help_panel=_SIMULATED,
        ),
    ] = False,
    runs: Annotated[
        int,
        typer.Option(
            help="Number of random joysticks for each row.",
            min=2,
            max=100_000,
            rich_help_panel=_SIMULATED,
        ),
    ] = 100,
    seed: Annotated[
        int, typer.Option(help="Seed of these joysticks.", min=0, rich_help_panel=_SIMULATED)
    ] = 1,
    slack: Annotated[
        float | None,
        typer.Option(
            help="Play of each cable at the handle, end to end [m].",
            min=0,
            max=0.02,
            show_default="0.0005, assumed",
            rich_help_panel=_SIMULATED,
        ),
    ] = None,
    alignment: Annotated[
        float,
        typer.Option(
            help="Errors of installation, in multiples of those assumed.",
            min=0,
            max=100,
            rich_help_panel=_SIMULATED,
        ),
    ] = 1.0,
    as_json: output.AsJson = False,
) -> None:
    """Fit a line or a circle to recorded paths.

    Prints standard deviation, path error and uncertainty, as in Table I of the paper. SD is sqrt(sum d^2 / (n - p))
    of the distances d from the fit, with p = 2 for a line and 3 for a circle; the path error is the mean of |d|.

    **Examples**

    * `ebac demo line circle`, then `ebac track line.csv circle.csv`: two recorded paths

    * `ebac track circle.csv --shape circle --robust`: without its outliers

    * `ebac track --simulated --runs 20`: error budget of the paper's joystick, beside Table I
    """
    with output.refusing():
        if simulated == bool(files):
            raise ValueError(
                "give files to fit, or --simulated for the error budget: one of the two"
            )
        if simulated:
            _simulated(runs, seed, slack, alignment, to, as_json)
            return
        from ebac.tracking import evaluate, read_path

        chosen = output.words(columns) or None
        found = [
            evaluate(read_path(file, columns=chosen, unit=unit), shape=shape, robust=robust)
            for file in files or []
        ]
    folder = to.folder("track", as_json=as_json)
    names = _write(folder, found, robust, to) if folder else []
    if as_json:
        typer.echo(output.document("track", [t.row() for t in found], robust=robust))
        return
    _show(found)
    if folder is not None:
        output.list_files(folder, names)


def _write(folder: Path, found: list[Tracking], robust: bool, to: ResultOptions) -> list[str]:
    from ebac.plot import plot_tracking

    with output.results(folder) as draft:
        if draft is None:
            return []
        document = output.document("track", [t.row() for t in found], robust=robust)
        (draft / "track.json").write_text(document + "\n", encoding="utf-8")
        for i, tracking in enumerate(found):
            stem = Path(tracking.path.name).stem
            same = [t for t in found if Path(t.path.name).stem == stem]
            name = f"{stem}-{i + 1}" if len(same) > 1 else stem
            to.save(plot_tracking(tracking), draft, name)
        return sorted(file.name for file in draft.iterdir())


def _show(found: list[Tracking]) -> None:
    from ebac._util import formatting
    from ebac.tracking import LineFit
    from ebac.tracking.deviation import digits

    headings = ["file", "shape", "SD", "path error", "largest", "points", "outliers", "fitted"]
    grid = output.table(headings, numbers=(2, 3, 4, 5, 6))
    for t in found:
        row, fit = t.row(), t.fit
        if isinstance(fit, LineFit):
            fitted = (f"{formatting.quantity(row['length_m'], 'm')} long, at {row['angle_deg']:.3f} "
                    f"+- {digits(1.96 * row['angle_sd_deg'], 2)} deg")  # fmt: skip
        else:
            fitted = (f"radius {formatting.quantity(fit.radius, 'm')} +- {digits(1.96e3 * fit.radius_sd_m, 2)} mm, "
                    f"{row['arc_deg']:.0f} deg of it")  # fmt: skip
            if len(fit.centre) == 3:
                rms, largest = (
                    formatting.quantity(row[f"out_of_plane_{k}_m"], "m") for k in ("rms", "largest")
                )
                fitted += f"; out of its plane {rms} rms, largest {largest}"
        lengths = [formatting.quantity(row[k], "m") for k in ("sd_m", "error_m", "largest_m")]
        grid.add_row(
            t.path.name, t.shape, *lengths, str(row["points"]), str(row["outliers"]), fitted
        )
    output.show(grid)
    for t in found:
        output.say(f"{t.path.name}: {t.path.remark}.")
        if t.remark:
            output.note(t.remark)
    output.say("+- is a 95 % interval that counts correlated points for what they are worth.")


def _simulated(
    runs: int, seed: int, slack: float | None, alignment: float, to: ResultOptions, as_json: bool
) -> None:
    from ebac.tracking import ErrorSources, error_budget

    plain = ErrorSources()
    names = ("zero", "skew", "axis_offset", "lever", "ratio")
    sizes: dict[str, Any] = {name: alignment * getattr(plain, name) for name in names}
    sources = plain.replace(slack=plain.slack if slack is None else slack, **sizes)
    folder = to.folder("track", as_json=as_json)
    interrupts.keeping("nothing was written; fewer --runs take less time")
    with output.counting("drawing joysticks", quiet=as_json) as progress:
        budget = error_budget(sources=sources, runs=runs, seed=seed, progress=progress)
    document = output.document("track", _rows(budget), **_assumed(budget))
    files = _write_budget(folder, budget, document, to) if folder else []
    if as_json:
        typer.echo(document)
        return
    _show_budget(budget)
    if folder is not None:
        output.list_files(folder, files)


def _rows(budget: Budget) -> list[dict[str, Any]]:
    from dataclasses import asdict

    from ebac.tracking import TABLE_I

    simulated = [asdict(row) for row in budget.rows]
    paper = [
        {"shape": e.shape, "source": "paper", "sd_m": e.sd_m, "sd_low_m": None, "sd_high_m": None,
         "error_m": e.error_m, "ratio": e.ratio, "radius_m": None}
        for e in TABLE_I
    ]  # fmt: skip
    return simulated + paper


def _assumed(budget: Budget) -> dict[str, Any]:
    s = budget.sources
    return {
        "runs": budget.runs,
        "seed": budget.seed,
        "assumed": {"zero_rad": s.zero, "skew_rad": s.skew, "axis_offset_m": s.axis_offset,
                    "lever_m": s.lever, "ratio": s.ratio, "slack_m": s.slack},
        "slack_for_table_m": budget.slack_m,
        "unexplained_m": {shape: budget.unexplained_m(shape) for shape in ("line", "circle")},
    }  # fmt: skip


def _write_budget(folder: Path, budget: Budget, document: str, to: ResultOptions) -> list[str]:
    from ebac.plot import plot_budget, plot_tracking
    from ebac.tracking import RecordedPath, evaluate

    with output.results(folder) as draft:
        if draft is None:
            return []
        (draft / "budget.json").write_text(document + "\n", encoding="utf-8")
        to.save(plot_budget(budget), draft, "budget")
        for shape, points in budget.examples.items():
            path = RecordedPath(points=points, name=f"simulated {shape}", remark="simulated")
            to.save(plot_tracking(evaluate(path, shape=shape)), draft, shape)
        return sorted(file.name for file in draft.iterdir())


def _show_budget(budget: Budget) -> None:
    from ebac._util import formatting

    headings = ["path", "source", "SD", "5 % to 95 %", "path error", "error/SD"]
    grid = output.table(headings, numbers=(2, 3, 4, 5))
    for row in _rows(budget):
        sd, low, high, error = (
            formatting.quantity(row[k], "m") for k in ("sd_m", "sd_low_m", "sd_high_m", "error_m")
        )
        span = "" if row["sd_low_m"] is None else f"{low.removesuffix(' mm')} to {high}"
        style = "bold" if row["source"] == "all" else None
        grid.add_row(
            row["shape"], row["source"], sd, span, error, f"{row['ratio']:.2f}", style=style
        )
    output.show(grid)
    for shape, slack in budget.slack_m.items():
        left = formatting.quantity(budget.unexplained_m(shape), "m")
        cause = (
            f"a slack of {formatting.quantity(slack, 'm')} at the handle would explain the paper's mean SD"
            if slack is not None
            else "no slack up to 20 mm brings it to the paper's mean SD"
        )
        output.say(f"{shape}: {left} of the paper's SD are left (hand, ruler, rope); {cause}.")
    s = budget.sources
    output.say(
        f"Simulated. The sizes are assumptions, the paper gives none: zero and squareness {_deg(s.zero)} and "
        f"{_deg(s.skew)}, lever and axes {1e3 * s.lever:.3g} and {1e3 * s.axis_offset:.3g} mm, capstan ratio "
        f"{100 * s.ratio:.3g} %, slack {1e3 * s.slack:.3g} mm.",
        style="bold",
    )


def _deg(angle: float) -> str:
    from math import degrees

    return f"{degrees(angle):.3g} deg"
