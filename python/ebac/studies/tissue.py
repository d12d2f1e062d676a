"""Soft materials against their closed forms, and laws whose hand presses them and lets go."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from types import NoneType
from typing import Any

import numpy as np

from ebac._core import Elastic, Hand, HuntCrossley, Plane, Recorded
from ebac._util.arguments import require
from ebac._util.sequences import several
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw, law_name
from ebac.metrics import contact
from ebac.scenario import Scenario
from ebac.simulation import simulate
from ebac.studies.measures import SPARE
from ebac.trace import Trace
from ebac.worlds import Body, Placed, World, preset
from ebac.worlds.force_depth import ForceDepth, Material, force_depth

#: Laws that are compared unless others are given.
LAWS = ("direct", "tca-damped", "force-bounding", "ebac")
#: Where the surface is [m]; the hand's target in and out again [s], [m].
SURFACE = 5e-3
TARGET = ((0.0, 1.0, 1.5, 2.5), (0.0, 0.03, 0.03, 0.0))
SECONDS = 3.0


@dataclass(frozen=True, kw_only=True)
class TissueRow:
    """One material under one law: a hand of 300 N/m presses it and lets go.

    Attributes
    ----------
    material, law : str
        Names.
    deepest_m : float
        Of the true handle below the surface.
    least_energy_J : float
        Of the physical port, the device's damping counted.
    passive : bool
        The port gave out at most 1 mJ.
    kept_J : float
        Energy that the motor's force took from the handle; with `direct` it can fall below zero by less than the
        device's damping takes.
    own_loss_J : float
        What the material itself takes along the same motion.
    force_error_N : float
        Between the motor's force and the material's own along the same motion, rms while it is touched.
    """

    material: str
    law: str
    deepest_m: float
    least_energy_J: float
    passive: bool
    kept_J: float
    own_loss_J: float
    force_error_N: float


@dataclass(frozen=True, kw_only=True)
class Tissue:
    """What `tissue` found.

    Attributes
    ----------
    curves : dict of str to ForceDepth
        Force over depth of each material, beside its closed form.
    rows : tuple of TissueRow
        Each law with each material.
    traces : tuple of Trace
        The run of each row.
    """

    curves: dict[str, ForceDepth]
    rows: tuple[TissueRow, ...]
    traces: tuple[Trace, ...]

    def table(self) -> list[dict[str, Any]]:
        """Return the curves' numbers as dictionaries, units in the keys."""
        return [{"material": name, **curve.row()} for name, curve in self.curves.items()]

    def law_table(self) -> list[dict[str, Any]]:
        """Return the laws' rows as dictionaries, units in the keys."""
        return [asdict(row) for row in self.rows]


def materials() -> dict[str, Material]:
    """Return the materials that are compared unless others are given, by name."""
    layered = preset("tissue").bodies[0].material
    return {
        "elastic": Elastic(stiffness=1000),
        "Kelvin-Voigt": Elastic(stiffness=1000, damping=10),
        "Hunt-Crossley": HuntCrossley(),
        "layered": layered,
    }


@plain_function
def tissue(
    laws: Sequence[AnyLaw] = LAWS,
    *,
    chosen: Mapping[str, Material] | None = None,
    depth: float = 12e-3,
    speed: float = 0.02,
    progress: Callable[[int, int], None] | None = None,
) -> Tissue:
    """Compare soft materials with their closed forms, and simulate each law with a hand that presses them.

    Parameters
    ----------
    laws : sequence of laws
        As `simulate` takes them; none for the curves alone.
    chosen : mapping of str to material, optional
        Default: `materials()`: elastic, Kelvin-Voigt, Hunt-Crossley, and the layers of the world `tissue`.
    depth, speed : float
        Of the curves [m], [m/s]; ranges as in `worlds.force_depth`.
    progress : callable, optional
        Called with runs done and all.

    Raises
    ------
    ValueError
        For a depth or a speed out of its range.
    """
    require(chosen, (Mapping, NoneType), "ebac.tissue", "materials by name")
    known = dict(materials() if chosen is None else chosen)
    curves = {name: force_depth(one, depth=depth, speed=speed) for name, one in known.items()}
    rendered = several("tissue: laws", laws, least=0)
    rows, traces = [], []
    for name, material in known.items():
        for law in rendered:
            row, trace = _pressed(name, material, law)
            rows.append(row)
            traces.append(trace)
            if progress is not None:
                progress(len(rows), len(known) * len(rendered))
    return Tissue(curves=curves, rows=tuple(rows), traces=tuple(traces))


def _pressed(name: str, material: Material, law: AnyLaw) -> tuple[TissueRow, Trace]:
    world = World(Body(solid=Placed(Plane(), (SURFACE, 0.0, 0.0)), material=material))
    hand = Hand(path=[Recorded(t=TARGET[0], x=TARGET[1])])
    trace = simulate(Scenario(environment=world, hand=hand, seconds=SECONDS), law)
    x, v, f = trace["true.x"], trace["true.v"], trace["true.f_motor"]
    flat = np.zeros_like(x)
    touches = world.walk(np.column_stack([x, flat, flat]), np.column_stack([v, flat, flat]))
    own = np.array([touch.force[0] for touch in touches])
    touched = x > SURFACE
    least = float(contact(trace).least_energy_J or 0.0)
    return TissueRow(
        material=name,
        law=law_name(law),
        deepest_m=float(x.max() - SURFACE),
        least_energy_J=least,
        passive=least >= -SPARE,
        kept_J=float(np.trapezoid(f * v, trace["t"])),
        own_loss_J=float(np.trapezoid(own, x)),
        force_error_N=float(np.sqrt(np.mean((f - own)[touched] ** 2))) if touched.any() else 0.0,
    ), trace
