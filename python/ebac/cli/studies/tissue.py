"""`ebac tissue`: soft materials against their closed forms, and under laws."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import by_name, options, output
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.studies.tissue import Tissue


def tissue(
    to: ResultOptions,
    law: Annotated[
        list[str] | None, options.laws("direct, tca-damped, force-bounding, ebac")
    ] = None,
    depth: Annotated[
        float,
        typer.Option(help="Largest depth of the curves [m].", rich_help_panel=options.WALL),
    ] = 0.012,
    speed: Annotated[
        float,
        typer.Option(help="Speed of the curves, in and out [m/s].", rich_help_panel=options.WALL),
    ] = 0.02,
    as_json: output.AsJson = False,
) -> None:
    """Compare soft materials with their closed forms, and laws that render them.

    A simulation. An elastic, a Kelvin-Voigt, a Hunt-Crossley and a layered body are pressed and released at constant
    speed; force over depth, punctures, energy put in and energy returned are compared with closed forms. Then a hand
    of 300 N/m presses each body under every law and lets go.

    **Examples**

    * `ebac tissue`

    * `ebac tissue --speed 0.1 --law ebac`: five times as fast

    * `ebac tissue --depth 0.02 --json`
    """
    from ebac.studies.tissue import LAWS
    from ebac.studies.tissue import tissue as compare

    with output.refusing():
        laws = by_name.laws(law or LAWS, many=True)
        folder = to.folder("tissue", as_json=as_json)
        with output.counting("simulating", quiet=as_json) as progress:
            found = compare(list(laws.values()), depth=depth, speed=speed, progress=progress)
    to.report(
        folder, "tissue", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=lambda: _show(found),
    )  # fmt: skip


def _document(found: Tissue) -> str:
    return output.document("tissue", found.table(), laws=found.law_table())


def _fill(draft: Path, found: Tissue, to: ResultOptions) -> None:
    from ebac.plot import plot_tissue

    to.save(plot_tissue(found), draft, "tissue")
    output.csv_table(draft / "tissue.csv", found.law_table())


def _show(found: Tissue) -> None:
    _show_curves(found)
    _show_laws(found)


def _show_curves(found: Tissue) -> None:
    from ebac._util import formatting

    columns = ["material", "force error", "energy in", "exact", "given back", "exact"]
    grid = output.table(columns, numbers=(1, 2, 3, 4, 5))
    for name, curve in found.curves.items():
        energies = (curve.taken, curve.taken_exact, curve.back, curve.back_exact)
        grid.add_row(
            name,
            formatting.quantity(curve.error, "N"),
            *(formatting.quantity(one, "J") for one in energies),
        )
    output.show(grid)
    for name, curve in found.curves.items():
        for one, exact in zip(curve.punctures, curve.punctures_exact, strict=False):
            output.say(
                f"{name}: gives way at {1e3 * one.depth:.3f} mm, exact {1e3 * exact.depth:.3f} mm; "
                f"from {one.before:.2f} to {one.after:.2f} N, exact {exact.before:.2f} to {exact.after:.2f} N"
            )
    curve = next(iter(found.curves.values()))
    output.say(
        f"Pressed {1e3 * curve.depth.max():g} mm deep at {1e3 * curve.speed:g} mm/s and let out again; "
        "exact: the closed form."
    )


def _show_laws(found: Tissue) -> None:
    from ebac._util import formatting

    columns = ["material", "law", "least energy", "kept", "own loss", "force error"]
    grid = output.table(columns, numbers=(2, 3, 4, 5))
    before = None
    for row in found.rows:
        if before not in (None, row.material):
            grid.add_section()
        energies = (row.least_energy_J, row.kept_J, row.own_loss_J)
        grid.add_row(
            row.material if row.material != before else "",
            row.law,
            *(formatting.quantity(one, "J") for one in energies),
            formatting.quantity(row.force_error_N, "N"),
        )
        before = row.material
    output.show(grid)
    output.say(
        "A hand of 300 N/m presses and lets go, simulated. Least energy: at the physical port, the device's damping "
        "counted. Kept: what the motor's force took; own loss: what the material takes of the same motion."
    )
