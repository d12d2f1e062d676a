"""Laws by name, and one of them once more with other parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ebac.cli import options, setting

if TYPE_CHECKING:
    from ebac.laws import Variant

Change: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        help="The law once more, with other parameters: NAME=VALUE in SI units, on or off; several separated by "
        "commas; repeat it. Wants one --law. `ebac laws NAME` lists the parameters.",
        rich_help_panel=options.RUN,
    ),
]


def beside(names: list[str], changes: list[str]) -> dict[str, str | Variant]:
    """Return the laws by name, and the one of `changes` once more with each of them."""
    from ebac.laws import Variant

    laws: dict[str, str | Variant] = {name: name for name in names}
    _of_one(names, changes)
    for change in changes:
        laws[f"{names[0]}, {change}"] = Variant(names[0], setting.parse_change(change))
    return laws


def instead(names: list[str], changes: list[str]) -> list[str | Variant]:
    """Return the laws by name, or the only one with other parameters, which are given once."""
    from ebac.laws import Variant

    _of_one(names, changes)
    if len(changes) > 1:
        raise ValueError(
            f"--change {changes[1]}: one law is searched, and --change {changes[0]} was given already; "
            f"separate the changes by commas: --change {','.join(changes)}"
        )
    return [Variant(names[0], setting.parse_change(one)) for one in changes] or [*names]


def _of_one(names: list[str], changes: list[str]) -> None:
    if changes and len(names) != 1:
        raise ValueError(
            f"--change {changes[0]}: changes one law, not {len(names)}; give one --law, as --law {names[0]}"
        )
