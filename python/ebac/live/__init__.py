"""The loop in a browser: a page without a server, and sliders in a notebook, over the core in WebAssembly."""

from ebac.live.live_page import page
from ebac.live.notebook_widget import widget
from ebac.live.wasm_module import module

__all__ = ["module", "page", "widget"]


def __dir__() -> list[str]:
    return __all__
