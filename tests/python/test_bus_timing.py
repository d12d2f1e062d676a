"""The time a bus takes: exact lengths of frames against another way to count them, arbitration, errors, verdicts."""

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from ebac import drives
from ebac.cli import app


def by_hand(cob_id: int, data: bytes) -> int:
    """Text of bits, CRC by long division of polynomials, stuffing as a receiver takes it out."""
    text = f"0{cob_id:011b}000{len(data):04b}" + "".join(f"{byte:08b}" for byte in data)
    rest = int(text + "0" * 15, 2)
    while rest.bit_length() > 15:
        rest ^= 0xC599 << rest.bit_length() - 16
    sent = ""
    for bit in text + f"{rest:015b}":
        sent += bit
        if sent[-5:] in ("00000", "11111"):
            sent += "1" if bit == "0" else "0"
    plain = "".join(
        part
        for i, part in enumerate(sent)
        if i not in {j for j in range(5, len(sent)) if len(set(sent[j - 5 : j])) == 1}
    )
    assert plain == text + f"{rest:015b}"
    return len(sent) + len("1" + "01" + "1111111" + "111")


@given(st.integers(0, 0x7FF), st.binary(max_size=8))
def test_a_frame_is_as_long_as_counted_by_hand(cob_id: int, data: bytes) -> None:
    bits = drives.exact_bits(cob_id, data)
    assert bits == by_hand(cob_id, data)
    assert 47 + 8 * len(data) <= bits <= drives.frame_bits(len(data))


def test_remote_frames_and_wrong_ones() -> None:
    assert 47 <= drives.exact_bits(0x701, remote=True, size=1) <= drives.frame_bits(0)
    for wrong in ((0x800, b""), (1, bytes(9))):
        with pytest.raises(ValueError, match="must be at most 0x7FF"):
            drives.exact_bits(*wrong)


def network(bitrate: int = 1_000_000, **more: object) -> drives.Network:
    return dataclasses.replace(drives.load("joystick"), bitrate=bitrate, **more)  # type: ignore[arg-type]


def test_an_exchange_of_five_frames_takes_under_half_a_millisecond_at_1_mbit() -> None:
    """515 us is the worst case; data that are random have fewer stuff bits, and drives answer after 50 us."""
    found = drives.bus_timing(network(), answer_share=0.6, ticks=200)
    assert found.good
    assert 0.40e-3 < found.mean < found.worst < 0.515e-3 + 0.05e-3 + 0.26e-3
    assert found.errors == 0
    assert 0.38 < found.load < 0.515


def test_the_loops_own_signs_of_life_take_their_time() -> None:
    def load(**values: float) -> float:
        nodes = tuple(
            dataclasses.replace(
                one,
                profile=dataclasses.replace(one.profile, values={**one.profile.values, **values}),
            )
            for one in drives.load("joystick").nodes
        )
        return drives.bus_timing(network(nodes=nodes), ticks=1000).load

    slow = {"heartbeat.producer": 60.0}
    quiet = load(**slow, **{"heartbeat.consumer": 0.0})
    beats = load(**slow, **{"heartbeat.consumer": 0.02})  # every 2 ms
    assert 500 * 55e-6 < beats - quiet < 500 * 66e-6
    asked = load(**slow, **{"heartbeat.consumer": 0.0, "heartbeat.guard": 0.05})  # every 10 ms
    assert 200 * 100e-6 < asked - quiet < 200 * 121e-6  # a request and an answer of each


def test_a_slow_bus_is_late_and_a_full_one_never_answers() -> None:
    slow = drives.bus_timing(network(500_000), ticks=100)
    assert slow.late == 100
    full = drives.bus_timing(network(125_000), ticks=100)
    assert full.missing > 50
    assert full.load > 0.99


def test_traffic_that_never_comes_takes_no_time() -> None:
    never = drives.Traffic(name="others", size=8, rate=0)
    alone, beside = (
        drives.bus_timing(network(others=others), ticks=20) for others in ((), (never,))
    )
    assert beside == alone


def test_a_lower_identifier_goes_first() -> None:
    """Foreign traffic of low priority holds an exchange up by the frame under way, wherever the bus becomes free."""
    busy = drives.Traffic(name="others", size=8, rate=3500.0)
    alone, beside = (
        drives.bus_timing(network(others=others), answer_share=0.9, ticks=200)
        for others in ((), (busy,))
    )
    assert alone.worst < beside.worst < alone.worst + 4 * 135e-6
    assert beside.load > alone.load + 0.3


def test_destroyed_frames_cost_time_and_a_broken_node_goes_off_the_bus() -> None:
    found = drives.bus_timing(network(), answer_share=0.9, ticks=300, error_rate=0.02, seed=3)
    clean = drives.bus_timing(network(), answer_share=0.9, ticks=300, seed=3)
    assert found.errors > 5
    assert found.worst > clean.worst
    assert found.off == ()
    broken = drives.bus_timing(network(), ticks=50, broken=2)
    assert broken.off == ("node 2",)
    assert broken.passive == ("node 2",)
    assert broken.errors == 32  # 8 each, to above 255
    assert broken.missing == 50


def test_the_same_seed_gives_the_same() -> None:
    first, again = (drives.bus_timing(network(), ticks=50, error_rate=0.1, seed=7) for _ in "ab")
    assert first == again
    assert drives.bus_timing(network(), ticks=50, error_rate=0.1, seed=np.int64(7)) == first  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "wrong", [{"dt": 0.0}, {"answer_share": 2.0}, {"ticks": 0}, {"error_rate": 1.5}]
)
def test_wrong_values_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=f"{next(iter(wrong))} = .*must lie in"):
        drives.bus_timing(network(), **wrong)  # type: ignore[arg-type]


def test_the_command_judges() -> None:
    for words, code in (
        (["--answer-share", "0.6"], 0),
        (["--broken", "1"], 1),
        (["--rate", "5000"], 1),
    ):
        done = CliRunner().invoke(app, ["drive", "timing", "--ticks", "50", *words])
        assert done.exit_code == code, done.output
        assert "Simulation. 1000 kbit/s, load" in " ".join(done.output.split())


@pytest.mark.parametrize("broken", [0, -1, 99, "x"])
def test_a_node_that_is_not_there_cannot_be_broken(broken: Any) -> None:
    with pytest.raises(ValueError, match=r"broken = .*: must be the id of a node: 1, 2"):
        drives.bus_timing(network(), broken=broken, ticks=10)
