"""CHAI3D: a contact with the same triangles by its finger proxy, in the program of examples/chai3d."""

from __future__ import annotations

import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values

#: Seconds until it is taken for hung: a million triangles are sorted first.
PATIENCE = 600


def contact(
    program: Path,
    vertices: Values,
    faces: NDArray[np.int64],
    places: Values,
    repeats: int,
) -> float:
    """Return the time of a contact [s]; the first of the places lies outside.

    Raises
    ------
    RuntimeError
        When the program fails, with what it printed.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mesh.bin"
        counts = np.array([len(vertices), len(faces), len(places)], np.int64)
        parts = (counts, vertices.astype(float), faces.astype(np.int64), places.astype(float))
        file.write_bytes(b"".join(np.ascontiguousarray(part).tobytes() for part in parts))
        try:
            done = subprocess.run(
                [str(program), str(file), str(repeats)],
                capture_output=True,
                text=True,
                timeout=PATIENCE,
                check=True,
            )
            return float(json.loads(done.stdout)["contact_s"])
        except subprocess.CalledProcessError as error:
            raise RuntimeError(
                f"{program}: ended with {error.returncode}: {error.stderr.strip()}"
            ) from error
        except (OSError, subprocess.TimeoutExpired, ValueError, KeyError) as error:
            raise RuntimeError(
                f"{program}: not the program chai3d_contacts of examples/chai3d ({error})"
            ) from error
