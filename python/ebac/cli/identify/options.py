"""What the commands of `ebac identify` share: how a log is read, the path the hand was asked to follow."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.identify import Recording, Target

#: Panels of the help.
LOG, FIT = "Log", "Fit"
#: The smallest lag that is not zero [s].
LEAST_LAG = 1e-6
Log = Annotated[Path, typer.Argument(help="MCAP, CSV, .mat or .npz.", show_default=False)]
Logs = Annotated[
    list[Path],
    typer.Argument(
        help="Logs: MCAP, CSV, .mat or .npz; several are fitted together.", show_default=False
    ),
]


def _log(text: str, default: str | bool = False, *names: str, **more: Any) -> Any:
    return typer.Option(*names, help=text, show_default=default, rich_help_panel=LOG, **more)


def _fit(text: str, default: str | bool = False, **more: Any) -> Any:
    return typer.Option(help=text, show_default=default, rich_help_panel=FIT, **more)


Fix = Annotated[
    list[str] | None,
    _fit("NAME=VALUE in SI units: M0, B0, K0, X0, delay; several separated by commas."),
]
Robust = Annotated[
    float | None,
    _fit("Errors beyond this many standard deviations count linearly.", min=0.1, max=100),
]


@dataclass(frozen=True, kw_only=True)
class TargetOptions:
    """The path the hand was asked to follow."""

    switch: Annotated[
        list[float] | None,
        _fit(
            "Time at which the hand went to another place [s]; several separated by commas.",
            "as the log says, else held in one place",
        ),
    ] = None
    tapping: Annotated[
        float | None, _fit("Frequency at which the hand taps [Hz].", min=0.01, max=1000)
    ] = None
    held: Annotated[
        bool,
        typer.Option(
            "--held",
            help="The hand was held in one place, whatever the log contains.",
            rich_help_panel=FIT,
        ),
    ] = False

    def of(self, r: Recording) -> tuple[Recording, Target]:
        """Return a recording and the target of its hand; its last remark names the target."""
        from ebac.identify import Target
        from ebac.identify.target import in_words

        if bool(self.switch) + (self.tapping is not None) + self.held > 1:
            raise ValueError("--switch, --tapping and --held: give one of them")
        if self.tapping is not None:
            found = Target.tapping(self.tapping, r.seconds, float(r.t[0]))
            why = f"taps at {self.tapping:g} Hz"
        elif self.switch:
            found = Target.steps(*sorted(self.switch))
            why = f"steps at {', '.join(f'{t:g}' for t in sorted(self.switch))} s"
        elif self.held:
            found, why = Target.held(), "held in one place"
        elif r.target is not None:
            found, why = Target.following(r.target), "the column of the log"
        elif r.path is not None:
            found = Target.along(r.path, r.t)
            why = f"{in_words(r.path)}, by the scenario in the log"
        else:
            found = Target.held()
            why = "held in one place, an assumption: --tapping, --switch or a column target give another"
        return replace(r, remarks=(*r.remarks, f"target of the hand: {why}")), found


def pairs(given: list[str] | None, option: str) -> dict[str, str]:
    """Split NAME=VALUE, several separated by commas or given one by one."""
    out = {}
    for text in (part for one in given or [] for part in re.split(r",(?=\w+=)", one)):
        name, mark, value = text.partition("=")
        if not mark or not name or not value:
            raise ValueError(f"{option} {text}: write NAME=VALUE")
        if name in out:
            raise ValueError(f"{option} {text}: {name} is given twice; give it once")
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
    """How a log is read."""

    column: Annotated[
        list[str] | None,
        _log(
            "SIGNAL=COLUMN: t, x, force, motor, desired or target; several separated by commas.",
            "guessed",
        ),
    ] = None
    unit: Annotated[
        list[str] | None,
        _log("SIGNAL=UNIT, as x=mm; several separated by commas.", "from the heading, else SI"),
    ] = None
    rate: Annotated[
        float | None,
        _log("Rows per second [Hz], for a log without time or with wrong ones.", min=0.1, max=1e6),
    ] = None
    count: Annotated[
        float | None,
        _log(
            "Step of the encoder at the handle [m], of a rotary log [rad], 0 for none.",
            "found in x",
            min=0,
            max=1,
        ),
    ] = None
    lag: Annotated[
        float | None, _log("Lag of the force sensor [s].", "of the trace, else 0", min=0, max=0.1)
    ] = None
    current_lag: Annotated[
        float | None,
        _log("Lag of the motor's current loop [s].", "of the trace, else 0.0003", min=0, max=0.1),
    ] = None
    lever: Annotated[
        float | None,
        _log(
            "Radius at which a knob or joint is held [m]; results are then those of its handle.",
            "results in rad and N m",
            min=1e-4,
            max=10,
        ),
    ] = None
    counts_per_turn: Annotated[
        float | None,
        _log("Counts for one turn of the knob or joint.", "found in x", min=1, max=1e10),
    ] = None
    torque_constant: Annotated[
        float | None,
        _log(
            "Torque at the joint for one ampere or volt [N m/A, N m/V], of a motor in A or V.",
            "none",
            min=1e-6,
            max=1e4,
        ),
    ] = None
    force_constant: Annotated[
        float | None,
        _log(
            "Force of a slide for one ampere or volt [N/A, N/V], of a motor in A or V.",
            "none",
            min=1e-6,
            max=1e6,
        ),
    ] = None
    axis: Annotated[int, _log("Axis of a recorded run.", True, min=0)] = 0
    flip_force: Annotated[
        bool,
        typer.Option(
            "--flip-force",
            help="The log contains the force on the hand, with the opposite sign.",
            rich_help_panel=LOG,
        ),
    ] = False

    flip_motor: Annotated[
        bool,
        typer.Option(
            "--flip-motor",
            help="A positive motor force in the log drives towards +x.",
            rich_help_panel=LOG,
        ),
    ] = False

    def load(self, path: Path) -> Recording:
        """Read one log."""
        from ebac.identify.load import load

        for option, lag in (("--lag", self.lag), ("--current-lag", self.current_lag)):
            if lag is not None and 0 < lag < LEAST_LAG:
                raise ValueError(
                    f"{option} = {lag:g} s: must be 0, or lie in [{LEAST_LAG:g}, 0.1] s"
                )
        units = pairs(self.unit, "--unit")
        read = load(
            path,
            columns=pairs(self.column, "--column"),
            units=units,
            rate=self.rate,
            lag=self.lag,
            current_lag=self.current_lag,
            count=self.count,
            axis=self.axis,
            flip_force=self.flip_force,
            flip_motor=self.flip_motor,
            lever=self.lever,
            counts_per_turn=self.counts_per_turn,
            torque_constant=self.torque_constant,
            force_constant=self.force_constant,
        )
        for key, unit in units.items():
            for text in read.remarks:
                if text.startswith(f"{key}: taken as ") and (
                    says := text.partition("as asked, ")[2]
                ):
                    output.note(
                        f"{read.name}: --unit {key}={unit}: {says}, and --unit is followed; leave it out where the "
                        "heading is right"
                    )
        return read


def given_logs(
    paths: Sequence[Path], reading: Reading, target: TargetOptions
) -> list[tuple[Recording, Target]]:
    """Read logs, each with its target; no two recordings have one name.

    Raises
    ------
    ValueError
        For a log that is there twice, as one file or as a copy: its rows count once.
    """
    from ebac.identify.recording_list import refuse_copies, with_own_names

    recordings = [reading.load(path) for path in paths]
    refuse_copies(recordings, paths)
    return [target.of(r) for r in with_own_names(recordings)]
