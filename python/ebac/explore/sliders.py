"""`ebac.explore.sliders()`: wall, delay, law and hand under sliders in a notebook, simulated anew at every move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ebac._core import Wall
from ebac._util import formatting, verdicts
from ebac._util.arguments import number, require, unknown
from ebac.metrics import contact
from ebac.scenario import Scenario
from ebac.simulation import LoopFault, simulate

if TYPE_CHECKING:
    from anywidget import AnyWidget

    from ebac.trace import Trace

_SCRIPT = Path(__file__).with_name("sliders.js")


@dataclass(frozen=True)
class Slider:
    """One slider: what it is called, its unit and range; with `decades` equal ways are equal factors."""

    name: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    decades: bool = False


SLIDERS = (
    Slider("stiffness_N_per_m", "wall", "N/m", 100.0, 50e3, 0.0, decades=True),
    Slider("delay_samples", "delay", "samples", 0, 8, 1),
    Slider("hand_mass_kg", "hand: mass", "kg", 0.02, 1.0, 0.0, decades=True),
    Slider("hand_damping_N_s_per_m", "hand: damping", "N s/m", 0.2, 50.0, 0.0, decades=True),
    Slider("hand_stiffness_N_per_m", "hand: stiffness", "N/m", 10.0, 2000.0, 0.0, decades=True),
)
#: Laws to choose among unless others are given.
LAWS = ("direct", "tca", "tca-damped", "eba", "ebac-printed", "ebac")


def values_of(scenario: Scenario, law: str) -> dict[str, Any]:
    """Return where the sliders stand for a scenario."""
    wall, hand = scenario.environment, scenario.hand
    assert isinstance(wall, Wall)
    return {
        "law": law,
        "stiffness_N_per_m": wall.stiffness,
        "delay_samples": scenario.timing.delay,
        "hand_mass_kg": hand.mass,
        "hand_damping_N_s_per_m": hand.damping,
        "hand_stiffness_N_per_m": hand.stiffness,
    }


def moved(scenario: Scenario, values: dict[str, Any]) -> Scenario:
    """Return a scenario with what the sliders say.

    Raises
    ------
    KeyError, ValueError
        For a slider that is missing or that there is not, or a value out of range.
    """
    known = values_of(scenario, "")
    if strange := [name for name in values if name not in known]:
        raise ValueError(unknown(f"slider {strange[0]!r}", strange[0], known))
    wall = scenario.environment
    assert isinstance(wall, Wall)
    return scenario.replace(
        environment=wall.replace(stiffness=float(values["stiffness_N_per_m"])),
        timing=scenario.timing.replace(delay=int(values["delay_samples"])),
        hand=scenario.hand.replace(
            mass=float(values["hand_mass_kg"]),
            damping=float(values["hand_damping_N_s_per_m"]),
            stiffness=float(values["hand_stiffness_N_per_m"]),
        ),
    )


def checked(values: Mapping[str, Any], laws: Sequence[str], where: str) -> dict[str, Any]:
    """Return values that the sliders can take; `where` begins the message of one that they cannot.

    Raises
    ------
    ValueError
        For a slider that there is not, a value out of its range, a law that is not among `laws`.
    TypeError
        For what is not a number.
    """
    ranges = {one.name: one for one in SLIDERS}
    found: dict[str, Any] = {}
    for name, value in values.items():
        if name == "law":
            if value not in laws:
                raise ValueError(unknown(f"{where}: law = {value!r}", str(value), laws))
            found[name] = value
            continue
        if name not in ranges:
            raise ValueError(unknown(f"{where}: slider {name!r}", name, ["law", *ranges]))
        one = ranges[name]
        at = number(f"{where}: {name}", value)
        near = 1e-9 * (one.high - one.low)  # a slider over decades ends at 10**log10(high)
        if not one.low - near <= at <= one.high + near:
            raise ValueError(
                f"{where}: {name} = {at:g} {one.unit}: must lie in [{one.low:g}, {one.high:g}] {one.unit}"
            )
        if one.step == 1 and at != int(at):
            raise ValueError(f"{where}: {name} = {at:g} {one.unit}: must be a whole number")
        at = min(max(at, one.low), one.high)
        found[name] = int(at) if one.step == 1 else at
    return found


def picture(trace: Trace) -> dict[str, Any]:
    """Return what the page draws: panels of lines, as float32 bytes."""
    from ebac.plot.style import colour as colour_of

    def line(name: str, colour: str, values: Any) -> dict[str, Any]:
        return {
            "name": name,
            "colour": colour,
            "y": np.ascontiguousarray(values, np.float32).tobytes(),
        }

    own = colour_of(trace.law)
    return {
        "t": np.ascontiguousarray(trace["t"], np.float32).tobytes(),
        "panels": [
            {
                "label": "position [mm]",
                "lines": [line("handle", own, 1e3 * trace.axis("true.x"))],
            },
            {
                "label": "force [N]",
                "lines": [
                    line("of the wall", "#000000", trace.axis("f_env")),
                    line("commanded", own, trace.axis("f_cmd")),
                ],
            },
            {
                "label": "energy [mJ]",
                "lines": [line("at the port", own, 1e3 * trace.axis("true.energy"))],
            },
        ],
    }


def sliders(
    scenario: Scenario | None = None, law: str = "ebac", *, laws: Sequence[str] = LAWS
) -> AnyWidget:
    """Return a widget for a notebook: every move of a slider simulates the scenario anew and redraws it.

    Needs `pip install 'ebac[notebook]'`.

    Parameters
    ----------
    scenario : Scenario, optional
        Where the sliders stand at first; default: `Scenario(seconds=2)`. Its environment must be a wall.
    law : str
        The law at first.
    laws : sequence of str
        The laws to choose among.

    Returns
    -------
    anywidget.AnyWidget
        With `values`, where the sliders stand (units in the names; set all or some of them), `scenario` and
        `trace`, what was simulated last, `verdict` and `error`.

    Raises
    ------
    TypeError
        For a world that is no wall.
    ValueError
        For a law that is not among `laws`, a scenario beyond the sliders, and later for `values` that are refused.
    ImportError
        Without anywidget.
    """
    try:
        from anywidget import AnyWidget
        from traitlets import Any as Anything
        from traitlets import Dict, Int, List, TraitError, Unicode, validate
    except ImportError as error:
        raise ImportError("sliders need anywidget: pip install 'ebac[notebook]'") from error
    start = Scenario(seconds=2.0) if scenario is None else scenario
    require(start, Scenario, "ebac.explore.sliders", "a Scenario")
    if not isinstance(start.environment, Wall):
        kind = type(start.environment).__name__
        raise TypeError(f"ebac.explore.sliders: the environment is a {kind}: must be a Wall")
    at_first = checked(values_of(start, law), laws, "ebac.explore.sliders")

    class WrongValues(TraitError, ValueError):  # traitlets sets back what a TraitError refuses
        pass

    class Sliders(AnyWidget):
        """Sliders over a simulated press."""

        _esm = _SCRIPT
        controls: List[Any] = List().tag(sync=True)
        laws: List[Any] = List().tag(sync=True)
        values = Dict().tag(sync=True)
        picture = Dict().tag(sync=True)
        verdict = Unicode().tag(sync=True)
        error = Unicode().tag(sync=True)
        serial = Int().tag(sync=True)  # of the answer: the page may send the next values
        scenario = Anything()
        trace = Anything()

        @validate("values")
        def _merged(self, proposal: Mapping[str, Any]) -> dict[str, Any]:
            try:
                given = checked(proposal["value"], self.laws, "values")
            except (ValueError, TypeError) as error:
                raise WrongValues(str(error)) from None
            return {**self.values, **given}

        def run(self, _change: object = None) -> None:
            """Simulate what the sliders say."""
            try:
                self.scenario = moved(start, self.values)
                trace = simulate(self.scenario, self.values["law"])
            except LoopFault as fault:
                trace, verdict = fault.trace, f"fault: {fault.fault.name.lower().replace('_', ' ')}"
            except (ValueError, TypeError, KeyError) as error:
                with self.hold_sync():
                    self.error = str(error)
                    self.serial += 1
                return
            else:
                measured = contact(trace)
                rest = formatting.quantity(measured.deviation_m, "m", signed=True)
                verdict = f"{verdicts.verdict(measured)}; rests {rest} from the ideal wall"
            with self.hold_sync():
                self.error, self.verdict = "", verdict
                self.trace, self.picture = trace, picture(trace)
                self.serial += 1

    made = Sliders(
        controls=[asdict(one) for one in SLIDERS],
        laws=list(laws),
        values=at_first,
    )
    made.observe(made.run, names="values")
    made.run()
    return made
