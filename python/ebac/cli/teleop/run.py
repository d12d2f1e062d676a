"""`ebac teleop run`: every scheme over one network."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.headings import with_units
from ebac.cli import completion, options, output
from ebac.cli.files import ResultOptions
from ebac.cli.teleop.options import NAMES, LinkOptions, MasterOptions

if TYPE_CHECKING:
    from ebac.teleop import Run


def run(
    to: ResultOptions,
    over: LinkOptions,
    master: MasterOptions,
    scheme: Annotated[
        list[str] | None,
        typer.Option(
            help=f"Schemes, separated by commas: {NAMES}.",
            show_default="all",
            autocompletion=completion.schemes,
        ),
    ] = None,
    law: Annotated[
        str | None,
        typer.Option(help="Law of the master; see `ebac laws`.", show_default="that of the scheme"),
    ] = None,
    contact_stiffness: Annotated[
        float,
        typer.Option(
            help="Stiffness of the contact that the slave meets at 20 mm [N/m]; 0 for none.",
            min=0,
            max=1e5,
        ),
    ] = 500.0,
    seconds: Annotated[float, typer.Option(help="Length of the run [s].", min=3, max=600)] = 10.0,
    seed: options.Seed = None,
    as_json: output.AsJson = False,
) -> None:
    """Simulate a master, a network and a slave in contact, under each scheme.

    A hand moves the stick to 45 mm; the slave follows through the network and meets a spring at 20 mm. The table
    shows the swing of the stick at rest, the energies of the master's port and of both ports, and the stiffness at
    the stick divided by that at the slave. Of `--scenario` device, timing and observer are used.

    **Examples**

    * `ebac teleop run`

    * `ebac teleop run --delay 0.2 --jitter 0.01 --loss 0.1 --scheme waves,ebac --device-noise 0.03`

    * `ebac teleop run --contact-stiffness 2000 --law eba --scheme position-force --json`
    """
    from ebac.teleop import SCHEMES, SlaveModel, simulate

    with output.refusing():
        names = output.words(scheme or SCHEMES)
        folder = to.folder("teleop-run", as_json=as_json)
        stick = master.stick()
        runs = [
            simulate(
                name,
                law=law,
                there=over.link(),
                slave=SlaveModel(contact_stiffness=contact_stiffness),
                seconds=seconds,
                seed=1 if seed is None else seed,
                scenario=stick,
            )
            for name in names
        ]
    rows = [_row(one) for one in runs]
    files = _write(folder, runs, rows, to) if folder else []
    if as_json:
        typer.echo(output.document("teleop run", rows, **_settings(runs[0])))
        return
    _show(runs, rows)
    if folder is not None:
        output.list_files(folder, files)


def _row(one: Run) -> dict[str, Any]:
    return {
        "scheme": one.scheme.name,
        "still": one.still,
        "passive": one.passive,
        "two_port_passive": one.two_port_passive,
        "swing_m": one.swing_m,
        "least_master_J": one.least_master_J,
        "least_network_J": one.least_network_J,
        "transparency": one.transparency,
        "drift_m": one.drift_m,
        "rest_N": one.rest_N,
        "most_N": one.most_N,
        "whole": one.whole,
        "at_master": one.at_master,
        "at_slave": one.at_slave,
    }


def _settings(one: Run) -> dict[str, Any]:
    """Return what all schemes have in common: network, slave, hand and device, units in the keys."""
    parts: dict[str, Any] = {"there": one.there, "back": one.back, "slave": one.slave}
    return {
        **{name: with_units(part.as_dict(), _units(part)) for name, part in parts.items()},
        "scenario": tomllib.loads(one.scenario.to_toml()),
    }


def _units(part: Any) -> dict[str, str]:
    fields = type(part).fields()
    return {one.name: one.unit.replace("/", " per ") for one in fields if one.unit != "1"}


def _write(
    folder: Path, runs: list[Run], rows: list[dict[str, Any]], to: ResultOptions
) -> list[str]:
    import numpy as np

    from ebac.plot import plot_teleop_runs

    with output.results(folder) as draft:
        if draft is None:
            return []
        figures = to.save(plot_teleop_runs(runs), draft, "runs")
        document = output.document("teleop run", rows, **_settings(runs[0]))
        (draft / "runs.json").write_text(document + "\n", encoding="utf-8")
        for one in runs:
            columns: dict[str, Any] = dict(one.columns)
            np.savez_compressed(draft / f"{one.scheme.name}.npz", **columns)
    return [*figures, "runs.json", *(f"{one.scheme.name}.npz" for one in runs)]


def _show(runs: list[Run], rows: list[dict[str, Any]]) -> None:
    from ebac._util import formatting
    from ebac.teleop import run_text

    columns = [
        "scheme",
        "swing",
        "master, least",
        "both ports, least",
        "transparency",
        "drift",
        "at rest",
    ]
    grid = output.table(columns, numbers=(1, 2, 3, 4, 5, 6))
    for row in rows:
        ratio = row["transparency"]
        grid.add_row(
            row["scheme"],
            formatting.quantity(row["swing_m"], "m") if row["whole"] else "left",
            formatting.quantity(row["least_master_J"], "J"),
            formatting.quantity(row["least_network_J"], "J"),
            "" if ratio != ratio else f"{ratio:.2f}",
            formatting.quantity(row["drift_m"], "m"),
            formatting.quantity(row["rest_N"], "N"),
        )
    output.show(grid)
    for one in runs:
        output.say(f"{one.scheme.name}, law {one.law}: {run_text.verdict(one)}")
    output.say("Simulated, not measured:", style="bold")
    output.indented("\n".join(run_text.conditions(runs[0])[1:]))
    output.say(
        "Swing: of the stick over the last 30 %; energies: the lowest, the master's own damping counted; drift: master "
        "less slave; at rest: force on the environment."
    )
