"""The page of `ebac live` in a real browser: drag, law, pause; its numbers are those of the simulation."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import ebac
from ebac.live import serve

pytest.importorskip("websockets")
#: A browser draws thirty frames a second by the processor.
pytestmark = [pytest.mark.slow, pytest.mark.real_time]

DRAWN = "() => window.ebacServed && ebacServed.drawn > 0 && ebacServed.frame.x"
#: Where the violet ball is on the screen [pixels].
BALL = """() => {
  const box = document.getElementById("scene").getBoundingClientRect();
  const [u, v] = seen(scene.look().matrix, [...ebacServed.frame.target, 0]);
  return [box.left + (1 + u) / 2 * box.width, box.top + (1 - v) / 2 * box.height];
}"""


@pytest.fixture
def live(tmp_path: Path) -> Iterator[Any]:
    """A page on a virtual clock: a browser that draws by the processor would make a real one late."""
    with serve(virtual=True, folder=tmp_path) as server:
        yield server


def opened(browser: Any, server: Any, width: int = 1280, height: int = 800) -> Any:
    page = browser.new_page(viewport={"width": width, "height": height}, bypass_csp=True)
    page.errors = []
    page.on("pageerror", lambda error: page.errors.append(str(error)))
    page.goto(server.gate.url())
    page.wait_for_function(DRAWN)
    return page


def verdict(page: Any, *heads: str) -> None:
    page.wait_for_function(
        "heads => heads.some(head => document.querySelector('#verdict strong').innerText.startsWith(head))",
        arg=list(heads),
        timeout=20_000,
    )


def test_drag_law_and_pause_show_what_the_simulation_gives(browser: Any, live: Any) -> None:
    page = opened(browser, live)
    verdict(page, "Still and quiet", "Buzzes")
    x, y = page.evaluate(BALL)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 13):
        page.mouse.move(x - 1.5 * step, y)
        page.wait_for_timeout(15)
    page.mouse.up()
    page.wait_for_timeout(1500)
    target = page.evaluate("ebacServed.frame.target")
    assert 0.02 < target[0] < 0.039
    assert live.session.hand.mode == "mouse"
    rest = ebac.contact(ebac.simulate(live.session.scenario, "ebac")).rest_m
    assert page.evaluate("ebacServed.frame.x")[0] == pytest.approx(rest, abs=3e-4)

    page.select_option("#pick-law", "tca-damped")
    page.wait_for_function("() => ebacServed.state.choices.law === 'tca-damped'")
    assert live.session.run.law.name == "tca-damped"
    assert live.session.starts == 1

    page.select_option("#pick-world", "sphere")
    page.wait_for_function("() => document.getElementById('notice').innerText.includes('sphere')")
    page.click("#run")
    page.wait_for_function("() => !ebacServed.state.running")
    assert not live.session.running
    verdict(page, "At rest")
    assert not page.errors
    page.close()


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
def test_the_page_fits(browser: Any, live: Any, width: int, height: int) -> None:
    page = opened(browser, live, width, height)
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    law = [int(COLOUR[k : k + 2], 16) for k in (1, 3, 5)]
    shares = page.evaluate(
        """() => new Promise(done => requestAnimationFrame(() => {
          scene.draw({x: [0, 0], force: [5, 0], target: [0.03, 0], law: rgb(COLOURS.ebac)});
          const {gl, canvas} = scene.screen;
          const pixels = new Uint8Array(4 * canvas.width * canvas.height);
          gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
          const count = test => {
            let n = 0;
            for (let i = 0; i < pixels.length; i += 4) n += test(...pixels.subarray(i, i + 4));
            return n / (canvas.width * canvas.height);
          };
          done([count((r, g, b, a) => a && g > 1.3 * r && g > b), count((r, g, b) => r > 2 * g && r > 2 * b && r > 60),
            count((r, g, b, a) => a > 0)]);
        }))"""
    )
    assert law[1] > law[0]
    handle, arrow, drawn = shares
    assert 3e-4 < handle < 0.02
    assert 1e-4 < arrow < 0.01
    assert 0.03 < drawn < 0.5
    assert not page.errors
    page.close()


COLOUR = ebac.plot.style.COLOURS["ebac"]
