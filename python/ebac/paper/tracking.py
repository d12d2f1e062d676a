"""Fig. 8, Fig. 9 and Table I: paths along a ruler and around a rope, with the errors a joystick may have."""

from __future__ import annotations

from functools import cache

import numpy as np

from ebac._util import formatting
from ebac.paper.finding import Claim, Finding, judge, row
from ebac.tracking import TABLE_I, Budget, RecordedPath, Tracking, error_budget, evaluate
from ebac.tracking.table import mean

#: Joysticks drawn for each row of the error budget.
RUNS = 10
_FROM = (
    "The paths themselves are not published. Simulated: a handle led without error along the path, with "
    "assumed errors of encoder, installation and cable; the hand's own errors are not in it."
)


@cache
def _budget() -> Budget:
    return error_budget(runs=RUNS)


def _path(shape: str) -> Tracking:
    path = RecordedPath(
        points=_budget().examples[shape], name=f"simulated {shape}", remark="simulated"
    )
    return evaluate(path, shape=shape)


def _size(shape: str) -> Claim:
    """Judge whether the device's own errors come to the SD of Table I."""
    simulated = _budget().row(shape, "all")
    printed = [entry.sd_m for entry in TABLE_I if entry.shape == shape]
    return Claim(
        text=f"{shape}: the device's errors give the SD of Table I",
        holds=simulated.sd_low_m <= max(printed) and simulated.sd_high_m >= min(printed),
        evidence=f"simulated {formatting.quantity(simulated.sd_m, 'm')}, "
        f"Table I {formatting.quantity(min(printed), 'm')} to {formatting.quantity(max(printed), 'm')}",
    )


def _follows(shape: str, tracking: Tracking) -> Claim:
    size = float(np.ptp(tracking.path.points, axis=0).max())
    worst = tracking.fit.deviation.largest_m
    return Claim(
        text=f"the device shows a {shape} when led along one",
        holds=worst < 0.02 * size,
        evidence=f"at most {formatting.quantity(worst, 'm')} off over {formatting.quantity(size, 'm')}",
    )


def _figure(name: str, shape: str, title: str, claim: str) -> Finding:
    from ebac.plot import plot_tracking

    tracking = _path(shape)
    claims = (_follows(shape, tracking), _size(shape))
    simulated, table = _budget().row(shape, "all"), mean(shape)
    return Finding(
        name=name,
        title=title,
        claim=claim,
        rows=[
            row(
                "SD about the fit, median of the simulated joysticks",
                simulated.sd_m,
                "m",
                table.sd_m,
            ),
            row("path error, mean distance from the fit", simulated.error_m, "m", table.error_m),
            row("largest distance of the path shown", tracking.fit.deviation.largest_m, "m"),
        ],
        verdict=judge(*claims),
        why=f"{_FROM} The paper's values here are the means of Table I's three sets.",
        claims=claims,
        figure=plot_tracking(tracking),
    )


def fig8() -> Finding:
    """Check Fig. 8: the device led along a ruler."""
    return _figure(
        "fig8",
        "line",
        "Fig. 8: the device following a straight line",
        "Moved along a ruler, the points lie about a fitted straight line.",
    )


def fig9() -> Finding:
    """Check Fig. 9: the device led around a circle."""
    return _figure(
        "fig9",
        "circle",
        "Fig. 9: the device following a circle",
        "Moved around a rope of 80 mm, the points lie about a fitted circle.",
    )


def table1() -> Finding:
    """Check Table I: whether its numbers fit each other, and whether the device's errors give them."""
    from ebac.plot import plot_budget

    budget = _budget()
    ratios = [entry.ratio for entry in TABLE_I]
    own = Claim(
        text="SD and Error are of one set of distances",
        holds=all(0 < ratio <= 1 for ratio in ratios),
        evidence=f"Error / SD is {min(ratios):.2f} to {max(ratios):.2f}; a mean distance is never above "
        "the SD about the fit, errors of a normal distribution have 0.80",
    )
    claims = (own, _size("line"), _size("circle"))
    rows = []
    for shape in ("line", "circle"):
        found, table = budget.row(shape, "all"), mean(shape)
        rows += [
            row(f"{shape}: SD", found.sd_m, "m", table.sd_m),
            row(f"{shape}: Error, as mean distance", found.error_m, "m", table.error_m),
            row(
                f"{shape}: SD that the device leaves to hand and ruler",
                budget.unexplained_m(shape),
                "m",
            ),
            row(f"{shape}: cable slack that would give Table I's SD", budget.slack_m[shape], "m"),
        ]
    return Finding(
        name="table1",
        title="Table I: standard deviation and error of the trajectories",
        claim="Line: SD 0.92, 1.07, 0.98 mm, error 0.78, 0.89, 0.86 mm. Circle: SD 1.46, 1.25, 1.31 mm, "
        "error 0.93, 0.91, 0.97 mm.",
        rows=rows,
        verdict=judge(*claims),
        why=f"The table's numbers fit each other, with Error as the mean distance. {_FROM} The device's "
        "assumed errors give about a fifth of the SD: the rest is hand, ruler and rope, or far more "
        "cable slack than assumed.",
        claims=claims,
        figure=plot_budget(budget),
    )
