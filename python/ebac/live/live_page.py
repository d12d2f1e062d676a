"""`ebac.live.page()`: the page without a server, one file with everything inside."""

from __future__ import annotations

import base64
import json
from pathlib import Path

from ebac import presets
from ebac._core import Hand
from ebac._util.arguments import require_path
from ebac._util.atomic_file import write_text
from ebac._util.law_colours import COLOURS
from ebac.live.wasm_module import WEB, module, script

#: In the order in which one needs the other.
SCRIPTS = ("core", "words", "strips", "scene", "sound", "controls", "page")
#: Hands to choose from, as the page calls them.
HANDS = {
    "reference": "paper, 0.15 kg",
    "finger": "finger, 0.006 kg",
    "arm-hapticmaster": "relaxed arm, 0.55 kg",
    "arm-hogan": "stiff arm, 0.8 kg",
}
#: What a visitor needs to know of the first laws.
ABOUTS = {
    "tca": "the wall's force as it is, with feedback of the force sensor; a stiff wall shakes",
    "tca-damped": "the same with a virtual damper; still, but its force clicks with the encoder",
    "eba": "the energy-bounding algorithm of Kim and Ryu; quiet, but the wall feels soft",
    "ebac": "energy-bounding with closed-loop control and a state observer; stiff, exact and quiet",
}


def page(
    path: str | Path | None = None,
    *,
    home: str | None = None,
    wasm: bytes | None = None,
) -> str:
    """Return the page on which a visitor shakes a virtual wall and calms it, and write it to `path`.

    It needs no server, no network and no installation: a browser opens the file, on a phone, too.

    Parameters
    ----------
    path : path, optional
        Where to write it.
    home : str, optional
        The address of the documentation; without one the page has no link to it.
    wasm : bytes, optional
        The WebAssembly module; default: `module()`.

    Returns
    -------
    str
        HTML, 0.6 MB.

    Raises
    ------
    FileNotFoundError
        When the WebAssembly module was not built.
    OSError
        When the file cannot be written; one of that name stays as it is.
    """
    if path is not None:
        require_path(path, "ebac.live.page")
    hands = [
        {"name": name, "about": about, "settings": _settings(presets.HANDS[name].hand)}
        for name, about in HANDS.items()
    ]
    parts = {
        "{style}": (WEB / "page.css").read_text(encoding="utf-8"),
        "{script}": script(*SCRIPTS),
        "{module}": base64.b64encode(module() if wasm is None else wasm).decode(),
        "{facts}": json.dumps({"colours": COLOURS, "hands": hands, "abouts": ABOUTS}),
        "{home}": f' <a href="{home}" target="_top">Documentation</a>' if home else "",
    }
    html = (WEB / "page.html").read_text(encoding="utf-8")
    for mark, text in parts.items():
        html = html.replace(mark, text, 1)
    if path is not None:
        write_text(path, html)
    return html


def _settings(hand: Hand) -> dict[str, float]:
    return {f"hand.{name}": getattr(hand, name) for name in ("mass", "damping", "stiffness")}
