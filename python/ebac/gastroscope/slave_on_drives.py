"""A gastroscope on four CANopen drives, two pairs on two buses, at the end of a network."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac import _core
from ebac._core import FarLink, Fault, Follow, Gears, Hand, Scope, Step
from ebac.gastroscope.drive_configurations import PAUSE, configuration
from ebac.gastroscope.far_side import FarWorld, LinkAtWork, LinkEvent, SideReport
from ebac.gastroscope.lumen import Lumen
from ebac.gastroscope.side_at_work import agreed, fault_of, side_report, silent

if TYPE_CHECKING:
    from ebac.hardware import Configuration, OpenDevice, Run

#: The second pair of the slave has power earlier than the first, by at most this [s], and ends with it.
_BEFORE = 10.0


def run_slave(
    feed: Configuration | None = None,
    bend: Configuration | None = None,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    simulate: bool = False,
    follow: Follow | None = None,
    gears: Gears | None = None,
    scope: Scope | None = None,
    lumen: Lumen | None = None,
    start: float = 0.09,
    give_up: float = 10.0,
    timeout: float = 0.5,
    seconds: float | None = None,
    log: str | Path | None = None,
    notify: Callable[[LinkEvent], None] = silent,
    confirm: Callable[[OpenDevice], None] = agreed,
    look: Callable[[tuple[Run, Run], LinkAtWork], None] = lambda runs, link: None,
    ready: Callable[[int], None] = lambda port: None,
) -> SideReport:
    """Run the four drives of a gastroscope, which follow what comes over a network and send their load back.

    Parameters
    ----------
    feed, bend : Configuration, optional
        Drives for insertion and rotation, and for both bends, each pair on its own bus; default: `configuration`.
    host, port : str, int
        Where to listen; port 0 takes any free one.
    simulate : bool
        On simulated drives, with a gastroscope in a patient behind them.
    follow : Follow, optional
        How the drives follow, and how far.
    gears : Gears, optional
        What the cables move.
    scope, lumen, start : Scope, Lumen, float
        Simulated: the gastroscope, the patient, and the place of the camera at the start [m].
    give_up, timeout, seconds : float
        As `run_master`. Until a master has come, it waits.
    log : str or Path, optional
        File to record to, .mcap; the bends go to a file beside it, with "-bend" at the end of its name.
    notify, confirm, look : callable
        As `run_master`; `confirm` for both pairs before either has power, `look` with both runs.
    ready : callable
        Called with the UDP port when the drives have power.

    Raises
    ------
    ValueError
        For a sample time that differs, and as `run_master`.
    """
    from ebac.hardware import OpenDevice
    from ebac.hardware.patience import LONGEST_STEP, patient

    both = [configuration("feed") if feed is None else feed]
    both += [configuration("bend") if bend is None else bend]
    geared, known_scope = gears or Gears(), scope or Scope()
    if any(one.device.axes != 2 for one in both):
        raise ValueError(
            "feed, bend: must have 2 axes each, insertion and rotation, and both bends"
        )
    if both[0].timing.dt != both[1].timing.dt:
        raise ValueError(
            f"feed, bend: timing.dt = {both[0].timing.dt:g} s and {both[1].timing.dt:g} s: must be the same"
        )
    end = _core._slave_link(
        params=FarLink(timeout=timeout), dt=both[0].timing.dt, host=host, port=port
    )
    link = LinkAtWork(name="slave", end=end, give_up=give_up, notify=notify)
    worlds = _core._slave_worlds(end, follow or Follow(), geared)
    driven = None
    if simulate:
        inside = Lumen() if lumen is None else lumen
        driven = _core._DrivenScope(known_scope, inside.core, start, geared)
        stiffness = (
            known_scope.axial_stiffness * geared.insertion**2,
            known_scope.bend_stiffness * geared.bend**2,
        )
        both = [
            patient(one, pause=PAUSE).replace(
                hand=Hand(mass=0.0, damping=1.0, stiffness=k, path=Step(target=0.0))
            )
            for one, k in zip(both, stiffness, strict=True)
        ]
    names = (None, None) if log is None else (Path(log), _beside(Path(log)))
    devices: list[OpenDevice] = []
    started: dict[int, Run] = {}
    fault = Fault.NONE
    try:
        with ExitStack() as stack:
            for i, known in enumerate(both):
                more: dict[str, Any] = {}
                if driven is not None:
                    more = {"longest_step": LONGEST_STEP * known.timing.dt, "load": driven.load(i)}
                devices.append(stack.enter_context(OpenDevice(known, simulate=simulate, **more)))
                confirm(devices[i])
                stack.push(_end_of(started, i))  # while signals are still its own device's
            # None has power before all are confirmed. The first pair, which answers the master, comes last: what the
            # master asks before all follow would be made up for.
            for i in (1, 0):
                world = FarWorld(worlds[i], "the master")
                longest = seconds if seconds is None or i == 0 else seconds + _BEFORE
                started[i] = devices[i].start(None, world, seconds=longest, log=names[i])
            runs = [started[0], started[1]]
            ready(end.port)
            try:
                _watch_both(runs, link, look)
            except BaseException:
                for run in runs:  # both at once: neither pair goes on alone
                    run.stop(by="exception")
                raise
            fault = next((one for one in map(fault_of, runs) if one != Fault.NONE), Fault.NONE)
    finally:
        ended = all(run.report is not None for run in started.values())
        link.goodbye(fault if ended else Fault.DEVICE)
        link.look()
    return side_report(link, runs, fault, {} if driven is None else _scope_row(driven.report()))


def _end_of(started: dict[int, Run], i: int) -> Callable[..., None]:
    """Return what ends a run, if there is one by then."""

    def end(*raised: Any) -> None:
        if i in started:
            started[i].__exit__(*raised)

    return end


def _watch_both(
    runs: list[Run], link: LinkAtWork, look: Callable[[tuple[Run, Run], LinkAtWork], None]
) -> None:
    """Wait for the end of either loop; then the other one ends as well, at once where it was a fault."""
    one, other = runs

    def watch(run: Run) -> None:
        look((one, other), link)
        if not link.look():
            one.stop(by=link.ended_by)
        if other.done or one.done:
            one.stop(at_once=fault_of(other) != Fault.NONE, by="other drives")

    one.wait(look=watch)
    found = fault_of(one) or fault_of(other)
    if found:
        link.end.fail(Fault(found))
    other.stop(at_once=bool(found), by="other drives")
    other.wait()


def _scope_row(report: dict[str, Any]) -> dict[str, Any]:
    units = {"seconds": "s", "place": "m", "inserted": "m"}
    return {f"{key}_{units.get(key, 'N')}": value for key, value in report.items()}


def _beside(log: Path) -> Path:
    return log.with_name(f"{log.stem}-bend{log.suffix}")
