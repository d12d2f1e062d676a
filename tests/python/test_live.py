"""The core as WebAssembly: the numbers of the native one, its errors as errors, and a widget over it."""

import base64
import json
import math
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer.testing

import ebac
from ebac.cli import app
from ebac.live import module as module_of
from ebac.live.notebook_widget import MOVED, moved, values_of
from ebac.live.settings import options, settings
from ebac.live.wasm_module import script


@pytest.fixture
def in_javascript(
    wasm: bytes, tmp_path: Path, request: pytest.FixtureRequest
) -> Callable[..., Any]:
    """A function that runs code over a loaded `core`, in Node or else in a browser, and returns what it returns."""
    node = shutil.which("node")
    page = None if node else request.getfixturevalue("browser").new_page()

    def run(code: str, **given: Any) -> Any:
        text = (
            script("core", "words", "strips", "controls", "widget").replace(
                "export default", "void"
            )
            + f"const bytes = atob({json.dumps(base64.b64encode(wasm).decode())});"
            + "const core = await load(Uint8Array.from(bytes, (c) => c.charCodeAt(0)));"
            + f"const given = {json.dumps(given)};"
            + f"const answer = JSON.stringify(await (async () => {{ {code} }})());"
        )
        if page is not None:
            return json.loads(page.evaluate(f"async () => {{ {text} return answer; }}"))
        file = tmp_path / "run.mjs"
        file.write_text(f"{text} process.stdout.write(answer);", encoding="utf-8")
        done = subprocess.run([str(node), str(file)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr[-2000:]
        return json.loads(done.stdout)

    return run


RUN = """const { columns, fault } = simulated(core, given.law, given.settings, given.options, given.rows);
return { fault, measured: core.measure(), columns: Object.fromEntries(
  ["t", "x", "f_env", "f_cmd", "f_applied", "energy", "beta", "target"].map((name) => [name, [...columns[name]]])) };"""


def simulated(run: Callable[..., Any], scenario: ebac.Scenario, law: str) -> Any:
    rows = round(scenario.seconds / scenario.timing.dt) + 1
    return run(RUN, law=law, settings=settings(scenario), options=options(scenario), rows=rows)


def assert_same(made: Any, trace: ebac.Trace, newton: float) -> None:
    assert made["fault"] == 0
    columns = {name: np.array(values, dtype=float) for name, values in made["columns"].items()}
    np.testing.assert_array_equal(columns["t"], trace["t"])
    for name in ("f_env", "f_cmd", "f_applied"):
        np.testing.assert_allclose(columns[name], trace[name], rtol=0, atol=newton)
    np.testing.assert_allclose(columns["x"], trace["true.x"], rtol=0, atol=newton / 1e3)
    np.testing.assert_allclose(columns["energy"], trace["true.energy"], rtol=0, atol=newton)


@pytest.mark.parametrize("law", ebac.laws.LAWS)
def test_a_run_has_the_numbers_of_the_native_one(
    in_javascript: Callable[..., Any], run: Callable[..., ebac.Trace], law: str
) -> None:
    made = simulated(in_javascript, ebac.Scenario(), law)
    trace = run(law)
    assert_same(made, trace, 1e-11)
    native = ebac.contact(trace)
    assert made["measured"]["rest"] == pytest.approx(native.rest_m, rel=1e-9)
    assert made["measured"]["swing"] == pytest.approx(native.swing_m, rel=1e-6, abs=1e-12)
    assert made["measured"]["perceived"] == pytest.approx(native.perceived, rel=1e-6)
    if "law.beta" in trace:
        beta = np.array(made["columns"]["beta"], dtype=float)
        np.testing.assert_allclose(beta, trace["law.beta"], rtol=1e-6, atol=1e-6)


OTHER = ebac.Scenario(
    environment=ebac.Wall(stiffness=20e3, position=0.01, damping=3),
    device=ebac.Device(
        mechanics=ebac.Mechanics(damping=1.0, coulomb=0.3), sensor=ebac.ForceSensor(noise=0.03)
    ),
    hand=ebac.Hand(mass=0.3, stiffness=500, path=[ebac.Step(target=0.05, at=0.1)]),
    timing=ebac.Timing(delay=2),
    seconds=1.0,
    jitter=0.1,
    seed=7,
    observer="every-law",
)


@pytest.mark.parametrize("law", ["tca-damped", "ebac"])
def test_all_of_a_scenario_gets_there(in_javascript: Callable[..., Any], law: str) -> None:
    made = simulated(in_javascript, OTHER, law)
    assert_same(made, ebac.simulate(OTHER, law), 1e-9)
    np.testing.assert_array_equal(np.array(made["columns"]["target"])[[99, 101]], [0.0, 0.05])


def test_an_aim_is_a_step_of_the_hand(in_javascript: Callable[..., Any]) -> None:
    code = """core.start("ebac", { "hand.path.target": 0 });
    core.step(500); core.aim(0.04);
    return [...core.step(1000).f_cmd];"""
    step = ebac.Scenario(hand=ebac.Hand(path=[ebac.Step(at=0.4985)]), seconds=1.499)
    force = ebac.simulate(step, "ebac")["f_cmd"][500:]
    np.testing.assert_allclose(in_javascript(code), force, rtol=0, atol=1e-12)


def test_a_curve_has_gaps_where_there_is_no_value(in_javascript: Callable[..., Any]) -> None:
    code = """const drawn = [];
    const [moveTo, lineTo] = ["move", "line"].map((what) => (...at) => drawn.push([what, ...at]));
    const g = { beginPath() {}, stroke() {}, moveTo, lineTo };
    const y = [null, 1, 2, null, null, 3, 4, 5, null].map((value) => value ?? NaN);
    curve(g, y.map((_, k) => k), { y }, (t) => t, (value) => value);
    return drawn;"""
    drawn = in_javascript(code)
    assert drawn == [
        *(["move", 0.5, 1], ["line", 1, 1], ["line", 2, 2]),
        *(["move", 4.5, 3], ["line", 5, 3], ["line", 6, 4], ["line", 7, 5]),
    ]


def test_what_the_core_refuses_is_an_error_and_leaves_a_run_as_it_was(
    in_javascript: Callable[..., Any],
) -> None:
    code = """core.start("ebac"); core.step(100);
    const refused = [];
    for (const call of [
      () => core.start("ebac", { "hand.mass": -1 }), () => core.start("ebac", { "hand.mas": 1 }),
      () => core.start("pid"), () => core.wall(-5, 0), () => core.start("ebac", { "timing.delay": NaN }),
    ]) try { call(); refused.push("taken"); } catch (error) { refused.push(error.message); }
    const top = core.wasm.__stack_pointer.value;
    for (let i = 0; i < 5000; ++i) try { core.start("pid"); } catch {}
    const after = core.step(100);
    return { refused, t: after.t[99], x: after.x[99], top: top === core.wasm.__stack_pointer.value };"""
    made = in_javascript(code)
    assert made["refused"] == [
        "hand.mass = -1 kg: must lie in [0, 10] kg",
        "no setting 'hand.mas'",
        "no law 'pid'",
        "Wall.stiffness = -5 N/m: must lie in [0, 1e+07] N/m",
        "timing.delay = nan samples: must lie in [0, 8] samples",
    ]
    assert made["top"]
    trace = ebac.simulate(ebac.Scenario(seconds=0.199), "ebac")
    assert made["t"] == trace["t"][-1]
    assert made["x"] == pytest.approx(trace["true.x"][-1], abs=1e-15)


def test_nothing_runs_before_a_start(in_javascript: Callable[..., Any]) -> None:
    code = "try { core.step(1); } catch (error) { return error.message; }"
    assert in_javascript(code) == "start a run before it is stepped"


def test_the_catalogue_is_that_of_the_package(in_javascript: Callable[..., Any]) -> None:
    made = in_javascript("return { ...core.catalogue, sliders: SLIDERS };")
    assert [law["name"] for law in made["laws"]] == list(ebac.laws.LAWS)
    known = {one["name"]: one for one in made["settings"]}
    assert known["hand.mass"] == {
        "name": "hand.mass", "unit": "kg", "low": 0, "high": 10, "default": 0.15,
        "meaning": "mass of the hand, which moves with the handle: M0 of eq. (4)",
    }  # fmt: skip
    assert set(settings(OTHER)) <= set(known)
    assert [one["name"] for one in made["sliders"]] == list(MOVED)
    for one in made["sliders"]:
        assert known[one["name"]]["low"] <= one["low"] < one["high"] <= known[one["name"]]["high"]


def test_the_verdict_is_that_of_the_package(in_javascript: Callable[..., Any]) -> None:
    said = {}
    for law in ("tca", "eba"):
        code = RUN.replace(
            "return {", "const said = verdict(core.measure(), 0.0116504854); return { said,"
        )
        said[law] = in_javascript(code, law=law, settings={}, options={}, rows=6001)["said"]["head"]
    assert said["tca"] == "Shakes by 9.2 mm"
    assert said["eba"] == "Quiet, but soft"


def test_a_force_that_is_not_quiet_has_its_reasons(in_javascript: Callable[..., Any]) -> None:
    never = math.nan
    given = [(5.0, 0.3), (2.0, never), (0.5, never)]  # vibration [thresholds], settled at [s]
    rows = [
        {
            "still": 1,
            "force_quiet": 0,
            "rest": 0.0,
            "swing": 0.0,
            "perceived": p,
            "force_settled": t,
        }
        for p, t in given
    ]
    said = in_javascript("return given.rows.map((one) => verdict(one, 0, true).more);", rows=rows)
    assert [one.partition(". Rests")[0] for one in said] == [
        "Still, but its force vibrates 5.0 times the threshold of touch",
        "Still, but its force vibrates 2.0 times the threshold of touch and does not settle",
        "Still, but its force does not settle",
    ]


def test_the_module_is_small(wasm: bytes) -> None:
    assert len(wasm) < 600e3


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"environment": ebac.Free()}, "environment is a Free: must be a Wall"),
        ({"hand": ebac.Hand(path=[ebac.Sine()])}, "hand.path.0. is a Sine: must be a Step"),
        ({"hand": ebac.hands.Reflex()}, "hand.model is a Reflex: must be None"),
        ({"device": ebac.Device(kinematics=ebac.Gimbal())}, "device.kinematics is a Gimbal"),
        ({"device": ebac.Device(kinematics=ebac.Linear(axes=2))}, "has 2 axes: must have 1"),
        ({"device": ebac.Device(velocity=ebac.LowPass())}, "device.velocity is a LowPass"),
        ({"observer": ebac.Observer()}, "observer is an Observer: must be True"),
    ],
)
def test_what_the_module_does_not_simulate_is_refused(changes: Any, words: str) -> None:
    with pytest.raises(TypeError, match=words):
        settings(ebac.Scenario(**changes))


def test_a_seed_that_javascript_would_round_is_refused() -> None:
    with pytest.raises(ValueError, match=r"seed = 9007199254740993: must lie in \[0, 2\^53\]"):
        options(ebac.Scenario(seed=2**53 + 1))


def test_sliders_change_the_scenario() -> None:
    assert moved(OTHER, values_of(OTHER)) == OTHER
    values = {**values_of(OTHER), "timing.delay": 3, "device.mechanics.damping": 0.5}
    there = moved(OTHER, values)
    assert values_of(there) == values
    assert there.device.mechanics.coulomb == 0.3


def test_a_widget_knows_what_it_shows(placed: bytes) -> None:
    pytest.importorskip("anywidget")
    made = ebac.live.widget(OTHER, "tca")
    assert made.scenario == OTHER
    assert made.module == placed
    np.testing.assert_array_equal(made.trace["x"], ebac.simulate(OTHER, "tca")["x"])
    with pytest.raises(KeyError, match="pid"):
        ebac.live.widget(law="pid")
    with pytest.raises(ValueError, match=r"Scenario.seconds = 100 s: must lie in"):
        ebac.live.widget(ebac.Scenario(seconds=100))


def test_without_the_module_the_remedy_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("ebac.live.wasm_module.PLACE", tmp_path / "ebac.wasm")
    with pytest.raises(FileNotFoundError, match=r"python bindings/wasm/build.py"):
        module_of()
    done = typer.testing.CliRunner().invoke(app, ["live", "--page", str(tmp_path / "live.html")])
    assert done.exit_code == 2
    assert "python bindings/wasm/build.py" in done.output


def test_the_command_writes_the_page(placed: bytes, tmp_path: Path) -> None:
    page = tmp_path / "live.html"
    done = typer.testing.CliRunner().invoke(app, ["live", "--page", str(page), "--json"])
    assert done.exit_code == 0, done.output
    assert json.loads(done.output)["size_bytes"] == page.stat().st_size
    html = page.read_text(encoding="utf-8")
    assert base64.b64encode(placed).decode() in html
    assert " src=" not in html.split("<script", 1)[0]
    assert "import " not in html.split("<script", 1)[1].split("export_name")[0][:4000]
    nowhere = typer.testing.CliRunner().invoke(app, ["live", "--page", str(tmp_path / "no" / "a")])
    assert nowhere.exit_code == 2
    assert "there is no folder" in nowhere.output
    again = typer.testing.CliRunner().invoke(app, ["live", "--page", str(page)])
    assert again.exit_code == 2
    assert "--force" in again.output
