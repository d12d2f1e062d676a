"""Every scheme in free motion, on soft tissue and on something hard, over networks with delay, jitter and loss."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ebac._core import STILL_SWING, Hand, Link, MinimumJerk, SlaveModel
from ebac._util.arguments import named, require
from ebac._util.report import report
from ebac._util.sequences import each_once, several
from ebac.teleop.run import Run, simulate
from ebac.teleop.schemes import SCHEMES, Scheme, chosen_scheme

if TYPE_CHECKING:
    from ebac.scenario import Scenario

#: What the slave meets [N/m].
CONTACTS: Mapping[str, float] = {"free": 0.0, "soft": 500.0, "hard": 20e3}
#: Delays of the study, each way [s].
DELAYS = (0.0, 0.05, 0.2, 0.3)
#: The study's network besides the delay, and one without faults.
NETWORKS: Mapping[str, Mapping[str, float]] = {
    "rough": {"jitter": 0.01, "loss": 0.1, "reorder": 0.02},
    "clean": {},
}
#: Stiffness of the hands that are simulated [N/m], each with a seed of its own.
HANDS = (150.0, 300.0, 600.0)
#: A stick that stays within it [m] is bounded: the hand's target is at 45 mm.
BOUND = 0.1


@dataclass(frozen=True, kw_only=True)
class StudyRow:
    """A scheme in one contact over one network; the worst of all hands, if nothing else is said.

    Attributes
    ----------
    scheme, contact, network : str
        Names.
    stiffness_N_per_m, delay_s : float
        Of the contact; one way.
    runs, still, bounded, passive, two_port_passive : int
        Runs, and how many of them: swing about a line by less than 0.25 mm at the end; stay within 0.1 m; give out at
        most 1 mJ at the master's port; at both ports together, beyond the reserve of the scheme.
    shaking_m, swing_m : float
        Of the stick over the last 30 %, peak to peak, about a line and as it is; null where a run ended early.
    least_master_J, least_network_J : float
        Lowest energies.
    transparency : float
        Median of stiffness at the stick over stiffness at the slave; null without contact.
    drift_m, rest_N, most_N : float
        Master less slave at rest, force on the environment at rest, medians; largest force on the environment.
    """

    scheme: str
    contact: str
    network: str
    stiffness_N_per_m: float
    delay_s: float
    runs: int
    still: int
    bounded: int
    passive: int
    two_port_passive: int
    shaking_m: float
    swing_m: float
    least_master_J: float
    least_network_J: float
    transparency: float
    drift_m: float
    rest_N: float
    most_N: float


#: What a printed study shows of a row; `Study.table` has all.
SHOWN = (
    "scheme",
    "contact",
    "network",
    "delay_s",
    "runs",
    "still",
    "shaking_m",
    "least_network_J",
    "transparency",
)


@dataclass(frozen=True, kw_only=True, repr=False)
class Study:
    """What `study` found.

    Attributes
    ----------
    rows : tuple of StudyRow
        Each scheme in each contact over each network.
    schemes : tuple of Scheme
        With their parameters.
    """

    rows: tuple[StudyRow, ...]
    schemes: tuple[Scheme, ...]

    def __repr__(self) -> str:
        """Return a row for each scheme, contact and network."""
        rows = [{name: row[name] for name in SHOWN} for row in self.table()]
        return report(
            "Teleoperation, simulated: the worst of the hands, transparency their median", rows
        )

    def table(self) -> list[dict[str, Any]]:
        """Return the rows as dictionaries, units in the keys."""
        return [asdict(row) for row in self.rows]

    def parameters(self) -> dict[str, dict[str, Any]]:
        """Return law and coupling of each scheme."""
        return {one.name: {"law": one.law, **one.coupling.as_dict()} for one in self.schemes}


def shaking(run: Run) -> float:
    """Return the swing of the stick about a straight line over the tail [m]; inf where the run did not end."""
    if not run.whole:
        return float("inf")
    x, t = run.tail("true_x"), run.tail("t")
    return float(np.ptp(x - np.polyval(np.polyfit(t, x, 1), t)))


def study(
    schemes: Sequence[str | Scheme] = tuple(SCHEMES),
    *,
    contacts: Mapping[str, float] = CONTACTS,
    delays: Sequence[float] = DELAYS,
    networks: Sequence[str] = ("rough",),
    hands: Sequence[float] = HANDS,
    scenario: Scenario | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Study:
    """Simulate every scheme in every contact over every network.

    Parameters
    ----------
    schemes : sequence of str or Scheme
        Each by a name of its own; default: all.
    contacts : mapping of str to float
        Stiffness by name [N/m]; 0 is free motion.
    delays : sequence of float
        One way [s], 0 to 0.5.
    networks : sequence of str
        Of `NETWORKS`: "rough" has up to 10 ms of jitter, 10 % loss and 2 % reordering, "clean" none of it.
    hands : sequence of float
        Stiffness of the hands [N/m].
    scenario : Scenario, optional
        For the master's device and timing, as in `simulate`; default: the reference, whose sensor has no noise.
    progress : callable, optional
        Called with rows done and all.

    Raises
    ------
    KeyError, ValueError
        For a scheme or network that does not exist, a value out of its range, nothing to simulate; for two schemes of
        one name, a delay or a network that stands there twice.
    TypeError
        For contacts that are no mapping, others that are no sequence.
    """
    require(contacts, Mapping, "teleop.study", "contacts by name, as in {'soft': 500}")
    if not contacts:
        raise ValueError("contacts = {}: is empty; give one at least")
    hands, networks = several("hands", hands), each_once("networks", networks)
    for name in networks:
        named("network", name, NETWORKS)
    chosen = tuple(chosen_scheme(one) for one in several("schemes", schemes))
    names = [one.name for one in chosen]
    if twice := [name for name in names if names.count(name) > 1]:
        raise ValueError(
            f"two schemes are called {twice[0]!r}: give each a name of its own, as by "
            "dataclasses.replace(scheme, name='mine')"
        )
    cells = list(product(chosen, contacts.items(), networks, each_once("delays", delays, "s")))
    rows = []
    for one, (contact, stiffness), network, delay in cells:
        link = Link(delay=delay, **NETWORKS[network])
        runs = [
            simulated(one, stiffness, link, hand=k, seed=seed, scenario=scenario)
            for seed, k in enumerate(hands, 1)
        ]
        rows.append(_row(runs, contact, network, delay))
        if progress is not None:
            progress(len(rows), len(cells))
    return Study(rows=tuple(rows), schemes=chosen)


def simulated(
    one: Scheme,
    stiffness: float,
    link: Link,
    *,
    hand: float,
    seed: int,
    scenario: Scenario | None,
) -> Run:
    """Return one run of a study: a hand of that stiffness [N/m] moves to 45 mm; the slave meets `stiffness` [N/m]."""
    return simulate(
        one,
        there=link,
        slave=SlaveModel(contact_stiffness=stiffness),
        hand=Hand(stiffness=hand, path=[MinimumJerk(target=0.045, at=1.2, duration=0.8)]),
        seconds=12.0,
        seed=seed,
        scenario=scenario,
    )


def _row(runs: Sequence[Run], contact: str, network: str, delay: float) -> StudyRow:
    one, stiffness = runs[0].scheme, runs[0].slave.contact_stiffness
    shakes = [shaking(run) for run in runs]
    ratios = [run.transparency for run in runs if np.isfinite(run.transparency)]
    return StudyRow(
        scheme=one.name,
        contact=contact,
        network=network,
        stiffness_N_per_m=stiffness,
        delay_s=delay,
        runs=len(runs),
        still=sum(shake < STILL_SWING for shake in shakes),
        bounded=sum(bool(np.abs(run["true_x"]).max() < BOUND) for run in runs),
        passive=sum(run.passive for run in runs),
        two_port_passive=sum(run.two_port_passive for run in runs),
        shaking_m=max(shakes),
        swing_m=max(run.swing_m for run in runs),
        least_master_J=min(run.least_master_J for run in runs),
        least_network_J=min(run.least_network_J for run in runs),
        transparency=float(np.median(ratios)) if ratios else float("nan"),
        drift_m=float(np.median([run.drift_m for run in runs])),
        rest_N=float(np.median([run.rest_N for run in runs])),
        most_N=max(run.most_N for run in runs),
    )
