"""`ebac tune`: a law's parameters searched on training hands, judged on others."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, completion, from_options, interrupts, options, output
from ebac.cli.files import PANEL, Force, free_folder
from ebac.cli.studies import replaced

if TYPE_CHECKING:
    from ebac.studies import Tuned

_SEARCH = "Search"


def tune(
    device: options.DeviceOptions,
    length: options.RunOptions,
    law: Annotated[
        str,
        typer.Argument(
            help="A law, see `ebac laws`, or of your own in Python, FILE.py:NAME; several separated by commas, `all` "
            "for every law with parameters to tune.",
            autocompletion=completion.laws,
        ),
    ],
    condition: Annotated[
        list[str] | None,
        options.conditions(
            "Conditions of the search, see `ebac conditions`; each delay is tuned for itself.",
            panel=_SEARCH,
            default="d0K10, d0K20, d1K10, d1K20, d2K10, d2K20",
        ),
    ] = None,
    hands: Annotated[
        int,
        typer.Option(help="Random training hands.", min=1, max=1_000_000, rich_help_panel=_SEARCH),
    ] = 24,
    evaluations: Annotated[
        int,
        typer.Option(
            help="Number of points to try for each delay.",
            min=2,
            max=10_000_000,
            rich_help_panel=_SEARCH,
        ),
    ] = 120,
    seed: Annotated[
        int, typer.Option(help="Seed of noise, jitter and search.", min=0, rich_help_panel=_SEARCH)
    ] = 1,
    threads: options.Threads = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Folder for the results, new or empty: tune.json, and tune.csv with the table; written only if given.",
            rich_help_panel=PANEL,
        ),
    ] = None,
    force: Force = False,
    as_json: output.AsJson = False,
) -> None:
    """Search the best parameters of a law.

    A simulation. The parameters are searched on random training hands; the table shows the 60 hands of the grid, with
    the parameters of the design and with those found. The number of good hands, which are exact and quiet in position
    and force, counts most; then those in time and the stiffness on impact; then settling, energy drawn and the force
    swing at rest. With --observer-every-law
    the law uses the estimate of the observer, otherwise the encoder. Ctrl-C keeps the best parameters so far.

    Of a law of your own in Python those fields are searched that are numbers. Each declares its range:
    `damping: float = field(default=30.0, metadata={"unit": "N s/m", "low": 0, "high": 100})`.

    The parameters found for the reference device, with 0.03 N of sensor noise, are part of the package under names
    such as `tca-damped-tuned` and, acting on the observer's estimate, `tca-damped-tuned-observer`.

    **Examples**

    * `ebac tune tca-damped --condition d1K10 --hands 4 --evaluations 8`: a short search

    * `ebac tune tca-damped --device-noise 0.03 --observer-every-law --out tuned`

    * `ebac tune all --device-noise 0.03 --evaluations 480 --json > tuned_rivals.json`: the tuned laws of this package
    """
    from ebac.operators import Operators
    from ebac.studies import TuningInterrupted
    from ebac.studies import tune as search
    from ebac.studies.tuning import HANDS_SEED, RANGES, TUNING_CONDITIONS

    found: list[Tuned] = []
    stopped = False
    folder = None if out is None else free_folder(out, force=force)
    with output.refusing():
        laws = by_name.laws([law], "LAW", many=True)
        if law.lower() == "all":
            laws = {name: one for name, one in laws.items() if name in RANGES}
        wanted = by_name.condition_names(condition or TUNING_CONDITIONS)
        base = from_options.scenario(device, length)
        replaced.note(base, wanted)
        training = Operators.sample(hands, HANDS_SEED)
        for name, one in laws.items():
            with output.counting(f"tuning {name}", quiet=as_json) as progress:
                try:
                    found += search(
                        one, wanted, training=training, base=base, evaluations=evaluations, seed=seed,
                        threads=threads, progress=progress,
                    )  # fmt: skip
                except TuningInterrupted as interrupted:
                    found += interrupted.result
                    stopped = True
                    break
    text = output.document("tune", [one.row() for one in found], complete=not stopped)
    if folder is not None and found:
        with output.results(folder) as draft:
            _write(draft, text, found)
    if as_json:
        typer.echo(text)
    elif found:
        _show(found)
        if folder is not None:
            output.list_files(folder, ["tune.csv", "tune.json"])
    if stopped:
        interrupts.keeping("the best so far was printed" if found else "nothing was tried yet")
        raise KeyboardInterrupt


def _write(draft: Path | None, text: str, found: list[Tuned]) -> None:
    """Write the JSON document, and a row for each law, condition, and design or tuned."""
    if draft is None:
        return
    rows: list[dict[str, Any]] = [
        {"law": one.law, "parameters": what, **asdict(row)}
        for one in found
        for both in zip(one.default, one.test, strict=True)
        for what, row in zip(("designed", "tuned"), both, strict=True)
    ]
    (draft / "tune.json").write_text(text + "\n", encoding="utf-8")
    output.csv_table(draft / "tune.csv", rows)


def _to_copy(one: Tuned) -> str:
    """Return the options that give another command the parameters found, all digits included."""
    values = [
        ("off", "on")[v] if isinstance(v, bool) else str(v).removesuffix(".0")
        for v in one.changes.values()
    ]
    pairs = ",".join(f"{name}={value}" for name, value in zip(one.changes, values, strict=True))
    return f"--change {pairs}{' --observer-every-law' * one.observer}"


def _show(found: list[Tuned]) -> None:
    from ebac._util import formatting
    from ebac.laws.variant import shown_value

    def quantity(value: float | None, unit: str) -> str:
        return "-" if value is None else formatting.quantity(value, unit)

    headings = [
        "law",
        "condition",
        "parameters",
        "in position",
        "and force",
        "in time",
        "on impact",
        "settled",
        "drawn in any window",
        "force swing",
    ]
    grid = output.table(headings, numbers=range(3, 10))
    for one in found:
        for rows in zip(one.default, one.test, strict=True):
            for what, row in zip(("designed", "tuned"), rows, strict=True):
                of = f" of {row.hands}"
                in_time = "-" if row.settled_in_time is None else f"{row.settled_in_time}{of}"
                grid.add_row(
                    one.law, row.condition, what, f"{row.exact_and_still}{of}", f"{row.good}{of}", in_time,
                    quantity(row.median_impact_share, "share"), quantity(row.median_settled_s, "s"),
                    quantity(row.most_drawn_J, "J"), quantity(row.force_swing_N, "N"),
                )  # fmt: skip
    output.show(grid)
    output.say(
        "Good hands by their position alone, and by position and force. In time: of the former, those that settle "
        "within 1.5 times what they need at an ideal wall, plus 0.2 s. On impact: median share of the wall's stiffness "
        "where a hand is deepest. Settled: median of the good, - where there is none. Force swing: peak to peak at "
        "rest, the largest of the hands good in position. Cost: mean of the training hands, less is better; 0 for a "
        "good hand that meets the full wall and settles at once, 1 and more for one that is not good."
    )
    for one in found:
        samples, acts = output.plural(one.delay, "sample"), ", on the observer" * one.observer
        changes = ", ".join(f"{n} = {shown_value(v)}" for n, v in one.changes.items())
        cost = f"cost {one.default_cost:.3f} -> {one.cost:.3f}"
        output.say(
            f"{one.law}, {samples} of delay{acts}: {changes or 'nothing better than the design'}; "
            f"{cost if changes else cost.partition(' ->')[0]}, {one.tried} points"
        )
        if changes:
            output.indented(_to_copy(one))
        for line in one.at_bounds:
            output.note(f"{one.law}, {samples} of delay: {line}")
    for line in (line for one in found for line in one.worse):
        output.note(f"{line}; search with more --hands or --evaluations, or keep the design")
    output.say("Simulated, not measured.", style="bold")
