"""Law or world changed as the hand lands, or by nothing: the wall stands, and the account is given nothing."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac.hardware.law import designed
from ebac.hardware.virtual_device import VirtualDevice, VirtualRun
from ebac.live.choices import CONFIGURED, base_of
from ebac.trace import Trace

SURFACE = 0.01  # m
HAND = ebac.Hand(mass=0.15, damping=6.0, stiffness=300.0, target=0.0)
Order = Callable[[VirtualRun], object]


def recorded(
    orders: dict[int, Order],
    *,
    law: str = "ebac",
    stiffness: float = 1e4,
    observer: bool = True,
    seconds: float = 1.2,
    speed: float = 0.5,
    hand: ebac.Hand = HAND,
    aim: Callable[[float], float] | None = None,
) -> Trace:
    """Return a run in which a hand lands with `speed` [m/s] or aims as told; `orders` come before their ticks."""
    scenario = ebac.Scenario(
        environment=ebac.Wall(stiffness=stiffness, position=SURFACE),
        hand=hand,
        device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)),
    )
    known = base_of(scenario, CONFIGURED).replace(
        observer=observer, seconds=seconds, memory=seconds + 1
    )
    device = VirtualDevice(known, delay=known.timing.delay)
    run = device.start(new_law(law, observer=observer), known.environment)
    for tick in range(round(1e3 * seconds)):
        t = 1e-3 * tick
        way = min(0.04, max(0.0, (t - 0.3) * speed)) if aim is None else aim(t)
        run.aim_now([way, np.nan, np.nan])
        if tick in orders:
            orders[tick](run)
        if not run.advance(1):
            break
    trace = run.tail(10**6)
    device.close()
    return trace


def new_law(name: str, *, observer: bool) -> ebac.laws.CoreLaw:
    return designed(name, {}, ebac.Device(), ebac.Timing(), sensor=observer)


def landing(trace: Trace) -> int:
    return int(np.argmax(trace.axis("f_env", 0) > 0))


def depth(trace: Trace) -> float:
    return float(trace.axis("true.x", 0).max()) - SURFACE


@pytest.mark.parametrize("observer", [True, False])
@pytest.mark.parametrize(
    ("before", "after"),
    [("tca-damped", "ebac"), ("ebac", "tca-damped"), ("eba", "lag-compensator")],
)
def test_a_law_changed_just_before_a_landing_has_its_whole_force(
    before: str, after: str, observer: bool
) -> None:
    alone = recorded({}, law=before, observer=observer)
    most = max(depth(alone), depth(recorded({}, law=after, observer=observer)))
    for ms in (-1, 0, 1, 10, 30):
        order: Order = lambda run: run.replace_law(new_law(after, observer=observer))  # noqa: E731
        changed = recorded({landing(alone) - ms: order}, law=before, observer=observer)
        assert depth(changed) < most + 1e-3, (
            ms
        )  # m; up to 28 mm where a fade held the law's force back


@pytest.mark.parametrize("observer", [True, False])
@pytest.mark.parametrize("law", ["ebac", "tca-damped"])
def test_the_same_world_again_changes_no_bit(law: str, observer: bool) -> None:
    alone = recorded({}, law=law, observer=observer)
    again: Order = lambda run: run.change()  # noqa: E731
    changed = recorded({landing(alone): again, 900: again}, law=law, observer=observer)
    for name in ("f_cmd", "true.x", "f_env"):
        assert np.array_equal(changed[name], alone[name]), name


@pytest.mark.parametrize("observer", [True, False])
def test_a_world_that_hardly_changes_as_the_hand_lands_stands(observer: bool) -> None:
    alone = recorded({}, stiffness=2e4, observer=observer, speed=0.8)
    for ms in (-2, -1, 0, 1, 2):
        order: Order = lambda run: run.change(stiffness=20_010.0)  # noqa: E731
        changed = recorded(
            {landing(alone) + ms: order}, stiffness=2e4, observer=observer, speed=0.8
        )
        assert depth(changed) < depth(alone) + 2e-4, (
            ms
        )  # m; 11 to 14 mm where the landing was faded in


def test_changes_of_nothing_pay_no_account() -> None:
    """A press of 6 N shaken at 280 Hz by 9 N draws on the account until the watchdog ends it."""
    hand = ebac.Hand(mass=0.3, damping=5.0, stiffness=100.0, target=0.0)

    def aim(t: float) -> float:
        swing = 1.5 * np.sin(2 * np.pi * 280 * t) if t > 0.5 else 0.0
        return min(1.0, t / 0.3) * SURFACE + min(1.0, max(0.0, (t - 0.2) / 0.3)) * 0.06 * (
            1 + swing
        )

    alone = recorded({}, hand=hand, aim=aim, seconds=12.0)
    order: Order = lambda run: run.change(stiffness=1e4 + 0.01 * (run.ticks % 2))  # noqa: E731
    changed = recorded(
        dict.fromkeys(range(1000, 12_000, 55), order), hand=hand, aim=aim, seconds=12.0
    )
    assert drawn(alone) < 5e-3
    assert drawn(changed) < 5e-3  # J; 70 mJ where every change filled the account up


def drawn(trace: Trace) -> float:
    """Return the most energy that was taken out within any time [J]."""
    energy = trace.axis("true.energy", 0)
    return float((np.maximum.accumulate(energy) - energy).max())


@pytest.mark.slow
def test_every_change_is_told_however_many_there_are() -> None:
    told = []

    def order(run: VirtualRun) -> None:
        run.change(stiffness=1e4 + run.ticks % 2)
        run.change(stiffness=1.1e4 + run.ticks % 2)  # the one before is replaced, and never acts
        told.extend(run._parameters.updates.events())

    def last(run: VirtualRun) -> None:
        told.extend(run._parameters.updates.events())
        assert not run._parameters.updates._notes
        assert run._running.changes_lost == 0

    recorded({**dict.fromkeys(range(4500), order), 4505: last}, seconds=4.6)
    assert [one.tick for one in told] == list(range(4500))
    assert {one.values["environment.stiffness"] for one in told} == {11_000.0, 11_001.0}


def test_a_run_that_was_changed_is_measured_but_not_judged_exact(tmp_path: Path) -> None:
    order: Order = lambda run: run.change(stiffness=2e4)  # noqa: E731
    for orders, exact in (({}, True), ({100: order}, False)):
        trace = recorded(orders, seconds=3.0)
        assert trace.changed is not exact
        for ending in ("mcap", "npz"):
            trace.save(tmp_path / f"one.{ending}")
            kept = ebac.load(tmp_path / f"one.{ending}")
            assert kept.changed is not exact
            assert (ebac.contact(kept).ideal_m is not None) is exact


@pytest.mark.parametrize(
    ("order", "says"),
    [
        (lambda run: run.change(3), "change takes a world"),
        (
            lambda run: run.change(stiffness=True),
            r"environment\.stiffness = True: must be a number",
        ),
        (lambda run: run.hold_back(1.5), r"hold_back = 1\.5: must be a whole number"),
        (lambda run: run.hold_back("x"), "hold_back = 'x': must be a whole number"),
        (
            lambda run: run.replace_law(
                designed("ebac", {}, ebac.Device(), ebac.Timing(dt=5e-4), sensor=True)
            ),
            r"law\.timing\.dt = 0\.0005 s: the loop has a tick every 0\.001 s",
        ),
    ],
)
def test_what_cannot_be_changed_is_named(order: Order, says: str) -> None:
    def refused(run: VirtualRun) -> None:
        with pytest.raises((TypeError, ValueError), match=says):
            order(run)

    assert not recorded({5: refused}, seconds=0.05).changed
