"""What `ebac wall` gives: a table, a JSON document, a folder of files, or the log of a fault."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias

from ebac._util.file_names import file_name
from ebac.cli import output
from ebac.cli.files import ResultOptions, new_file

if TYPE_CHECKING:
    from rich.table import Table

    from ebac.metrics import Contact, WorldContact
    from ebac.scenario import Scenario
    from ebac.simulation import LoopFault
    from ebac.trace import Trace

Lines: TypeAlias = Sequence[tuple[str, str, str, str]]

#: Numbers of a contact that are left to its own text: the table has a column for each of several laws.
LEFT_OUT = (
    "allowed_m", "force_rest_N", "ripple_rms_N", "ripple_high_N", "most_drawn_J", "saturated"
)  # fmt: skip
#: More laws than this side by side do not fit 80 columns.
LAWS_ABREAST = 4


def write(
    folder: Path,
    scenario: Scenario,
    traces: list[Trace],
    text: str,
    to: ResultOptions,
    step: Callable[[str], None],
) -> list[str]:
    """Write table, scenario, figure and logs into a folder; return their names."""
    step("drawing")
    from ebac.plot import plot_walls, plot_world
    from ebac.worlds import World

    files = to.save(plot_walls(traces), folder, "wall")
    if isinstance(scenario.environment, World):
        files += to.save(plot_world(scenario.environment, traces), folder, "world")
    (folder / "wall.json").write_text(text + "\n", encoding="utf-8")
    scenario.save(folder / "scenario.toml")
    files += ["wall.json", "scenario.toml"]
    for trace in traces:
        step(f"writing the log of {trace.law}")
        name = file_name(trace.law)
        trace.to_npz(folder / f"{name}.npz")
        trace.to_csv(folder / f"{name}.csv")
        files += [f"{name}.npz", f"{name}.csv"]
    return files


def log_names(log: Path | None, names: list[str], *, force: bool = False) -> list[Path]:
    """Return the file of each law's log: `--log` itself for one, `run-tca.mcap` and so on for several.

    Raises
    ------
    ValueError
        When the extension is none of a log.
    """
    if log is None:
        return []
    from ebac.logs.files import FORMATS, extension

    kind = extension(log, tuple(FORMATS))
    one = len(names) == 1
    files = (
        [log] if one else [log.with_name(f"{log.stem}-{file_name(name)}{kind}") for name in names]
    )
    return [new_file("--log", file, force=force) for file in files]


def write_logs(logs: list[Path], traces: list[Trace], step: Callable[[str], None]) -> None:
    """Write the log of each trace, if logs are wanted."""
    for path, trace in zip(logs, traces, strict=False):  # no logs, no pairs
        step(f"writing {path.name}")
        with output.writing(f"--log {path}"):
            trace.save(path)


def in_world(traces: list[Trace]) -> list[WorldContact]:
    """Return how each law met the bodies of a world; nothing for a wall, or a handle on a sphere."""
    from ebac._core import Gimbal
    from ebac.metrics import world_contact
    from ebac.worlds import World

    scenario = traces[0].scenario
    if scenario is None or not isinstance(scenario.environment, World):
        return []
    if isinstance(scenario.device.kinematics, Gimbal):
        return []
    return [world_contact(trace) for trace in traces]


def document(
    scenario: Scenario,
    contacts: list[Contact],
    through: str | None = None,
    bodies: list[WorldContact] | None = None,
) -> str:
    """Return the JSON document; what concerns the bodies of a world is under `world`."""
    import tomllib
    from dataclasses import asdict

    rows: list[dict[str, Any]] = [dict(contact.row()) for contact in contacts]
    for row, met in zip(rows, bodies or [], strict=False):
        row["world"] = asdict(met)
    settings = tomllib.loads(scenario.to_toml())
    return output.document("wall", rows, scenario=settings, through=through)


def report_fault(error: LoopFault, out: Path | None) -> NoReturn:
    """End the command, leaving the log of the run that stopped."""
    what = "; ".join(filter(None, [str(error).partition("; see")[0], error.remedy]))
    if out is None:
        output.fail(f"{error.trace.law}: {what}; its log is kept with --out", code=output.FAILED)
    name = f"{file_name(error.trace.law)}-fault.npz"
    with output.results(out) as draft:
        if draft is not None:
            error.trace.to_npz(draft / name)
    output.fail(f"{error.trace.law}: {what}; its log is {out / name}", code=output.FAILED)


def show(
    scenario: Scenario,
    contacts: list[Contact],
    through: str | None = None,
    bodies: list[WorldContact] | None = None,
    limited: Sequence[str] = (),
) -> None:
    """Print the table, a few laws at a time, that of the bodies, and what was simulated."""
    from ebac._util import descriptions
    from ebac._util.doubts import motor
    from ebac.metrics.unjudged import no_ideal_rest
    from ebac.metrics.world_contact import LINES as BODY_LINES

    show_contacts(contacts)
    if why := no_ideal_rest(scenario):
        output.say(f"Not judged exact, there is no ideal rest: {why}.")
    elif weak := motor.too_weak(scenario) or motor.too_hot(scenario):
        output.say(f"{weak}.")
    if scenario.device.axes > 1:
        output.say(
            f"Of the {scenario.device.axes} axes: rest and deepest are those of the first; swings, settling times, "
            "jumps and vibration are the worst of all on which the world acts. The figure shows the first, or one on "
            "which a law swings more."
        )
    for first in range(0, len(bodies or []), LAWS_ABREAST):
        part = slice(first, first + LAWS_ABREAST)
        laws = [contact.law for contact in contacts[part]]
        show_lines(BODY_LINES, dict(zip(laws, (bodies or [])[part], strict=True)))
    if bodies and scenario.device.axes == 1:
        output.say(
            "The device has one axis, on which every world is met head-on, as a wall; for more, see "
            "docs/how-to/three_axes.md."
        )
    if bodies:
        output.say(
            "depth: mean over the last 30 %; normal error: the largest angle between force and surface then, beyond 90 "
            "deg the law pulled into the body; friction share: the largest tangential over normal force; in contact: "
            "of all ticks; stored at most: elastic energy of the world; ticks come through: inside a body that did not "
            "hold the handle."
        )
    output.say("Simulated, not measured:", style="bold")
    output.indented(descriptions.describe(scenario).replace("; ", "\n"))
    if through is not None:
        output.indented(
            "through a CAN bus in this process, with simulated CANopen drives, torque in whole thousandths of the "
            "rated one" + _without_bus(limited)
        )


def limited_by_i2t(traces: list[Trace]) -> list[str]:
    """Return the laws under which a simulated drive gave less torque than it was sent, as its i2t limit makes it."""
    return [
        trace.law
        for trace in traces
        if "bus.actual_permille" in trace
        and (trace["bus.actual_permille"][1:] != trace["bus.target_permille"][:-1]).any()
    ]


def _without_bus(limited: Sequence[str]) -> str:
    """Return how a run through a bus compares with one without."""
    if not limited:
        return ": the same to the bit without the bus by --device-permille"
    return (
        f"; under {', '.join(limited)} the i2t limit of a drive held the torque; a run without the bus "
        "(--device-permille) has no such limit"
    )


def show_fallbacks(traces: list[Trace]) -> None:
    """Print how far laws that are made for the observer's estimate could not use it."""
    from ebac.metrics import observer_use

    for trace in traces:
        used = observer_use(trace)
        if used is not None and used.fallback.keys() - {"off"}:
            output.say(f"Observer of {trace.law}: {used}.")


def show_contacts(contacts: list[Contact]) -> None:
    """Print the table, a few laws at a time."""
    for first in range(0, len(contacts), LAWS_ABREAST):
        part = contacts[first : first + LAWS_ABREAST]
        show_table({contact.law: contact for contact in part})


def show_table(columns: Mapping[str, Contact], *, verdict: bool = True) -> None:
    """Print contacts side by side, each under its heading, and their verdict."""
    from ebac.metrics.contact_result import LINES

    grid = _lines([line for line in LINES if line[1] not in LEFT_OUT], columns)
    if verdict:
        grid.add_section()
        alone = len(columns) == 1
        grid.add_row("verdict", *(_verdict(contact, alone) for contact in columns.values()))
    output.show(grid)


def show_lines(lines: Lines, columns: Mapping[str, object]) -> None:
    """Print numbers of several things side by side, each under its heading."""
    output.show(_lines(lines, columns))


def _lines(lines: Lines, columns: Mapping[str, object]) -> Table:
    from ebac._util import formatting

    grid = output.table(["", *columns], numbers=range(1, 99))
    for label, name, unit, none in lines:
        cells = [formatting.of_contact(one, name) for one in columns.values()]
        if not none and all(cell is None for cell in cells):
            continue
        signed = name == "deviation_m"
        grid.add_row(
            label, *(formatting.quantity(c, unit, signed=signed, none=none) for c in cells)
        )
    return grid


def _verdict(contact: Contact, alone: bool) -> str:
    """Return the verdict, in short lines unless it stands alone."""
    from ebac._util import verdicts

    words = verdicts.verdict(contact)
    if not alone:
        words = re.sub(r" (?=by|with|and|not quiet)|(?<=[,:]) ", "\n", words)
    if contact.surface_moves:
        return words
    passive = verdicts.drawn_energy(contact) <= verdicts.RESERVE
    good = (
        passive
        and contact.quiet
        and contact.exact is not False
        and contact.touched_at_rest is not False
    )
    return f"[{'green' if good else 'yellow' if contact.still else 'red'}]{words}[/]"
