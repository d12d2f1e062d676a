"""The work of a sweep: bundles of runs, here or elsewhere, each kept as soon as it is done."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor, Future, as_completed

from ebac._core import RunLimits
from ebac._util.background import Background
from ebac._util.cores import usable_cores
from ebac._util.progress import Progress
from ebac.studies.sweeps.measure import Columns, Run, Watch, empty, measure
from ebac.studies.sweeps.store import Store

#: How often progress is looked at [s].
LOOK = 0.05


class Job:
    """All runs of a sweep, bundle by bundle, here or elsewhere."""

    def __init__(
        self, runs: list[Run], limits: RunLimits, threads: int | None, progress: Progress
    ) -> None:
        self.runs = runs
        self.limits = limits
        self.threads = threads
        self.progress = progress
        self.columns = empty(len(runs))
        self.done = 0

    def keep(self, part: range, columns: Columns) -> None:
        """Put the rows of a bundle in their place."""
        for name, values in columns.items():
            self.columns[name][part.start : part.stop] = values
        self.done += int(columns["done"].sum())
        self.progress(self.done, len(self.runs))

    def work(
        self, size: int, store: Store | None, executor: Executor | None
    ) -> Iterator[tuple[range, Columns]]:
        """Yield the rows of each bundle as they come: first those on disk."""
        n = len(self.runs)
        left = {}
        for i, start in enumerate(range(0, n, size)):
            part = range(start, min(start + size, n))
            kept = store.load(i) if store else None
            if kept is None:
                left[i] = part
            else:
                yield part, kept
        for i, columns in self._elsewhere(executor, left) if executor else self._here(left):
            if store:
                store.save(i, columns)
            yield left[i], columns

    def _bundle(self, part: range) -> list[Run]:
        return self.runs[part.start : part.stop]

    def _here(self, left: dict[int, range]) -> Iterator[tuple[int, Columns]]:
        """Work in a thread of its own, so that this one can show the progress and receive Ctrl-C."""
        threads = self.threads or usable_cores()
        for i, part in left.items():
            watch = Watch()
            work = _start(self._bundle(part), threads, self.limits, watch)
            try:
                while not work.wait(LOOK):
                    self.progress(self.done + watch.done, len(self.runs))
            except BaseException as error:  # Ctrl-C, or what `progress` raises
                watch.core.cancel()
                columns = work.result()
                if isinstance(error, KeyboardInterrupt):
                    self.keep(part, columns)
                raise
            yield i, work.result()

    def _elsewhere(
        self, executor: Executor, left: dict[int, range]
    ) -> Iterator[tuple[int, Columns]]:
        waiting: dict[Future[Columns], int] = {
            executor.submit(_measure, self._bundle(part), self.threads or 1, self.limits): i
            for i, part in left.items()
        }
        try:
            for future in as_completed(list(waiting)):
                columns = future.result()
                yield waiting.pop(future), columns
        except (Exception, KeyboardInterrupt):
            for future, i in waiting.items():  # what is done already shall not be lost
                if future.done() and not future.cancelled() and future.exception() is None:
                    yield i, future.result()
            raise
        finally:
            for future in waiting:
                future.cancel()


def _measure(
    runs: list[Run], threads: int, limits: RunLimits, watch: Watch | None = None
) -> Columns:
    return measure(runs, threads=threads, limits=limits, watch=watch or Watch())


def _start(runs: list[Run], threads: int, limits: RunLimits, watch: Watch) -> Background[Columns]:
    """Measure a bundle in another thread of this process."""
    return Background(lambda: _measure(runs, threads, limits, watch))
