"""What `ebac study` gives: tables, a JSON document, figures, and the traces of failures."""

from __future__ import annotations

from collections import Counter, defaultdict
from itertools import chain, zip_longest
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._util.file_names import file_name
from ebac.cli import output
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.studies import Failure, Study, StudyRow

#: Folder of the sweep's bundles inside the results, for `--resume`.
BUNDLES = "sweep"
#: Failures named on the screen, and traces kept where no number is given: one of each law and condition, at most so
#: many; the files name all.
SHOWN, KEPT = 12, 20
#: Columns of failures.csv.
FAILURES = ("law", "condition", "operator", "hand", "why")


def fill(draft: Path, study: Study, traces: int | None, to: ResultOptions, *, quiet: bool) -> None:
    """Write tables, figures and so many traces of failures into a draft of the results."""
    from ebac.plot import plot_study

    most = min(KEPT, len(_counted(study.failures))) if traces is None else traces
    kept = spread(study.failures, most)
    with output.progress(3 + len(kept), quiet=quiet) as step:
        step("writing tables")
        study.save(draft / "study.csv")
        study.operators.to_csv(draft / "population.csv")
        study.result().to_csv(draft / "runs.csv")
        write_failures(draft / "failures.csv", study)
        step("drawing")
        for name, figure in plot_study(study):
            to.save(figure, draft, f"study-{name}")
        for failure in kept:
            step("keeping traces of failures")
            which = failure.operator or f"drive{failure.drive}"
            name = f"failure-{file_name(failure.law)}-{failure.condition}-{which}.npz"
            study.trace(failure.run).to_npz(draft / name)


def write_failures(file: Path, study: Study) -> None:
    """Write every hand that failed as CSV."""
    failures = [
        {"law": f.law, "condition": f.condition, "operator": f.operator, "hand": f.name, "why": f.why}
        for f in study.failures
    ]  # fmt: skip
    output.csv_table(file, failures, FAILURES)


def spread(failures: list[Failure], most: int) -> list[Failure]:
    """Return at most so many failures, in turn from every law and condition, the rarest failures first."""
    groups = defaultdict(list)
    for failure in failures:
        groups[failure.law, failure.condition].append(failure)
    turns = chain.from_iterable(zip_longest(*sorted(groups.values(), key=len)))
    return [failure for failure in turns if failure is not None][:most]


def show(study: Study, *, files: bool) -> None:
    """Print the table, and which hands failed; `files` says whether there are files that name all."""
    from ebac._util import formatting

    headings = [
        "condition",
        "law",
        "hands",
        "ideal wall good",
        "good",
        "exact, still",
        "in time",
        "quiet force",
        "least energy",
        "drawn in any window",
        "power at rest",
        "settled",
        "stiffness on impact",
        "ended early",
    ]
    grid = output.table(headings, numbers=range(2, len(headings)))
    last = ""
    for row in study.rows:
        if last and row.condition != last:
            grid.add_section()
        grid.add_row(
            row.condition if row.condition != last else "",
            row.law,
            str(row.hands),
            "-" if row.ideal_good is None else str(row.ideal_good),
            _count(row.good, row),
            _count(row.exact_and_still, row),
            _count(row.settled_in_time, row),
            _count(row.force_quiet, row),
            formatting.quantity(row.least_energy_J, "J"),
            formatting.quantity(row.most_drawn_J, "J"),
            formatting.quantity(row.least_rest_power_W, "W"),
            formatting.quantity(row.median_settled_s, "s", none="never"),
            formatting.quantity(row.median_impact_share, "share"),
            f"[red]{row.ended_early}[/]" if row.ended_early else "",
        )
        last = row.condition
    output.show(output.filled(grid))
    _show_failures(study, files=files)
    words = {
        "ideal wall good: hands that would be good at an ideal wall, - where that is not known, as for a hand with a "
        "model of its own": any(row.ideal_good is not None for row in study.rows),
        "power at rest: the lowest mean rate of the port energy while a hand rests for 20 s and more, below 0 it is "
        "drawn": any(row.least_rest_power_W is not None for row in study.rows),
        "settled, stiffness on impact: medians": True,
        "ended early: by a fault, or diverged": any(row.ended_early for row in study.rows),
    }
    meant = "; ".join(word for word, shown in words.items() if shown)
    output.say(f"{meant}. `ebac study --help` defines the rest.")
    output.say("Simulated, not measured.", style="bold")


def _count(count: int | None, row: StudyRow) -> str:
    if count is None:
        return "-"
    style = "green" if count == row.hands else "red" if count == 0 else "yellow"
    return f"[{style}]{count}[/]"


def _show_failures(study: Study, *, files: bool) -> None:
    failures, unjudged = study.failures, study.unjudged
    for condition, why in unjudged.items():
        output.say(
            f"{condition}: hands are not judged good or exact, there is no ideal rest: {why}. Look at least energy and "
            "drawn in any window."
        )
    if not failures:
        if len(unjudged) < len(study.conditions):
            every = "Every other hand is good." if unjudged else "Every hand is good."
            output.say(every, style="green")
        return
    counted = _counted(failures)
    for failure in spread(failures, min(SHOWN, len(counted))):
        count = counted[failure.law, failure.condition]
        hand = f"{'the first ' if count > 1 else ''}#{failure.operator} ({failure.name})"
        output.say(
            f"{failure.law}, {failure.condition}: {output.plural(count, 'hand')} not good, {hand}: {failure.why}"
        )
    if len(failures) > min(SHOWN, len(counted)):
        all_of_them = f"names all {len(failures)} runs of them."
        output.say(
            f"failures.csv {all_of_them}"
            if files
            else f"Without --no-files failures.csv {all_of_them}"
        )


def _counted(failures: list[Failure]) -> Counter[tuple[str, str]]:
    """Return how many failures there are of each law and condition."""
    return Counter((failure.law, failure.condition) for failure in failures)
