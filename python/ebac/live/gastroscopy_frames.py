"""What the page of a gastroscopy shows: outside, camera, forces."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ebac.live.gastroscopy_session import GastroscopySession

PHASES = ("along the lumen", "at a target", "back from a target", "behind the pylorus")


class GastroscopyFrames:
    """What the page shows of a gastroscopy. SI units; places in tenths of a millimetre."""

    def __init__(self, session: GastroscopySession) -> None:
        self._session = session
        lumen = session.procedure.lumen
        self._places = np.arange(0.0, lumen.landmarks()["end"] - 1e-3, 6e-3)
        self._shape = json.dumps({"kind": "shape", "shape": self._rings()})

    def frame(self) -> dict[str, Any]:
        """Return what is new since the last call."""
        row, slave, found, new, run = self._session.snapshot()
        lumen, t, bag = self._session.procedure.lumen.core, row["t"], slave["bag"]
        wall = [lumen.at(float(s), t, bag) for s in self._places]
        targets = []
        for polyp in self._session.procedure.polyps():
            middle, right, down, _, radius = lumen.at(polyp.place, t, bag)
            out = np.cos(polyp.angle) * np.array(right) + np.sin(polyp.angle) * np.array(down)
            targets.append(_tenths(np.array(middle) + radius * out))
        return {
            "kind": "frame",
            "run": run,
            "t": t,
            "place": row["place"],
            "force": row["section_force"],
            "most": found["most_section"],
            "touched": int(found["touched"]),
            "reached": bool(found["reached"]),
            "fault": int(found["fault"]),
            "over": found["over_limit"],
            "phase": PHASES[int(row["phase"])],
            "on_hand": float(np.linalg.norm([row[f"felt_{axis}"] for axis in "xyz"])),
            "energy": found["least_energy"],
            "at": _tenths(np.array(slave["at"])),
            "ahead": np.round(slave["ahead"], 4).tolist(),
            "right": np.round(slave["right"], 4).tolist(),
            "tube": _tenths(np.array(slave["tube"])),
            "wall": _tenths(np.array([one[0] for one in wall])),
            "radius": _tenths(np.array([one[4] for one in wall])),
            "targets": targets,
            "strips": _strips(new),
        }

    def history(self) -> dict[str, Any]:
        """Return the strips of the last seconds."""
        return _strips(list(self._session.recent))

    def state(self) -> dict[str, Any]:
        """Return what is run, and what is drawn of it."""
        session, procedure = self._session, self._session.procedure
        return {
            "law": session.law,
            "delay_s": procedure.master.delay,
            "feedback": procedure.master.feedback,
            "heed_N": procedure.physician.heed,
            "limit_N": procedure.lumen.patient.force_limit,
            "targets": len(procedure.polyps()),
            "field_rad": procedure.physician.field_of_view,
            "tip_m": procedure.scope.tip,
            "diameter_m": procedure.scope.diameter,
            "running": session.running,
        }

    def shape(self) -> str:
        """Return the axes of the rings of the wall as a message, always the same object."""
        return self._shape

    def _rings(self) -> dict[str, Any]:
        lumen = self._session.procedure.lumen.core
        rows = [lumen.at(float(s), 0.0, (0.0, 0.0, 0.0)) for s in self._places]
        axes = np.array([[row[1], row[2]] for row in rows])
        right, down = np.round(axes, 4).transpose(1, 0, 2)
        return {"right": right.ravel().tolist(), "down": down.ravel().tolist()}


def _tenths(metres: NDArray[np.float64]) -> list[int]:
    found: list[int] = np.rint(1e4 * metres).astype(int).ravel().tolist()
    return found


def _strips(rows: list[dict[str, float]]) -> dict[str, list[float]]:
    names = {"t": "t", "force": "section_force", "tube": "tube_force", "place": "place"}
    return {own: [round(row[name], 4) for row in rows] for own, name in names.items()}
