"""The items of the paper that are checked, by name."""

from __future__ import annotations

from collections.abc import Callable

from ebac.paper.fig5 import fig5
from ebac.paper.fig11 import fig11
from ebac.paper.finding import Finding
from ebac.paper.numbers import eq1, specs
from ebac.paper.workspace import fig6, fig7

#: Every item, in the order of the paper.
ITEMS: dict[str, Callable[[], Finding]] = {
    "eq1": eq1,
    "specs": specs,
    "fig5": fig5,
    "fig6": fig6,
    "fig7": fig7,
    "fig11": fig11,
}


def find(name: str) -> Finding:
    """Check one item of the paper.

    Raises
    ------
    KeyError
        When there is no such item; the message lists them.
    """
    if name not in ITEMS:
        raise KeyError(f"no item of the paper is called {name!r}; there are: {', '.join(ITEMS)}")
    return ITEMS[name]()
