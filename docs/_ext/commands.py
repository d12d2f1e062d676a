"""`{commands}`: every command of `ebac` with all its options, read from the program when the site is built."""

import re
from collections.abc import Iterator
from typing import Any

import typer.main
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

#: "Meaning.  [default: 1; x>=1]", as typer writes the help of an option.
HELP = re.compile(r"^(.*?)(?:\s+\[((?:default|required|env var|\d|x|[<>]).*)\])?$", re.S)


class Commands(SphinxDirective):
    """One section for each panel of `ebac --help`, in it one for each command."""

    def run(self) -> list[nodes.Node]:
        from ebac.cli import app

        root: Any = typer.main.get_command(app)
        panels: dict[str, list[nodes.Node]] = {}
        for name, command in root.commands.items():
            if not command.hidden:
                shown = panels.setdefault(panel_of(command), [])
                shown += [self.section(*found) for found in walk(f"ebac {name}", command)]
        return [titled(panel, shown) for panel, shown in panels.items()]

    def section(self, name: str, command: Any) -> nodes.section:
        """Show one command: usage, help, and a table for each kind of option."""
        context = command.make_context(name, [], resilient_parsing=True)
        usage = " ".join([name, *command.collect_usage_pieces(context)])
        box = nodes.literal_block(usage, usage, language="text", classes=["usage"])
        body: list[nodes.Node] = [box, *self.parse_text_to_nodes(command.help or "")]
        for panel, rows in options(command, context).items():
            body += self.parse_text_to_nodes("\n".join(table(panel, rows)))
        return titled(name, body)


def panel_of(command: Any) -> str:
    """Return the panel a command has in `ebac --help`."""
    panel = getattr(command, "rich_help_panel", None)
    return panel if isinstance(panel, str) else "Commands"


def walk(name: str, command: Any) -> Iterator[tuple[str, Any]]:
    """Yield a command, or the commands of a group, by their full names."""
    inner = getattr(command, "commands", None)
    if inner is None:
        yield name, command
        return
    for part, below in inner.items():
        if not below.hidden:
            yield from walk(f"{name} {part}", below)


def options(command: Any, context: Any) -> dict[str, list[tuple[str, str, str]]]:
    """Return name, default and meaning of arguments and options, by their panel."""
    panels: dict[str, list[tuple[str, str, str]]] = {}
    for parameter in command.params:
        record = parameter.get_help_record(context)
        if parameter.hidden or record is None:
            continue
        kind = "Arguments" if parameter.param_type_name == "argument" else "Options"
        panel = parameter.rich_help_panel or kind
        found = HELP.match(record[1])
        assert found is not None
        panels.setdefault(panel, []).append((record[0], found[2] or "", found[1]))
    return panels


def table(panel: str, rows: list[tuple[str, str, str]]) -> Iterator[str]:
    """Yield the options of one panel as a table in Markdown."""
    yield from (f"| {panel} | default, range | meaning |", "|---|---|---|")
    for name, default, meaning in rows:
        default = re.sub(r"default: \(?([^;)]*)\)?", r"\1", default)
        cells = (f"`{name}`", default.replace("<", r"\<"), " ".join(meaning.split()))
        yield "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"
    yield ""


def titled(title: str, body: list[nodes.Node]) -> nodes.section:
    """Return a section with a title and an address of its own."""
    address = nodes.make_id(title)
    return nodes.section("", nodes.title(title, title), *body, ids=[address], names=[title.lower()])


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("commands", Commands)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
