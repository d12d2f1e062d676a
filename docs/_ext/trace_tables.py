"""Columns of a trace with unit and meaning, read from short runs."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

CONFIGURATION = Path(__file__).parents[2] / "examples" / "joystick.toml"
Row = tuple[str, ...]


def every() -> Iterator[Row]:
    """What every run has."""
    return _table(row for row in _of(_simulated("direct")) if not row[0].startswith("`true."))


def law() -> Iterator[Row]:
    """The state of each law."""
    import ebac

    found: dict[Row, list[str]] = {}
    for name in ebac.LAWS:
        for row in _of(_simulated(name), "law."):
            found.setdefault(row, []).append(f"`{name}`")
    rows = [(*row, ", ".join(laws)) for row, laws in sorted(found.items())]
    return _table(rows, "laws")


def true() -> Iterator[Row]:
    """What only a simulation knows."""
    return _table(_of(_simulated("direct"), "true."))


def drives() -> Iterator[Row]:
    """What a run on drives has in addition."""
    import ebac

    with ebac.Device.open(CONFIGURATION, simulate=True) as device:
        try:
            trace = device.run("direct", seconds=0.1)
        except ebac.LoopFault as stopped:  # of a machine that is late; the columns are there
            trace = stopped.trace
    return _table(_of(trace, "bus.", "ft.", "limit.", "time."))


def log() -> Iterator[Row]:
    """What a replay keeps of its log."""
    import ebac

    return _table(_of(ebac.replay(_simulated("direct"), "direct"), "log."))


def _simulated(law: str) -> Any:
    import ebac

    return ebac.simulate(ebac.Scenario(seconds=0.01), law)


def _of(trace: Any, *prefixes: str) -> Iterator[Row]:
    """Give name, unit and meaning of the columns that begin so; of all without a beginning."""
    for info in trace.columns.values():
        if info.name.startswith(prefixes or ""):
            yield f"`{info.name}`", info.unit, info.meaning


def _table(rows: Iterable[Row], *more: str) -> Iterator[Row]:
    yield "column", "unit", "meaning", *more
    yield from rows


TABLES: dict[str, Callable[[], Iterator[Row]]] = {
    table.__name__: table for table in (every, law, true, drives, log)
}
