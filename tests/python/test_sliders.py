"""Sliders in a notebook: what they show is what is simulated, and wrong values are told and change nothing."""

import base64
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac
from ebac.explore import sliders
from ebac.explore.sliders import SLIDERS, moved, picture, values_of

SCRIPT = Path(ebac.__file__).with_name("explore") / "sliders.js"


def as_text(drawn: dict[str, Any]) -> Any:
    return json.loads(json.dumps(drawn, default=lambda data: base64.b64encode(data).decode()))


@given(st.fixed_dictionaries({one.name: st.floats(one.low, one.high) for one in SLIDERS}))
def test_a_scenario_has_what_the_sliders_say(values: dict[str, Any]) -> None:
    values["delay_samples"] = int(values["delay_samples"])
    values["law"] = "ebac"
    assert values_of(moved(ebac.Scenario(), values), "ebac") == values


def test_the_picture_is_the_simulation() -> None:
    pytest.importorskip("anywidget")
    scenario = ebac.Scenario(seconds=0.5, observer=False)
    made = sliders(scenario, "tca")
    assert made.picture == picture(ebac.simulate(scenario, "tca"))
    made.values = {**made.values, "stiffness_N_per_m": 20e3, "law": "ebac", "delay_samples": 2}
    there = scenario.replace(environment=ebac.Wall(stiffness=20e3), timing=ebac.Timing(delay=2))
    trace = ebac.simulate(there, "ebac")
    assert made.picture == picture(trace)
    assert made.scenario == there
    assert "m from the ideal wall" in made.verdict
    np.testing.assert_array_equal(made.trace["x"], trace["x"])


#: A notebook of which only the model matters: as traitlets, it answers where a value differs from the one before.
NOTEBOOK = """
const listeners = [];
const element = () => ({
  style: {}, append() {}, setAttribute() {},
  addEventListener(name, does) { if (name === "input") listeners.push(does); },
});
globalThis.document = { createElement: element };
globalThis.requestAnimationFrame = () => {};
let values = { law: "ebac", a: 1 }, sent = 0;
const on = {};
const model = {
  get: (name) => ({ values, laws: [], controls: [{ name: "a", label: "a", low: 0, high: 9, step: 1, unit: "1" }],
                    picture: {} })[name],
  set(name, given) { if (JSON.stringify(given) !== JSON.stringify(values)) { values = given; ++sent; } },
  save_changes() {}, on(name, does) { on[name] = does; },
};
const inputs = [];
const made = document.createElement;
document.createElement = (kind) => { const one = made(); if (kind === "input") inputs.push(one); return one; };
const { default: page } = await import(process.argv[1]);
page.render({ model, el: element() });
const move = (value) => { inputs[0].value = value; listeners[0](); };
const answer = () => on["change:serial"]();
"""


@pytest.mark.parametrize(
    ("moves", "sent"),
    [
        ("move(2); answer(); move(3); answer();", 2),
        ("move(2); move(3); move(2); answer(); move(5);", 2),  # forth and back meanwhile
        ("move(1); move(4);", 1),  # to where it was
        ("move(2); move(3); move(4); answer(); answer();", 2),  # what was skipped is not simulated
    ],
)
def test_a_slider_never_waits_for_an_answer_that_does_not_come(moves: str, sent: int) -> None:
    node = shutil.which("node") or pytest.skip("no node")
    script = f"{NOTEBOOK}{moves}; console.log(sent);"
    how = [node, "--input-type=module", "--eval", script, SCRIPT.as_uri()]
    done = subprocess.run(how, capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout.split() == [str(sent)], done.stderr


def test_some_values_move_their_sliders_alone() -> None:
    pytest.importorskip("anywidget")
    made = sliders(ebac.Scenario(seconds=0.2))
    before = dict(made.values)
    made.values = {"stiffness_N_per_m": 20e3}
    assert made.values == {**before, "stiffness_N_per_m": 20e3}
    assert made.scenario.environment.stiffness == 20e3
    made.values = {"stiffness_N_per_m": 10 ** np.log10(50e3) * (1 + 1e-15)}  # the end of its slider
    assert made.values["stiffness_N_per_m"] == 50e3
    assert made.error == ""


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"delay_samples": 99},
            r"values: delay_samples = 99 samples: must lie in \[0, 8\] samples",
        ),
        ({"delay_samples": 1.5}, "delay_samples = 1.5 samples: must be a whole number"),
        ({"stiffness_N_per_m": -5}, r"= -5 N/m: must lie in \[100, 50000\] N/m"),
        ({"stiffness_N_per_m": float("nan")}, "= nan N/m: must lie in"),
        ({"hand_mass_kg": "x"}, "hand_mass_kg = 'x': must be a number"),
        (
            {"stiffness": 500.0},
            "slider 'stiffness': no such name, did you mean 'stiffness_N_per_m'",
        ),
        ({"law": "ebca"}, "law = 'ebca': no such name, did you mean 'eba' or 'ebac'"),
    ],
)
def test_a_wrong_value_is_refused_and_nothing_moves(given: dict[str, Any], words: str) -> None:
    pytest.importorskip("anywidget")
    made = sliders(ebac.Scenario(seconds=0.2))
    before, picture = dict(made.values), made.picture
    with pytest.raises(ValueError, match=words):
        made.values = given
    assert made.values == before
    assert made.picture == picture
    with pytest.raises(ValueError, match=words), made.hold_trait_notifications():
        made.values = given  # as a page sends it
    assert made.values == before


@pytest.mark.parametrize(
    ("given", "kind", "words"),
    [
        ({"scenario": ebac.Scenario(environment=ebac.Free())}, TypeError, "must be a Wall"),
        ({"law": "iss"}, ValueError, "law = 'iss': no such name; there are: direct"),
        ({"scenario": 3}, TypeError, "a Scenario"),
        (
            {"scenario": ebac.Scenario(environment=ebac.Wall(stiffness=1e6))},
            ValueError,
            r"stiffness_N_per_m = 1e\+06 N/m: must lie in \[100, 50000\] N/m",
        ),
    ],
)
def test_what_has_no_sliders_is_refused(given: Any, kind: Any, words: str) -> None:
    pytest.importorskip("anywidget")
    with pytest.raises(kind, match=words):
        sliders(**given)


PAGE = """<!doctype html><body style="margin:0"><div id="here"></div></body>"""

MODEL = """async ({source, state}) => {
  const bytes = (text) => new DataView(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const unpack = (drawn) => ({t: bytes(drawn.t), panels: drawn.panels.map((panel) => ({
    ...panel, lines: panel.lines.map((line) => ({...line, y: bytes(line.y)}))}))});
  state.picture = unpack(state.picture);
  const listeners = {};
  window.moves = 0;
  const model = {
    get: (name) => state[name],
    set: (name, value) => { state[name] = value; },
    on: (event, call) => { (listeners[event] ??= []).push(call); },
    save_changes: async () => {
      const answer = await window.simulated(state.values);
      state.picture = unpack(answer.picture);
      state.verdict = answer.verdict;
      state.error = "";
      window.moves += 1;
      for (const call of listeners["change:serial"]) call();
    },
  };
  const module = await import(URL.createObjectURL(new Blob([source], {type: "text/javascript"})));
  module.default.render({model, el: document.getElementById("here")});
  window.model = model;
}"""


@pytest.mark.slow
def test_in_a_browser_a_moved_slider_shows_another_simulation(browser: Any, tmp_path: Path) -> None:
    pytest.importorskip("anywidget")
    made = sliders(ebac.Scenario(seconds=1.0), "tca")
    page = browser.new_page(viewport={"width": 900, "height": 560})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))

    def simulated(values: dict[str, Any]) -> dict[str, Any]:
        made.values = values
        return {"picture": as_text(made.picture), "verdict": made.verdict}

    page.expose_function("simulated", simulated)
    page.set_content(PAGE)
    names = ("controls", "laws", "values", "verdict", "error")
    state = {name: getattr(made, name) for name in names}
    state["picture"] = as_text(made.picture)
    page.evaluate(MODEL, {"source": SCRIPT.read_text(encoding="utf-8"), "state": state})
    page.wait_for_function("document.querySelector('canvas').height > 100")
    page.wait_for_timeout(200)
    first = page.screenshot(path=tmp_path / "tca.png")
    assert "swings" in page.inner_text("[role=status]")

    page.select_option("select", "ebac")
    page.wait_for_function("moves === 1")
    assert "exact and quiet" in page.inner_text("[role=status]")
    assert page.screenshot(path=tmp_path / "ebac.png") != first

    slider = page.locator("input[type=range]").first
    box = slider.bounding_box()
    page.mouse.move(box["x"] + 5, box["y"] + box["height"] / 2)
    page.mouse.down()
    for share in np.linspace(0.05, 0.5, 12):
        page.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
    page.mouse.up()
    page.wait_for_function("moves > 2")
    page.wait_for_timeout(300)
    assert made.values["stiffness_N_per_m"] == pytest.approx(
        10 ** (2 + 0.5 * np.log10(500)), rel=0.1
    )
    shown = float(page.inner_text("label >> nth=1").split()[1])
    assert shown == pytest.approx(made.scenario.environment.stiffness, rel=0.01)
    assert not errors
