"""Long traces in a notebook: no peak is lost, axes have units, bad input is told."""

import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import ebac
from ebac._util.gaps import alone
from ebac.explore.pack import even, packed
from ebac.explore.panels import without_numbers
from ebac.explore.thin import bands
from ebac.plot.style import COLOURS

pytest.importorskip("bokeh")

ROWS = 60_001
values = hnp.arrays(
    np.float32, st.integers(2, 5000), elements=st.floats(-1e6, 1e6, width=32) | st.just(np.nan)
)


@pytest.fixture(scope="module")
def minute() -> ebac.Trace:
    """A minute of pressing again and again, with one needle of one tick put into the command."""
    scenario = ebac.Scenario(hand=ebac.Hand(path=[ebac.Sine(frequency=0.7)]), seconds=60)
    trace = ebac.simulate(scenario, "ebac")
    data = {name: trace[name].copy() for name in trace}
    data["f_cmd"][31_234] = 99.0
    return ebac.Trace(data=data, columns=trace.columns, axes=1, law="ebac")


@given(values=values, bins=st.integers(1, 50))
def test_thinning_keeps_least_and_most_of_all_and_of_every_bin(values: Any, bins: int) -> None:
    t = np.arange(len(values), dtype=float)
    thin = bands(values, t, bins)
    if not np.isnan(values).all():
        assert np.nanmax(thin.most) == np.nanmax(values)
        lowest = np.nanmin(np.concatenate([thin.least, thin.most]))
        assert lowest == np.nanmin(values)
    assert len(thin.t) <= max(bins, min(len(values), 4 * bins))
    assert (np.diff(thin.t) > 0).all()


def test_a_number_between_two_gaps_is_alone() -> None:
    nan = np.nan
    found = alone(np.array([1.0, nan, 2.0, nan, nan, 3.0, 4.0, nan, 5.0]))
    assert np.array_equal(found, [1, nan, 2, nan, nan, nan, nan, nan, 5], equal_nan=True)


@given(values=values)
def test_packing_loses_no_bit(values: Any) -> None:
    planes = np.frombuffer(zlib.decompress(packed(values)), np.uint8).reshape(4, -1)
    assert np.ascontiguousarray(planes.T).tobytes() == values.tobytes()


def test_a_steady_clock_is_distinguished_from_one_that_jitters() -> None:
    assert even(np.arange(10_000) * 1e-3 + 5)
    jittered = ebac.simulate(ebac.Scenario(jitter=0.2, seconds=0.5), "ebac")
    assert not even(jittered["t"])


def test_the_usual_panels_have_units(minute: ebac.Trace) -> None:
    labels = [panel.label for panel in minute.explore().panels]
    assert labels == [
        "position [mm]",
        "force [N]",
        "beta [kN/m]",
        "energy [mJ]",
        "force limited",
    ]


def test_chosen_columns_make_panels_in_their_order(minute: ebac.Trace) -> None:
    found = minute.explore("v", ["f_cmd", "f_meas"]).panels
    assert [(panel.names, panel.label) for panel in found] == [
        (("v",), "v [m/s]"),
        (("f_cmd", "f_meas"), "f_cmd, f_meas [N]"),
    ]


def test_an_axis_has_room_for_its_label(minute: ebac.Trace) -> None:
    (panel,) = minute.explore(["law.beta", "law.beta_min", "law.beta_max"]).panels
    assert panel.label == "stiffness [kN/m]"  # the legend has the names
    (panel,) = minute.explore(["f_env", "f_meas", "f_cmd", "f_applied", "law.f_d"]).panels
    assert panel.label == "force [N]"


@pytest.mark.parametrize(
    ("groups", "kind", "message"),
    [
        (["y"], KeyError, "no column is called 'y'"),
        ([["x", "f_cmd"]], ValueError, r"x \[m\], f_cmd \[N\]: put them into panels of their own"),
        ([[]], ValueError, "a panel without a column"),
    ],
)
def test_bad_columns_are_reported(minute: ebac.Trace, groups: Any, kind: Any, message: str) -> None:
    with pytest.raises(kind, match=message):
        minute.explore(*groups)


def test_a_wrong_axis_and_an_empty_trace_are_reported(minute: ebac.Trace) -> None:
    with pytest.raises(ValueError, match="axis = 1: must lie in"):
        minute.explore(axis=1)
    with pytest.raises(ValueError, match="the trace has 0 rows"):
        minute[:0.0].explore()


@pytest.mark.slow
def test_the_page_stands_alone(minute: ebac.Trace, tmp_path: Path) -> None:
    page = tmp_path / "run.html"
    minute[:5].explore("x").save(page)
    html = page.read_text(encoding="utf-8")
    assert "<script" in html
    tags = re.sub(r"<script.*?</script>", "<script></script>", html, flags=re.DOTALL)
    assert not re.search(r"<(script|link|img)[^>]* (src|href)=", tags)
    assert not re.search(r"<script[^>]* src=", html)
    shown = minute[:5].explore("x")._repr_html_()
    assert shown.startswith("<iframe")
    assert shown.count("<iframe") == 1


# --- in a real browser ---

SHOWN = """() => {
  const found = {};
  for (const model of Bokeh.documents[0]._all_models.values()) {
    if (model.type === "GlyphRenderer" && model.glyph.type === "Line" && model.glyph.y.field === "high") {
      const {t, least, most} = model.data_source.data;
      const known = (list) => Array.from(list).filter((value) => value === value);
      found[model.name] = {
        rows: t.length,
        least: known(least).concat(known(most)).reduce((a, b) => Math.min(a, b), Infinity),
        most: known(most).reduce((a, b) => Math.max(a, b), -Infinity),
      };
    }
  }
  return found;
}"""


@pytest.mark.slow
@pytest.mark.weekly
def test_in_a_browser_a_zoom_draws_the_window_anew_and_keeps_its_peaks(
    browser: Any, minute: ebac.Trace, tmp_path: Path
) -> None:
    page = browser.new_page(viewport={"width": 1000, "height": 700})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    minute.explore("x", ["f_env", "f_cmd"]).save(tmp_path / "run.html")
    page.goto((tmp_path / "run.html").as_uri())
    page.wait_for_function("window.ebac_exploration")
    assert page.evaluate("ebac_exploration.rows") == ROWS
    assert page.evaluate(SHOWN)["f_cmd"]["most"] == 99.0  # one tick among 60,001

    page.mouse.move(500, 200)
    for _ in range(6):
        before = page.evaluate("ebac_exploration.drawn")
        page.mouse.wheel(0, -240)
        page.wait_for_function(f"ebac_exploration.drawn > {before}")
    seen = page.evaluate("ebac_exploration")
    assert 10 < seen["rows"] < ROWS / 2
    start, stop = seen["start"], seen["stop"]
    shown = page.evaluate(SHOWN)
    for name, factor in (("x", 1e3), ("f_cmd", 1.0), ("f_env", 1.0)):
        part = (factor * minute[name][start:stop]).astype(np.float32)
        assert shown[name]["most"] == pytest.approx(float(part.max()), rel=1e-6)
        assert shown[name]["least"] == pytest.approx(float(part.min()), rel=1e-6)
    page.screenshot(path=tmp_path / "zoomed.png")
    assert not errors


def covered(picture: Path, law: str = "ebac") -> float:
    """Return how much of a screenshot has the colour of a law, as a fraction."""
    from matplotlib.colors import to_rgb
    from matplotlib.image import imread

    pixels = imread(picture)[..., :3]
    return float((np.abs(pixels - to_rgb(COLOURS[law])).max(axis=-1) < 0.1).mean())


@pytest.mark.slow
@pytest.mark.parametrize("stop", [2.0, 10.0], ids=["every row", "bins"])
def test_in_a_browser_a_curve_is_a_line_and_its_gaps_stay_open(
    browser: Any, stop: float, tmp_path: Path
) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=stop), "ebac")
    data = {name: trace[name].copy() for name in trace}
    t = trace["t"]
    data["true.x"] = np.where((t / stop < 0.2) | (t / stop > 0.8), 5e-3 * np.sin(7 * t), np.nan)
    data["law.beta"] = np.where(np.arange(len(t)) % 50 == 0, 1e4, np.nan)  # each row alone
    made = ebac.Trace(data=data, columns=trace.columns, axes=1, law="ebac")
    page = browser.new_page(viewport={"width": 1000, "height": 560})
    made.explore("true.x", "law.beta").save(tmp_path / "run.html")
    page.goto((tmp_path / "run.html").as_uri())
    page.wait_for_function("window.ebac_exploration")
    page.wait_for_timeout(300)
    picture = tmp_path / "run.png"
    page.screenshot(path=picture, clip={"x": 400, "y": 60, "width": 200, "height": 180})
    assert covered(picture) == 0  # the gap of the position
    for _ in range(3):
        page.screenshot(path=picture)
        assert 0.0002 < covered(picture) < 0.02
        before = page.evaluate("ebac_exploration.drawn")
        page.mouse.move(150, 120)
        page.mouse.wheel(0, -240)
        page.wait_for_function(f"ebac_exploration.drawn > {before}")
        page.wait_for_timeout(300)


def test_a_column_without_a_number_says_why() -> None:
    with_observer = ebac.simulate(ebac.Scenario(seconds=0.5), "ebac")
    (panel,) = with_observer.explore("law.beta").panels
    told = without_numbers(with_observer, panel)
    assert told.startswith("law.beta is NaN in every row: with its state observer ebac has no beta")
    assert told.replace("\n", "\\n") in with_observer.explore("law.beta").html
    on_encoder = ebac.simulate(ebac.Scenario(seconds=0.5, observer=False), "ebac")
    (panel,) = on_encoder.explore("law.beta").panels
    assert without_numbers(on_encoder, panel) == ""
    empty = on_encoder.with_column("v", np.full(len(on_encoder), np.nan))
    (panel,) = empty.explore("v").panels
    assert without_numbers(empty, panel) == f"v is NaN in every row:\n{empty.columns['v'].meaning}"


TICKS = """() => {
  const models = [...Bokeh.documents[0]._all_models.values()];
  const {y_range, left} = models.find((model) => model.type === "Figure" || model.type === "Plot");
  return left[0].ticker.get_ticks(y_range.start, y_range.end, y_range, 0).major.map(Math.sinh);
}"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("low", "high"), [(1.3, 2.3), (3.8, 3.82), (-0.5, 0.5), (-0.02, 0.01), (12, 90), (-800, 900)]
)
def test_in_a_browser_an_axis_of_stiffness_has_numbers_whatever_its_range(
    browser: Any, low: float, high: float, tmp_path: Path
) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.5, observer=False), "ebac")
    made = trace.with_column("law.beta", 1e3 * np.linspace(low, high, len(trace)))
    page = browser.new_page(viewport={"width": 800, "height": 400})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    made.explore("law.beta").save(tmp_path / "run.html")
    page.goto((tmp_path / "run.html").as_uri())
    page.wait_for_function("window.ebac_exploration")
    page.wait_for_timeout(300)
    ticks = page.evaluate(TICKS)
    assert 2 <= len(ticks) <= 9
    assert not errors


def test_a_page_is_saved_whole_under_a_name_that_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = ebac.simulate(ebac.Scenario(seconds=0.05), "direct").explore("x")
    for name in ("x.png", "x.pdf", "x.csv", "html.x"):
        with pytest.raises(
            ValueError, match=rf"{name}: must end in \.html or \.htm, as it is a page"
        ):
            shown.save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []
    for name in ("x.html", "X.HTM", "x"):
        shown.save(tmp_path / name)
        assert (tmp_path / name).read_text(encoding="utf-8") == shown.html
    monkeypatch.setattr(Path, "replace", lambda *_: (_ for _ in ()).throw(OSError("no")))
    (tmp_path / "x.html").write_text("old")
    with pytest.raises(OSError, match="no"):
        shown.save(tmp_path / "x.html")
    assert (tmp_path / "x.html").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 3
