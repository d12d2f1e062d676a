"""A joystick and a gastroscope on CANopen drives, each at its end of a network."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from importlib.resources import files
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac import _core
from ebac._core import FarLink, Fault, Follow, Gears, Hand, Master, Scope, Step
from ebac._util.reach import check_reach
from ebac.gastroscope.far_side import FarWorld, LinkAtWork, LinkEvent, SideReport
from ebac.gastroscope.lumen import Lumen

if TYPE_CHECKING:
    from ebac.hardware import Configuration, OpenDevice, Run
    from ebac.laws import AnyLaw

#: A simulated device moves at most so many ticks from one tick to the next, however late its loop is.
LONGEST_STEP = 2
#: Ticks in a row without an answer, or too late, that simulated drives bear: their machine is not made for it.
PATIENCE = 200
#: How often somebody looks after the loops [s].
LOOK = 0.02
#: The second pair of the slave has power earlier than the first, by at most this [s], and ends with it.
_BEFORE = 10.0


def configuration(part: str) -> Configuration:
    """Return a configuration that comes with `ebac`: "master", "feed" or "bend". `ebac demo` writes them.

    Raises
    ------
    KeyError
        For another name.
    """
    from ebac.hardware import Configuration

    if part not in ("master", "feed", "bend"):
        raise KeyError(f"no configuration of a gastroscope is called {part!r}: master, feed, bend")
    text = (files("ebac.datasets") / f"gastroscope-{part}.toml").read_text(encoding="utf-8")
    return Configuration.from_toml(text, name=f"gastroscope-{part}.toml")


def patient(known: Configuration) -> Configuration:
    """Return the configuration with limits of time that a machine without real time keeps; for simulated drives."""
    limits = known.limits.replace(watch_motion=False, overruns=PATIENCE, pause=10.0, force_age=0.2)
    return known.replace(silent=PATIENCE, limits=limits)


def _silent(event: LinkEvent) -> None:
    """Report nothing."""


def _agreed(device: OpenDevice) -> None:
    """Ask nobody."""


def run_master(
    known: Configuration | None = None,
    *,
    peer: tuple[str, int],
    law: AnyLaw | None = None,
    mapping: Master | None = None,
    host: str = "127.0.0.1",
    port: int = 0,
    simulate: bool = False,
    consent_after: float | None = None,
    give_up: float = 10.0,
    timeout: float = 0.5,
    seconds: float | None = None,
    log: str | Path | None = None,
    notify: Callable[[LinkEvent], None] = _silent,
    confirm: Callable[[OpenDevice], None] = _agreed,
    look: Callable[[Run, LinkAtWork], None] = lambda run, link: None,
) -> SideReport:
    """Run a joystick on its drives, as `OpenDevice.run`, with a gastroscope at the other end of a network as its world.

    Parameters
    ----------
    known : Configuration, optional
        The joystick; default: `configuration("master")`.
    peer : tuple of str and int
        Address and UDP port of the slave, or of a network before it.
    law : law, optional
        One of the core; that of the configuration, if not given.
    mapping : Master, optional
        From the handle to the gastroscope and back; its delay is not used.
    host, port : str, int
        Where to listen; port 0 takes any free one.
    simulate : bool
        On simulated drives, device and hand.
    consent_after : float, optional
        With `simulate`: a simulated hand consents so long after the link is back [s]; default: only
        `LinkAtWork.end.consent`.
    give_up : float
        After so long without a link the run ends [s].
    timeout : float
        Silence after which the link counts as lost [s], 0.01 to 10.
    seconds : float, optional
        How long it runs [s]; that of the configuration, if not given.
    log : str or Path, optional
        File to record to, .mcap; must not exist.
    notify, confirm, look : callable
        Called with each event; with the open device, before it has power; 50 times a second with run and link.
        While `notify` or `look` does not return, nobody gives up a lost link or hears of a fault elsewhere.

    Raises
    ------
    ValueError
        For `consent_after` without `simulate`, and for a `host` from which no other machine is reached.
    OSError
        Where the port cannot be had.
    PositionError, DriveError, ConfigurationError
        As `OpenDevice`.
    """
    from ebac.hardware import OpenDevice

    if consent_after is not None and not simulate:
        raise ValueError(
            f"consent_after = {consent_after:g} s: only a simulated hand consents by itself; on your "
            "drives press Enter, or call `LinkAtWork.end.consent`"
        )
    check_reach(host, peer[0], "the slave")
    chosen = configuration("master") if known is None else known
    if simulate:
        chosen = patient(chosen)
    params = FarLink(timeout=timeout, consent_after=inf if consent_after is None else consent_after)
    end = _core._master_link(params=params, dt=chosen.timing.dt, host=host, port=port, peer=peer)
    link = LinkAtWork(name="master", end=end, give_up=give_up, notify=notify)
    world = FarWorld(_core._master_world(end, mapping or Master()), "the slave")
    step = LONGEST_STEP * chosen.timing.dt if simulate else None
    fault, run = Fault.NONE, None
    try:
        with OpenDevice(chosen, simulate=simulate, longest_step=step) as device:
            confirm(device)
            run = device.start(law, world, seconds=seconds, log=log)
            with run:

                def watch(run: Run) -> None:
                    look(run, link)
                    if not link.look():
                        run.stop(by=link.ended_by)

                run.wait(look=watch)
                fault = _fault_of(run)  # before its end, which may raise for a log or a drive
    finally:
        # Whatever ended it: the other side gets to know.
        link.goodbye(fault if run is None or run.report is not None else Fault.DEVICE)
        link.look()
    return _side(link, [run], fault)


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
    notify: Callable[[LinkEvent], None] = _silent,
    confirm: Callable[[OpenDevice], None] = _agreed,
    look: Callable[[tuple[Run, Run], LinkAtWork], None] = lambda runs, link: None,
    ready: Callable[[int], None] = lambda port: None,
) -> SideReport:
    """Run the four drives of a gastroscope, which follow what comes over a network and send their load back.

    Parameters
    ----------
    feed, bend : Configuration, optional
        Drives for insertion and rotation, and for both bends, each pair on a bus of its own; default: `configuration`.
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
            patient(one).replace(
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
            fault = next((one for one in map(_fault_of, runs) if one != Fault.NONE), Fault.NONE)
    finally:
        ended = all(run.report is not None for run in started.values())
        link.goodbye(fault if ended else Fault.DEVICE)
        link.look()
    return _side(link, runs, fault, {} if driven is None else _scope_row(driven.report()))


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
            one.stop(at_once=_fault_of(other) != Fault.NONE, by="other drives")

    one.wait(look=watch)
    found = _fault_of(one) or _fault_of(other)
    if found:
        link.end.fail(Fault(found))
    other.stop(at_once=bool(found), by="other drives")
    other.wait()


def _fault_of(run: Run) -> Fault:
    """Return the fault in the newest row of a run."""
    last = run.tail(1)
    return Fault(int(last["fault"][-1])) if len(last) else Fault.NONE


def _side(
    link: LinkAtWork, runs: Sequence[Run | None], fault: Fault, scope: dict[str, Any] | None = None
) -> SideReport:
    known = [run for run in runs if run is not None]
    reports = [run.report for run in known if run.report is not None]
    ended = [one.ended_by for one in reports if one.ended_by not in ("other drives", "time")]
    by = "fault" if fault != Fault.NONE else link.ended_by or (ended[0] if ended else "time")
    late = [run.trace()["lateness"] for run in known]
    return SideReport(
        name=link.name,
        ended_by=by,
        fault=fault,
        report=dict(link.end.report()),
        events=tuple(link.events),
        drives=tuple(state for one in reports for state in one.drives),
        logs=tuple(str(one.log) for one in reports if one.log is not None),
        skipped=sum(int(run.trace()["skipped"].sum()) for run in known),
        latest=max((float(one.max()) for one in late if len(one)), default=0.0),
        scope=scope or {},
    )


def _scope_row(report: dict[str, Any]) -> dict[str, Any]:
    units = {"seconds": "s", "place": "m", "inserted": "m"}
    return {f"{key}_{units.get(key, 'N')}": value for key, value in report.items()}


def _beside(log: Path) -> Path:
    return log.with_name(f"{log.stem}-bend{log.suffix}")


__all__ = ["configuration", "patient", "run_master", "run_slave"]
