"""A gastroscopy: a physician steers from the teeth to the pylorus and touches targets on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._core import Device, Free, Hand, Master, Patient, Physician, Polyp, Scope, Step
from ebac._util.arguments import number, require, require_parts, require_path, whole
from ebac._util.background import cancellable
from ebac._util.plural import plural
from ebac._util.sequences import require_each
from ebac._util.wrong_calls import plain_constructor
from ebac.gastroscope.lumen import Lumen
from ebac.laws import AnyLaw, CoreLaw, design, law_name
from ebac.laws.making import compiled
from ebac.laws.tuned_laws import on_its_observer
from ebac.presets import DEVICES
from ebac.scenario import Scenario

if TYPE_CHECKING:
    from ebac.trace import Trace

#: Columns that hold the largest force since the row before.
FORCES = ("tip_force", "section_force", "tube_force")


def default_targets(patient: Patient) -> tuple[Polyp, ...]:
    """Return three targets: in the oesophagus, in the body of the stomach and in the antrum."""
    oesophagus = patient.mouth + patient.pharynx
    stomach = oesophagus + patient.oesophagus + patient.cardia
    return (
        Polyp(place=oesophagus + 0.68 * patient.oesophagus, angle=0.5),
        Polyp(place=stomach + 0.375 * patient.stomach, angle=2.0),
        Polyp(place=stomach + 0.75 * patient.stomach, angle=-1.0),
    )


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Procedure:
    """Everything of a gastroscopy but the law.

    Parameters
    ----------
    scope : Scope
        The gastroscope and its motors.
    lumen : Lumen
        The patient.
    master : Master
        Mapping of the joystick, feedback and delay.
    physician : Physician
        Who steers.
    hand : Hand
        The hand on the joystick; its paths are the physician's.
    device : Device, optional
        The joystick; default: `joystick-3` of the presets, and `joystick`, of two axes, with pedals.
    targets : sequence of Polyp, optional
        On the wall; default: three.
    start : float
        Place of the camera at the start [m], [0.08, 0.5], where it lies at rest, with straight tendons.
    seconds : float
        After which a run ends [s], (0, 3600].
    seed : int
        Of the physician's and the force sensor's noise, [0, 2^63).

    Raises
    ------
    ValueError
        For a start, a length or a seed out of its range, or a device with too few axes.
    TypeError
        When a part is of a wrong type.
    """

    scope: Scope = field(default_factory=Scope)
    lumen: Lumen = field(default_factory=Lumen)
    master: Master = field(default_factory=Master)
    physician: Physician = field(default_factory=Physician)
    hand: Hand = field(default_factory=Hand)
    device: Device | None = None
    targets: Sequence[Polyp] | None = None
    start: float = 0.09
    seconds: float = 120.0
    seed: int = 1

    def __post_init__(self) -> None:
        """Check types and ranges."""
        self._check_types()
        if not 0 <= whole("Procedure.seed", self.seed) < 2**63:
            raise ValueError(f"Procedure.seed = {self.seed}: must lie in [0, 2^63)")
        if not 0.08 <= number("Procedure.start", self.start) <= 0.5:
            raise ValueError(f"Procedure.start = {self.start} m: must lie in [0.08, 0.5] m")
        if not 0 < number("Procedure.seconds", self.seconds) <= 3600:
            raise ValueError(f"Procedure.seconds = {self.seconds} s: must lie in (0, 3600] s")
        needed = 2 if self.master.insertion == 0 else 3
        if self.device is not None and self.device.axes < needed:
            raise ValueError(
                f"Procedure.device: has {plural(self.device.axes, 'axis', 'axes')}, the mapping needs {needed}; "
                "give another device, or Master(insertion=0) with pedals"
            )

    def _check_types(self) -> None:
        parts: dict[str, tuple[Any, type]] = {
            "scope": (self.scope, Scope),
            "lumen": (self.lumen, Lumen),
            "master": (self.master, Master),
            "physician": (self.physician, Physician),
            "hand": (self.hand, Hand),
        }
        if self.device is not None:
            parts["device"] = (self.device, Device)
        require_parts("Procedure.", parts)
        if self.targets is not None:
            require_each(self.targets, Polyp, "Procedure.targets", "a sequence of Polyp")

    def scenario(self) -> Scenario:
        """Return joystick and hand: two axes with pedals, three without."""
        pedals = self.master.insertion == 0
        device = self.device or DEVICES["joystick" if pedals else "joystick-3"].device
        rest = [Step(target=0)] * device.axes
        return Scenario(
            device=device,
            hand=self.hand.replace(path=rest),
            environment=Free(),
            seconds=self.seconds,
            seed=self.seed,
        )

    def polyps(self) -> tuple[Polyp, ...]:
        """Return the targets, the default ones where none are given."""
        given = default_targets(self.lumen.patient) if self.targets is None else self.targets
        return tuple(sorted(given, key=lambda one: one.place))

    def core(self) -> _core._Procedure:
        """Return what the core runs."""
        return _core._Procedure(
            scope=self.scope,
            lumen=self.lumen.core,
            master=self.master,
            physician=self.physician,
            targets=self.polyps(),
            start=self.start,
        )


@dataclass(frozen=True, kw_only=True)
class Gastroscopy:
    """A run of a procedure.

    Attributes
    ----------
    procedure : Procedure
        What was run.
    law : str
        The joystick's law.
    findings : dict of str to float
        Time, way, forces, energies: SI units, as `units` says.
    rows : dict of str to ndarray
        The record, shape (rows,) each: `t` [s], camera, forces, handle.
    """

    procedure: Procedure
    law: str
    findings: dict[str, float]
    rows: dict[str, NDArray[np.float64]]

    @property
    def units(self) -> dict[str, str]:
        """Units of the findings, by name; a pure number has none."""
        return dict(_core._Navigation.units())

    @property
    def trace(self) -> Trace:
        """The record as a trace, with `tick`, the number of the row, and `fault`: what `ebac log` reads."""
        from ebac.gastroscope.log import trace_of

        return trace_of(self)

    def thinned(self, every: int) -> Gastroscopy:
        """Return the run with only every n-th row of its record, and the last; forces are the largest in between.

        Parameters
        ----------
        every : int
            1 or more.

        Raises
        ------
        ValueError
            For less.
        """
        if whole("every", every) < 1:
            raise ValueError(f"every = {every}: must be 1 or more")
        count = len(self.rows["t"])
        kept = np.unique(np.append(np.arange(0, count, every), count - 1))
        begins = np.append(0, kept[:-1] + 1)
        rows = {
            name: np.maximum.reduceat(column, begins) if name in FORCES else column[kept]
            for name, column in self.rows.items()
        }
        return replace(self, rows=rows)

    def save(self, path: str | Path) -> None:
        """Write the record, the format by the extension.

        A log, .mcap, also has the touches, the times above the limit, and all parameters; `ebac log` reads it.

        Parameters
        ----------
        path : path
            .mcap, .csv (units in the headings), .npz, .parquet, .mat or .h5; the file is replaced.

        Raises
        ------
        ValueError
            For another extension.
        ModuleNotFoundError
            When the library a format needs is not installed.
        OSError
            When the file cannot be written.
        """
        from ebac.gastroscope.log import write_log

        require_path(path, "Gastroscopy.save")
        path = Path(path)
        if path.suffix.lower() == ".mcap":
            write_log(self, path)
        else:
            self.trace.save(path)


def core_law(law: AnyLaw, scenario: Scenario) -> CoreLaw:
    """Return the law for a scenario's device.

    Raises
    ------
    TypeError
        For a law that is written in Python.
    """
    return compiled(design(law, scenario.device, scenario.timing))


def gastroscopy(
    law: AnyLaw = "ebac", procedure: Procedure | None = None, *, every: int = 10, **changes: Any
) -> Gastroscopy:
    """Run a gastroscopy; the same procedure gives the same bits.

    Parameters
    ----------
    law : law
        Of the joystick, as `simulate` takes it; not one written in Python.
    procedure : Procedure, optional
        Default: `Procedure()`.
    every : int
        Ticks from one row of the record to the next, [1, 10000].
    **changes
        Parameters of the law on top of its design.

    Raises
    ------
    ValueError
        For a number out of its range.
    TypeError
        For a law written in Python.
    """
    require(procedure, (Procedure, NoneType), "ebac.gastroscope.gastroscopy", "a Procedure")
    if not 1 <= whole("every", every) <= 10000:
        raise ValueError(f"every = {every}: must lie in [1, 10000]")
    given = Procedure() if procedure is None else procedure
    scenario = on_its_observer(given.scenario(), law)
    made: Any = core_law(law, scenario)
    made = made.replace(**changes) if changes else made
    findings, rows = cancellable(
        lambda state: _core._run_procedure(given.core(), scenario.setup(), made, every, state)
    )
    return Gastroscopy(
        procedure=given,
        law=law if isinstance(law, str) else law_name(made),
        findings={str(k): float(v) for k, v in findings.items()},
        rows={str(k): np.asarray(v) for k, v in rows.items()},
    )
