"""What a session runs, by what is chosen: configuration, law, world, device."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ebac._core import Fault
from ebac._util.plural import plural
from ebac.hardware import Configuration, OpenDevice, Run
from ebac.hardware.current_parameters import MOST_HELD_BACK
from ebac.hardware.law import designed
from ebac.hardware.patience import LONGEST_STEP, patient
from ebac.hardware.virtual_device import VirtualDevice
from ebac.laws import AnyLaw
from ebac.live.choices import CONFIGURED, Choices, base_of, world_of
from ebac.live.device_limits import DeviceLimits
from ebac.live.intended_hand import IntendedHand
from ebac.scenario import Environment, Scenario

#: Longest run [s].
LONGEST = 1e5


class SessionParts:
    """What is chosen, as parts of a run."""

    choices: Choices
    laws: dict[str, AnyLaw]
    hand: IntendedHand
    real: bool
    virtual: bool
    run: Run | None
    _given: Scenario | Configuration | None
    _device: OpenDevice | VirtualDevice | None
    _lent: bool
    _limits: DeviceLimits | None
    _clock: Callable[[], float]

    def _least_delay(self) -> int:
        """Return the delay of the bus [samples]: the rest is held back."""
        return base_of(self._given, self.choices.device).timing.delay

    def _chosen(self) -> Configuration:
        """Return the configuration of what is chosen."""
        from ebac import presets

        known = base_of(self._given, self.choices.device)
        if self.choices.hand != CONFIGURED:
            held = presets.HANDS[self.choices.hand].hand
            known = known.replace(hand=held.replace(path=list(known.hand.path)))
        observer: Any = self.choices.observer
        delay, least = self.choices.delay, known.timing.delay
        if not least <= delay <= least + MOST_HELD_BACK:
            raise ValueError(
                f"delay = {plural(delay, 'sample')}: must lie in [{least}, {least + MOST_HELD_BACK}] samples; drives "
                f"and bus take {least}, and at most {MOST_HELD_BACK} are added to them"
            )
        if not (self._lent or self.virtual):  # a machine may be late
            known = patient(known, pause=0.5)
        return known.replace(
            timing=known.timing.replace(delay=delay),
            observer=known.observer if bool(known.observer) == observer else observer,
            law=(law := self.laws[self.choices.law]),
            changes=known.changes if law == known.law else {},
        )

    def _law(self) -> Any:
        known = self._chosen()
        return designed(
            known.law,
            known.changes,
            known.device,
            known.timing,
            sensor=known.sensor is not None,
        )

    def _world(self) -> Any:
        return world_of(self.choices, base_of(self._given, self.choices.device).environment)

    @property
    def scenario(self) -> Scenario:
        """What runs, as a scenario: device, hand with its target, world, timing."""
        known = self._chosen()
        return known.scenario(seconds=6).replace(
            environment=self._world(),
            hand=self.hand.as_hand(known.hand),
        )

    def _begin_virtual(self) -> Run:
        known = self._chosen()
        device = VirtualDevice(known, delay=self._least_delay())
        run = device.start(self._law(), self._world())
        self._device = device
        self.hand = self._hand_of(known)
        self.hand.post = run.aim_now
        return run

    def _begin(self) -> Run:
        if self._device is None:
            known = self._chosen()
            self._device = OpenDevice(
                known, simulate=True, longest_step=LONGEST_STEP * known.timing.dt
            )
        device = self._device
        assert isinstance(device, OpenDevice)
        if device.report is not None and device.report.ended_by == "fault":
            if self.real:
                raise PermissionError(
                    "the last run ended by a fault: look at the device, end `ebac live`, start it again; it asks "
                    "for the zero anew"
                )
            device.reset()
        if self._limits is not None and self._world() != self._limits.configured:
            angles = [one.angle_rad for one in device.positions()]
            place = device.configuration.device.kinematics.forward(angles)
            self._limits.check_place(self._world(), [float(one) for one in place])
        if not self._lent:
            self.hand = self._hand_of(device.configuration)
            aim = device.backend.aim
            self.hand.post = None if aim is None else aim.post
        return device.start(self._law(), self._world(), seconds=LONGEST)

    def _hand_of(self, known: Configuration) -> IntendedHand:
        hand = self.hand
        return IntendedHand(known, goal=hand.goal, mode=hand.mode, clock=self._clock)

    def _check_world(self, world: Environment, *, another: bool) -> None:
        """Refuse what a device that was given does not allow, or another world that would push it out."""
        run = self.run
        if self._limits is None:
            return
        self._limits.check(world)
        if another and run is not None and not run.done:
            last = run.tail(1)
            self._limits.check_place(world, [float(one) for one in last["x"].reshape(-1)])

    @property
    def fault(self) -> Fault:
        """What ended the run, `Fault.NONE` while it runs."""
        last = None if self.run is None else self.run.tail(1)
        return Fault(int(last["fault"][-1])) if last is not None and len(last) else Fault.NONE
