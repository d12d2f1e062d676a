"""Links of a page to folders of the repository: shown by their path. (A file that is no page becomes a download.)"""

from pathlib import Path

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx


def show_path(app: Sphinx, doctree: nodes.document) -> None:
    """Turn each link to a folder into its path; a link to nothing stays a warning."""
    root = Path(app.srcdir).parent.resolve()
    for link in list(doctree.findall(addnodes.pending_xref)):
        page = Path(app.env.doc2path(app.env.docname)).parent
        found = (page / str(link["reftarget"])).resolve()
        if link.get("reftype") == "myst" and found.is_dir() and found.is_relative_to(root):
            link.replace_self(nodes.literal("", found.relative_to(root).as_posix()))


def setup(app: Sphinx) -> dict[str, bool]:
    """Run after a page is read and before its links are resolved."""
    app.connect("doctree-read", show_path)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
