"""`trace.explore()`: the panels of a trace as one page that needs no server and no network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from pathlib import Path

from ebac._util.arguments import require, require_path
from ebac._util.atomic_file import write_text
from ebac.explore.panels import Panel, chosen, usual
from ebac.trace import Trace

#: Height of a panel, and of what stands around them [pixels].
PANEL, AROUND = 190, 150
#: How the name of a page ends.
PAGES = (".html", ".htm")


@dataclass(frozen=True, kw_only=True, eq=False)
class Exploration:
    """Panels over one time axis: zoom with the wheel, drag to move, a box to look closer.

    A notebook shows it as it stands; `save` writes it as a page of its own. All rows travel with it, about two bytes
    a number, so a million rows of twelve columns are 27 MB: explore a part, `trace[0:60].explore()`, to keep a
    notebook small.

    Attributes
    ----------
    trace : Trace
        What is shown.
    panels : tuple of Panel
        From top to bottom.
    """

    trace: Trace
    panels: tuple[Panel, ...]

    @cached_property
    def html(self) -> str:
        """The page, with everything it needs inside."""
        from ebac.explore.page import page

        return page(self.trace, self.panels)

    @property
    def height(self) -> int:
        """Height of the page [pixels]."""
        return PANEL * len(self.panels) + AROUND

    def save(self, path: str | Path) -> None:
        """Write the page; any browser opens it, without network and without Python.

        Parameters
        ----------
        path : str or Path
            Ends in .html or .htm, or has no ending; a file of that name is replaced once the page is whole.

        Raises
        ------
        ValueError
            For another extension: `trace.plot()` draws a picture.
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        require_path(path, "Exploration.save")
        if Path(path).suffix.lower() not in ("", *PAGES):  # such as /dev/stdout
            raise ValueError(
                f"{path}: must end in {' or '.join(PAGES)}, as it is a page; trace.plot() draws a picture"
            )
        write_text(path, self.html)

    def _repr_html_(self) -> str:
        """Return a frame around the page, so that no style of the notebook gets in."""
        inside = escape(self.html, quote=True)
        style = f"width:100%;height:{self.height}px;border:0;background:white;color-scheme:light"
        return f'<iframe title="exploration of a trace" style="{style}" srcdoc="{inside}"></iframe>'

    def __repr__(self) -> str:
        """Return one line: what is shown."""
        shown = "; ".join(panel.label for panel in self.panels)
        return f"<Exploration of {len(self.trace)} rows: {shown}>"


def explore(trace: Trace, *columns: str | Sequence[str], axis: int = 0) -> Exploration:
    """Look at a trace panel by panel, however long it is.

    What is drawn is thinned to the least and the most of each pixel of the window on the screen, so no peak is lost;
    closer than four rows a pixel every row is drawn. Needs `pip install 'ebac[notebook]'`.

    Parameters
    ----------
    trace : Trace
        At least two rows.
    *columns : str or sequence of str
        One panel each, with columns of one unit; default: position, force, beta, energy, where the force was held
        back.
    axis : int
        Which axis of a trace with several.

    Returns
    -------
    Exploration

    Raises
    ------
    ValueError
        For a trace of fewer than two rows, an axis it does not have, columns of several units in one panel.
    KeyError
        For a column it does not have.
    ImportError
        Without Bokeh.
    """
    require(trace, Trace, "ebac.explore.explore", "a Trace")
    if len(trace) < 2:
        raise ValueError(
            f"the trace has {len(trace)} rows: there is something to explore from 2 on"
        )
    try:
        import bokeh  # noqa: F401
    except ImportError as error:
        raise ImportError("explore needs Bokeh: pip install 'ebac[notebook]'") from error
    panels = chosen(trace, columns, axis) if columns else usual(trace, axis)
    return Exploration(trace=trace, panels=tuple(panels))
