"""The items of the paper that are checked, by name."""

from __future__ import annotations

from collections.abc import Callable

from ebac._util.arguments import named
from ebac.paper.drawings import fig1, fig2, fig3, fig4, fig10
from ebac.paper.equations import eq2, eq3, eq8, eq9, eq10, eq11, eq12
from ebac.paper.fig5 import fig5
from ebac.paper.fig11 import fig11
from ebac.paper.finding import Finding
from ebac.paper.motion import eq4, eq5, eq6, eq7
from ebac.paper.numbers import eq1, specs
from ebac.paper.tracking import fig8, fig9, table1
from ebac.paper.workspace import fig6, fig7

#: Every equation, figure and table, and the specifications, in the order of the paper.
_CHECKS: tuple[Callable[[], Finding], ...] = (
    specs, fig1, eq1, fig2, eq2, fig3, fig4, eq3, eq4, eq5, eq6, eq7, eq8, eq9, eq10, fig5,
    eq11, fig6, fig7, fig8, fig9, table1, eq12, fig10, fig11,
)  # fmt: skip
ITEMS: dict[str, Callable[[], Finding]] = {check.__name__: check for check in _CHECKS}


def find(name: str) -> Finding:
    """Check one item of the paper.

    Parameters
    ----------
    name : str
        A name of `ITEMS`.

    Raises
    ------
    KeyError
        When there is no such item; the message lists them.
    """
    return named("item of the paper", name, ITEMS)()
