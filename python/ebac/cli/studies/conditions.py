"""`ebac conditions`: what a study can be run under."""

from __future__ import annotations

from typing import Any

import typer

from ebac.cli import output


def conditions(as_json: output.AsJson = False) -> None:
    """List the conditions of `ebac study` and the groups they belong to."""
    from ebac.studies import CONDITIONS, GROUPS

    rows: list[dict[str, Any]] = [
        {
            "condition": one.name,
            "what": one.summary,
            "groups": [name for name, members in GROUPS.items() if one.name in members],
        }
        for one in CONDITIONS.values()
    ]
    if as_json:
        typer.echo(output.document("conditions", rows))
        return
    grid = output.table(["condition", "what", "groups"])
    for row in rows:
        grid.add_row(row["condition"], row["what"], ", ".join(row["groups"]))
    output.console().print(grid)
