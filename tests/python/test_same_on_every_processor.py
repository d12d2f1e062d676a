"""Worlds that are computed in Python are the same to the bit, whichever kernels NumPy's libraries choose."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

FLAGS = Path("/proc/cpuinfo")

SHOWN = """
import numpy as np
from ebac.studies.world_kinds import KINDS
from ebac.worlds.presets import PRESETS
for name, preset in PRESETS.items():
    if not preset.extra:
        print(name, preset.solid())
for name, kind in KINDS.items():
    for axes in (2, 3):
        print(name, axes, kind.draw(np.random.default_rng(1), axes))
"""


def shown(kernels: str, without: str = "") -> str:
    """Return all worlds as text, with the kernels of one processor in OpenBLAS, without some of NumPy's own."""
    where = {**os.environ, "OPENBLAS_CORETYPE": kernels, "NPY_DISABLE_CPU_FEATURES": without}
    return subprocess.run(
        [sys.executable, "-c", SHOWN], env=where, capture_output=True, text=True, check=True
    ).stdout


@pytest.mark.parametrize(("kernels", "flag"), [("Haswell", "avx2"), ("SkylakeX", "avx512f")])
def test_a_world_has_the_same_bits_on_every_processor(kernels: str, flag: str) -> None:
    if not FLAGS.exists() or flag not in FLAGS.read_text().split():
        pytest.skip(f"this processor has no {flag}: kernels that need it would end the process")
    core = pytest.importorskip("numpy._core._multiarray_umath")  # of NumPy 2
    plain = shown(
        "Prescott", " ".join(f for f in core.__cpu_dispatch__ if core.__cpu_features__[f])
    )
    assert len(plain.splitlines()) > 10
    assert shown(kernels) == plain
