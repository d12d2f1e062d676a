"""What a contact with a mesh costs, beside coal and CHAI3D, and how exact it is."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from ebac import _core
from ebac._util.arrays import Values
from ebac.peers import chai3d_peer, coal_peer
from ebac.peers.row import PeerRow
from ebac.worlds.grid import Grid, Ints, Surface, cached_grid

#: The ring: distance of its tube's middle from the axis, and radius of the tube [m].
RING, TUBE = 0.03, 0.012
#: Around the axis and around the tube, of a thousand and of a million triangles.
MESHES = ((32, 16), (1024, 512))
#: Edge of a cell: 1/96 of the ring's diameter, as every mesh has it by default [m].
CELL = 2 * (RING + TUBE) / 96
#: Places that are timed, how far from the surface they lie at most [m], and runs.
PLACES, OFF, REPEATS = 20_000, 1e-3, 100
#: Those that a slower program gets.
FEW, FEW_REPEATS = 500, 30
AIM = "at most 60 ns"
#: How often `compare_worlds` calls `step`.
STEPS = 4 * len(MESHES)

_GRID = "signed distance and normal from a grid of 0.875 mm"
_PROXY = "god-object on that grid, force, frame; a path 0.5 to 1.5 mm deep, 42 mm/s"


def compare_worlds(
    *,
    chai3d: Path | None = None,
    meshes: tuple[tuple[int, int], ...] = MESHES,
    repeats: int = REPEATS,
    step: Callable[[str], None] = lambda name: None,
) -> tuple[list[PeerRow], list[str]]:
    """Time contacts with a ring of triangles and compare its grid with exact distances.

    Parameters
    ----------
    chai3d : Path, optional
        The program `chai3d_contacts` of examples/chai3d.
    meshes : tuple of (int, int)
        Sections around the axis and around the tube.
    repeats : int
        Runs, of which the quickest counts.
    step : callable
        Called with what comes next, four times a mesh.

    Returns
    -------
    rows : list of PeerRow
        Times [s]; `times_ebac` compares with ebac on the same mesh. Errors [m] and [deg].
    missing : list of str
        Sentences on what could not be compared.

    Raises
    ------
    ImportError
        Without the extra `worlds`.
    RuntimeError
        When the program fails.
    """
    rows: list[PeerRow] = []
    missing: list[str] = [] if chai3d else ["CHAI3D: not compared without --chai3d PROGRAM"]
    for around, along in meshes:
        vertices, faces = ring(around, along)
        size = f"{len(faces):,} triangles"
        step(f"{size}: grid")
        surface = Surface(vertices, faces)
        grid = cached_grid(surface, CELL)
        step(f"{size}: ebac")
        times = _own(grid, repeats)
        for what, seconds, note in zip(
            ("distance", "contact"), times, (_GRID, _PROXY), strict=True
        ):
            rows.append(
                PeerRow(subject=f"{what}, {size}", program="ebac", value=seconds, unit="s", times_ebac=1.0,
                        target=AIM, note=note)
            )  # fmt: skip
        step(f"{size}: coal")
        try:
            taken, call = coal_peer.distance(vertices, faces, near(FEW), min(repeats, FEW_REPEATS))
        except ImportError as error:
            missing = [*missing, f"coal: {error}"] if around == meshes[0][0] else missing
        else:
            note = f"tree of oriented boxes, no sign; {1e6 * call:.1f} µs of the call from Python taken off"
            rows.insert(
                -1,
                PeerRow(subject=f"distance, {size}", program="coal", value=taken, unit="s",
                        times_ebac=taken / times[0], note=note),
            )  # fmt: skip
        step(f"{size}: CHAI3D, errors")
        if chai3d is not None:
            taken = chai3d_peer.contact(chai3d, vertices, faces, path(), min(repeats, FEW_REPEATS))
            rows.append(
                PeerRow(subject=f"contact, {size}", program="CHAI3D", value=taken, unit="s",
                        times_ebac=taken / times[1], note="its finger proxy on the triangles, force; the same path")
            )  # fmt: skip
        rows += _errors(grid, f"{size}, its triangles", surface.distance)
        rows += _errors(grid, f"{size}, the smooth ring", exact)
    return rows, missing


def ring(around: int, along: int) -> tuple[Values, Ints]:
    """Return corners [m] and triangles of the ring."""
    a, b = np.meshgrid(_turns(around), _turns(along), indexing="ij")
    i, j = np.meshgrid(np.arange(around), np.arange(along), indexing="ij")
    next_i, next_j = (i + 1) % around, (j + 1) % along
    corners = [
        one.ravel()
        for one in (i * along + j, next_i * along + j, next_i * along + next_j, i * along + next_j)
    ]
    halves = [np.column_stack([corners[k] for k in half]) for half in ((0, 1, 2), (0, 2, 3))]
    return _on_ring(a.ravel(), b.ravel(), 0.0), np.concatenate(halves)


def path() -> Values:
    """Return a place outside, then a closed path below the surface [m], shape (n + 1, 3)."""
    turn = _turns(PLACES)
    below = _on_ring(3 * turn, 5 * turn, -OFF * (1 + 0.5 * np.sin(9 * turn)))
    return np.concatenate([_on_ring(np.zeros(1), np.zeros(1), OFF), below])


def near(count: int, seed: int = 1) -> Values:
    """Return places at random within 1 mm of the surface [m]."""
    random = np.random.default_rng(seed)
    a, b = random.uniform(0, 2 * np.pi, (2, count))
    return _on_ring(a, b, random.uniform(-OFF, OFF, count))


def exact(points: Values) -> tuple[Values, Values]:
    """Return distance [m] and direction of the smooth ring, in closed form."""
    flat = np.hypot(points[:, 0], points[:, 1])
    off = points * np.column_stack([1 - RING / flat, 1 - RING / flat, np.ones_like(flat)])
    length = np.linalg.norm(off, axis=1)
    return length - TUBE, off / length[:, None]


def _turns(count: int) -> Values:
    return 2 * np.pi * np.arange(count) / count


def _on_ring(a: Values, b: Values, off: Values | float) -> Values:
    """Return places at angles around the axis and around the tube, off the surface by so much."""
    flat = RING + (TUBE + off) * np.cos(b)
    return np.column_stack([flat * np.cos(a), flat * np.sin(a), (TUBE + off) * np.sin(b)])


def _own(grid: Grid, repeats: int) -> tuple[float, float]:
    """Return the times of a distance and of a contact [s]."""
    solid, places = grid.made(), path()
    world = _core._World([(solid, _core.Elastic(), 0.0, _core.Swing())])
    timed = partial(world._time, places[0], places[1:])
    return 1e-9 * solid._time(near(PLACES), repeats), 1e-9 * timed(repeats)


def _errors(
    grid: Grid, subject: str, true: Callable[[Values], tuple[Values, Values]]
) -> list[PeerRow]:
    points = near(PLACES)
    d, out = grid.made().distances(points)
    exact_d, exact_out = true(points)
    off = np.abs(d - exact_d)
    angle = np.degrees(np.arccos(np.clip(np.einsum("ni,ni->n", out, exact_out), -1, 1)))
    found = (
        ("depth error, rms", float(np.sqrt(np.mean(off**2))), "m"),
        ("depth error, largest", float(off.max()), "m"),
        ("normal error, median", float(np.median(angle)), "deg"),
        ("normal error, 99 %", float(np.quantile(angle, 0.99)), "deg"),
    )
    note = f"of the grid, within {1e3 * OFF:g} mm of the surface"
    return [
        PeerRow(subject=f"{name}: {subject}", program="ebac", value=value, unit=unit, note=note)
        for name, value, unit in found
    ]  # fmt: skip
