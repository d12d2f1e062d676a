"""The loop in a browser: a live server, a page without a server, and sliders in a notebook."""

from ebac._util.lazy import from_stub

__getattr__, __dir__, __all__ = from_stub(__name__, __file__)
