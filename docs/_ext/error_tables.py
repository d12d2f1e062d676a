"""Tables of all that can go wrong, from the code: `{error-table} faults`, `exceptions`, `aborts`, ..."""

import inspect
import re
from collections.abc import Callable, Iterator
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parents[2]
Row = tuple[str, ...]


def faults() -> Iterator[Row]:
    """Every fault of the loop: number and name from the module, the rest from its enum and the page on safety."""
    from ebac import Fault

    yield "number", "`ebac.Fault`", "what happened", "what to do"
    header = (ROOT / "cpp/ebac/core/sample.hpp").read_text(encoding="utf-8")
    told = dict(re.findall(r"^\s*k\w+ = (\d+),\s*// (.+)$", header, re.M))
    page = (ROOT / "docs/explanation/safety.md").read_text(encoding="utf-8")
    page = page.replace("](#", "](../explanation/safety.md#")  # of which this page shows a part
    remedies = dict(re.findall(r"^\| (\d+) \|(?:[^|]*\|){2} (.+?) \|$", page, re.M))
    for fault in Fault:
        number = str(int(fault))
        if number != "0":
            yield number, f"`{fault.name}`", told[number], remedies[number]


def exceptions() -> Iterator[Row]:
    """Every exception the package defines, with the built-in it can be caught as."""
    import ebac
    from ebac import drives

    yield "exception", "is a", "when"
    for module, names in ((ebac, ebac.__all__), (drives, drives.__all__)):
        for name in names:
            thing = getattr(module, name)
            if not inspect.isclass(thing) or issubclass(thing, Warning):
                continue
            if issubclass(thing, BaseException):
                about = (inspect.getdoc(thing) or "").split("\n\n")[0].replace("\n", " ")
                yield f"`{module.__name__}.{name}`", f"`{thing.__base__.__name__}`", about


def aborts() -> Iterator[Row]:
    """SDO abort codes."""
    from ebac.drives.aborts import ABORTS

    yield "code", "meaning", "what to do"
    for code, (meaning, remedy) in ABORTS.items():
        yield f"`0x{code:08X}`", meaning, remedy


def latched() -> Iterator[Row]:
    """Latched faults of Copley drives."""
    from ebac.drives.faults import LATCHED

    yield "bit of 0x2183", "fault", "what to do"
    for bit, name, check in LATCHED:
        yield f"{bit} (`0x{1 << bit:X}`)", name, check


def emergencies() -> Iterator[Row]:
    """Emergency codes."""
    from ebac.drives.faults import EMERGENCIES

    yield "code", "meaning"
    for code, meaning in EMERGENCIES.items():
        yield f"`0x{code:04X}`", meaning


TABLES: dict[str, Callable[[], Iterator[Row]]] = {
    table.__name__: table for table in (faults, exceptions, aborts, latched, emergencies)
}


class ErrorTable(SphinxDirective):
    """Shows one of `TABLES`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        head, *rows = TABLES[self.arguments[0]]()
        lines = [head, tuple("---" for _ in head), *rows]
        text = "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
        return self.parse_text_to_nodes(text)


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("error-table", ErrorTable)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
