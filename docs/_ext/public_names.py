"""`.. public:: PACKAGE`: a summary of public names and each of them in full.

The body names some, one a line; without a body it is all of `__all__`. A name that does not exist, and one that no
page shows, are warnings, so the reference cannot fall behind the code.
"""

import inspect
import re
from importlib import import_module
from pkgutil import walk_packages
from types import ModuleType
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.pycode import ModuleAnalyzer, PycodeError
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

LOGGER = logging.getLogger(__name__)
#: A quantity between bars, |x|, is a substitution to reStructuredText and a magnitude to us.
MAGNITUDE = re.compile(r"(?<![`\\|])\|(?=[^|\s`][^|`]*\|)|(?<=[^|\s`\\])\|(?!\|)")


class Public(SphinxDirective):
    """Expands to a table of what there is, and one autodoc directive per name."""

    required_arguments = 1
    has_content = True

    def run(self) -> list[nodes.Node]:
        package = self.arguments[0]
        module = import_module(package)
        names = [line.strip() for line in self.content if line.strip()] or public(module)
        shown = self.env.metadata.setdefault(self.env.docname, {}).setdefault("public", {})
        shown.setdefault(package, []).extend(names)
        comments = data_comments(module, [n for n in names if is_data(getattr(module, n, None))])
        lines = [f".. py:currentmodule:: {package}", "", ".. list-table::", "   :widths: 30 70", ""]
        details: list[str] = []
        for name in names:
            if not hasattr(module, name):
                LOGGER.warning("%s has no %s", package, name, location=self.get_location())
                continue
            thing = getattr(module, name)
            text = comments.get(name, "") if is_data(thing) else inspect.getdoc(thing) or ""
            lines += [f"   * - :py:obj:`{name} <{package}.{name}>`", f"     - {first_line(text)}"]
            details += directive(name, thing, text)
        holder = nodes.container()
        self.state.nested_parse(StringList([*lines, "", *details], source=package), 0, holder)
        return list(holder.children)


def public(module: ModuleType) -> list[str]:
    """Return the public names of a module that are not modules."""
    return [
        name
        for name in module.__all__
        if not name.startswith("__") and not inspect.ismodule(getattr(module, name))
    ]


def is_data(thing: Any) -> bool:
    """Whether a thing is a table or a number, whose docstring is that of its type."""
    return not callable(thing)


def data_comments(module: ModuleType, names: list[str]) -> dict[str, str]:
    """Return the `#:` comments of some of a package's data, wherever in the package they stand."""
    found: dict[str, str] = {}
    if not names:
        return found
    given = re.compile(rf"^(?:{'|'.join(map(re.escape, names))})\b.*=", re.MULTILINE)
    inside = walk_packages(getattr(module, "__path__", []), module.__name__ + ".")
    for name in [module.__name__, *(part.name for part in inside)]:
        if "._core" in name or ".__main__" in name or ".cli" in name:
            continue
        try:
            analyzer = ModuleAnalyzer.for_module(name)
        except PycodeError:
            continue
        if not given.search(analyzer.code):  # to read one takes as long as all else of a page
            continue
        told = analyzer.find_attr_docs()
        found |= {key: " ".join(text).strip() for (owner, key), text in told.items() if not owner}
    return found


def first_line(text: str) -> str:
    """Return the first paragraph of a docstring on one line."""
    line = " ".join(text.strip().split("\n\n")[0].split())
    if line.startswith("__init__("):  # pybind11's signature
        line = ""
    return MAGNITUDE.sub(r"\\|", line).rstrip(":") or "\\-"


def directive(name: str, thing: Any, text: str) -> list[str]:
    """Return the directive that shows a thing."""
    if inspect.isclass(thing):
        left_out = ["   :exclude-members: set"] if hasattr(thing, "savefig") else []
        bases = thing.__mro__[1:-1]
        own = bases and all(base.__module__.startswith("ebac.") for base in bases)
        inherited = ["   :inherited-members:"] if own else []
        return [f".. autoclass:: {name}", "   :members:", *inherited, *left_out, ""]
    if is_data(thing):
        return [f".. py:data:: {name}", "", f"   {first_line(text)}", ""]
    return [f".. autofunction:: {name}", ""]


def keep_magnitudes(
    app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]
) -> None:
    """Escape bars in docstrings."""
    lines[:] = [MAGNITUDE.sub(r"\\|", line) for line in lines]


def check(app: Sphinx, env: Any) -> None:
    """Warn of public names that no page shows."""
    shown: dict[str, set[str]] = {}
    for page in env.metadata.values():
        for package, names in page.get("public", {}).items():
            shown.setdefault(package, set()).update(names)
    everywhere = [
        getattr(import_module(package), name, None)
        for package, names in shown.items()
        for name in names
    ]
    for package, names in shown.items():
        module = import_module(package)
        for name in sorted(set(public(module)) - names):
            if any(getattr(module, name) is thing for thing in everywhere):
                continue  # shown where it is public, too
            LOGGER.warning("%s.%s stands on no page of the reference", package, name)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive, the check and the escape."""
    app.add_directive("public", Public)
    app.connect("autodoc-process-docstring", keep_magnitudes)
    app.connect("env-check-consistency", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
