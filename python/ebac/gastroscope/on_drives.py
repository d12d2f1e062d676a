"""A joystick and a gastroscope on CANopen drives, each at its end of a network; here the joystick."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from ebac import _core
from ebac._core import FarLink, Fault, Master
from ebac._util.reach import check_reach
from ebac.gastroscope.drive_configurations import PAUSE, configuration
from ebac.gastroscope.far_side import FarWorld, LinkAtWork, LinkEvent, SideReport
from ebac.gastroscope.side_at_work import agreed, fault_of, side_report, silent
from ebac.gastroscope.slave_on_drives import run_slave

if TYPE_CHECKING:
    from ebac.hardware import Configuration, OpenDevice, Run
    from ebac.laws import AnyLaw


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
    notify: Callable[[LinkEvent], None] = silent,
    confirm: Callable[[OpenDevice], None] = agreed,
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
    from ebac.hardware.patience import LONGEST_STEP, patient

    if consent_after is not None and not simulate:
        raise ValueError(
            f"consent_after = {consent_after:g} s: only a simulated hand consents by itself; on your "
            "drives press Enter, or call `LinkAtWork.end.consent`"
        )
    check_reach(host, peer[0], "the slave")
    chosen = configuration("master") if known is None else known
    if simulate:
        chosen = patient(chosen, pause=PAUSE)
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
                fault = fault_of(run)  # before its end, which may raise for a log or a drive
    finally:
        # Whatever ended it: the other side gets to know.
        link.goodbye(fault if run is None or run.report is not None else Fault.DEVICE)
        link.look()
    return side_report(link, [run], fault)


__all__ = ["configuration", "run_master", "run_slave"]
