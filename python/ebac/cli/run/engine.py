"""The engine of `ebac run --engine-command`: a program beside the loop that computes its world."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, Self

from ebac.cli import options, output

if TYPE_CHECKING:
    from ebac.hardware import Configuration, Run
    from ebac.hardware.schedule import Schedule
    from ebac.worlds import EngineProcess

#: A loop has ticked so long before an engine that has posted nothing is spoken of [s].
_SILENT = 1.0
#: So long after its force has faded one that has stopped posting is spoken of [s].
_HUNG = 0.2


def with_engine(
    known: Configuration, command: str | None, wall: options.WallOptions, schedule: Schedule
) -> Configuration:
    """Return the configuration with the engine of the command line, if there is one.

    Raises
    ------
    ValueError
        Where something else is asked of the world that the engine computes.
    """
    if command is not None and not command.strip():
        raise ValueError(
            "--engine-command: is empty; give a program and its arguments, or leave it out"
        )
    made = known if command is None else known.replace(engine=command)
    if not made.engine:
        return made
    asked = [
        f"--{name.replace('_', '-')}" for name, value in vars(wall).items() if value is not None
    ]
    asked += ["--at environment" for order in schedule.orders if order.environment][:1]
    if asked:
        raise ValueError(
            f"{', '.join(asked)}: the engine computes the world; leave it out, or leave out the engine"
        )
    return made


@contextmanager
def started(known: Configuration) -> Iterator[tuple[Configuration, EngineProcess | None]]:
    """Start the engine of a configuration, if it has one; give the configuration with its world, and end it after."""
    if not known.engine:
        yield known, None
        return
    from ebac.worlds import EngineProcess

    with output.refusing():
        process = EngineProcess(known.engine, rendering=known.rendering)
    with ExitStack() as stack:
        try:
            stack.enter_context(process)
        except RuntimeError as error:
            output.fail(str(error), code=output.FAILED)
        noted = f"{known.text}\n# the engine of this run: {known.engine}\n"
        yield known.replace(environment=process.world, text=noted), process


def watch(process: EngineProcess | None) -> Callable[[Run], None]:
    """Return what a run calls meanwhile: it says on stderr that the engine is gone, hangs, or has posted nothing."""
    said: set[str] = set()
    posted, since = 0, 0.0

    def report(what: str, text: str, t: float) -> None:
        if what not in said:
            said.add(what)
            output.console(stderr=True).print(
                f"At t = {t:.1f} s: {text}.", style="yellow", markup=False, soft_wrap=True
            )

    def look(run: Run) -> None:
        nonlocal posted, since
        if process is None or run.done or not len(tail := run.tail(1)):
            return
        t = float(tail["t"][-1])
        if process.posted != posted:
            posted, since = process.posted, t
            said.discard("hangs")
        faded = process.rendering.stale + process.rendering.fade
        if trouble := process.trouble:
            report("gone", f"{trouble}: its force fades to zero", t)
        elif posted == 0 and t > _SILENT:
            report("silent", "the engine has posted nothing so far: no force is rendered", t)
        elif posted > 0 and t - since > faded + _HUNG:
            report("hangs", "the engine has stopped posting: its force has faded to zero", t)

    return look


@dataclass(frozen=True, kw_only=True)
class Served:
    """How an engine served a run. SI units, the unit in the name.

    Attributes
    ----------
    command : str
        Of its program.
    models : int
        Answers that arrived.
    rate_Hz : float
        Of these, over the whole run.
    oldest_s, faded_s, faded_at_s, given_J, moved_J
        As in `worlds.BridgeReport`.
    trouble : str
        What happened to its program before the run ended, empty if nothing.
    """

    command: str
    models: int
    rate_Hz: float
    oldest_s: float
    faded_s: float
    faded_at_s: float | None
    given_J: float
    moved_J: float
    trouble: str

    @classmethod
    def of(cls, process: EngineProcess, seconds: float) -> Self:
        """Return how it served a run of that length."""
        report: dict[str, Any] = asdict(process.world.report)
        rate = report["models"] / seconds if seconds > 0 else 0.0
        words = " ".join(process.command or [process.name])
        return cls(command=words, rate_Hz=rate, trouble=process.trouble, **report)

    @property
    def lasted(self) -> bool:
        """Whether it had a world until the end."""
        return self.models > 0 and not self.trouble

    def row(self) -> dict[str, Any]:
        """Return it as plain values."""
        return asdict(self)

    def __str__(self) -> str:
        """Return it as a sentence."""
        if self.models == 0:
            return f"Engine: {self.command} posted nothing. No force was rendered."
        faded = "" if self.faded_at_s is None else f", faded for {self.faded_s:.2f} s"
        ended = f" It did not last: {self.trouble}." if self.trouble else ""
        return (
            f"Engine: {self.command}: {output.plural(self.models, 'model')}, {self.rate_Hz:,.0f} a second; oldest "
            f"rendered {1e3 * self.oldest_s:.1f} ms{faded}; updates can have given {1e3 * self.given_J:.3g} mJ.{ended}"
        )


def without_engine(known: Configuration) -> Configuration:
    """Return the configuration with free space for the engine's world, which no file can hold."""
    from ebac import Free

    return replace(known, environment=Free()) if known.engine else known
