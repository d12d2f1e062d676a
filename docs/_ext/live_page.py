"""The page without a server, beside the others: `live/index.html`. Left out where nothing compiles to WebAssembly."""

import importlib.util
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util import logging

from ebac.live import page

LOGGER = logging.getLogger(__name__)
ROOT = Path(__file__).parents[2]


def write(app: Sphinx) -> None:
    """Compile the core, unless it is compiled already, and write the page."""
    if app.builder.format != "html":
        return
    found = importlib.util.spec_from_file_location("build", ROOT / "bindings" / "wasm" / "build.py")
    assert found is not None
    assert found.loader is not None
    wasm = importlib.util.module_from_spec(found)
    found.loader.exec_module(wasm)
    if not wasm.compiler():
        LOGGER.info("no live page: ziglang is missing")
        return
    module = wasm.built(ROOT / "build" / "wasm" / "ebac.wasm")
    out = Path(app.outdir, "live", "index.html")
    out.parent.mkdir(parents=True, exist_ok=True)
    page(out, home="../index.html", wasm=module.read_bytes())


def setup(app: Sphinx) -> dict[str, bool]:
    """Run before the pages are read."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
