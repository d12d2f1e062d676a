"""A bus with simulated drives at its other end; time passes when a test says so."""

from __future__ import annotations

import queue

import can

from ebac._core import Joystick, SimulatedDrive


class SimulatedBus(can.BusABC):
    """What is sent reaches the drives at once, and takes `per_frame` seconds of their time."""

    def __init__(self, drives: SimulatedDrive | Joystick, per_frame: float = 0.0) -> None:
        self.drives = drives
        self.per_frame = per_frame
        self.heard: queue.Queue[can.Message] = queue.Queue()
        self.channel_info = "simulated drives"
        super().__init__(channel=0)
        self.elapse(0)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self.drives.receive(msg.arbitration_id, bytes(msg.data or b""), remote=msg.is_remote_frame)
        if self.per_frame > 0:
            self.drives.elapse(self.per_frame)
        self._listen()

    def elapse(self, seconds: float) -> None:
        self.drives.elapse(seconds)
        self._listen()

    def _listen(self) -> None:
        for identifier, data in self.drives.take():
            self.heard.put(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        try:
            return self.heard.get(timeout=timeout), False
        except queue.Empty:
            return None, False
