"""The navigation of every page copies the contents of all pages, to keep their titles: here only those are copied."""

from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx


def titles(contents: nodes.bullet_list) -> nodes.bullet_list:
    """Return the contents of a page without what `titles_only` would leave out."""
    short = nodes.bullet_list()
    for entry in contents:
        kept = entry.copy()
        kept += entry[0].deepcopy()
        if inner := [one.deepcopy() for one in entry.findall(addnodes.toctree)]:
            kept += nodes.bullet_list("", *inner)
        short += kept
    return short


def shorten(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Let a tree of titles be made from titles."""
    env, full = app.env, context.get("toctree")
    if full is None:
        return
    if not hasattr(app, "short_contents"):
        app.short_contents = {name: titles(toc) for name, toc in env.tocs.items()}  # type: ignore[attr-defined]

    def toctree(**wanted: Any) -> str:
        if not wanted.get("titles_only"):
            return str(full(**wanted))
        whole, env.tocs = env.tocs, app.short_contents  # type: ignore[attr-defined]
        try:
            return str(full(**wanted))
        finally:
            env.tocs = whole

    context["toctree"] = toctree


def setup(app: Sphinx) -> dict[str, bool]:
    """Before the theme, which asks for its navigation at the same event."""
    app.connect("html-page-context", shorten, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
