"""Files with numbers that are none, and archives that are damaged: refused by name, and closed."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from ebac.identify import load


def test_an_underscore_is_no_digit(tmp_path: Path) -> None:
    rows = "".join(f"{i * 1e-3},{np.sin(i / 9)},{np.cos(i / 9)}\n" for i in range(90))
    (tmp_path / "log.csv").write_text("t,x,force\n0,1_0,1\n" + rows)
    with pytest.raises(ValueError, match=r"log.csv: '1_0' in row 1, column 'x', is no number"):
        load(tmp_path / "log.csv")


def test_an_archive_is_named_and_closed(tmp_path: Path) -> None:
    np.savez(tmp_path / "objects.npz", x=np.array([{}, []], dtype=object))
    (tmp_path / "none.npz").write_bytes(b"PK\x03\x04 no archive")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ValueError, match=r"objects.npz: x holds objects of Python"):
            load(tmp_path / "objects.npz")
        with pytest.raises(ValueError, match=r"none.npz: is no NumPy archive"):
            load(tmp_path / "none.npz")
