"""`stiffest`: the stiffest wall up to which each law holds for all hands of a population."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ebac._core import Wall
from ebac._util import remarks
from ebac._util.arguments import number, of_percent, require
from ebac._util.doubts.study import doubts
from ebac._util.progress import Progress
from ebac._util.sequences import several_numbers
from ebac._util.wrong_calls import plain_function
from ebac.laws import LAWS
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.simulation import warn_of
from ebac.studies.condition import wall_of
from ebac.studies.stiffest_result import Stiffest
from ebac.studies.study import study
from ebac.studies.sweeps.run import Laws

#: Stiffnesses of the walls that are tried, softest first [N/m].
LADDER = (1e3, 1.5e3, 2e3, 3e3, 5e3, 7e3, 10e3, 15e3, 20e3, 30e3, 50e3, 70e3, 100e3)
#: Stiffest wall there is [N/m].
MOST = 1e7


@plain_function
def stiffest(
    laws: Laws | None = None,
    *,
    population: Operators | None = None,
    stiffnesses: Sequence[float] = LADDER,
    share: float = 1.0,
    base: Scenario | None = None,
    seed: int | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    out: str | Path | None = None,
    resume: bool = True,
    progress: Progress | None = None,
) -> Stiffest:
    """Search for each law the stiffest wall up to which it holds for all hands of a population.

    "Up to which" means that all softer walls of the ladder hold as well: a law may lose a soft wall and hold a stiffer
    one, see `Stiffest.again`.

    Parameters
    ----------
    laws : law, sequence of laws, or mapping of names to laws
        As `sweep` takes them; default: every law of `LAWS`.
    population : Operators, optional
        The hands; default: the 60 of `Operators.grid()`.
    stiffnesses : sequence of float
        Walls to try [N/m], (0, 1e7].
    share : float
        Share of the hands for which a wall must hold, (0, 1].
    base : Scenario, optional
        Device, timing, damping of the wall and all else; default: the reference scenario.
    seed, threads, executor, out, resume, progress
        As in `study`.

    Returns
    -------
    Stiffest

    Warns
    -----
    DoubtWarning
        For what is doubtful of the device and the length of `base`, and from which wall on its motor is too weak.

    Raises
    ------
    SweepInterrupted
        On a keyboard interrupt, as `sweep`.
    TypeError
        For a base whose environment is not a wall.
    ValueError
        For a number out of its range, or a base at whose wall no hand has an ideal rest, as where the wall moves.
    """
    from ebac.metrics.unjudged import no_ideal_rest

    scenario = Scenario() if base is None else base
    require(scenario, Scenario, "ebac.stiffest", "a Scenario as its base")
    require(
        scenario.environment, Wall, "ebac.stiffest", "a base with a Wall, whose stiffness it sets"
    )
    hands = Operators.grid() if population is None else population
    require(hands, Operators, "ebac.stiffest", "a population, an Operators")
    ladder = _ladder(stiffnesses)
    require_share("share", share)
    walls = [wall_of(stiffness) for stiffness in ladder.tolist()]
    if why := no_ideal_rest(walls[0].scenarios(hands[:1], scenario)[0]):
        raise ValueError(f"stiffest: no hand can be judged: {why}; give another base")
    if base is not None and remarks.wanted():
        warn_of(doubts(hands, scenario, ladder.tolist()))
    found = study(
        hands, list(LAWS.values()) if laws is None else laws, walls, base=scenario, seed=seed,
        threads=threads, executor=executor, out=out, resume=resume, progress=progress,
    )  # fmt: skip
    columns = found.columns
    met = {
        "exact_and_still": columns["exact_and_still"],
        "good": columns["good"],
        "good_in_time": columns["good"] & columns["settled_in_time"],
    }
    if np.isnan(columns["ideal_settled_s"]).any():
        del met["good_in_time"]
    shape = (len(found.laws), len(ladder), len(hands))
    counts = {name: flags.reshape(shape).sum(axis=2) for name, flags in met.items()}
    return Stiffest(study=found, base=scenario, stiffnesses=ladder, share=share, counts=counts)


def require_share(name: str, share: float) -> None:
    """Raise ValueError unless a share of the hands can be asked for; `name` is what the caller calls it."""
    if not 0 < number(name, share) <= 1:
        remedy = of_percent(share) or "; 1 asks that every hand is held"
        raise ValueError(f"{name} = {share:g}: must lie in (0, 1]{remedy}")


def _ladder(stiffnesses: Sequence[float]) -> NDArray[np.float64]:
    """Return the stiffnesses, each once, softest first [N/m]."""
    ladder = np.unique(several_numbers("stiffnesses", stiffnesses))
    for stiffness in ladder:
        if not 0 < stiffness <= MOST:
            raise ValueError(f"stiffnesses: {stiffness:g} N/m: must lie in (0, {MOST:g}] N/m")
    return ladder
