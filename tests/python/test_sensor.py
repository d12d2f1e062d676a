"""The force/torque sensor: packets, configuration, and reading one over loopback."""

from __future__ import annotations

import math
import socket
import struct
import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebac
from ebac import _core, presets
from ebac.sensor import (
    EmulatorOptions,
    EmulatorTrouble,
    LinkState,
    Sensor,
    SensorConfig,
    SensorError,
    SensorStatus,
    SharedForce,
    SimulatedSensor,
    explain,
)

U16, U32 = st.integers(0, 2**16 - 1), st.integers(0, 2**32 - 1)
I32 = st.integers(-(2**31), 2**31 - 1)
TURNED = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


@given(U32, U32, U32, st.lists(I32, min_size=6, max_size=6))
def test_a_record_is_the_bytes_of_the_manual_and_back(
    rdt: int, ft: int, status: int, counts: list[int]
) -> None:
    data = _core._encode_record(rdt, ft, status, counts[:3], counts[3:])
    assert data == struct.pack(">III6i", rdt, ft, status, *counts)
    assert _core._decode_record(data) == (rdt, ft, status, counts[:3], counts[3:])


@given(U16, U32)
def test_a_request_is_the_bytes_of_the_manual(command: int, samples: int) -> None:
    assert _core._encode_request(command, samples) == struct.pack(">HHI", 0x1234, command, samples)


@given(st.binary(max_size=80).filter(lambda data: len(data) != 36))
def test_other_lengths_are_no_record(data: bytes) -> None:
    with pytest.raises(ValueError, match=f"{len(data)} bytes are no record: must be 36"):
        _core._decode_record(data)


def rotation(numbers: list[float]) -> np.ndarray:
    """Return a rotation made of any nine numbers."""
    q, _ = np.linalg.qr(np.asarray(numbers).reshape(3, 3) + 2 * np.eye(3))
    return q * np.sign(np.linalg.det(q))


@given(st.lists(st.floats(-1, 1), min_size=9, max_size=9))
def test_every_rotation_is_taken_and_what_is_none_refused(numbers: list[float]) -> None:
    turned = rotation(numbers)
    config = SensorConfig(rotation=turned)  # type: ignore[arg-type]
    assert np.array_equal(config.rotation, turned)
    with pytest.raises(ValueError, match="mirror"):
        SensorConfig(rotation=(-turned).tolist())
    with pytest.raises(ValueError, match=r"rows \d and \d have the product"):
        SensorConfig(rotation=(1.001 * turned).tolist())


@pytest.mark.parametrize(
    ("wrong", "error", "message"),
    [
        ({"host": ""}, TypeError, "sensor.host = ''"),
        ({"host": 5}, TypeError, "sensor.host = 5"),
        ({"port": 0}, ValueError, r"sensor.port = 0: must lie in \[1, 65535\]"),
        ({"port": 65536}, ValueError, "sensor.port = 65536"),
        ({"port": True}, TypeError, "sensor.port = True"),
        ({"model": "mini45"}, ValueError, "there are: net-ft, axia, other"),
        ({"counts_per_force": 0.0}, ValueError, r"sensor.counts_per_force = 0 1/N: must lie in"),
        ({"counts_per_torque": float("nan")}, ValueError, "sensor.counts_per_torque = nan"),
        ({"force_range": -1.0}, ValueError, r"sensor.force_range = -1 N"),
        ({"force_range": "all"}, TypeError, "sensor.force_range = 'all'"),
        ({"rotation": ((1, 0), (0, 1))}, TypeError, "must be 3 rows of 3 numbers"),
        ({"rotation": "none"}, TypeError, "must be 3 rows of 3 numbers"),
        ({"rotation": ((1, 0, 0), (0, 1, 0), (0, 0, None))}, TypeError, "has None"),
        ({"rotation": ((1, 0, 0), (0, 1, 0), (0, 0, float("inf")))}, ValueError, "has inf"),
        ({"sign": 0}, ValueError, "sensor.sign = 0"),
        ({"bias": (1.0,)}, TypeError, "must be 6 numbers"),
        ({"retry": 0.0}, ValueError, r"sensor.retry = 0 s: must lie in \[0.001, 60\] s"),
        ({"gone": float("nan")}, ValueError, "sensor.gone = nan s"),
    ],
)
def test_a_configuration_says_what_is_wrong(
    wrong: dict[str, object], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        SensorConfig(**wrong)  # type: ignore[arg-type]


def test_a_configuration_takes_numbers_of_numpy() -> None:
    bias = (np.float32(1.5), *[np.int64(0)] * 5)
    whole = {"port": np.int64(5), "http_port": np.uint16(0), "sign": np.int8(-1)}
    other = {
        "counts_per_force": np.float32(1e5),
        "force_range": np.int64(100),
        "retry": np.float64(0.5),
    }
    made = SensorConfig(**whole, **other, bias=bias)  # type: ignore[arg-type]
    assert made == SensorConfig(
        port=5,
        http_port=0,
        sign=-1,
        counts_per_force=1e5,
        force_range=100,
        retry=0.5,
        bias=(1.5, 0, 0, 0, 0, 0),
    )
    assert {type(value) for value in (*vars(made).values(), *made.bias)} <= {int, float, str, tuple}
    with pytest.raises(TypeError, match=r"sensor\.port = 5\.0: must be a whole number"):
        SensorConfig(port=np.float32(5))  # type: ignore[arg-type]


def test_a_configuration_is_read_from_its_table() -> None:
    bias = (1.0, 0.0, 0.0, 0.0, 0.0, 0.5)
    table = {"host": "10.0.0.7", "rotation": [list(row) for row in TURNED], "bias": list(bias)}
    config = SensorConfig(host="10.0.0.7", rotation=TURNED, bias=bias)
    assert SensorConfig.from_table(table) == config
    with pytest.raises(ValueError, match="did you mean 'port'"):
        SensorConfig.from_table({"prt": 1})


def test_bits_have_names() -> None:
    assert explain(0) == []
    assert explain(0x80020000) == ["saturated, or a converter's error"]
    assert explain(0x80000000) == ["an error"]
    assert explain(0xC0000000, "axia") == ["force or torque out of range"]
    assert explain(0x00000006, "other") == ["bit 2", "bit 1"]


# --- over loopback ---


@pytest.fixture
def pushed() -> Iterator[SimulatedSensor]:
    """Give a simulated sensor that feels 3 N, -2 N, 1 N, with 7 N of load on its z axis."""
    options = EmulatorOptions(rate=2000, load=7)
    with SimulatedSensor((3.0, -2.0, 1.0), options=options) as sensor:
        yield sensor


def test_the_force_of_the_hand_arrives(pushed: SimulatedSensor) -> None:
    with Sensor.open(pushed.config) as sensor:
        reading = sensor.read()
        assert reading.force == (3.0, -2.0, 8.0)
        assert reading.torque == pytest.approx((0.04, 0.06, 0.0))  # the hand holds 20 mm ahead
        assert reading.health is SensorStatus.GOOD
        assert 0 <= reading.age < 0.5
        assert sensor.state is LinkState.STREAMING
        later = sensor.read()
        assert later.rdt_sequence > reading.rdt_sequence
        assert sensor.counts.received >= 2
    assert sensor.state is LinkState.CLOSED
    with pytest.raises(SensorError, match="it is closed"):
        sensor.read()


def test_what_acts_now_is_zero(pushed: SimulatedSensor) -> None:
    with Sensor.open(pushed.config) as sensor:
        with pytest.raises(SensorError, match="a load acts on the sensor"):
            sensor.bias(100)  # 8.8 N
        assert sensor.read().force == (3.0, -2.0, 8.0)
        bias = sensor.bias(100, accept_load=True)
        assert bias == pytest.approx((3, -2, 8, 0.04, 0.06, 0))
        assert sensor.read().force == (0.0, 0.0, 0.0)
    with Sensor.open(pushed.config, bias=bias) as sensor:  # kept for the next run
        assert sensor.read().force == pytest.approx((0, 0, 0), abs=1e-9)
    with Sensor.open(pushed.config) as sensor:
        with pytest.raises(SensorError, match=r"8\.77 N: must be at most 7\.25 N \(5 % of 145 N"):
            sensor.bias_inside()
        sensor.bias_inside(accept_load=True)
        deadline = time.monotonic() + 5
        while sensor.read().force != (0.0, 0.0, 0.0):
            assert time.monotonic() < deadline


@pytest.mark.parametrize("configured", [False, True])
def test_the_zero_inside_the_sensor_takes_the_place_of_the_one_here(configured: bool) -> None:
    """It counts from what acts, not from what is left of it here, and is not taken off twice."""
    with SimulatedSensor((8.0, 0.0, 0.0), rotation=TURNED, sign=-1) as simulated:
        with Sensor.open(simulated.config) as plain:
            zero = plain.bias(50, accept_load=True)
        with Sensor.open(simulated.config, bias=zero if configured else (0.0,) * 6) as sensor:
            if not configured:
                sensor.bias(50, accept_load=True)
            assert sensor.read().force == pytest.approx((0, 0, 0), abs=1e-9)
            with pytest.raises(SensorError, match=r"a load acts on the sensor, 8 N: must be at mo"):
                sensor.bias_inside(50)
            assert sensor.read().force == pytest.approx((0, 0, 0), abs=1e-9)
            before = sensor.counts
            sensor.bias_inside(50, accept_load=True)
            assert sensor.config.bias == (0.0,) * 6
            assert sensor.counts.received > before.received
            deadline = time.monotonic() + 5
            while sensor.read().force != (0.0, 0.0, 0.0):
                assert time.monotonic() < deadline


def test_a_load_is_measured_by_the_range_of_the_sensor() -> None:
    with (
        SimulatedSensor((3.0, 0.0, 0.0)) as simulated,
        Sensor.open(simulated.config, force_range=50) as sensor,
    ):
        with pytest.raises(
            SensorError, match=r"3 N: must be at most 2\.5 N \(5 % of sensor\.force"
        ):
            sensor.bias(50)
        with pytest.raises(ValueError, match=r"records = 0: must lie in \[1, 1000000\]"):
            sensor.bias(0)


def test_a_hand_at_the_handle_is_no_zero() -> None:
    """It trembles: 10 Hz, with an amplitude of 1 N."""
    shared = SharedForce([1.0, 0.0, 0.0])
    over = threading.Event()

    def tremble() -> None:
        while not over.wait(1e-3):
            shared.post([1 + math.sin(2 * math.pi * 10 * time.monotonic()), 0.0, 0.0])

    thread = threading.Thread(target=tremble)
    with SimulatedSensor(shared) as simulated, Sensor.open(simulated.config) as sensor:
        thread.start()
        try:
            with pytest.raises(SensorError, match=r"not still, its standard deviation is 0\.\d+ N"):
                sensor.bias(50, timeout=10, accept_load=True)
            with pytest.raises(SensorError, match="not still"):
                sensor.bias_inside(50, timeout=10)
            zero = sensor.bias(500, timeout=10, accept_unsteady=True)
            assert zero[0] == pytest.approx(1, abs=0.6)
        finally:
            over.set()
            thread.join()


def test_a_hand_that_comes_while_zero_is_taken_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """After the reading was watched, and before the mean is complete."""
    shared = SharedForce()
    with SimulatedSensor(shared) as simulated, Sensor.open(simulated.config) as sensor:
        rest = sensor.rest(10, timeout=10)
        assert rest.mean[:3] == (0.0, 0.0, 0.0)
        monkeypatch.setattr(Sensor, "rest", lambda *_, **__: rest)
        shared.post([3.0, 0.0, 0.0])
        with pytest.raises(
            SensorError, match=r"changed meanwhile, by 3 N: must be at most 1\.45 N"
        ):
            sensor.bias(100_000, timeout=10)
        assert sensor.read(10).force == (3.0, 0.0, 0.0)  # the zero is what it was


def test_rest_is_in_the_axes_of_the_sensor() -> None:
    with (
        SimulatedSensor((3.0, -2.0, 1.0), rotation=TURNED, sign=-1) as simulated,
        Sensor.open(simulated.config) as sensor,
    ):
        found = sensor.rest(10)
        assert found.mean == pytest.approx(sensor.bias(10))
        assert found.mean[:3] == pytest.approx((2, -1, -3))
        assert found.force_spread == pytest.approx(0)


def test_the_axes_of_the_sensor_are_turned_into_the_handles() -> None:
    with SimulatedSensor((3.0, -2.0, 1.0), rotation=TURNED, sign=-1) as simulated:
        assert simulated.config.rotation == TURNED
        with Sensor.open(simulated.config) as sensor:
            assert sensor.read().force == pytest.approx((3, -2, 1))
        with Sensor.open(simulated.config, rotation=SensorConfig().rotation, sign=1) as sensor:
            assert sensor.read().force == pytest.approx((2, -1, -3))  # as the sensor tells it


def test_losses_are_counted_exactly() -> None:
    # The system's queue holds the records of half a second: who reads is kept waiting so long by no machine of ours.
    with SimulatedSensor(options=EmulatorOptions(rate=500)) as simulated:
        with Sensor.open(simulated.config) as sensor:
            simulated.inject(EmulatorTrouble(loss=0.2, duplicate=0.2, reorder=0.2))
            for _ in range(200):
                sensor.read()
            simulated.inject(EmulatorTrouble())
            time.sleep(0.05)
            for _ in range(5):  # what was held back has left before these
                sensor.read()
            counts, did = sensor.counts, simulated.counts
        assert did.dropped > 20
        assert counts.lost == did.dropped
        assert counts.late == did.swapped
        assert counts.duplicate == did.doubled


def test_a_sensor_that_is_unwell_is_told_and_no_zero(pushed: SimulatedSensor) -> None:
    with Sensor.open(pushed.config) as sensor:
        pushed.inject(EmulatorTrouble(status=0x80020000))
        deadline = time.monotonic() + 5
        while (reading := sensor.read()).health is SensorStatus.GOOD:
            assert time.monotonic() < deadline
        assert reading.health is SensorStatus.SATURATED
        with pytest.raises(SensorError, match=r"0x80020000 \(saturated, or a converter's error\)"):
            sensor.bias(10, timeout=0.1)
        pushed.inject(EmulatorTrouble(status=0x80000004))
        while (reading := sensor.read()).health is SensorStatus.SATURATED:
            assert time.monotonic() < deadline
        assert reading.health is SensorStatus.ERROR


def test_a_zero_that_was_given_up_is_not_taken_later(pushed: SimulatedSensor) -> None:
    with Sensor.open(pushed.config) as sensor:
        pushed.inject(EmulatorTrouble(status=0x80020000))
        deadline = time.monotonic() + 5
        while sensor.read().health is SensorStatus.GOOD:
            assert time.monotonic() < deadline
        with pytest.raises(SensorError):
            sensor.bias(10, timeout=0.1)
        pushed.inject(EmulatorTrouble())
        while sensor.read().health is not SensorStatus.GOOD:
            assert time.monotonic() < deadline
        for _ in range(30):  # more than the zero asked for
            assert sensor.read().force == (3.0, -2.0, 8.0)


def test_what_waited_in_a_queue_is_not_what_acts_now() -> None:
    with (
        SimulatedSensor(options=EmulatorOptions(rate=7000)) as simulated,
        Sensor.open(simulated.config) as sensor,
    ):
        time.sleep(0.3)
        assert sensor.read().age < 0.1
        assert sensor.counts.lost > 0  # the queue ran over


def test_too_much_force_saturates() -> None:
    with (
        SimulatedSensor((200.0, 0.0, 0.0)) as simulated,
        Sensor.open(simulated.config) as sensor,
    ):
        reading = sensor.read()
        assert reading.health is SensorStatus.SATURATED
        assert reading.force[0] == 145


def test_silence_says_what_to_check(pushed: SimulatedSensor) -> None:
    with Sensor.open(pushed.config) as sensor:
        pushed.inject(EmulatorTrouble(silent=True))
        time.sleep(0.2)
        assert sensor.latest.age > 0.05  # what was under way is read
        with pytest.raises(SensorError, match=r"nothing for 0.8 s: its records stopped"):
            sensor.read(timeout=0.8)
        assert sensor.latest.health is SensorStatus.DISCONNECTED
        pushed.inject(EmulatorTrouble())
        assert sensor.read().health is SensorStatus.GOOD
        assert sensor.counts.asked > 1


def test_nobody_there_says_what_to_check() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        with pytest.raises(SensorError, match="no answer; check its power and cable"):
            Sensor.open(host="127.0.0.1", port=port, timeout=0.1)
    with pytest.raises(SensorError, match="nobody listens at that port"):
        Sensor.open(host="127.0.0.1", port=port, timeout=0.6)
    with pytest.raises(ValueError, match="no such host"):
        Sensor.open(host="no.such.host.invalid")
    with pytest.raises(ValueError, match=r"read.timeout = -1 s"):
        Sensor.open(host="127.0.0.1", timeout=-1)


def test_an_address_that_is_taken_is_refused(pushed: SimulatedSensor) -> None:
    with pytest.raises(OSError, match="the port is taken"):
        SimulatedSensor(port=pushed.address[1])
    with pytest.raises(OSError, match="has no such address"):
        SimulatedSensor(host="192.0.2.1")
    with pytest.raises(TypeError, match=r"sensor.source = \(1.0, 2.0\): must be 3 numbers"):
        SimulatedSensor((1.0, 2.0))
    with pytest.raises(ValueError, match=r"sensor.source has nan: must be finite"):
        SimulatedSensor((1.0, 2.0, float("nan")))


def test_a_program_that_knows_only_the_protocol_is_served(pushed: SimulatedSensor) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.settimeout(5)
        client.sendto(struct.pack(">HHI", 0x1234, 2, 3), pushed.address)
        records = [struct.unpack(">III6i", client.recv(100)) for _ in range(3)]
        assert [record[0] for record in records] == [1, 2, 3]
        assert records[0][2:] == (0, 3_000_000, -2_000_000, 8_000_000, 40_000, 60_000, 0)
        client.sendto(b"GET / HTTP/1.1", pushed.address)
        client.sendto(struct.pack(">HHI", 0x1234, 3, 20), pushed.address)  # ten a packet
        assert [len(client.recv(1000)) for _ in range(2)] == [360, 360]
    assert pushed.counts.refused == 1


def test_it_feels_the_hand_of_a_scenario() -> None:
    scenario = ebac.Scenario(hand=presets.hand("reference"))
    with SimulatedSensor(scenario) as simulated, Sensor.open(simulated.config) as sensor:
        assert max(sensor.read().force[0] for _ in range(50)) > 1  # the hand pulls the device away


def test_it_feels_the_hand_on_simulated_drives() -> None:
    cell = SharedForce()
    joystick = _core.Joystick(ebac.Scenario().setup(), force=cell)
    with SimulatedSensor(cell) as simulated, Sensor.open(simulated.config) as sensor:
        for _ in range(5):
            joystick.elapse(0.01)
        felt = joystick.truth(0).f_sensor
        assert felt > 1
        deadline = time.monotonic() + 5
        while abs(sensor.read().force[0] - felt) > 1e-6:
            assert time.monotonic() < deadline


@settings(max_examples=30)
@given(st.floats(), st.floats())
def test_troubles_lie_in_their_ranges(loss: float, status: float) -> None:
    if not 0 <= loss <= 1:
        with pytest.raises(ValueError, match=r"EmulatorTrouble.loss = .*: must lie in \[0, 1\]"):
            EmulatorTrouble(loss=loss)


def test_a_status_is_explained_for_a_known_model_only() -> None:
    with pytest.raises(ValueError, match=r"model 'axai': no such name, did you mean 'axia'"):
        explain(1, model="axai")
    with pytest.raises(ValueError, match=r"status = -1: must lie in \[0, 0xFFFFFFFF\]"):
        explain(-1)
