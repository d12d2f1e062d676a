"""A program that ends with a bus open, or with threads still in C++, ends with its own exit code and prints nothing."""

import subprocess
import sys

import pytest

_READERS = {
    "notifier": "notifier = can.Notifier(bus, [lambda message: None])",
    "own thread": "threading.Thread(target=lambda: [bus.recv() for _ in iter(int, 1)], daemon=True).start()",
    "recv with a time": (
        "threading.Thread(target=lambda: [bus.recv(1e-3) for _ in iter(int, 1)], daemon=True).start()"
    ),
    "simulation": (
        "threading.Thread(target=lambda: [ebac.simulate(ebac.Scenario(seconds=0.01), 'direct') "
        "for _ in iter(int, 1)], daemon=True).start()"
    ),
    "drives": "drive = drives.DriveBus(bus).drive(1); drive.state",
    "second bus": "other = can.Bus(interface='ebac', channel='joystick'); can.Notifier([bus, other], [])",
    "periodic": "task = bus.send_periodic(can.Message(arbitration_id=0x80, is_extended_id=False), 1e-3)",
}
_ENDS = {"": 0, "sys.exit(3)": 3, "raise SystemExit('over')": 1}


@pytest.mark.parametrize("reader", _READERS)
@pytest.mark.slow
def test_a_program_that_leaves_its_bus_open_ends_in_silence(reader: str) -> None:
    # Every reader with one end, the first with each.
    turn = list(_READERS).index(reader)
    for end, code in list(_ENDS.items())[turn % 3 : turn % 3 + 1] if turn else _ENDS.items():
        program = (
            "import sys, threading, time, can, ebac\nfrom ebac import drives\n"
            "bus = can.Bus(interface='ebac', channel='joystick')\n"
            f"{_READERS[reader]}\ntime.sleep(0.02)\n{end}\n"
        )
        ended = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, timeout=60
        )
        assert (ended.returncode, ended.stdout) == (code, "")
        assert ended.stderr.strip() == ("over" if code == 1 else "")


def test_a_bus_can_be_shut_down_after_all_was_left() -> None:
    program = (
        "import atexit, can\nkept = []\natexit.register(lambda: kept[0].shutdown())\n"
        "kept.append(can.Bus(interface='ebac', channel='joystick'))\n"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")
