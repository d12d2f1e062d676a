"""What `ebac wall` gives: a table, a JSON document, a folder of files, or the log of a fault."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from ebac.cli import output
from ebac.cli.files import ResultOptions, new_file

if TYPE_CHECKING:
    from ebac.metrics import Contact
    from ebac.scenario import Scenario
    from ebac.simulation import LoopFault
    from ebac.trace import Trace

#: The lines of the table: label, attribute of a contact, its unit, what to say where there is none.
LINES = (
    ("rest", "rest_m", "m", "-"),
    ("ideal rest", "ideal_m", "m", "-"),
    ("deviation", "deviation_m", "m", "-"),
    ("swing", "swing_m", "m", "-"),
    ("force swing", "force_swing_N", "N", "-"),
    ("settled", "settled_s", "s", "never"),
    ("force settled", "force_settled_s", "s", "never"),
    ("ripple", "ripple_N", "N", "-"),
    ("force jumps", "jumps", "1", "-"),
    ("vibration/threshold", "perceived", "1", "-"),
    ("deepest", "peak_m", "m", "-"),
    ("limit cycle", "limit_cycle_Hz", "Hz", "none"),
    ("least energy", "least_energy_J", "J", "-"),
    ("force limited", "clamped_share", "share", "-"),
)


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
        trace.to_npz(folder / f"{trace.law}.npz")
        trace.to_csv(folder / f"{trace.law}.csv")
        files += [f"{trace.law}.npz", f"{trace.law}.csv"]
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
    files = [log] if one else [log.with_name(f"{log.stem}-{name}{kind}") for name in names]
    return [new_file("--log", file, force=force) for file in files]


def write_logs(logs: list[Path], traces: list[Trace], step: Callable[[str], None]) -> None:
    """Write the log of each trace, if logs are wanted."""
    for path, trace in zip(logs, traces, strict=False):  # no logs, no pairs
        step(f"writing {path.name}")
        try:
            trace.save(path)
        except ModuleNotFoundError as error:
            output.fail(f"--log {path}: {error}")
        except OSError as error:
            output.fail(f"--log {path}: cannot be written ({error.strerror})")


def document(scenario: Scenario, contacts: list[Contact], through: str | None = None) -> str:
    """Return the JSON document."""
    import tomllib

    rows = [contact.row() for contact in contacts]
    settings = tomllib.loads(scenario.to_toml())
    return output.document("wall", rows, scenario=settings, through=through)


def report_fault(error: LoopFault, out: Path | None) -> NoReturn:
    """End the command, leaving the log of the run that stopped."""
    what = "; ".join(filter(None, [str(error).partition("; see")[0], error.remedy]))
    if out is None:
        output.fail(f"{error.trace.law}: {what}; its log is kept with --out", code=output.FAILED)
    name = f"{error.trace.law}-fault.npz"
    with output.results(out) as draft:
        if draft is not None:
            error.trace.to_npz(draft / name)
    output.fail(f"{error.trace.law}: {what}; its log is {out / name}", code=output.FAILED)


def show(scenario: Scenario, contacts: list[Contact], through: str | None = None) -> None:
    """Print the table, a few laws at a time, and what was simulated."""
    from ebac._util import formatting

    show_contacts(contacts)
    output.say("Simulated, not measured:", style="bold")
    output.indented(formatting.describe(scenario).replace("; ", "\n"))
    if through is not None:
        output.indented(
            "through a CAN bus in this process, with simulated CANopen drives, torque in whole thousandths of the "
            "rated one: the same to the bit without the bus by --device-permille"
        )


def show_contacts(contacts: list[Contact]) -> None:
    """Print the table, a few laws at a time."""
    for first in range(0, len(contacts), LAWS_ABREAST):
        part = contacts[first : first + LAWS_ABREAST]
        show_table({contact.law: contact for contact in part})


def show_table(columns: Mapping[str, Contact], *, verdict: bool = True) -> None:
    """Print contacts side by side, each under its heading, and their verdict."""
    from ebac._util import formatting

    contacts = list(columns.values())
    grid = output.table(["", *columns], numbers=range(1, 99))
    for label, name, unit, none in LINES:
        cells = (getattr(contact, name) for contact in contacts)
        signed = name == "deviation_m"
        grid.add_row(
            label, *(formatting.quantity(c, unit, signed=signed, none=none) for c in cells)
        )
    if verdict:
        grid.add_section()
        grid.add_row("verdict", *(_verdict(contact) for contact in contacts))
    output.show(grid)


def _verdict(contact: Contact) -> str:
    from ebac._util import formatting

    words = re.sub(r" (?=by|and|not quiet)|(?<=,) ", "\n", formatting.verdict(contact))
    good = contact.quiet and contact.exact is not False
    return f"[{'green' if good else 'yellow' if contact.still else 'red'}]{words}[/]"
