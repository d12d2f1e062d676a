"""`ebac.live.widget()`: a scenario under sliders in a notebook, simulated in the browser at every move."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac._util import serialisation
from ebac._util.arguments import named, require
from ebac._util.law_colours import COLOURS
from ebac.laws import LAWS
from ebac.live.settings import options, settings
from ebac.live.wasm_module import module, script
from ebac.scenario import Scenario
from ebac.simulation import simulate

if TYPE_CHECKING:
    from anywidget import AnyWidget

#: What has a slider, as web/controls.js lists it.
MOVED = (
    "environment.stiffness",
    "timing.delay",
    "hand.stiffness",
    "hand.damping",
    "hand.mass",
    "device.mechanics.damping",
)
LONGEST = 60.0  # s


def values_of(scenario: Scenario) -> dict[str, float]:
    """Return where the sliders stand for a scenario."""
    values = {}
    for name in MOVED:
        part: Any = scenario
        for word in name.split("."):
            part = getattr(part, word)
        values[name] = part
    return values


def moved(scenario: Scenario, values: dict[str, float]) -> Scenario:
    """Return a scenario with what the sliders say."""
    return Scenario(
        **{
            part: _with(getattr(scenario, part), values, part)
            for part in ("device", "hand", "environment", "timing")
        },
        **{name: getattr(scenario, name) for name in ("seconds", "jitter", "seed", "observer")},
    )


def _with(part: Any, values: dict[str, float], prefix: str) -> Any:
    changes: dict[str, Any] = {}
    for name, value in values.items():
        if not name.startswith(f"{prefix}."):
            continue
        first, _, rest = name.removeprefix(f"{prefix}.").partition(".")
        here = getattr(part, first)
        changes[first] = type(here)(value) if not rest else here.replace(**{rest: value})
    return part.replace(**changes)


def widget(scenario: Scenario | None = None, law: str = "ebac") -> AnyWidget:
    """Return a widget for a notebook: every move of a slider simulates the scenario again, in the browser.

    Nothing travels to Python and back, so the curves follow the mouse; the same core, compiled to WebAssembly, gives
    the numbers of `ebac.simulate` to within 1e-12 N. Needs `pip install 'ebac[notebook]'`.

    Parameters
    ----------
    scenario : Scenario, optional
        Where the sliders stand at first; default: `Scenario(seconds=2)`. One axis, a wall, a hand that steps to its
        target; at most 60 s.
    law : str
        The law at first, a name of `ebac.LAWS`.

    Returns
    -------
    anywidget.AnyWidget
        With `law` and `values`, where the sliders stand (SI units; may be set), `verdict`, what is shown, `error`,
        `scenario`, and `trace`, the same run simulated by Python when it is asked for.

    Raises
    ------
    TypeError
        For a scenario with parts that the module does not simulate.
    ValueError
        For a run longer than 60 s.
    KeyError
        For a name that is no law.
    FileNotFoundError
        When the WebAssembly module was not built.
    ImportError
        Without anywidget.
    """
    try:
        from anywidget import AnyWidget
        from traitlets import Bytes, Dict, Unicode
    except ImportError as error:
        raise ImportError("the widget needs anywidget: pip install 'ebac[notebook]'") from error
    start = Scenario(seconds=2.0) if scenario is None else scenario
    require(start, Scenario, "ebac.live.widget", "a Scenario")
    named("law", law, LAWS)
    if start.seconds > LONGEST:
        raise ValueError(f"Scenario.seconds = {start.seconds:g} s: must lie in (0, {LONGEST:g}] s")

    class Live(AnyWidget):
        """Sliders over a press that the browser simulates."""

        _esm = script("core", "words", "strips", "controls", "widget")
        module = Bytes().tag(sync=True)
        facts = Dict().tag(sync=True)
        values = Dict().tag(sync=True)
        law = Unicode().tag(sync=True)
        verdict = Unicode().tag(sync=True)
        error = Unicode().tag(sync=True)

        @property
        def scenario(self) -> Scenario:
            """What is shown, as a scenario."""
            return moved(start, self.values)

        @property
        def trace(self) -> Any:
            """What is shown, simulated by Python."""
            return simulate(self.scenario, self.law)

    facts = {
        "settings": settings(start),
        "options": options(start),
        "seconds": start.seconds,
        "rows": round(start.seconds / start.timing.dt) + 1,
        "target": serialisation.to_document(start.hand.path[0])["target"],
        "colours": COLOURS,
    }
    return Live(module=module(), facts=facts, values=values_of(start), law=law)
