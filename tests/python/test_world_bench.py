"""`ebac bench --worlds`: what it compares and tells. How fast anything is, no test asserts."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac.cli import app
from ebac.peers import chai3d_peer, worlds

pytest.importorskip("igl")


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("EBAC_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(worlds, "CELL", 3e-3)
    monkeypatch.setattr(worlds, "PLACES", 2000)
    monkeypatch.setattr(worlds, "FEW", 20)
    compare = worlds.compare_worlds
    monkeypatch.setattr(
        worlds, "compare_worlds", lambda **more: compare(meshes=((32, 16), (64, 32)), **more)
    )


@pytest.fixture
def stand_in(tmp_path: Path) -> Path:
    """A program that answers as chai3d_contacts does, and fails for a file of another size."""
    program = tmp_path / "contacts"
    numbers = 3 + 3 * (32 * 16 + 1024 + 2001), 3 + 3 * (64 * 32 + 4096 + 2001)
    sizes = " ".join(f'"{8 * count}"' for count in numbers)
    program.write_text(
        f'#!/bin/sh\nfor size in {sizes}; do\n  if [ "$(wc -c < "$1")" = "$size" ]; then\n'
        '    echo \'{"contact_s": 2e-6}\'; exit 0\n  fi\ndone\necho "wrong size" >&2; exit 2\n'
    )
    program.chmod(0o755)
    return program


def test_the_rows(stand_in: Path) -> None:
    command = ["bench", "--worlds", "--json", "--repeats", "1", "--chai3d", str(stand_in)]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    programs = {(row["subject"], row["program"]) for row in found["rows"]}
    for size in ("1,024", "4,096"):
        for what, program in (("distance", "ebac"), ("contact", "ebac"), ("contact", "CHAI3D")):
            assert (f"{what}, {size} triangles", program) in programs
    assert all(row["value"] > 0 and row["note"] for row in found["rows"])
    assert any("coal" in one for one in found["missing"]) != ("coal" in str(programs))
    (rms,) = (
        row["value"]
        for row in found["rows"]
        if row["subject"] == "depth error, rms: 4,096 triangles, its triangles"
    )
    assert rms < 1e-4  # cells of 3 mm


def test_what_is_left_out_is_said() -> None:
    result = CliRunner().invoke(app, ["bench", "--worlds", "--repeats", "1"])
    assert result.exit_code == 0, result.output
    assert "not compared without --chai3d PROGRAM" in result.output
    assert "at most 60 ns" in result.output


def test_a_program_that_fails(stand_in: Path, tmp_path: Path) -> None:
    vertices, faces = worlds.ring(8, 4)
    with pytest.raises(RuntimeError, match="ended with 2: wrong size"):
        chai3d_peer.contact(stand_in, vertices, faces, worlds.path(), 1)
    other = tmp_path / "other"
    other.write_text("#!/bin/sh\necho hello\n")
    other.chmod(0o755)
    with pytest.raises(RuntimeError, match="not the program chai3d_contacts"):
        chai3d_peer.contact(other, vertices, faces, worlds.path(), 1)
    alone = CliRunner().invoke(app, ["bench", "--chai3d", str(other)])
    assert alone.exit_code == 2
    assert "--worlds" in alone.output


def test_the_ring_is_closed_and_its_distance_exact() -> None:
    vertices, faces = worlds.ring(32, 16)
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    d, out = worlds.exact(vertices)
    assert np.abs(d).max() < 1e-12
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ni,ni->n", normals, out[faces[:, 0]]) > 0).all()  # outwards
    assert (worlds.exact(worlds.path()[1:])[0] < 0).all()
