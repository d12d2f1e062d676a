"""`ebac teleop study`: every scheme, contact and network."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import completion, output
from ebac.cli.files import ResultOptions
from ebac.cli.teleop.options import NAMES, MasterOptions

if TYPE_CHECKING:
    from ebac.teleop import Study


def study(
    to: ResultOptions,
    master: MasterOptions,
    scheme: Annotated[
        list[str] | None,
        typer.Option(
            help=f"Schemes, separated by commas: {NAMES}.",
            show_default="all",
            autocompletion=completion.schemes,
        ),
    ] = None,
    delay: Annotated[
        list[float] | None,
        typer.Option(
            help="Delay in each direction [s]; several separated by commas.",
            show_default="0, 0.05, 0.2, 0.3",
        ),
    ] = None,
    contact_stiffness: Annotated[
        list[float] | None,
        typer.Option(
            help="Stiffness of the contact that the slave meets [N/m]; several separated by commas.",
            show_default="0, 500, 20000",
        ),
    ] = None,
    network: Annotated[
        str, typer.Option(help="rough: jitter of 10 ms, 10 % lost, 2 % held back; or clean.")
    ] = "rough",
    tune: Annotated[
        bool, typer.Option("--tune", help="Choose the parameters again on the training set.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Compare schemes in free motion, on soft tissue and on a hard contact, over delay, jitter and loss.

    A simulation of three hands in each case. The parameters of each scheme were the best on a training set of other
    contacts, delays and hands, with `--device-noise 0.03`; `--tune` repeats that search. Of `--scenario`
    device, timing and observer are used.

    **Examples**

    * `ebac teleop study --device-noise 0.03`

    * `ebac teleop study --network clean --scheme waves,ebac --delay 0.1`

    * `ebac teleop study --scheme ebac --contact-stiffness 100,1000 --json`
    """
    from ebac import teleop

    with output.refusing():
        names = output.words(scheme or teleop.SCHEMES)
        schemes = [teleop.scheme(name) for name in names]
        stick = master.stick()
        folder = to.folder("teleop-study", as_json=as_json)
        if tune:
            with output.progress(len(schemes), quiet=as_json) as step:
                for i, one in enumerate(schemes):
                    step(f"tuning {one.name}")
                    schemes[i] = teleop.tuned(one.name, scenario=stick)
        with output.counting("simulating", quiet=as_json) as progress:
            found = teleop.study(
                schemes,
                contacts={f"{k:g} N/m": k for k in contact_stiffness}
                if contact_stiffness
                else teleop.CONTACTS,
                delays=delay or teleop.DELAYS,
                networks=(network,),
                scenario=stick,
                progress=progress,
            )
    to.report(
        folder, "study", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, network, to), show=lambda: _show(found),
    )  # fmt: skip


def _document(found: Study) -> str:
    return output.document("teleop study", found.table(), schemes=found.parameters())


def _fill(draft: Path, found: Study, network: str, to: ResultOptions) -> None:
    from ebac.plot import plot_teleop

    to.save(plot_teleop(found, network), draft, "study")
    output.csv_table(draft / "study.csv", found.table())


def _show(found: Study) -> None:
    from ebac._util import formatting

    columns = [
        "contact",
        "delay",
        "scheme",
        "still",
        "passive",
        "both",
        "shaking",
        "both, least",
        "transparency",
    ]
    grid = output.table(columns, numbers=(3, 4, 5, 6, 7, 8))
    order = {one.name: i for i, one in enumerate(found.schemes)}
    contacts = list(dict.fromkeys(row.contact for row in found.rows))
    before = None
    rows = sorted(
        found.rows, key=lambda row: (contacts.index(row.contact), row.delay_s, order[row.scheme])
    )
    for row in rows:
        case = (row.contact, row.delay_s)
        if before not in (None, case):
            grid.add_section()
        grid.add_row(
            row.contact if case != before else "",
            f"{1e3 * row.delay_s:g} ms" if case != before else "",
            row.scheme,
            *(f"{n}/{row.runs}" for n in (row.still, row.passive, row.two_port_passive)),
            formatting.quantity(row.shaking_m, "m") if row.bounded else "left",
            formatting.quantity(row.least_network_J, "J"),
            "" if row.transparency != row.transparency else f"{row.transparency:.2f}",
        )
        before = case
    output.show(grid)
    output.say(
        "Simulated. Of the runs: the stick is still, its port passive, both ports together passive. Shaking about a "
        "line at the end and least energy: the worst; transparency: stiffness at the stick over that at the slave."
    )
