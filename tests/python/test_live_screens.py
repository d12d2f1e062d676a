"""The live pages beside pictures of them that a person looked at: tests/golden/screens, a quarter of the size.

Each page stands still at a known tick, so that nothing but fonts and the browser's drawing may differ. After a change
that is meant: `pytest -m "" tests/python/test_live_screens.py --ebac-update`, then look at the pictures.
"""

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import ebac
from ebac.gastroscope import Physician, Procedure
from ebac.live.gastroscopy import GastroscopyServer, GastroscopySession
from ebac.live.server import Server

pytest.importorskip("websockets")
pytestmark = pytest.mark.slow

PLACE = Path(__file__).parent.parent / "golden" / "screens"
WINDOWS = {"wide": (1280, 800), "phone": (390, 844)}
LOWER = 4
#: What fonts and antialiasing may change: the mean over all, and the share of blocks of 16 x 16 pixels off by a tenth.
MEAN, SHARE = 0.012, 0.03
DRAWN = """async () => {
  while (!(window.ebacServed && ebacServed.drawn > 2)) await new Promise(done => setTimeout(done, 20));
}"""


def reduced(png: bytes) -> Image.Image:
    with Image.open(io.BytesIO(png)) as picture:
        return picture.convert("RGB").reduce(LOWER)


def alike(picture: Image.Image, golden: Image.Image) -> bool:
    assert picture.size == golden.size
    seen, known = (np.asarray(one.reduce(4), dtype=np.float64) / 255 for one in (picture, golden))
    differ = np.abs(seen - known)
    mean, share = differ.mean(), (differ.max(axis=2) > 0.1).mean()
    print(f"{mean:.4f} of white in the mean, {share:.1%} of the blocks by more than a tenth")
    return bool(mean < MEAN and share < SHARE)


def still(tab: Any, golden: Path | None) -> Image.Image:
    """Return what is seen when the page is drawn: a busy machine takes seconds for that."""
    for _ in range(20):
        tab.wait_for_timeout(500)
        seen = reduced(tab.screenshot())
        if golden is not None:
            with Image.open(golden) as known:
                if alike(seen, known):
                    break
    return seen


@contextmanager
def alone(tmp_path: Path, wasm: bytes) -> Iterator[tuple[str, str]]:
    """The page without a server: four seconds of `ebac` at its wall."""
    file = tmp_path / "live.html"
    ebac.live.page(file, wasm=wasm)
    yield (
        file.as_uri(),
        """async () => {
          while (!window.ebacLive) await new Promise(done => setTimeout(done, 20));
          const page = ebacLive;
          page.pause(true);
          page.ticks = 0;
          page.choose("ebac");
          for (let i = 0; i < 80; ++i) page.advance(50);
          page.judge();
        }""",
    )


@contextmanager
def served(tmp_path: Path, wasm: bytes) -> Iterator[tuple[str, str]]:
    """`ebac live --virtual` after four seconds."""
    del wasm
    with ebac.live.Session(virtual=True, paced=False, folder=tmp_path) as session:
        session.start()
        session.advance(4.0)
        with Server(session) as server:
            yield (
                server.gate.url(),
                DRAWN,
            )


@contextmanager
def gastroscopy(tmp_path: Path, wasm: bytes) -> Iterator[tuple[str, str]]:
    """`ebac gastroscopy --live` after half a minute, on the way through the oesophagus."""
    del tmp_path, wasm
    with GastroscopySession("ebac", Procedure(physician=Physician(heed=3))) as session:
        session.advance(30.0)
        with GastroscopyServer(session) as server:
            yield (
                server.gate.url(),
                DRAWN,
            )


@pytest.mark.parametrize("window", WINDOWS)
@pytest.mark.parametrize("page", [alone, served, gastroscopy])
def test_the_screen_is_the_one_that_was_looked_at(
    page: Callable[..., Any],
    window: str,
    browser: Any,
    wasm: bytes,
    tmp_path: Path,
    pytestconfig: pytest.Config,
) -> None:
    golden = PLACE / f"{page.__name__}-{window}.png"
    width, height = WINDOWS[window]
    with page(tmp_path, wasm) as (address, ready):
        context = browser.new_context(
            viewport={"width": width, "height": height},
            bypass_csp=True,
            reduced_motion="reduce",
            color_scheme="light",
        )
        tab = context.new_page()
        tab.goto(address)
        tab.evaluate(ready)
        update = pytestconfig.getoption("--ebac-update")
        seen = still(tab, None if update else golden)
        tab.add_style_tag(content="canvas { visibility: hidden }")
        broken = reduced(tab.screenshot())
        context.close()
    if update:
        PLACE.mkdir(exist_ok=True)
        seen.save(golden, optimize=True)
    seen.save(tmp_path / golden.name)
    with Image.open(golden) as known:
        known.load()
    assert alike(seen, known), f"{tmp_path / golden.name} is not {golden}"
    assert not alike(broken, known), "a page without its picture would pass"
