"""Equations as MathML, which browsers typeset by themselves: no script and nothing from the network."""

import re
from typing import Any

from docutils import nodes
from latex2mathml import converter
from sphinx.application import Sphinx
from sphinx.locale import _
from sphinx.writers.html5 import HTML5Translator


def convert(latex: str, display: str = "inline") -> str:
    """Return an expression as MathML; a single upright letter, as the unit N, as text: the library slants it."""
    return converter.convert(re.sub(r"\\mathrm\{(\w)\}", r"\\text{\1}", latex), display=display)


def inline(self: HTML5Translator, node: nodes.math) -> None:
    """Write an expression within a sentence."""
    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def block(self: HTML5Translator, node: nodes.math_block) -> None:
    """Write an equation on a line of its own, with its number where it has one."""
    self.body.append(self.starttag(node, "div", CLASS="math equation"))
    if number := node["number"]:
        self.body.append(f'<span class="eqno">(T{number})')
        self.add_permalink_ref(node, _("Link to this equation"))
        self.body.append("</span>")
    for line in node.astext().split("\n\n"):
        self.body.append(convert(line, display="block"))
    self.body.append("</div>")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the renderer; `html_math_renderer = "mathml"` chooses it."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
