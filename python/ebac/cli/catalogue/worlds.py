"""`ebac worlds`: the virtual worlds known by name."""

from __future__ import annotations

from typing import Annotated, Any

import typer
from rich.markup import escape

from ebac.cli import options, output, setting


def worlds(
    name: Annotated[
        str | None,
        typer.Argument(
            help="One world: its bodies as TOML, for the table `environment` of a scenario.",
            show_default=False,
            autocompletion=options.complete_worlds,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """List the virtual worlds known by name, or show the bodies of one.

    Each lies with its surface at the origin and is met by a motion along +x. `mesh:FILE` is a mesh of your own, its
    longest side made 40 mm.

    **Examples**

    * `ebac worlds`

    * `ebac worlds sphere`: its bodies, to begin a scenario file with

    * `ebac wall --world sphere --law tca,ebac`: press a hand against it
    """
    from ebac.worlds import PRESETS

    if name is None:
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
    with output.refusing():
        text = _toml(name)
    typer.echo(output.document("worlds", [{"name": name, "toml": text}]) if as_json else text)


def _toml(name: str) -> str:
    import tomli_w

    from ebac._util.serialisation import to_document

    return tomli_w.dumps({"environment": to_document(setting.choose_world(name, option=""))})
