"""What `ebac run` gives: tables, a JSON document, a figure."""

from __future__ import annotations

import tomllib
import warnings
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from ebac._util.atomic_file import write_text
from ebac.cli import output
from ebac.cli.files import FigureOptions
from ebac.cli.machine.grants import show_refused
from ebac.cli.run.engine import Served, without_engine

if TYPE_CHECKING:
    from ebac.hardware import Configuration, Report, Times
    from ebac.metrics import Contact, CurrentLimits, ObserverUse
    from ebac.simulation import LoopFault
    from ebac.trace import Trace
    from ebac.worlds import EngineProcess

#: The longest run that is also shown on a virtual clock [ticks]: about a second of computing, 100 MB of rows.
LONGEST_EXPECTED = 100_000

#: The lines of the table of times: label, attributes of `Times` for p50, p99.9 and most.
_TIMES = (
    ("compute", "compute_p50_s", "compute_p99_9_s", "compute_most_s"),
    ("exchange", "exchange_p50_s", "exchange_p99_9_s", None),
    ("late", "late_p50_s", "late_p99_9_s", "late_most_s"),
)


@dataclass(frozen=True, kw_only=True)
class Result:
    """A run and what it came to.

    Attributes
    ----------
    configuration : Configuration
        What was asked.
    trace : Trace
        The rows in memory.
    report : Report
        How it went.
    place : str
        Where the drives were.
    simulated : bool
        Whether they were simulated.
    contact : Contact or None
        The contact with the wall; None where there were too few rows under the law.
    expected : Contact or None
        The same of `Configuration.simulate`, by its readings; None on hardware, and where a run changed on its way.
    observer : ObserverUse or None
        How far the law relied on the observer; None without one.
    limits : CurrentLimits or None
        What held the current back; None where nothing did.
    times : Times or None
        How quick and punctual the loop was.
    fault : str or None
        Why it stopped.
    virtual : bool
        Whether the clock was virtual too.
    changed : bool
        Whether parameters changed during the run.
    engine : Served or None
        How the engine served the run; None without one.
    first_run : tuple of str
        What --first changed, a line for each value; empty without it.
    """

    configuration: Configuration
    trace: Trace
    report: Report
    place: str
    simulated: bool
    contact: Contact | None
    expected: Contact | None
    observer: ObserverUse | None
    limits: CurrentLimits | None
    times: Times | None
    fault: str | None
    virtual: bool = False
    changed: bool = False
    engine: Served | None = None
    first_run: tuple[str, ...] = ()

    @classmethod
    def of_virtual(
        cls, configuration: Configuration, trace: Trace, log: Path | None, fault: LoopFault | None
    ) -> Self:
        """Measure a run on a virtual clock."""
        from ebac.hardware import Report, under_the_law
        from ebac.metrics import FEWEST_ROWS, contact, current_limits, observer_use

        part = under_the_law(trace)
        measured = len(part) >= FEWEST_ROWS and fault is None
        return cls(
            configuration=configuration,
            trace=trace,
            report=Report.of_virtual(trace, log, fault=fault is not None),
            place="simulated drives on a bus inside this process",
            simulated=True,
            contact=contact(part, truth=False) if measured else None,
            expected=None,
            observer=observer_use(part),
            limits=current_limits(part),
            times=None,
            fault=None if fault is None else fault.fault.name.lower(),
            virtual=True,
        )

    @classmethod
    def of(
        cls,
        configuration: Configuration,
        trace: Trace,
        report: Report,
        place: str,
        simulated: bool,
        fault: LoopFault | None,
        *,
        changed: bool = False,
        process: EngineProcess | None = None,
    ) -> Self:
        """Measure a run; `changed` on its way, or with an engine, it has no simulation beside it."""
        from ebac.hardware import times, under_the_law
        from ebac.metrics import FEWEST_ROWS, contact, current_limits, observer_use
        from ebac.metrics.with_hand import at_hands_pace, moves_with_hand

        part = under_the_law(trace)
        measured = len(part) >= FEWEST_ROWS and fault is None
        met = contact(part) if measured else None
        if met is not None and simulated and not met.still:
            axes = range(part.axes)
            pace = at_hands_pace(part, met.limit_cycle_Hz, axes, target=True)
            follows = all(moves_with_hand(part, i) for i in axes)
            met = replace(met, with_hand=follows, at_hands_pace=pace)
        whole = report.ended_by == "time" and not changed and process is None
        seconds = report.ticks * configuration.timing.dt
        return cls(
            configuration=configuration,
            trace=trace,
            report=report,
            place=place,
            simulated=simulated,
            contact=met,
            expected=_expected(configuration) if measured and whole and simulated else None,
            observer=observer_use(part),
            limits=current_limits(part),
            times=replace(times(part), skipped=int(trace["skipped"].sum())) if len(part) else None,
            fault=None if fault is None else fault.fault.name.lower(),
            changed=changed,
            engine=None if process is None else Served.of(process, seconds),
        )

    def document(self) -> str:
        """Return the JSON document."""
        scenario = tomllib.loads(without_engine(self.configuration).scenario().to_toml())
        if self.engine is not None:
            del scenario["environment"]  # it was the engine's
        rows: list[dict[str, Any]] = [] if self.contact is None else [self.contact.row()]
        return output.document(
            "run",
            rows,
            simulated=self.simulated,
            virtual=self.virtual,
            place=self.place,
            expected=None if self.expected is None else self.expected.row(),
            scenario=scenario,
            observer=None if self.observer is None else asdict(self.observer),
            current_limited=None if self.limits is None else asdict(self.limits),
            times=None if self.times is None else asdict(self.times),
            fault=self.fault,
            changed=self.changed,
            first_run=list(self.first_run),
            engine=None if self.engine is None else self.engine.row(),
            **self.report.row(),
        )


def _expected(configuration: Configuration) -> Contact | None:
    """Return the contact of the same run on a virtual clock; None where it is long, or ends by a (printed) fault."""
    from ebac.hardware import ConfigurationError
    from ebac.metrics import contact
    from ebac.simulation import LoopFault

    if configuration.seconds > LONGEST_EXPECTED * configuration.timing.dt:
        return None
    with warnings.catch_warnings(action="ignore"):  # the run has reported how full the bus is
        try:
            return contact(configuration.simulate(bus_time=False), truth=False)
        except (
            ConfigurationError
        ):  # simulated signs or zero are wrong on purpose: there is no such run
            return None
        except LoopFault as error:
            what = str(error).partition(": the command")[0]
            output.console(stderr=True).print(f"On a virtual clock this run ends by {what}.")
            return None


def write(result: Result, stem: Path | None, style: FigureOptions) -> list[str]:
    """Write figure and numbers beside the log; return the names of all files."""
    if stem is None:
        return []
    from ebac.logs import read
    from ebac.plot import plot_trace

    names = [f"{stem.name}.mcap"]
    if len(result.trace) >= 2:
        events = read(result.report.log).events if result.changed and result.report.log else []
        names += style.save(plot_trace(result.trace, events=events), stem.parent, stem.name)
    write_text(stem.with_suffix(".json"), result.document() + "\n")
    return [*names, f"{stem.name}.json"]


def show(result: Result) -> None:
    """Print what the run came to."""
    from ebac.cli.wall import results

    if result.contact is not None:
        columns = {result.contact.law: result.contact}
        if result.expected is not None:
            columns = {"real time": result.contact, "virtual clock": result.expected}
        results.show_table(columns, verdict=not result.changed)
        if result.changed:
            output.say(
                "Parameters changed during the run (--at): ideal rest and deviation are those of the configured world "
                "and hand, and there is no verdict."
            )
    if result.observer is not None:
        output.say(f"Observer: {result.observer}.")
    elif (
        result.configuration.law == "ebac" and result.configuration.scenario().device.sensor.fitted
    ):
        output.say("By the encoder alone: with --observer the law acts on the force sensor, too.")
    if result.limits is not None:
        output.say(f"The current was held back by {result.limits}.", style="yellow")
    if result.engine is not None:
        met = result.contact
        judged = met is not None and result.engine.models and not met.surface_moves
        still = " The verdict takes its surface to stand still." if judged else ""
        output.say(f"{result.engine}{still}")
    if result.times is not None:
        _show_times(result.times)
    output.say("Run with:")
    output.indented(_setup(result))
    report = result.report
    kept = (
        "no log"
        if report.log is None
        else f"{report.recorded:,} recorded, {report.lost_rows:,} lost"
    )
    output.say(
        f"{output.plural(report.ticks, 'tick')}, {kept}; ended by {report.ended_by}; on {result.place}."
    )
    if result.virtual:
        output.say(
            "Everything was simulated, on a virtual clock: every tick in time.", style="bold"
        )
        if result.contact is not None:
            output.say(
                "Measured by the encoder's readings, as on hardware; ebac.contact of the log knows the true motion and "
                "the energy."
            )
        missing = result.trace["bus.missing"]
        if late := int((missing[-1] - missing[0]).sum()):
            output.say(
                f"{output.plural(late, 'answer')} came after the loop had stopped waiting: see `ebac doctor` with this "
                "configuration."
            )
        return
    states = ", ".join(report.drives) or "not asked"
    output.say(f"Drives after it: {states}.")
    show_refused(report.grants)
    if result.simulated:
        output.say(
            "Drives, device and hand were simulated; clock and thread were real.", style="bold"
        )


def _setup(result: Result) -> str:
    """Return device, hand, virtual world and timing, a line each: of an engine no world, of a person no hand."""
    from ebac._util import descriptions

    scenario = without_engine(result.configuration).scenario()
    device, hand, world, timing, *length = descriptions.describe(scenario).split("; ")
    lines = [device]
    lines += [hand] if result.simulated else []
    lines += [world] if result.engine is None else []
    return "\n".join([*lines, timing, *(length if result.simulated else [])])


def _show_times(times: Times) -> None:
    grid = output.table(["time of a tick", "p50", "p99.9", "most"], numbers=range(1, 4))
    for label, *names in _TIMES:
        values = [None if name is None else getattr(times, name) for name in names]
        grid.add_row(label, *("-" if v is None else f"{1e6 * v:,.1f} µs" for v in values))
    output.show(grid)
    if times.skipped:
        were = "was" if times.skipped == 1 else "were"
        ticks = output.plural(times.skipped, "tick")
        output.say(f"{ticks} could not be kept and {were} skipped.", style="yellow")
