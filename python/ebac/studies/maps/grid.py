"""`stability_map`: a law over a grid of scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

import numpy as np

from ebac._util.arguments import require, unknown
from ebac._util.arrays import Values
from ebac._util.progress import Progress
from ebac._util.sequences import several_numbers
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw
from ebac.scenario import Scenario
from ebac.studies.maps.axes import AXES, MapAxis
from ebac.studies.maps.result import StabilityMap
from ebac.studies.sweeps import sweep
from ebac.studies.sweeps.run import name_laws

#: Values along an axis where none are given.
SIDE = 200


@plain_function
def stability_map(
    law: AnyLaw = "ebac",
    x: str = "damping",
    y: str = "stiffness",
    *,
    xs: Sequence[float] | Values | None = None,
    ys: Sequence[float] | Values | None = None,
    base: Scenario | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    out: str | Path | None = None,
    resume: bool = True,
    progress: Progress | None = None,
) -> StabilityMap:
    """Run a law over a grid of two quantities and measure each run.

    Parameters
    ----------
    law : str, law class, law or PythonLaw
        As `simulate` takes it; a name or class is designed anew where device or timing change.
    x, y : str
        Names of `AXES`.
    xs, ys : array-like, optional
        Values, at least two, rising, in the unit of the axis; default: 200 over its range.
    base : Scenario, optional
        The rest; default: the reference scenario, 2 s.
    threads, executor, out, resume, progress
        As in `sweep`.

    Returns
    -------
    StabilityMap

    Raises
    ------
    ValueError
        For a quantity that does not exist, or values that do not rise or are out of range.
    TypeError
        For a delay that is no whole number.
    """
    scenario = Scenario(seconds=2.0) if base is None else base
    require(scenario, Scenario, "ebac.stability_map", "a Scenario as its base")
    names = list(name_laws(law, "a map"))
    if len(names) != 1:
        raise ValueError(
            f"stability_map: law = {', '.join(names)}: a map is of one law; make one of each"
        )
    along = [_axis(x), _axis(y)]
    if x == y:
        raise ValueError(f"x = y = {x!r}: a map needs two quantities")
    values = [
        axis.values(SIDE) if given is None else _rising(which, axis, given)
        for which, axis, given in zip(("xs", "ys"), along, (xs, ys), strict=True)
    ]
    scenarios = _grid(scenario, along, values)
    result = sweep(
        scenarios, law, threads=threads, executor=executor, out=out, resume=resume, progress=progress
    )  # fmt: skip
    return StabilityMap(
        base=scenario, law=names[0], x=x, y=y, xs=values[0], ys=values[1], result=result
    )


def _axis(name: str) -> MapAxis:
    if str(name) not in AXES:
        raise ValueError(unknown(f"map axis {name}", name, list(AXES)))
    return AXES[name]


def _rising(which: str, axis: MapAxis, given: Sequence[float] | Values) -> Values:
    """Return values along an axis; a figure has no place for others than rising ones."""
    values = np.array(several_numbers(f"stability_map: {which}", given))
    if len(values) < 2 or not (np.diff(values) > 0).all():
        raise ValueError(
            f"stability_map: {which} = {given} {axis.unit}: must be at least two, rising"
        )
    if axis.logarithmic and values[0] <= 0:
        raise ValueError(f"stability_map: {which} = {given} {axis.unit}: must be above 0")
    return values


def _grid(base: Scenario, along: list[MapAxis], values: list[Values]) -> list[Scenario]:
    """Return the scenarios row by row; what stays the same is one object, so that laws are designed once."""
    columns = [along[0].apply(base, value) for value in values[0].tolist()]
    return [along[1].apply(column, value) for value in values[1].tolist() for column in columns]
