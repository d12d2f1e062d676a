"""The page of `ebac gastroscopy --live`: its numbers are those of the simulation, and it fits."""

import asyncio
import json
import time
from collections.abc import Iterator
from typing import Any

import pytest

from ebac.gastroscope import Physician, Procedure, gastroscopy
from ebac.live.gastroscopy import GastroscopySession, serve_gastroscopy

pytest.importorskip("websockets")
pytestmark = pytest.mark.real_time

HEEDS = Procedure(physician=Physician(heed=3))


@pytest.fixture
def live() -> Iterator[Any]:
    with serve_gastroscopy("ebac", HEEDS) as server:
        yield server


@pytest.mark.slow
@pytest.mark.weekly
def test_what_runs_in_real_time_is_what_is_simulated(live: Any) -> None:
    time.sleep(1.0)
    live.session.pause()
    time.sleep(0.1)
    row = live.session.recent[-1]
    assert 0.3 < row["t"] < 1.5
    known = gastroscopy("ebac", HEEDS, every=1).rows
    at = round(row["t"] / 1e-3)
    for name in ("place", "handle_x", "bend_y", "phase"):
        assert row[name] == known[name][at]
    live.session.reset()
    assert live.session.recent[0]["t"] == 0
    assert live.session.starts == 2


def test_a_pause_while_time_goes_on_is_not_lost() -> None:
    class Paused(GastroscopySession):
        def _take(self, ticks: int) -> None:
            super()._take(ticks)
            self.pause()  # as a page does from another thread

    with Paused("ebac", HEEDS) as session:
        begun = time.monotonic()
        session.start()
        while len(session.recent) < 2:
            assert time.monotonic() - begun < 10
            time.sleep(0.01)
        time.sleep(0.1)
        assert not session.running
        assert len(session.recent) == 2


def test_a_page_can_neither_drag_nor_change(live: Any) -> None:
    from websockets.asyncio.client import connect

    async def asks() -> list[dict[str, Any]]:
        gate = live.gate
        own = f"127.0.0.1:{gate.port}"
        found = []
        async with connect(
            f"ws://{own}/socket?token={gate.control}", origin=f"http://{own}"
        ) as page:
            for message in (
                {"kind": "drag", "place": [0.1]},
                {"kind": "change", "name": "law", "value": "tca"},
            ):
                await page.send(json.dumps(message))
                while (answer := json.loads(await page.recv()))["kind"] != "error":
                    pass
                found.append(answer)
        return found

    answers = asyncio.run(asyncio.wait_for(asks(), 20))
    assert all("the physician steers" in one["text"] for one in answers)


@pytest.mark.slow
@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
def test_the_page_shows_what_the_simulation_gives(
    browser: Any, live: Any, width: int, height: int
) -> None:
    page = browser.new_page(viewport={"width": width, "height": height}, bypass_csp=True)
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(live.gate.url())
    page.wait_for_function("() => window.ebacServed && ebacServed.drawn > 2")
    first = page.evaluate("ebacServed.frame.t")
    page.wait_for_function(f"() => ebacServed.frame.t > {first} + 0.5")
    page.click("#run")
    page.wait_for_function("() => !ebacServed.state.running")
    assert not live.session.running
    page.wait_for_function("t => ebacServed.frame.t === t", arg=live.session.recent[-1]["t"])
    page.wait_for_timeout(300)
    row = live.session.recent[-1]
    assert page.inner_text("#place") == f"{100 * row['place']:.1f} cm"
    assert page.inner_text("#t") == f"{row['t']:.1f} s"
    assert page.inner_text("#touched") == "0 of 3"
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    seen = page.evaluate(
        """() => new Promise(done => requestAnimationFrame(() => {
          dirty = true; paint(0);
          done([outside.screen, endoscope].map(({gl, canvas}) => {
            const pixels = new Uint8Array(4 * canvas.width * canvas.height);
            gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            let n = 0;
            for (let i = 0; i < pixels.length; i += 4) n += pixels[i + 3] > 0;
            return n / (canvas.width * canvas.height);
          }));
        }))"""
    )
    assert 0.02 < seen[0] < 0.5
    assert seen[1] > 0.3
    page.click("#reset")
    page.wait_for_function("() => ebacServed.state.running && ebacServed.frame.t < 1")
    assert not errors
    page.close()
