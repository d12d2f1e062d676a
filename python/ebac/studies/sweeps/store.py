"""A sweep on disk: a folder of bundles, each written whole or not at all, so that a killed sweep continues."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from types import FunctionType, MethodType
from typing import Any, Self

import numpy as np

from ebac._core import RunLimits
from ebac._util.atomic_file import draft
from ebac._util.atomic_folder import NO_LOCKS, locked
from ebac._util.code_print import ADDRESS, code_print
from ebac._util.foreign_worlds import foreign
from ebac.scenario import Scenario
from ebac.studies.sweeps.measure import Columns, Run, empty

MANIFEST = "sweep.json"


def fingerprint(runs: Sequence[Run], limits: RunLimits) -> str:
    """Return a hash of all that decides the result: version, columns, every scenario, every law with its code."""
    from ebac import __version__

    digest = hashlib.sha256(f"{__version__} {limits!r} {list(empty(0))}".encode())
    laws: dict[int, str] = {}
    scenarios: dict[int, str] = {}  # each runs under every law
    for scenario, law in runs:
        if id(law) not in laws:
            laws[id(law)] = _describe(law)
        if id(scenario) not in scenarios:
            scenarios[id(scenario)] = _scenario_text(scenario)
        digest.update(f"{scenarios[id(scenario)]} {laws[id(law)]}\n".encode())
    return digest.hexdigest()


def _scenario_text(scenario: Scenario) -> str:
    """Return a scenario as text, with what a hand or a world of the user's own does in place of where it lies."""
    world = foreign(scenario.environment)
    parts = [scenario.hand.model, getattr(world, "function", None), getattr(world, "engine", None)]
    text = repr(scenario)
    for part in (part for part in parts if part is not None):
        text = text.replace(repr(part), _describe(part))
    return text


def _describe(part: Any) -> str:
    """Return a law, hand or function as text: its values, and its code where it is a user's own."""
    if isinstance(part, MethodType):
        return f"{_describe(part.__self__)}.{part.__func__.__qualname__}"
    if isinstance(part, FunctionType):
        return f"{part.__module__}.{part.__qualname__} {code_print(part)}"
    if not ADDRESS.search(repr(part)):
        return f"{part!r} {_code(part)}"
    # The default repr holds an address, which is another one after a restart.
    values = ADDRESS.sub("", repr(sorted(getattr(part, "__dict__", {}).items())))
    return f"{type(part).__module__}.{type(part).__qualname__} {values} {_code(part)}"


def _code(part: Any) -> str:
    """Return the code of a law or hand of a user's own, which may be edited between two calls."""
    kind = type(part)
    return "" if kind.__module__.partition(".")[0] in ("builtins", "ebac") else code_print(kind)


class Store:
    """The folder of one sweep.

    A context manager: until its end no other sweep may use the folder.

    Raises
    ------
    ValueError
        When the folder holds another sweep and may not be started anew, or another sweep is writing to it.
    """

    def __init__(self, folder: str | Path, about: dict[str, Any], *, resume: bool) -> None:
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        with ExitStack() as stack:
            self._lock(stack)
            self._begin(about, resume=resume)
            self._locked = stack.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._locked.close()

    def _lock(self, stack: ExitStack) -> None:
        try:
            stack.enter_context(locked(self.folder, wait=False))
        except BlockingIOError:
            raise ValueError(
                f"{self.folder}: another sweep is writing to it; give another folder, or wait for its end"
            ) from None
        except NO_LOCKS:
            pass

    def _begin(self, about: dict[str, Any], *, resume: bool) -> None:
        manifest = self.folder / MANIFEST
        found = self._found(manifest) if resume else None
        if found is not None and found != about:
            other = next(name for name in about if found.get(name) != about[name])
            raise ValueError(
                f"{self.folder}: holds another sweep ({other}: {found.get(other)}, now {about[other]}); "
                "give another folder, or resume=False to start anew in this one"
            )
        if found is None:
            manifest.unlink(missing_ok=True)
            for old in self.folder.glob("bundle-*.npz"):
                old.unlink()
            self._write(MANIFEST, lambda file: file.write(json.dumps(about, indent=2).encode()))

    def _found(self, manifest: Path) -> dict[str, Any] | None:
        """Return what is known of the sweep in the folder, None where there is none."""
        if not manifest.exists():
            return None
        try:
            return dict(json.loads(manifest.read_bytes()))
        except (TypeError, ValueError):
            raise ValueError(
                f"{manifest}: is damaged; give another folder, or resume=False to start anew in this one"
            ) from None

    def load(self, bundle: int) -> Columns | None:
        """Return what a bundle gave, None when it has not been done, or its file is damaged."""
        path = self._path(bundle)
        if not path.exists():
            return None
        try:  # NumPy leaves a file open that is none of its own
            with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
        except Exception:  # a damaged archive has a dozen errors: it is done again
            return None

    def save(self, bundle: int, columns: Columns) -> None:
        """Write what a bundle gave."""
        arrays: dict[str, Any] = columns
        self._write(self._path(bundle).name, lambda file: np.savez(file, **arrays))

    def _path(self, bundle: int) -> Path:
        return self.folder / f"bundle-{bundle:06d}.npz"

    def _write(self, name: str, fill: Any) -> None:
        with draft(self.folder / name) as new, new.open("wb") as file:
            fill(file)
