"""A page that stands alone: estimates, warnings, figures."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #222 }
.wide { overflow-x: auto } table { border-collapse: collapse; margin: 1rem 0 } td { white-space: nowrap }
th, td { padding: .25rem .8rem; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left } img { max-width: 100% } .careful { background: #fff3e0; padding:
.5rem 1rem }
"""


def page(
    title: str,
    rows: list[dict[str, str]],
    careful: list[str],
    notes: list[str],
    figures: Sequence[Figure],
) -> str:
    """Return HTML with everything inside it."""
    parts = [f"<h1>{escape(title)}</h1>"]
    parts += [f'<p class="careful">{escape(text)}</p>' for text in careful]
    if rows:
        head = "".join(f"<th>{escape(name)}</th>" for name in rows[0])
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row.values()) + "</tr>"
            for row in rows
        )
        parts.append(f'<div class="wide"><table><tr>{head}</tr>{body}</table></div>')
    parts += [f"<p>{escape(text)}</p>" for text in notes]
    parts += [
        f'<img alt="figure" src="data:image/png;base64,{_png(figure)}">' for figure in figures
    ]
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{_STYLE}</style><body>{''.join(parts)}</body></html>\n"
    )


def _png(figure: Figure) -> str:
    file = BytesIO()
    figure.savefig(file, format="png")
    return b64encode(file.getvalue()).decode("ascii")
