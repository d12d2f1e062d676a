"""The live page in a real browser: drag, law, stop; its numbers are those of the native simulation."""

import base64
import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import ebac
from ebac.live.wasm_module import WEB, script

#: A browser draws sixty frames a second by the processor.
pytestmark = pytest.mark.slow

SETTLED = "() => ebacLive.ticks - ebacLive.since > 1600"
#: The edges of the picture of a wide window [m], as web/scene.js has them.
LEFT, RIGHT = -0.045, 0.075


@pytest.fixture
def open_page(browser: Any, wasm: bytes, tmp_path: Path) -> Iterator[Callable[..., Any]]:
    """A function that opens the page from its file; an error on it is one of the test."""
    file = tmp_path / "live.html"
    ebac.live.page(file, wasm=wasm)

    def opened(width: int = 1280, height: int = 800) -> Any:
        page = browser.new_page(viewport={"width": width, "height": height})
        page.errors = []
        page.on("pageerror", lambda error: page.errors.append(str(error)))
        page.on(
            "request", lambda asked: asked.url.startswith("http") and page.errors.append(asked.url)
        )
        page.goto(file.as_uri())
        page.wait_for_function("window.ebacLive && ebacLive.ticks > 0")
        return page

    yield opened
    for context in browser.contexts:
        context.close()  # a page that runs takes half a core


def number(page: Any, place: str) -> float:
    return float(page.inner_text(place).split()[0].replace("−", "-"))


def judged(page: Any) -> str:
    page.wait_for_function(SETTLED)
    page.wait_for_timeout(300)
    return str(page.inner_text("#verdict strong"))


def pressed(target: float, law: str) -> ebac.Contact:
    scenario = ebac.Scenario(hand=ebac.Hand(path=[ebac.Step(target=target)]), seconds=3)
    return ebac.contact(ebac.simulate(scenario, law))


def test_law_drag_and_pause_show_what_the_simulation_gives(open_page: Callable[..., Any]) -> None:
    page = open_page()
    head = judged(page)
    assert head.startswith("Shakes by ")
    assert float(head.split()[2]) == pytest.approx(1e3 * pressed(0.04, "tca").swing_m, abs=0.06)

    page.click("button[data-law=ebac]")
    assert judged(page) == "Quiet and exact"
    assert number(page, "#x") == pytest.approx(1e3 * pressed(0.04, "ebac").rest_m, abs=0.03)

    box = page.locator("#scene").bounding_box()
    metre = box["width"] / (RIGHT - LEFT)
    middle = box["y"] + box["height"] / 2
    start = box["x"] + (0.04 - LEFT) * metre - 20
    page.mouse.move(start, middle)
    page.mouse.down()
    for step in range(1, 9):
        page.mouse.move(start - 10 * step, middle)
    assert page.evaluate("ebacLive.dragging")
    page.mouse.up()
    target = page.evaluate("ebacLive.target")
    assert target == pytest.approx(0.04 - 80 / metre, abs=5e-4)
    assert judged(page) == "Quiet and exact"
    depth, force = number(page, "#x") / 1e3, number(page, "#force")
    assert depth == pytest.approx(pressed(target, "ebac").rest_m, abs=3e-5)
    assert force == pytest.approx(300 * (target - depth), abs=0.2)

    page.click("#pause")
    stood = page.evaluate("ebacLive.ticks")
    page.wait_for_timeout(200)
    assert page.evaluate("ebacLive.ticks") == stood
    page.click("#pause")
    page.focus("#scene")
    for _ in range(20):
        page.keyboard.press("ArrowLeft")
    assert judged(page) == "No contact at rest"
    assert not page.errors


def test_sound_starts_by_a_click_and_plays_the_ripple(open_page: Callable[..., Any]) -> None:
    page = open_page()
    assert page.evaluate("ebacLive.sound.context === null")
    page.click("#sound")
    page.wait_for_function("ebacLive.sound.next > ebacLive.sound.context.currentTime")
    assert page.inner_text("#sound") == "Sound on"
    page.click("#sound")
    page.wait_for_function("ebacLive.sound.context.state === 'suspended'")
    assert page.inner_text("#sound") == "Sound off"
    assert not page.errors


def test_a_refused_setting_is_named_and_the_page_goes_on(open_page: Callable[..., Any]) -> None:
    page = open_page()
    page.evaluate("ebacLive.change('hand.mass', -1)")
    assert page.inner_text("#error") == "hand.mass = -1 kg: must lie in [0, 10] kg"
    page.evaluate("ebacLive.change('hand.mass', 0.15)")
    assert page.inner_text("#error") == ""
    assert not page.errors


def test_every_axis_has_two_numbers_whatever_its_range(browser: Any) -> None:
    code = base64.b64encode((WEB / "strips.js").read_bytes()).decode()
    page = browser.new_page()
    found = page.evaluate(
        """async (code) => {
          const { ticks } = await import(`data:text/javascript;base64,${code}`);
          const found = [];
          for (let range = 0.01; range < 2000; range *= 1.03) {
            for (const place of [-1.3, -1, -0.5, -0.07, 0, 3.1]) {
              const { values, digits } = ticks(place * range, (place + 1) * range, 2);
              found.push([range, place, new Set(values.map((value) => value.toFixed(digits))).size]);
            }
          }
          return found;
        }""",
        code,
    )
    assert len(found) > 2000
    assert all(2 <= labels <= 5 for _, _, labels in found), [one for one in found if one[2] < 2][:5]


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
def test_the_page_fits(open_page: Callable[..., Any], width: int, height: int) -> None:
    page = open_page(width, height)
    page.wait_for_timeout(100)
    assert page.evaluate("document.documentElement.scrollWidth") == width
    if width > 1000:
        assert page.evaluate("document.documentElement.scrollHeight") <= height
    for place in ("#laws", "#scene", "#verdict", "#sound"):
        box = page.locator(place).bounding_box()
        assert box["y"] + box["height"] <= height
    if folder := os.environ.get("EBAC_SCREENSHOTS"):
        page.wait_for_function(SETTLED)
        page.screenshot(path=Path(folder) / f"live-{width}.png")


MODEL = """async ({source, state, module}) => {
  state.module = new DataView(Uint8Array.from(atob(module), (c) => c.charCodeAt(0)).buffer);
  const listeners = {};
  window.model = {
    get: (name) => state[name],
    set: (name, value) => { state[name] = value; },
    save_changes: () => {},
    on: (event, call) => { listeners[event] = call; },
    put: (name, value) => { state[name] = value; listeners[`change:${name}`](); },
  };
  const url = URL.createObjectURL(new Blob([source], {type: "text/javascript"}));
  const el = document.body.appendChild(document.createElement("div"));
  await (await import(url)).default.render({model: window.model, el});
}"""


def test_the_widget_simulates_at_every_move(browser: Any, placed: bytes, tmp_path: Path) -> None:
    pytest.importorskip("anywidget")
    made = ebac.live.widget(law="tca")
    page = browser.new_page(viewport={"width": 900, "height": 560})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    state = {name: getattr(made, name) for name in ("facts", "values", "law")}
    given = {
        "source": script("core", "words", "strips", "controls", "widget"),
        "state": json.loads(json.dumps(state)),
        "module": base64.b64encode(placed).decode(),
    }
    page.evaluate(MODEL, given)
    assert page.inner_text("[role=status]").startswith("Shakes by 9.2 mm")
    page.select_option("select", "ebac")
    assert page.inner_text("[role=status]").startswith("Quiet and exact")
    page.evaluate("model.put('values', {...model.get('values'), 'environment.stiffness': 20000})")
    assert "20.0 kN/m" in page.inner_text(".side")
    page.locator("[data-name='timing.delay']").fill("3")
    made.values = page.evaluate("model.get('values')")
    made.law = page.evaluate("model.get('law')")
    assert (made.scenario.timing.delay, made.scenario.environment.stiffness) == (3, 20e3)
    still = ebac.contact(made.trace).still
    assert page.inner_text("[role=status]").startswith("Shakes") != still
    page.screenshot(path=Path(os.environ.get("EBAC_SCREENSHOTS", tmp_path)) / "widget.png")
    page.evaluate("model.put('values', {...model.get('values'), 'hand.mass': -1})")
    assert "must lie in [0, 10] kg" in page.inner_text("[role=status]")
    assert not errors
