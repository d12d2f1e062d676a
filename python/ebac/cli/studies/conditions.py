"""`ebac conditions`: what a study can be run under."""

from __future__ import annotations

from typing import Any

import typer

from ebac.cli import output


def conditions(as_json: output.AsJson = False) -> None:
    """List the conditions of a study and their groups.

    A name such as d1b2K10 stands for 1 sample of delay, device damping 2 N s/m, and a wall of 10 kN/m. Any other
    numbers may be written in their places where a condition is asked for: d2b0.5K15, or d2K15, which leaves the device
    its damping. K15 changes the stiffness of the wall only: delay, device and the wall's damping are those of the
    scenario.

    **Examples**

    * `ebac conditions`

    * `ebac study --condition five --law ebac`: the five of one group

    * `ebac study --condition d2K15 --law ebac`: 2 samples of delay, 15 kN/m

    * `ebac study --condition K5,K10,K20 --law ebac`: three walls, all else as in the scenario
    """
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
        groups = [name for name in row["groups"] if name != "all"]
        grid.add_row(row["condition"], row["what"], ", ".join(groups))
    output.show(grid)
    output.say(
        "The group `all` is every condition. Written out: d2b0.5K15, or K15 for the wall alone, see --help."
    )
