"""Where the WebAssembly module of the core is, and its scripts as one."""

from __future__ import annotations

import re
from pathlib import Path

#: Made by bindings/wasm/build.py, or by CMake with EBAC_WASM=ON, as for the wheels of a release.
PLACE = Path(__file__).with_name("ebac.wasm")
WEB = Path(__file__).with_name("web")

_IMPORT = re.compile(r'^import \{[^}]*\} from "\./[\w.]+";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const)\b)", re.MULTILINE)


def module() -> bytes:
    """Return the core compiled to WebAssembly.

    Returns
    -------
    bytes
        A module for wasm32-wasi, 0.4 MB; `bindings/wasm/exports.cpp` lists its functions.

    Raises
    ------
    FileNotFoundError
        When it was not built, as after `pip install .` in a clone.
    """
    try:
        return PLACE.read_bytes()
    except FileNotFoundError:
        raise FileNotFoundError(
            f"{PLACE}: this installation has no WebAssembly module, which the Linux wheels of a release bring; in a "
            "clone: pip install '.[wasm]', then python bindings/wasm/build.py. Without it `ebac live` shows the same "
            "in the browser, ebac.explore.sliders() in a notebook"
        ) from None


def script(*names: str) -> str:
    """Return scripts of the folder `web` as one, in this order: what they import of each other stands before it."""
    text = "\n".join((WEB / f"{name}.js").read_text(encoding="utf-8") for name in names)
    return joined(text)


def joined(text: str) -> str:
    """Return modules that were put one behind the other as one script."""
    return _EXPORT.sub("", _IMPORT.sub("", text))
