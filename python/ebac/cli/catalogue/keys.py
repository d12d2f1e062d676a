"""`ebac keys`: the keys of the files that describe a run."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from ebac._util.arguments import unknown
from ebac.cli import completion, output

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ebac.hardware.keys import FileKey


def keys(
    name: Annotated[
        str | None,
        typer.Argument(
            help="A table (limits, device.motor, device), a key (thermal_time), or a kind of file (profile, network, "
            "scenario, configuration); without one, list the tables.",
            show_default=False,
            autocompletion=completion.keys,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """List the keys of configurations, scenarios, drive profiles and network files: unit, default, range, meaning.

    Defaults that follow from the device are those of the reference device. The parameters of a law, which stand in the
    table `law`, are listed by `ebac laws NAME`.

    **Examples**

    * `ebac keys`: every table with its keys

    * `ebac keys limits`: the keys of this table, in a configuration and in a drive profile

    * `ebac keys device.motor`: those of the motor, and where a data sheet has them

    * `ebac keys thermal_time`: one key
    """
    from ebac.hardware.keys import file_keys

    every = file_keys()
    found = every if name is None else _called(name, every)
    if as_json:
        typer.echo(output.document("keys", [one.row() for one in found]))
    elif name is None:
        _list(found)
    else:
        for (heading, kind, files), rows in groupby(
            found, lambda one: (one.heading, one.type, one.files)
        ):
            typed = f', type = "{kind}"' if kind else ""
            output.say(f"{heading}{typed} ({', '.join(files)})", style="bold")
            _show(list(rows))


def _called(name: str, every: Sequence[FileKey]) -> Sequence[FileKey]:
    """Return the keys of a table, a key or a kind of file of that name."""
    wanted = name.strip("[]")
    ways = (_is_table, _is_key, _is_kind)
    found = next((keys for fits in ways if (keys := [k for k in every if fits(k, wanted)])), None)
    if found is None:
        output.fail(unknown(f"NAME {name}", wanted, names(every), "table"))
    return found


def names(every: Sequence[FileKey]) -> list[str]:
    """Return the names of tables and kinds of files."""
    tables = (
        part for one in every if one.table for part in (one.table.partition(".")[0], one.table)
    )
    return list(dict.fromkeys([*tables, *(_short(kind) for one in every for kind in one.files)]))


def _is_table(one: FileKey, wanted: str) -> bool:
    places = (one.table, *(f"{_short(kind)}.{one.table}" for kind in one.files))
    return any(place == wanted or place.startswith(f"{wanted}.") for place in places if one.table)


def _is_key(one: FileKey, wanted: str) -> bool:
    return wanted in (one.name, f"{one.table}.{one.name}")


def _is_kind(one: FileKey, wanted: str) -> bool:
    return any(wanted in (kind, _short(kind)) for kind in one.files)


def _short(kind: str) -> str:
    return kind.partition(" ")[0]


def _list(found: Sequence[FileKey]) -> None:
    grid = output.table(["table", "file", "keys"])
    for (heading, files), rows in groupby(found, lambda one: (one.heading, one.files)):
        of_table = ", ".join(dict.fromkeys(one.name for one in rows))
        grid.add_row(escape(heading), ", ".join(files), escape(of_table))
    output.show(grid)
    output.say("`ebac keys TABLE` shows unit, default, range and meaning, `ebac keys KEY` one key.")


def _show(rows: Sequence[FileKey]) -> None:
    grid = output.table(["key", "default", "range", "unit", "meaning", "sets"])
    for one in rows:
        unit = "" if one.unit == "1" else one.unit
        cells = (one.name, one.default_text, one.range_text, unit, one.text, one.sets)
        key, default, allowed, unit, meaning, sets = map(escape, cells)
        if one.warning:
            meaning += f". [bold]{escape(one.warning_text)}[/]"
        grid.add_row(key, default, allowed, unit, meaning, sets)
    output.show(output.filled(grid))
