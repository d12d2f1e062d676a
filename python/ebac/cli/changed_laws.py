"""Laws by name, and one of them once more with other parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ebac.cli import options, setting

if TYPE_CHECKING:
    from ebac.laws import AnyLaw

Change: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        help="The law once more, with other parameters: NAME=VALUE in SI units, on or off; several separated by "
        "commas; repeat it. Wants one --law. `ebac laws NAME` lists the parameters.",
        rich_help_panel=options.RUN,
    ),
]


def beside(laws: Mapping[str, AnyLaw], changes: Sequence[str]) -> dict[str, AnyLaw]:
    """Return laws by name, and the only one once more with each of `changes`."""
    from ebac.laws import changed

    _of_one(laws, changes)
    more = {
        f"{name}, {change}": changed(law, **setting.parse_change(change))
        for change in changes
        for name, law in laws.items()
    }
    return {**laws, **more}


def instead(laws: Mapping[str, AnyLaw], changes: Sequence[str]) -> list[AnyLaw]:
    """Return laws, or the only one with other parameters, which are given once."""
    from ebac.laws import changed

    _of_one(laws, changes)
    if len(changes) > 1:
        raise ValueError(
            f"--change {changes[1]}: one law is searched, and --change {changes[0]} was given already; "
            f"separate the changes by commas: --change {','.join(changes)}"
        )
    if not changes:
        return list(laws.values())
    return [changed(law, **setting.parse_change(changes[0])) for law in laws.values()]


def _of_one(laws: Mapping[str, AnyLaw], changes: Sequence[str]) -> None:
    if changes and len(laws) != 1:
        raise ValueError(
            f"--change {changes[0]}: changes one law, not {len(laws)}; give one --law, as --law {next(iter(laws))}"
        )
