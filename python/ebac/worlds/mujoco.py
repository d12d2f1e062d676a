"""MuJoCo as an engine: a tip in an MJCF model pokes whatever lies there, rigid bodies and soft ones (flex).

Needs `pip install 'ebac[mujoco]'`; nothing is imported before an engine is made.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ebac._util.arrays import Values
from ebac.worlds.answers import LocalModel
from ebac.worlds.grid import needed

#: By how much the tip is pressed further to see how stiff a contact is [m].
PROBE = 2e-4
#: Share of a new stiffness in its estimate: one probe of a soft body is noisy.
TRUST = 0.3


class MujocoEngine:
    """An engine for `Bridge` or `EngineThread`: a mocap body follows the handle through a MuJoCo model.

    Each call moves the tip to the handle, simulates `period` and answers with a plane: across the force on the tip
    while there is one, before that at the nearest rigid surface within `reach`; a soft one is not seen before it is
    touched. How stiff it is, is found by pressing a copy of the simulation further by 0.2 mm. Friction acts as a
    tilt of the plane.

    Parameters
    ----------
    model : mujoco.MjModel, path or str
        A model, its MJCF file, or MJCF text.
    tip : str
        Name of a mocap body with one geom, which touches the others.
    period : float
        Time simulated in a call [s]: 1 / rate of the engine.
    stiffness : float
        Of a surface that was not touched yet [N/m], (0, 1e7].
    most_stiffness : float
        Estimates end there [N/m].
    reach : float
        From where on a rigid surface is seen [m].

    Attributes
    ----------
    model, data
        Of MuJoCo; `data` is the state after the last call.

    Raises
    ------
    ImportError
        Without MuJoCo.
    ValueError
        For a model without such a tip, or that MuJoCo does not read.
    """

    def __init__(
        self,
        model: Any,
        *,
        tip: str = "tip",
        period: float = 1 / 60,
        stiffness: float = 300.0,
        most_stiffness: float = 5000.0,
        reach: float = 0.02,
    ) -> None:
        self._mj = needed("mujoco", "MuJoCo", what="these engines", extra="mujoco")
        self.model = model if isinstance(model, self._mj.MjModel) else self._read(model)
        self.data = self._mj.MjData(self.model)
        self._probe = self._mj.MjData(self.model)
        self._given = (tip, period, stiffness, most_stiffness, reach)
        body = self._mj.mj_name2id(self.model, self._mj.mjtObj.mjOBJ_BODY, tip)
        self._mocap = -1 if body < 0 else int(self.model.body_mocapid[body])
        if self._mocap < 0 or self.model.body_geomnum[body] != 1:
            raise ValueError(f"MujocoEngine.tip = {tip!r}: must be a mocap body with one geom")
        self._geom = int(self.model.body_geomadr[body])
        if not 0 < stiffness <= most_stiffness:
            raise ValueError(
                f"MujocoEngine.stiffness = {stiffness} N/m: must lie in (0, {most_stiffness:g}] N/m"
            )
        self._stiffness, self._most = stiffness, most_stiffness
        self._steps = max(1, round(period / self.model.opt.timestep))
        self._reach = reach
        touched = (self.model.geom_contype > 0) | (self.model.geom_conaffinity > 0)
        self._others = [int(i) for i in np.flatnonzero(touched) if i != self._geom]

    def _read(self, model: Any) -> Any:
        text = str(model)
        if text.lstrip().startswith("<"):
            return self._mj.MjModel.from_xml_string(text)
        if not Path(text).exists():
            raise FileNotFoundError(f"{text}: no such file")
        return self._mj.MjModel.from_xml_path(text)

    def __call__(self, x: Values, v: Values) -> LocalModel | None:
        """Return the plane near the tip."""
        start = self.data.mocap_pos[self._mocap].copy()
        self._mj.mj_copyData(self._probe, self.model, self.data)
        force = self._advance(self.data, start, x)
        if not np.isfinite(force).all():
            raise RuntimeError("the MuJoCo model became unstable: give it a smaller timestep")
        size = float(np.linalg.norm(force))
        if size > 0:
            deeper = self._advance(self._probe, start, x + PROBE * force / size)
            slope = (float(deeper @ force) / size - size) / PROBE
            wanted = float(np.clip(slope, 1.0, self._most))
            self._stiffness += TRUST * (wanted - self._stiffness)
            return LocalModel.of_force(x, force, self._stiffness)
        return self._ahead(x)

    def _advance(self, data: Any, start: Values, x: Values) -> Values:
        """Move the tip in even steps; return the force with which it presses [N]."""
        for i in range(1, self._steps + 1):
            data.mocap_pos[self._mocap] = start + (x - start) * i / self._steps
            self._mj.mj_step(self.model, data)
        force, one = np.zeros(3), np.zeros(6)
        for i in range(data.ncon):
            contact = data.contact[i]
            if self._geom in contact.geom:
                self._mj.mj_contactForce(self.model, data, i, one)
                force += self._towards(contact) * (contact.frame.reshape(3, 3).T @ one[:3])
        return force

    def _towards(self, contact: Any) -> float:
        """Return 1 where the frame points away from the tip, -1 where it points towards it."""
        return 1.0 if int(contact.geom[0]) == self._geom else -1.0

    def _ahead(self, x: Values) -> LocalModel | None:
        """Return the plane of the nearest rigid surface."""
        nearest, ends, line = self._reach, np.zeros(6), np.zeros(6)
        for other in self._others:
            distance = self._mj.mj_geomDistance(
                self.model, self.data, self._geom, other, nearest, line
            )
            if 0 < distance < nearest:
                nearest, ends = distance, line.copy()
        if nearest == self._reach:
            return None
        normal = (ends[3:] - ends[:3]) / nearest
        a, b, c = x + nearest * normal
        return LocalModel(at=(a, b, c), normal=tuple(normal), stiffness=self._stiffness)

    def __deepcopy__(self, memo: dict[int, Any]) -> MujocoEngine:
        """Return a fresh one: each run has its own."""
        tip, period, stiffness, most, reach = self._given
        return MujocoEngine(
            self.model,
            tip=tip,
            period=period,
            stiffness=stiffness,
            most_stiffness=most,
            reach=reach,
        )
