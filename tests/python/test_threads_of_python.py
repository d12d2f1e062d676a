"""Threads of Python beside those of the library: who waits for whom, and who holds the interpreter's lock meanwhile."""

import os
import shutil
import socket
import struct
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import ebac
from ebac.hardware import Configuration
from ebac.hardware.run_setup import run_setup, started
from ebac.sensor import SensorConfig

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
pytestmark = [pytest.mark.real_time, LINUX]


def output_of(code: str, *, tmp_path: Path, seconds: float = 60, **environment: str) -> str:
    """Output of Python code in a process of its own, which may hang."""
    file = tmp_path / "code.py"
    file.write_text(code, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(file)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=seconds,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


SLOW_RESOLVER = """
#include <dlfcn.h>
#include <netdb.h>
#include <string.h>
#include <unistd.h>

int getaddrinfo(const char* node, const char* service, const struct addrinfo* hints, struct addrinfo** found) {
  if (node != 0 && strcmp(node, "127.0.0.9") == 0) usleep(500000);
  int (*real)(const char*, const char*, const struct addrinfo*, struct addrinfo**) =
      (int (*)(const char*, const char*, const struct addrinfo*, struct addrinfo**))dlsym(RTLD_NEXT, "getaddrinfo");
  return real(node, service, hints, found);
}
"""

ASKS_A_SLOW_NAME_SERVER = """
import threading, time
from ebac import _core, teleop
from ebac.gastroscope import Follow

HOST = "127.0.0.9"


def sensor():
    ebac_sensor.SensorConfig(host=HOST).core()


def emulator():
    ebac_sensor.SimulatedSensor(host=HOST)


def link():
    _core._slave_link(params=_core.FarLink(), dt=1e-3, host=HOST, port=0)


from ebac import sensor as ebac_sensor

for ask in (sensor, emulator, link):
    thread = threading.Thread(target=ask)
    thread.start()
    ticks = 0
    while thread.is_alive():
        time.sleep(0.01)
        ticks += 1
    print(ask.__name__, ticks)
"""


def test_others_run_while_a_name_server_is_slow(tmp_path: Path) -> None:
    """The lock was held during getaddrinfo: no thread of Python ran, be it the one that stops a device."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        pytest.skip("needs a C compiler")
    source, library = tmp_path / "slow.c", tmp_path / "slow.so"
    source.write_text(SLOW_RESOLVER, encoding="utf-8")
    subprocess.run(
        [compiler, "-D_GNU_SOURCE", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True
    )
    shown = output_of(ASKS_A_SLOW_NAME_SERVER, tmp_path=tmp_path, LD_PRELOAD=str(library))
    ticks = dict(line.split() for line in shown.splitlines())
    assert ticks.keys() == {"sensor", "emulator", "link"}
    assert min(map(int, ticks.values())) > 5, shown


DROPS_A_SENSOR_WHOSE_THREAD_WAITS = """
import faulthandler, sys, time
import ebac
from ebac import _core, sensor

faulthandler.dump_traceback_later(20, exit=True)


class Hand:
    def force(self, t, x, v):
        return 1.0


scenario = ebac.Scenario(hand=ebac.Hand(model=Hand()), seconds=1)
work = _core.RdtEmulator(
    "127.0.0.1", 0, scenario.setup(), options=_core.EmulatorOptions(), rotation=[1.0, 0, 0, 0, 1, 0, 0, 0, 1],
    sign=1, model=_core.SensorModel.NET_FT, seed=1,
)
work.start()
time.sleep(0.1)
sys.setswitchinterval(60)
end = time.perf_counter() + 0.1
while time.perf_counter() < end:  # its thread now waits for the lock
    pass
del work
print("gone")
"""


def test_a_sensor_with_a_hand_in_python_may_be_dropped(tmp_path: Path) -> None:
    """Its end was waited for with the lock that its thread was waiting for."""
    assert output_of(DROPS_A_SENSOR_WHOSE_THREAD_WAITS, tmp_path=tmp_path) == "gone\n"


def stops(sensor: socket.socket) -> int:
    """Requests to stop the stream that wait at a socket."""
    sensor.settimeout(0.2)
    count = 0
    while True:
        try:
            header, command, _ = struct.unpack("!HHI", sensor.recv(64))
        except TimeoutError:
            return count
        assert header == 0x1234
        count += command == 0


def test_several_threads_may_wait_for_the_end_of_a_run() -> None:
    """Each of them stopped the stream of the sensor, at once: two threads wrote the state of one client."""
    known = Configuration.load(EXAMPLE)
    patient = known.limits.replace(overruns=100_000, pause=100, jump=1.0, speed=100.0)
    known = known.replace(silent=1000, limits=patient, soft_start=0.05, ramp_down=0.05, sensor=None)
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sensor,
        ebac.Device.open(known, simulate=True) as device,
    ):
        sensor.bind(("127.0.0.1", 0))
        host, port = sensor.getsockname()
        backend = replace(device.backend, sensor=SensorConfig(host=host, port=port))
        setup = run_setup(known, known.drives.nodes, backend=backend, seconds=0.2)
        running: Any = started(known.design(), backend, setup)
        together = threading.Barrier(4)

        def join() -> None:
            together.wait()
            running.join()

        threads = [threading.Thread(target=join) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        running.join()
        assert running.done
        assert stops(sensor) == 1
