"""Commands that are imported when they are asked for, so that one of them does not wait for all others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Any, ClassVar, NamedTuple

import typer
import typer.main

from ebac.cli.command import Group, add


class Place(NamedTuple):
    """Where a command is, or a group of commands: its panel of the help, and module and name in `ebac.cli`."""

    panel: str
    at: str
    defaults: str | None = None


class Places(Mapping[str, Any]):
    """The commands of an app by name, each made the first time it is looked up."""

    def __init__(self, app: typer.Typer, places: dict[str, Place]) -> None:
        self._app, self._places = app, places
        self._made: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._made:
            self._made[name] = self._make(name, self._places[name])
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def _make(self, name: str, place: Place) -> Any:
        module, _, attribute = place.at.partition(":")
        found = getattr(import_module(f"ebac.cli.{module}"), attribute)
        alone = typer.Typer(name=self._app.info.name, rich_markup_mode=self._app.rich_markup_mode)
        if isinstance(found, typer.Typer):
            alone.add_typer(found, name=name, rich_help_panel=place.panel)
        else:
            add(alone, found, name, panel=place.panel, defaults=place.defaults)
        group: Any = typer.main.get_group(alone)
        return group.commands[name]


class GroupByNeed(Group):
    """A command of commands that are imported when they are asked for; a subclass has `app` and `places`."""

    app: ClassVar[typer.Typer]
    places: ClassVar[dict[str, Place]]

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self.commands: Any = Places(self.app, self.places)

    def list_commands(self, ctx: Any) -> list[str]:
        """Return all names, in the order of the help."""
        return list(self.commands)
