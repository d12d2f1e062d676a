"""One run of a master and a slave through a simulated network."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ebac import _core
from ebac._core import STILL_SWING, TAIL_SHARE, Free, Hand, Link, MinimumJerk, SlaveModel
from ebac._util.arguments import named, number, require, require_parts, whole
from ebac.laws import AnyLaw, design, law_name
from ebac.laws.making import compiled
from ebac.laws.tuned_laws import on_its_observer
from ebac.metrics.with_hand import on_its_way
from ebac.scenario import Scenario
from ebac.teleop import run_text
from ebac.teleop.schemes import Scheme, chosen_scheme

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: A stick that swings farther does not rest [m].
NO_REST = 5e-3
#: Energy that a passive port may have given out for errors of the measurement, as in `ebac zwidth` [J].
SPARE = 1e-3


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Run:
    """A run of both sides.

    Attributes
    ----------
    scheme : Scheme
        What ran.
    law : str
        Of the master, by name.
    columns : dict of str to ndarray
        Each of shape (ticks,); names, units and meanings by `Run.fields`.
    slave : SlaveModel
        With the environment it met.
    there, back : Link
        The network to the slave and back.
    scenario : Scenario
        Of the master: device, hand, timing.
    at_master, at_slave : dict of str to int
        Packets received, missing, late, doubled, foreign.
    whole : bool
        False where the stick left 1 m, or the master stopped on a fault.
    """

    scheme: Scheme
    law: str
    columns: dict[str, npt.NDArray[np.float64]]
    slave: SlaveModel
    there: Link
    back: Link
    scenario: Scenario
    at_master: dict[str, int]
    at_slave: dict[str, int]
    whole: bool

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        """Return a column; shape (ticks,)."""
        return named("column", name, self.columns)

    @staticmethod
    def fields() -> dict[str, tuple[str, str]]:
        """Return unit and meaning of every column."""
        return dict(_core._teleop_fields())

    def tail(self, name: str) -> npt.NDArray[np.float64]:
        """Return a column over the last 30 % of the run."""
        values = self[name]
        return values[int((1 - TAIL_SHARE) * len(values)) :]

    @property
    def swing_m(self) -> float:
        """Movement of the stick over the tail, peak to peak [m]; inf where the run did not end."""
        return float(np.ptp(self.tail("true_x"))) if self.whole else np.inf

    @property
    def still(self) -> bool:
        """The stick swings by less than 0.25 mm."""
        return self.swing_m < STILL_SWING

    @property
    def still_moving(self) -> bool:
        """The run ended before its stick: it goes one way over the tail, or swings by less in the tail's second half.

        Less is under 60 % of the whole tail. A longer run shows whether it comes to rest.
        """
        return self.whole and not self.still and on_its_way(self.tail("true_x"))

    @property
    def least_master_J(self) -> float:  # noqa: N802
        """Lowest energy of the master's port, its own damping counted [J]."""
        return float(self["energy"].min())

    @property
    def least_network_J(self) -> float:  # noqa: N802
        """Lowest energy that both ports together had put into the network [J]."""
        return float(self["network"].min())

    @property
    def passive(self) -> bool:
        """The master's port gave out at most 1 mJ."""
        return self.least_master_J >= -SPARE

    @property
    def two_port_passive(self) -> bool:
        """Both ports together gave out at most 1 mJ beyond the reserves of the scheme."""
        coupling = self.scheme.coupling
        return self.least_network_J >= -SPARE - (2 * coupling.reserve if coupling.scheme else 0)

    @property
    def transparency(self) -> float:
        """Stiffness at the stick over that at the slave, at rest; nan without contact, and for swings of over 5 mm.

        At the stick: mean force over its depth beyond the contact. At the slave: mean force of the environment over the
        slave's depth. 1 is ideal.
        """
        contact = self.slave.contact
        stick_depth = float(self.tail("true_x").mean()) - contact
        met_depth = float(self.tail("slave_x").mean()) - contact
        met = float(self.tail("met").mean())
        if not self.swing_m < NO_REST or min(stick_depth, met_depth, met) <= 1e-6:
            return float("nan")
        return float(self.tail("force").mean()) / stick_depth / (met / met_depth)

    @property
    def drift_m(self) -> float:
        """Mean distance of slave and master at rest [m]."""
        return float((self.tail("true_x") - self.tail("slave_x")).mean())

    @property
    def rest_N(self) -> float:  # noqa: N802
        """Mean force on the environment at rest [N]."""
        return float(self.tail("met").mean())

    @property
    def most_N(self) -> float:  # noqa: N802
        """Largest force on the environment [N]."""
        return float(self["met"].max())

    def plot(self) -> Figure:
        """Draw positions, forces and energies of both ports over time; `ebac.plot.plot_teleop_runs` draws several."""
        from ebac.plot import plot_teleop_runs

        return plot_teleop_runs([self])

    def __repr__(self) -> str:
        """Return the verdict and the main numbers in one line."""
        return run_text.one_line(self)

    def __str__(self) -> str:
        """Return the verdict, the conditions and every number with its unit, one a line."""
        return run_text.listed(self)

    def _repr_html_(self) -> str:
        """Return a figure and the numbers, for a notebook."""
        from ebac._util import notebook

        title = f"Teleoperation under {self.scheme.name}, simulated: {run_text.verdict(self)}"
        rows = [{name: getattr(self, name) for _, name, _, _ in run_text.LINES}]
        return notebook.result(title, rows, self.plot)


def simulate(
    scheme: str | Scheme = "ebac",
    *,
    law: AnyLaw | None = None,
    there: Link | None = None,
    back: Link | None = None,
    slave: SlaveModel | None = None,
    hand: Hand | None = None,
    seconds: float = 10.0,
    seed: int = 1,
    consent_after: float = 0.5,
    scenario: Scenario | None = None,
    **changes: Any,
) -> Run:
    """Simulate a master, a network and a slave.

    The master is the device of the scenario with its hand and law at 1 kHz; it feels the force of the slave's
    position controller. Each session begins where both sides are.

    Parameters
    ----------
    scheme : str or Scheme
        A name of `SCHEMES`, or one of your own.
    law : law, optional
        Of the master, in place of the scheme's.
    there, back : Link, optional
        To the slave, default 50 ms; to the master, default as there.
    slave : SlaveModel, optional
        With its environment; default 500 N/m at 20 mm.
    hand : Hand, optional
        Default: 300 N/m, from 1.2 s on in 0.8 s to 45 mm.
    seconds : float
        Length of the run [s], 0.1 to 600.
    seed : int
        Of device and network; the same gives the same bits.
    consent_after : float
        After a lost link came back, the simulated hand consents in this time [s]; inf for never.
    scenario : Scenario, optional
        For a device, a timing or an observer of your own; its world and its hand are not used.
    **changes
        Parameters of the coupling, as `impedance=30`.

    Raises
    ------
    KeyError, TypeError, ValueError
        For a scheme, a law or a parameter that does not exist, is of a wrong type or out of its range.
    """
    require(scheme, (str, Scheme), "teleop.simulate", "the name of a scheme or a Scheme")
    _check_parts(there=there, back=back, slave=slave, hand=hand, scenario=scenario)
    seconds = number("teleop.simulate: seconds", seconds)
    consent_after = number("teleop.simulate: consent_after", consent_after)
    seed = whole("teleop.simulate: seed", seed)
    chosen = chosen_scheme(scheme)
    if changes:
        chosen = chosen.changed(**changes)
    if not 0.1 <= seconds <= 600:
        raise ValueError(f"seconds = {seconds:g} s: must lie in [0.1, 600] s")
    if not consent_after >= 0:
        raise ValueError(f"consent_after = {consent_after:g} s: must be at least 0 s")
    given = Scenario() if scenario is None else scenario
    if given.device.axes != 1:
        raise ValueError(
            f"device: has {given.device.axes} axes; teleoperation is for one axis so far"
        )
    acting = chosen.law if law is None else law
    path = hand or Hand(path=[MinimumJerk(target=0.045, at=1.2, duration=0.8)])
    full = given.replace(environment=Free(), hand=path, seconds=seconds, seed=seed)
    setup = on_its_observer(full, acting).setup()
    made = compiled(design(acting, given.device, given.known_timing))
    to_slave = there or Link()
    to_master = back or to_slave
    model = slave or SlaveModel()
    columns = _core._simulate_teleop(
        made,
        setup,
        coupling=chosen.coupling,
        slave=model,
        there=to_slave,
        back=to_master,
        consent_after=consent_after,
    )
    at_master, at_slave = columns.pop("at_master"), columns.pop("at_slave")
    return Run(
        scheme=chosen,
        law=law_name(acting),
        columns=columns,
        slave=model,
        there=to_slave,
        back=to_master,
        scenario=full,
        at_master=at_master,
        at_slave=at_slave,
        whole=columns.pop("whole"),
    )


#: What the parts of a run must be.
_PARTS: Mapping[str, type] = {
    "there": Link,
    "back": Link,
    "slave": SlaveModel,
    "hand": Hand,
    "scenario": Scenario,
}


def _check_parts(**given: Any) -> None:
    """Refuse a part of a wrong type; None stands for the default."""
    for name, value in given.items():
        if value is not None:
            require_parts("teleop.simulate: ", {name: (value, _PARTS[name])})
