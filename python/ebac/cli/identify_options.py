"""What the commands of `ebac identify` share: how a log is read, what the hand was told to do, the report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ebac.identify import Estimate, Recording, Target

#: Panels of the help.
LOG, FIT, RUN = "Log", "Fit", "Run"
Logs = Annotated[
    list[Path],
    typer.Argument(
        help="MCAP, CSV, .mat or .npz; several are fitted together.", show_default=False
    ),
]
ColumnOf = Annotated[
    list[str] | None,
    typer.Option(
        "--column",
        help="SIGNAL=COLUMN: t, x, force, motor, desired or target.",
        show_default="guessed",
        rich_help_panel=LOG,
    ),
]
UnitOf = Annotated[
    list[str] | None,
    typer.Option(
        "--unit",
        help="SIGNAL=UNIT, as x=mm.",
        show_default="from the heading, else SI",
        rich_help_panel=LOG,
    ),
]
Rate = Annotated[
    float | None,
    typer.Option(
        help="Rows per second [Hz], for a log without time.",
        show_default=False,
        rich_help_panel=LOG,
    ),
]
Lag = Annotated[
    float | None,
    typer.Option(
        help="Lag of the force sensor [s].",
        show_default="of the trace, else 0",
        rich_help_panel=LOG,
    ),
]
Axis = Annotated[int, typer.Option(help="Axis of a recorded run.", min=0, rich_help_panel=LOG)]
CurrentLag = Annotated[
    float | None,
    typer.Option(
        help="Lag of the motor's current loop [s].",
        show_default="of the trace, else 0.0003",
        rich_help_panel=LOG,
    ),
]
Switch = Annotated[
    list[float] | None,
    typer.Option(
        help="Time [s] at which the hand was told to go elsewhere; repeat it.",
        show_default="held in one place",
        rich_help_panel=FIT,
    ),
]
Tapping = Annotated[
    float | None,
    typer.Option(
        help="The hand taps at this frequency [Hz].", show_default=False, rich_help_panel=FIT
    ),
]
Fix = Annotated[
    list[str] | None,
    typer.Option(
        help="NAME=VALUE in SI units: M0, B0, K0, X0, delay.",
        show_default=False,
        rich_help_panel=FIT,
    ),
]
Robust = Annotated[
    float | None,
    typer.Option(
        help="Errors beyond so many deviations count linearly.",
        show_default=False,
        rich_help_panel=FIT,
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        help="Folder for the report page and figures.",
        show_default=False,
        rich_help_panel=RUN,
    ),
]


def pairs(given: list[str] | None, option: str) -> dict[str, str]:
    """Split NAME=VALUE."""
    out = {}
    for text in given or []:
        name, mark, value = text.partition("=")
        if not mark or not name or not value:
            raise ValueError(f"{option} {text}: write NAME=VALUE")
        out[name] = value
    return out


def numbers(given: list[str] | None, option: str) -> dict[str, float]:
    """Split NAME=NUMBER."""
    out = {}
    for name, text in pairs(given, option).items():
        try:
            out[name] = float(text)
        except ValueError:
            raise ValueError(f"{option} {name}={text}: {text!r} is no number") from None
    return out


@dataclass(frozen=True, kw_only=True)
class Reading:
    """The options that say how a log is read."""

    column: list[str] | None
    unit: list[str] | None
    rate: float | None
    lag: float | None
    current_lag: float | None = None
    axis: int = 0

    def load(self, path: Path) -> Recording:
        """Read one log."""
        from ebac.identify.load import load

        return load(
            path,
            columns=pairs(self.column, "--column"),
            units=pairs(self.unit, "--unit"),
            rate=self.rate,
            lag=self.lag,
            current_lag=self.current_lag,
            axis=self.axis,
        )


def target_of(r: Recording, switch: list[float] | None, tapping: float | None) -> Target:
    """Return what the hand was told to do."""
    from ebac.identify import Target

    if switch and tapping:
        raise ValueError("--switch and --tapping: give one of them")
    if tapping:
        return Target.tapping(tapping, r.seconds, float(r.t[0]))
    if switch:
        return Target.steps(*sorted(switch))
    return Target.held() if r.target is None else Target.following(r.target)


def line(e: Estimate) -> dict[str, str]:
    """Return an estimate as a row of a report."""
    return {
        "parameter": e.name,
        "estimate": f"{e.value:.5g}",
        "95 % interval": "given" if e.fixed else f"{e.low:.5g} to {e.high:.5g}",
        "unit": e.unit,
    }


def report(
    folder: Path | None,
    name: str,
    *,
    title: str,
    rows: list[dict[str, str]],
    careful: list[str],
    notes: list[str],
    draw: Sequence[Callable[[], Figure]],
) -> list[str]:
    """Write `name`.html, which holds everything, and its figures beside it; return the names of the files."""
    from ebac.identify.report import page

    with output.results(folder) as draft:
        if draft is None:
            return []
        figures = [one() for one in draw]
        for i, figure in enumerate(figures, 1):
            figure.savefig(draft / (f"{name}-{i}.png" if len(figures) > 1 else f"{name}.png"))
        text = page(title, rows, careful, notes, figures)
        (draft / f"{name}.html").write_text(text, encoding="utf-8")
        return sorted(file.name for file in draft.iterdir())
