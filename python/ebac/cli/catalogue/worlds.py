"""`ebac worlds`: the virtual worlds known by name."""

from __future__ import annotations

from typing import Annotated, Any

import typer
from rich.markup import escape

from ebac.cli import completion, output, setting
from ebac.cli.catalogue import contact_at_place


def worlds(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Name of a world: print its bodies as TOML, for the table `environment` of a scenario.",
            show_default=False,
            autocompletion=completion.worlds,
        ),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y,Z",
            help="Show force, normal, depth and stiffness at this position [m] instead. May be given several times.",
            show_default=False,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """List the virtual worlds known by name, or show the bodies of one or the contact at a position.

    The surface of each world is at the origin and is touched by a motion along +x. `mesh:FILE` is a mesh of your own,
    scaled so that its longest side is 40 mm.

    **Examples**

    * `ebac worlds`

    * `ebac worlds sphere`: its bodies, as the start of a scenario file

    * `ebac worlds sphere --at 0.001,0,0`: force, normal, depth and stiffness 1 mm inside

    * `ebac wall --world sphere --law tca,ebac`: press a hand against it
    """
    from ebac.worlds import PRESETS

    if name is None:
        if at:
            output.fail(
                f"--at {at[0]}: in which world? give its name, as in `ebac worlds sphere --at {at[0]}`"
            )
        rows: list[dict[str, Any]] = [
            {"name": key, "what": known.what, "needs": "ebac[worlds]" if known.extra else None}
            for key, known in PRESETS.items()
        ]
        rows.append(
            {"name": "mesh:FILE", "what": "a mesh of your own, 40 mm long", "needs": "ebac[worlds]"}
        )
        if as_json:
            typer.echo(output.document("worlds", rows))
            return
        grid = output.table(["world", "what", "needs"])
        for row in rows:
            grid.add_row(row["name"], row["what"], escape(row["needs"] or "-"))
        output.show(grid)
        return
    with output.refusing(), output.counting_meshes():
        world = setting.choose_world(name, option="")
        if at:
            contact_at_place.show(name, world, at, as_json=as_json)
            return
        text = output.toml(environment=world)
    typer.echo(output.document("worlds", [{"name": name, "toml": text}]) if as_json else text)
