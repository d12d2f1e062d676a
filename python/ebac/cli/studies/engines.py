"""`ebac engines`: laws before a world that is computed slower than the loop runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ebac.cli import by_name, engine_options, from_options, options, output
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.scenario import Scenario
    from ebac.studies.engines import EngineRow, Engines


def engines(
    setup: options.ScenarioOptions,
    to: ResultOptions,
    law: Annotated[
        list[str] | None, options.laws("direct, tca-damped, passivity-control, ebac")
    ] = None,
    engine_rate: Annotated[
        list[float] | None,
        options.option(
            text="Calls of the engine per second [Hz]; several separated by commas",
            default="60, 500",
            panel=engine_options.ENGINE,
        ),
    ] = None,
    engine_jitter: engine_options.EngineJitter = None,
    engine_compute: engine_options.EngineCompute = None,
    as_json: output.AsJson = False,
) -> None:
    """Compare laws with a physics engine that is slower than the loop.

    A simulation. Each law renders the world in three ways: computed in every tick; by an engine whose force is held
    until its next answer; and by the same engine with local models as answers, which the loop renders in every tick.
    *passive* means that the port gave out no more than 1 mJ.

    **Examples**

    * `ebac engines`: a plane of 10 kN/m, engines at 60 and 500 Hz, 10 ms of jitter

    * `ebac engines --world sphere --wall-position 0.01 --law direct,ebac --engine-rate 30`

    * `ebac engines --wall-stiffness 500 --json`: a soft wall
    """
    from ebac.studies.engines import JITTER, LAWS, RATES
    from ebac.studies.engines import engines as compare

    with output.refusing():
        laws = by_name.laws(law or LAWS, many=True)
        base = _scenario(setup)
        folder = to.folder("engines", as_json=as_json)
        with output.counting("simulating", quiet=as_json) as progress:
            found = compare(
                list(laws.values()),
                base=base,
                rates=engine_rate or RATES,
                jitter=JITTER if engine_jitter is None else engine_jitter,
                compute=engine_compute,
                progress=progress,
            )
    to.report(
        folder, "engines", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=lambda: _show(found),
    )  # fmt: skip


def _scenario(setup: options.ScenarioOptions) -> Scenario:
    """Return the scenario; without a world or file of its own a plane that the handle approaches."""
    from dataclasses import replace

    if setup.scenario is None and setup.wall_position is None:
        setup = replace(setup, wall_position=0.01)
    return from_options.scenario(setup, seconds=4.0)


def _document(found: Engines) -> str:
    return output.document("engines", found.table())


def _fill(draft: Path, found: Engines, to: ResultOptions) -> None:
    from ebac.plot import plot_engines

    to.save(plot_engines(found), draft, "engines")
    output.csv_table(draft / "engines.csv", found.table())
    found.base.save(draft / "scenario.toml")


def _show(found: Engines) -> None:
    from ebac._util import descriptions, formatting

    grid = output.table(["law", "world", "swing", "least energy", "verdict"], numbers=(2, 3))
    before = None
    for row in found.rows:
        if before not in (None, row.law):
            grid.add_section()
        rate = "" if row.rate_Hz is None else f"{row.rate_Hz:g} Hz, "
        grid.add_row(
            row.law if row.law != before else "",
            rate + row.rendered.removeprefix("force ").removeprefix("local "),
            formatting.quantity(row.swing_m, "m"),
            formatting.quantity(row.least_energy_J, "J"),
            _verdict(row),
        )
        before = row.law
    output.show(grid)
    late = next((row for row in found.rows if row.rate_Hz is not None), None)
    if late is not None:
        output.say(
            f"held: the engine's force until its next answer; model: its local model in every tick. Answers take "
            f"{_times(found)} and up to {1e3 * (late.jitter_s or 0):g} ms more at random."
        )
    output.say("Simulated, not measured:", style="bold")
    output.indented(descriptions.describe(found.base).replace("; ", "\n"))


def _times(found: Engines) -> str:
    """Return how long answers take at least: "17 ms or 2 ms"."""
    times = dict.fromkeys(row.compute_s for row in found.rows if row.compute_s is not None)
    return " or ".join(f"{1e3 * one:.2g} ms" for one in times)


def _verdict(row: EngineRow) -> str:
    words = ["quiet" if row.quiet else "still" if row.still else "shakes"]
    if row.exact is not None and row.still:
        words.append("exact" if row.exact else "too deep")
    if row.still and not row.passive:
        words.append("active")
    good = row.quiet and row.passive and row.exact is not False
    tint = "green" if good else "yellow" if row.still else "red"
    return f"[{tint}]{', '.join(words)}[/]"
