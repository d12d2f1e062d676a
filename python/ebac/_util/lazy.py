"""Packages that import a name when it is first used; the names stand in the package's stub (`.pyi`)."""

from __future__ import annotations

import ast
import sys
from importlib import import_module

TYPE_CHECKING = False  # typing itself would be a third of the time of an import
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Any


def unknown(package: str, name: str, known: Iterable[str]) -> AttributeError:
    """Return the error for a name that a package has not, with the nearest one, which only a traceback would add."""
    from difflib import get_close_matches

    near = get_close_matches(name, known, 1)
    more = f". Did you mean: {near[0]!r}?" if near else ""
    # Without obj=, by which a traceback would add the nearest once more.
    return AttributeError(f"module {package!r} has no attribute {name!r}{more}", name=name)


def from_stub(
    package: str, file: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package from the imports of its stub.

    Parameters
    ----------
    package : str
        Its `__name__`.
    file : str
        Its `__file__`; the stub lies beside it.
    """
    places: dict[str, tuple[str, str]] = {}
    with open(file.removesuffix(".py") + ".pyi", encoding="utf-8") as stub:  # noqa: PTH123
        body = ast.parse(stub.read()).body
    for node in body:
        if isinstance(node, ast.ImportFrom) and node.module:
            places |= {
                alias.asname or alias.name: (node.module, alias.name) for alias in node.names
            }

    def get(name: str) -> Any:
        if name not in places:
            raise unknown(package, name, places)
        module, wanted = places[name]
        if module == package:
            return import_module(f"{package}.{wanted}")
        value = getattr(import_module(module), wanted)
        setattr(sys.modules[package], name, value)
        return value

    names = sorted(places)
    return get, lambda: names, names
