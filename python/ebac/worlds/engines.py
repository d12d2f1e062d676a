"""Engines of others: a Python function as a world, and a bridge to what is slower than the loop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

from ebac import _core
from ebac._core import BridgeParams, Elastic, EngineTiming
from ebac._util.arrays import Values
from ebac.worlds.answers import Kept, LocalModel, contact_numbers, model_numbers
from ebac.worlds.world import World

#: What an engine is: position [m] and velocity [m/s] of the handle in, each of shape (3,); a local model out.
Engine = Callable[[Values, Values], LocalModel | None]


class ForeignWorld(_core._World):
    """A world that is not made of bodies: it is called in simulated time, and may fail."""

    #: Whether a tick in real time may call it.
    in_real_time = False

    def for_run(self) -> ForeignWorld:
        """Return the same world for one run, with its own errors and report."""
        raise NotImplementedError

    def ideal(self) -> World | None:
        """Return the bodies that it stands for, where it does."""
        return None

    @property
    def error(self) -> BaseException | None:
        """The first error of the run, or None."""
        return None

    @property
    def has_text(self) -> bool:
        """Whether it can be written to TOML."""
        return self.ideal() is not None

    def remark(self) -> str:
        """Return what the run must say, empty if nothing."""
        return ""

    @property
    def what(self) -> str:
        """Name for messages."""
        raise NotImplementedError


def named(function: Any) -> str:
    """Return what a function or an object that can be called goes by in messages."""
    return getattr(function, "__qualname__", None) or type(function).__name__


def _callable(owner: str, given: Any) -> None:
    if isinstance(given, type) or not callable(given):
        raise TypeError(
            f"{owner} = {given!r}: must be a function of position and velocity, or an object that can be called so"
        )


class FunctionWorld(ForeignWorld):
    """A world that is a Python function, called in every tick; for simulation.

    Parameters
    ----------
    function : callable
        `function(position, velocity)`, [m] and [m/s], each of shape (3,), returns the force with which the handle
        presses [N], three numbers, positive into the body; or a `Touch`, which also has the normal; or None without
        contact. An object is copied for each run. What it raises ends the run with a `LoopFault` that names it.

    Raises
    ------
    TypeError
        When it cannot be called.
    """

    def __init__(self, function: Callable[[Values, Values], Any]) -> None:
        _callable("FunctionWorld.function", function)
        self._errors: list[BaseException] = []
        kept = Kept(function, contact_numbers, self._errors)
        super().__init__(_core._function_world(kept))
        self.function = function

    def for_run(self) -> FunctionWorld:
        """Return the same world for one run, with its own errors."""
        return FunctionWorld(self.function)

    @property
    def error(self) -> BaseException | None:
        """The first error of the run, or None."""
        return self._errors[0] if self._errors else None

    @property
    def what(self) -> str:
        """Name for messages."""
        return f"the world {named(self.function)}"

    def __repr__(self) -> str:
        """Return the function."""
        return f"FunctionWorld({self.function!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what a copy is made from."""
        return FunctionWorld, (self.function,)


@dataclass(frozen=True, kw_only=True)
class BridgeReport:
    """How an engine served a run.

    Attributes
    ----------
    models : int
        Answers that arrived.
    oldest_s : float
        Oldest model that was rendered.
    faded_s : float
        Time in which the force was faded because the model was too old.
    faded_at_s : float or None
        When that began for the first time.
    given_J : float
        Most energy that changes of the model, late answers and blending can have given to the handle.
    moved_J : float
        Most energy that the surface's own motion, as the engine reports it, can have given.
    """

    models: int
    oldest_s: float
    faded_s: float
    faded_at_s: float | None
    given_J: float
    moved_J: float


def report_of(world: _core._World) -> BridgeReport:
    """Return the report of a bridge's last run."""
    numbers: Any = _core._bridge_report(world)
    at = numbers.pop("faded_at_s")
    return BridgeReport(**numbers, faded_at_s=at if at >= 0 else None)


def warning_of(report: BridgeReport, rendering: BridgeParams) -> str:
    """Return what a run with an engine must say, empty if nothing."""
    if report.models == 0:
        return "the engine never answered: no force was rendered"
    if report.faded_at_s is None:
        return ""
    return (
        f"the engine's model was older than {1e3 * rendering.stale:g} ms (up to {1e3 * report.oldest_s:.0f} ms): from "
        f"t = {report.faded_at_s:.3g} s on, for {report.faded_s:.3g} s in all, its force was faded or zero"
    )


def _refuse_damping(world: World) -> None:
    """Raise ValueError for an elastic body with damping: the local model of bodies would leave it out."""
    for body in world.bodies:
        if isinstance(body.material, Elastic) and body.material.damping > 0:
            raise ValueError(
                f"Elastic.damping = {body.material.damping:g} N s/m: must be 0 N s/m behind an engine, "
                "whose local model of bodies has none; leave it out, or return a LocalModel with damping= from an "
                "engine of your own"
            )


class Bridge(ForeignWorld):
    """A world computed by a slow engine: its newest local model is rendered in every tick; in simulated time.

    The engine is called with where the handle is, `rate` times a second, and its answers arrive `compute` to
    `compute + jitter` later. Between them the tick renders the plane or sphere of the last one. When a new one arrives
    nothing jumps: the surface begins where it was and moves over. One that is too old fades to zero, with a warning.

    Parameters
    ----------
    engine : callable or World
        `engine(position, velocity)`, [m] and [m/s], each of shape (3,), returns a `LocalModel`, or None where no
        surface is near. An object is copied for each run. A `World` stands for an engine that computes it.
    timing : EngineTiming
        When it is called and answers; default: 60 Hz, answers at once.
    held : bool
        Hold the engine's force until the next one comes, as a bridge is not to do: to compare with.
    rendering : BridgeParams
        How models take over from each other and fade.

    Raises
    ------
    TypeError, ValueError
        For something that cannot be called, more than 62 answers on their way, or an elastic body with damping, which
        the local model of a `World` would leave out.
    """

    def __init__(
        self,
        engine: Engine | World,
        *,
        timing: EngineTiming | None = None,
        held: bool = False,
        rendering: BridgeParams | None = None,
    ) -> None:
        self.engine, self.held = engine, bool(held)
        self.timing = EngineTiming() if timing is None else timing
        self.rendering = BridgeParams() if rendering is None else rendering
        for name, kind in (("timing", EngineTiming), ("rendering", BridgeParams)):
            if not isinstance(value := getattr(self, name), kind):
                raise TypeError(f"Bridge.{name} = {value!r}: must be {kind.__name__}(...)")
        self.in_real_time = isinstance(engine, World)
        self._errors: list[BaseException] = []
        self._last: Bridge | None = None
        how = (self.timing, self.rendering, self.held)
        if isinstance(engine, World):
            _refuse_damping(engine)
            made = _core._scheduled_world(engine, *how)
        else:
            _callable("Bridge.engine", engine)
            kept = Kept(engine, model_numbers, self._errors)
            made = _core._scheduled_function(kept, *how)
        super().__init__(made)

    @classmethod
    def from_table(
        cls,
        world: World,
        engine_timing: EngineTiming | None = None,
        held: bool = False,
        rendering: BridgeParams | None = None,
    ) -> Self:
        """Return it from its parts by name."""
        return cls(world, timing=engine_timing, held=held, rendering=rendering)

    def as_dict(self) -> dict[str, Any]:
        """Return the parameters by name; of a world, not of a function."""
        if not isinstance(self.engine, World):
            raise ValueError(
                f"Bridge.engine = {self.engine!r}: a function cannot be written to TOML; give a World"
            )
        return {
            "world": self.engine,
            "engine_timing": self.timing,
            "held": self.held,
            "rendering": self.rendering,
        }

    def for_run(self) -> Bridge:
        """Return the same bridge for one run, with its own errors and report."""
        made = Bridge(self.engine, timing=self.timing, held=self.held, rendering=self.rendering)
        self._last = made
        return made

    def ideal(self) -> World | None:
        """Return the bodies that the engine computes; None for a function."""
        return self.engine if isinstance(self.engine, World) else None

    def remark(self) -> str:
        """Return what the run must say, empty if nothing."""
        return "" if self.held else warning_of(self.report, self.rendering)

    @property
    def report(self) -> BridgeReport:
        """How the engine served the last run."""
        return report_of(self if self._last is None else self._last)

    @property
    def error(self) -> BaseException | None:
        """The first error of the run, or None."""
        return self._errors[0] if self._errors else None

    @property
    def what(self) -> str:
        """Name for messages."""
        return f"the engine {named(self.engine)}"

    def __repr__(self) -> str:
        """Return engine, timing and rendering."""
        held = ", held=True" if self.held else ""
        return (
            f"Bridge({self.engine!r}, timing={self.timing!r}{held}, rendering={self.rendering!r})"
        )

    def _parts(self) -> tuple[Any, ...]:
        return self.engine, self.timing, self.held, self.rendering

    def __eq__(self, other: object) -> bool:
        """Return whether both have the same parts."""
        return isinstance(other, Bridge) and self._parts() == other._parts()

    def __hash__(self) -> int:
        """Return a number of the parts."""
        return hash(self._parts())

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what a copy is made from."""
        return _bridge, self._parts()


def _bridge(engine: Any, timing: EngineTiming, held: bool, rendering: BridgeParams) -> Bridge:
    return Bridge(engine, timing=timing, held=held, rendering=rendering)
