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
#: The tip stays so far from what is fixed [m]: at a distance of 0 there is no direction.
SKIN = 1e-4
#: Moves of the tip along what is fixed in a call, and sweeps over the planes that it meets in a move.
MOVES, SWEEPS = 20, 50
#: What is nearer than this is there [m].
ROUGH = 1e-7


class MujocoEngine:
    """An engine for `Bridge` or `EngineThread`: a mocap body follows the handle through a MuJoCo model.

    Each call moves the tip to the handle, simulates `period` and answers with a plane: across the force on the tip
    while there is one, before that at the nearest rigid surface within `reach`; a soft one is not seen before it is
    touched. How stiff it is, is found by pressing a copy of the simulation further by 0.2 mm. Friction acts as a
    tilt of the plane.

    MuJoCo lets the tip pass through whatever is fixed to the world. Here it stays outside: it rests where it came in,
    however deep the handle is pressed, and slides there without friction; such a surface has `most_stiffness`.

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
        Estimates end there, and what is fixed to the world has it [N/m].
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
        For a model without such a tip, or that MuJoCo does not read; for a fixed geom of type hfield or sdf that the
        tip may touch.
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
        self._others, self._fixed = self._surfaces(body)

    def _read(self, model: Any) -> Any:
        text = str(model)
        if text.lstrip().startswith("<"):
            return self._mj.MjModel.from_xml_string(text)
        if not Path(text).exists():
            raise FileNotFoundError(f"{text}: no such file")
        return self._mj.MjModel.from_xml_path(text)

    def _surfaces(self, body: int) -> tuple[list[int], list[int]]:
        """Return the geoms that the tip may touch: those that move, and those that are fixed to the world."""
        model, mask = self.model, self.model.geom_contype[self._geom]
        affinity = self.model.geom_conaffinity[self._geom]
        touched = (model.geom_contype & affinity) | (model.geom_conaffinity & mask)
        touched[model.body_rootid[model.geom_bodyid] == body] = 0
        found = [int(i) for i in np.flatnonzero(touched)]
        degrees = model.body_dofnum[model.body_weldid[model.geom_bodyid]]
        fixed = [i for i in found if degrees[i] == 0]
        for i in fixed:  # neither kind is convex: the plane at its nearest place may cut it
            kind = self._mj.mjtGeom(int(model.geom_type[i]))
            if kind in (self._mj.mjtGeom.mjGEOM_HFIELD, self._mj.mjtGeom.mjGEOM_SDF):
                name = self._mj.mj_id2name(model, self._mj.mjtObj.mjOBJ_GEOM, i) or i
                word = kind.name.removeprefix("mjGEOM_").lower()
                raise ValueError(
                    f"MujocoEngine.model: geom {name} is a fixed {word}, through which the tip would pass; give it "
                    'contype="0" conaffinity="0" if it is only looked at, or put boxes or convex meshes there'
                )
        return [i for i in found if degrees[i] > 0], fixed

    def __call__(self, x: Values, v: Values) -> LocalModel | None:
        """Return the plane near the tip."""
        start = self.data.mocap_pos[self._mocap].copy()
        place, surface = self._kept_out(start, np.asarray(x, float))
        self._mj.mj_copyData(self._probe, self.model, self.data)
        force = self._advance(self.data, start, place)
        if not np.isfinite(force).all():
            raise RuntimeError("the MuJoCo model became unstable: give it a smaller timestep")
        size = float(np.linalg.norm(force))
        if size > 0:
            deeper = self._advance(self._probe, start, place + PROBE * force / size)
            slope = (float(deeper @ force) / size - size) / PROBE
            wanted = float(np.clip(slope, 1.0, self._most))
            self._stiffness += TRUST * (wanted - self._stiffness)
        wall = self._most * (x - surface)
        total = force + wall
        pressed = float(np.linalg.norm(total))
        if pressed == 0:
            return self._ahead(place)
        along = total / pressed
        stiffness = 0.0
        for part, own in ((force, self._stiffness), (wall, self._most)):
            if (length := float(np.linalg.norm(part))) > 0:
                stiffness += own * (float(part @ along) / length) ** 2
        return LocalModel.of_force(x, total, stiffness)

    def _kept_out(self, start: Values, x: Values) -> tuple[Values, Values]:
        """Lead the tip from `start` towards x, outside of all that is fixed.

        Returns
        -------
        place : array, shape (3,)
            Where the tip comes to lie [m].
        surface : array, shape (3,)
            Where the handle would meet the surface there [m]; x itself where it is free.
        """
        if not self._fixed:
            return x, x
        self._mj.mj_copyData(self._probe, self.model, self.data)
        self._mj.mj_kinematics(self.model, self._probe)
        centre = self._probe.geom_xpos[self._geom] - start
        if self.data.time == 0 and not len(self._seen(x + centre, SKIN)[0]):
            return x, x  # where a model has its tip is not where the handle begins
        place = start
        for _ in range(MOVES):
            # The geoms are convex: who stays on this side of the plane at the nearest place of each meets none.
            wish = x - place
            distances, normals = self._seen(place + centre, float(np.linalg.norm(wish)) + SKIN)
            move = _within(wish, normals, distances - SKIN)
            surface = place + _within(wish, normals, distances)
            place = place + move
            if np.linalg.norm(move) < ROUGH:
                break
        return place, x if np.linalg.norm(x - surface) < ROUGH else surface

    def _seen(self, centre: Values, within: float) -> tuple[Values, Values]:
        """Return distances of the fixed geoms from a tip at some place, shape (n,), and directions, shape (n, 3)."""
        self._probe.geom_xpos[self._geom] = centre
        seen = [one for i in self._fixed if (one := self._nearest(self._probe, i, within))]
        distances = np.array([distance for distance, _ in seen])
        return distances, np.array([normal for _, normal in seen]).reshape(-1, 3)

    def _nearest(self, data: Any, other: int, within: float) -> tuple[float, Values] | None:
        """Return the distance of a geom from the tip, negative inside [m], and the direction into it."""
        line = np.zeros(6)
        distance = self._mj.mj_geomDistance(self.model, data, self._geom, other, within, line)
        if distance >= within or distance == 0:
            return None
        return float(distance), (line[3:] - line[:3]) / distance

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
        nearest, stiffness = self._reach, 0.0
        normal: Any = None
        for geoms, own in ((self._others, self._stiffness), (self._fixed, self._most)):
            for other in geoms:
                found = self._nearest(self.data, other, nearest)
                if found is not None and found[0] > 0:
                    (nearest, normal), stiffness = found, own
        if nearest == self._reach:
            return None
        a, b, c = x + nearest * normal
        return LocalModel(at=(a, b, c), normal=tuple(normal), stiffness=stiffness)

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


def _within(wish: Values, normals: Values, limits: Values) -> Values:
    """Return the point nearest to `wish` that is not beyond any plane: normals @ point <= limits (Hildreth 1957)."""
    point, pushed = wish.copy(), np.zeros(len(limits))
    for _ in range(SWEEPS):
        before = point
        for i, normal in enumerate(normals):
            push = max(float(normal @ point) - limits[i], -pushed[i])
            pushed[i] += push
            point = point - push * normal
        if np.linalg.norm(point - before) < 1e-9:
            break
    return point
