"""Fig. 5: position, force and beta of the EBAC for a target of 0.04 m."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ebac._core import Wall
from ebac._util import descriptions, formatting
from ebac.laws import design
from ebac.metrics import Contact, contact
from ebac.paper.finding import Finding, Row, judge, row
from ebac.scenario import Scenario
from ebac.simulation import simulate
from ebac.trace import Trace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from ebac.laws import CoreLaw, PythonLaw
    from ebac.plot import Picture

LAWS = {
    "ebac": "completed",
    "ebac-printed": "as printed",
    "ebac-printed, K_p = 0": "as printed, K_p = 0",
}
#: What the figure calls those that it shows.
DRAWN = {"ebac": "ebac, the law of this package", "ebac-printed": "EBAC as printed"}
#: The walls, by name: the reference, the same behind a little free air, and a soft one behind it.
WALLS = {
    "10 kN/m at the start": Wall(),
    "10 kN/m behind 5 mm of air": Wall(position=0.005),
    "100 N/m behind 5 mm of air": Wall(position=0.005, stiffness=100),
}
#: A response that has settled by then is fast [s].
FAST = 1.5

Runs: TypeAlias = dict[tuple[str, str], Trace]


def fig5() -> Finding:
    """Check Fig. 5: the completed law beside eq. (8) to (10) as printed."""
    traces: Runs = {
        (law, name): simulate(Scenario(environment=wall, seconds=3.0), _made(law))
        for name, wall in WALLS.items()
        for law in LAWS
    }
    found = {key: contact(trace) for key, trace in traces.items()}
    lines: list[Row] = []
    for (law, name), measured in found.items():
        lines += _rows(f"{LAWS[law]}, {name}", measured, traces[law, name])
    return Finding(
        name="fig5",
        title="Fig. 5: the EBAC pressing a wall, target 0.04 m",
        claim="The algorithm provides a stable and fast response (plots of x, F_d and beta).",
        rows=lines,
        verdict=judge(*(_good(found, law) for law in LAWS)),
        why=_why(found, traces),
        figure=_draw(traces),
    )


def _made(law: str) -> CoreLaw | PythonLaw:
    """Return a law of `LAWS`, designed for the reference device."""
    base = Scenario()
    name, _, without_loop = law.partition(", ")
    return design(name, base.device, base.timing, **({"kp": 0} if without_loop else {}))


def _good(found: dict[tuple[str, str], Contact], law: str) -> bool:
    """Whether a law is quiet, fast and exact at every wall."""
    contacts = [found[law, name] for name in WALLS]
    return all(
        c.quiet and c.exact and c.settled_s is not None and c.settled_s < FAST for c in contacts
    )


def _silent(trace: Trace) -> tuple[float, float]:
    """How long [s] and how deep [m] in the wall F_d is still zero."""
    inside = np.flatnonzero(trace["f_env"] > 0)
    acting = np.flatnonzero((trace["f_env"] > 0) & (trace["law.f_d"] != 0))
    if len(inside) == 0:
        return 0.0, 0.0
    last = acting[0] if len(acting) else len(trace) - 1
    return float(trace["t"][last] - trace["t"][inside[0]]), float(
        trace["true.x"][last] - trace["true.x"][inside[0]]
    )


def _rows(what: str, measured: Contact, trace: Trace) -> list[Row]:
    return [
        row(f"{what}: beyond the ideal", measured.deviation_m, "m"),
        row(f"{what}: settled", measured.settled_s, "s"),
        row(f"{what}: F_d zero in contact for", _silent(trace)[0], "s"),
        row(f"{what}: least energy", measured.least_energy_J, "J"),
    ]


def _why(found: dict[tuple[str, str], Contact], traces: Runs) -> str:
    """Describe the response of the completed law at every wall, and of the printed one."""
    walls = list(WALLS)
    slowest = max((found["ebac", name].settled_s or np.inf) for name in walls)
    off = max(abs(found["ebac", name].deviation_m or 0) for name in walls)
    deep = [formatting.quantity(found["ebac-printed", n].deviation_m, "m") for n in walls[:2]]
    time, depth = _silent(traces["ebac-printed", walls[2]])
    least = min((found["ebac-printed", name].least_energy_J or 0) for name in walls)
    return (
        f"The completed law, `ebac`, settles within {formatting.quantity(slowest, 's')} and rests within "
        f"{formatting.quantity(off, 'm')} of the ideal point at each wall here. "
        "Eq. (8) to (10) as printed are stable and as fast, but rest too deep by "
        f"{deep[0]} and {deep[1]} at 10 kN/m and generate energy ({formatting.quantity(least, 'J')}). "
        "Started in free air, beta is 0 and the ratio rows of eq. (10) hold it there until the "
        f"first row frees it: at the soft wall F_d stays zero for {formatting.quantity(time, 's')}, "
        f"{formatting.quantity(depth, 'm')} deep. The paper does not specify hand, wall or device of its "
        "figure; these are simulations with the reference hand and device."
    )


def _draw(traces: Runs) -> Picture:
    from ebac.plot import figure_legend, new_figure

    figure = new_figure(13, 8.4)
    grid = figure.subplots(3, len(WALLS), sharex=True, sharey="row")
    for column, name in enumerate(WALLS):
        for law, label in DRAWN.items():
            _lines(grid[:, column], traces[law, name][0.0:1.2], label)
        grid[0, column].set_title(f"wall of {name}", fontsize="medium")
        grid[0, column].axhline(40, color="0.4", lw=1, ls=":", label="target of the hand, 40 mm")
        grid[-1, column].set_xlabel("time [s]")
        _frames(grid[:, column], first=column == 0)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure_legend(figure, handles, labels)
    given = traces["ebac", next(iter(WALLS))].scenario
    assert given is not None
    parts = descriptions.describe(given).split("; ")
    figure.suptitle(f"simulated: {parts[0]}; {parts[1]}; {parts[3]}", fontsize="medium")
    figure.align_ylabels()
    return figure


def _lines(panels: Sequence[Axes], trace: Trace, label: str) -> None:
    from ebac.plot import colour

    t, shade = trace["t"], colour(trace.law)
    panels[0].plot(t, 1e3 * trace["true.x"], color=shade, label=label)
    panels[1].plot(t, trace["law.f_d"], color=shade)
    panels[2].plot(t, trace["law.beta"] / 1e3, ".", ms=3, color=shade)


def _frames(panels: Sequence[Axes], *, first: bool) -> None:
    from ebac.plot import dress

    labels = ("x [mm]", "$F_d$ [N]", r"$\beta$ [kN/m]")
    for ax, label in zip(panels, labels, strict=True):
        dress(ax, label if first else "")
