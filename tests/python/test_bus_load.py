"""The load of a bus by its process data, and `ebac bus load`."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from ebac import _core
from ebac.cli import app


def call(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["bus", "load", *words])
    return result.exit_code, " ".join(result.output.split())


@given(
    nodes=st.lists(st.integers(1, 127), min_size=1, max_size=127, unique=True),
    rate=st.floats(0.2, 9e4),
    bit_rate=st.floats(1e4, 1e6),
)
def test_the_load_is_the_sum_of_its_frames(nodes: list[int], rate: float, bit_rate: float) -> None:
    load = _core.BusLoad(frames=_core.pdo_plan(nodes), bit_rate=bit_rate, period=1 / rate)
    assert sum(map(load.frame_share, load.frames)) == pytest.approx(load.share)
    assert len(load.frames) == 1 + 2 * len(nodes)
    assert len({frame.id for frame in load.frames}) == len(load.frames)
    assert load.share == pytest.approx((55 + 230 * len(nodes)) * rate / bit_rate)
    if load.share > 0.9:
        with pytest.raises(ValueError, match="must be at most 90 %"):
            load.check()
        slower = _core.BusLoad(
            frames=load.frames, bit_rate=bit_rate, period=1 / (0.999 * load.highest_rate)
        )
        if slower.period <= 10:
            assert "over 70 %" in slower.check()
    else:
        assert bool(load.check()) == (load.share > 0.7)


@pytest.mark.parametrize("nodes", [[0], [128], [1, 1], [-1]])
def test_nodes_that_cannot_be_are_refused(nodes: list[int]) -> None:
    with pytest.raises(ValueError, match="node"):
        _core.pdo_plan(nodes)


def test_two_drives_at_one_kilohertz() -> None:
    code, text = call()
    assert code == 0
    assert "515 us 51.5 %" in text
    assert "0x201" in text
    assert "Warning" not in text


def test_a_force_sensor_on_the_same_bus_is_warned_of() -> None:
    code, text = call("--force-sensor")
    assert code == 0
    assert "Warning: the planned frames take 785 us of each 1000 us, 78.5 %" in text


def test_two_kilohertz_are_refused_after_the_table() -> None:
    code, text = call("--rate", "2000")
    assert code == 2
    assert "103 % of a bus at 1000 kbit/s" in text
    assert "a rate up to 1747 Hz" in text
    assert text.index("SYNC") < text.index("Error:")


def test_json() -> None:
    result = CliRunner().invoke(app, ["bus", "load", "--nodes", "3", "--json"])
    told = json.loads(result.stdout)
    assert told["command"] == "bus load"
    assert told["busy_s"] == pytest.approx(745e-6)
    assert told["share"] == pytest.approx(0.745)
    assert "over 70 %" in told["remark"]
    assert len(told["rows"]) == 7
    assert {tuple(row) for row in told["rows"]} == {
        ("what", "cob_id", "size_bytes", "frames", "bits", "share")
    }


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--rate", "0"], "--rate = 0 Hz: must lie in [0.1, 100000] Hz"),
        (["--rate", "nan"], "--rate = nan Hz: must be a finite number"),
        (["--bitrate", "2e6"], "--bitrate = 2e+06 bit/s: must lie in [10000, 1000000] bit/s"),
    ],
)
def test_bad_numbers_name_their_option(words: list[str], message: str) -> None:
    code, text = call(*words)
    assert code == 2
    assert message in text
