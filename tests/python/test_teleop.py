"""Teleoperation: schemes, network, protocol, lost links, three processes."""

import contextlib
import itertools
import json
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ebac import Hand, MinimumJerk, Scenario, Sine, Timing, gastroscope, studies, teleop
from ebac._util.child_processes import Child, end
from ebac.operators import Operators
from ebac.plot import plot_study, plot_teleop, plot_teleop_runs
from ebac.teleop import Link, Packet, SlaveModel
from ebac.teleop.processes import Slave

GOLDEN = Path(__file__).parents[1] / "golden" / "teleop.npz"
ROUGH = Link(delay=0.05, jitter=0.01, loss=0.1, reorder=0.02)
FINITE = st.floats(-1e6, 1e6)


def packet(value: float = 0.01, energy: float = 2.0, wave: float = -3.0) -> Packet:
    return Packet(
        from_slave=True,
        session=3,
        sequence=70000,
        echo=5,
        stamp=-1,
        value=value,
        energy=energy,
        wave=wave,
        run=4,
        fault=7,
        leaving=True,
        more=(0.1, 0.2, 0.3),
        at=(1.0, 2.0, 3.0, 4.0),
    )


@given(FINITE, FINITE, FINITE)
def test_a_packet_comes_back_as_it_was(value: float, energy: float, wave: float) -> None:
    sent = packet(value, energy, wave)
    assert len(sent.encode()) == 116
    assert Packet.decode(sent.encode()) == sent


def test_the_layout_is_the_one_that_is_documented() -> None:
    import struct
    import zlib

    wire = packet().encode()
    assert struct.unpack("<2sBBIIIqdddII7dI", wire) == (
        *(b"ET", 4, 5, 3, 70000, 5, -1, 0.01, 2.0, -3.0, 4, 7),
        *(0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 4.0),
        zlib.crc32(wire[:112]),
    )


def test_every_flipped_bit_and_every_other_length_is_refused() -> None:
    wire = packet().encode()
    for bit in range(8 * len(wire)):
        broken = bytearray(wire)
        broken[bit // 8] ^= 1 << bit % 8
        assert Packet.decode(bytes(broken)) is None
    assert all(Packet.decode(wire[:n]) is None for n in range(len(wire)))
    assert Packet.decode(wire + b"\0") is None


@given(st.binary(max_size=128), st.floats(allow_nan=True))
def test_noise_and_numbers_that_are_not_finite_are_refused(noise: bytes, value: float) -> None:
    assert Packet.decode(noise) is None
    for packet in (
        Packet(value=value),
        Packet(more=(0.0, value, 0.0)),
        Packet(at=(0.0, 0.0, 0.0, value)),
    ):
        assert (Packet.decode(packet.encode()) is not None) == np.isfinite(value)


@given(
    st.floats(0, 0.3), st.sampled_from([0.0, 300.0, 5e3, 2e4]), st.sampled_from([5.0, 20.0, 40.0])
)
@example(0.3, 2e4, 40.0)
@settings(max_examples=12, deadline=None)
def test_waves_are_passive_for_every_constant_delay(delay: float, met: float, b: float) -> None:
    run = teleop.simulate(
        "waves",
        there=Link(delay=delay),
        slave=SlaveModel(contact_stiffness=met),
        seconds=6,
        impedance=b,
    )
    assert run.two_port_passive
    assert run.passive


@given(st.floats(0, 0.2), st.floats(0, 0.03), st.floats(0, 0.5), st.integers(1, 1000))
@settings(max_examples=10, deadline=None)
def test_waves_are_passive_with_jitter_loss_and_reordering(
    delay: float, jitter: float, loss: float, seed: int
) -> None:
    link = Link(delay=delay, jitter=jitter, loss=loss, reorder=0.05)
    run = teleop.simulate("waves", there=link, seconds=6, seed=seed)
    assert run.least_network_J >= -2 * run.scheme.coupling.reserve - 1e-3


@pytest.mark.parametrize("name", ["two-port-passivity", "two-port-ebac"])
@given(st.floats(0, 0.3), st.sampled_from([0.0, 300.0, 2e4]), st.integers(1, 1000))
@settings(max_examples=8, deadline=None)
def test_the_slaves_port_never_gives_out_more_than_is_allowed(
    name: str, delay: float, met: float, seed: int
) -> None:
    link = Link(delay=delay, jitter=0.01, loss=0.1)
    slave = SlaveModel(contact_stiffness=met)
    run = teleop.simulate(name, there=link, slave=slave, seconds=5, seed=seed)
    spare = run["slave_allowed"] + run.scheme.coupling.reserve - run["slave_out"]
    assert spare.min() >= -1e-9


def test_what_is_known_of_delay() -> None:
    """Position and force shake (Anderson, Spong 1989; Lawrence 1993); waves do not (Niemeyer, Slotine 1991)."""
    there = Link(delay=0.05)
    shakes = teleop.simulate("position-force", there=there)
    assert shakes.swing_m > 10e-3
    assert shakes.least_master_J < -1
    waves = teleop.simulate("waves", there=there)
    assert waves.still
    assert waves.two_port_passive
    # The channel is a spring of b/T: master and slave stand F T / b apart, the spring of the controller on top.
    delay = 0.05 + 5e-3 + waves.scheme.coupling.buffer  # and the lag with which waves are followed
    coupling = waves.scheme.coupling
    expected = waves.rest_N * (delay / coupling.impedance + 1 / coupling.stiffness)
    assert waves.drift_m == pytest.approx(expected, rel=0.3)
    ebac = teleop.simulate("ebac", there=there)
    assert ebac.still
    assert ebac.transparency > 0.8 > waves.transparency


def test_without_delay_every_scheme_is_transparent() -> None:
    for name in ("position-force", "waves", "ebac"):
        run = teleop.simulate(name, there=Link(delay=0), buffer=0, seconds=6)
        assert run.still
        assert run.transparency > 0.7


@pytest.mark.parametrize("dt", [1e-4, 5e-4, 1e-3, 2e-3])
def test_a_delay_is_a_time_whatever_the_sample_time(dt: float) -> None:
    scenario = Scenario(timing=Timing(dt=dt))
    link = Link(delay=0.1)
    run = teleop.simulate("position-force", law="direct", there=link, scenario=scenario, seconds=2)
    t, far = run["t"], run["target"]
    began = [t[np.flatnonzero(np.abs(one) > 1e-3)[0]] for one in (run["x"], far)]
    assert began[1] - began[0] == pytest.approx(link.delay, abs=6e-3)


@pytest.mark.parametrize("seconds", [0.1005, 0.1045, 2.5005])
def test_a_run_to_its_end_is_whole_whatever_its_length(seconds: float) -> None:
    assert teleop.simulate("waves", seconds=seconds).whole


def test_a_tenth_of_the_packets_is_missing() -> None:
    run = teleop.simulate("ebac", there=ROUGH, seconds=6)
    for side in (run.at_slave, run.at_master):
        assert side["missing"] / (side["missing"] + side["received"]) == pytest.approx(
            0.1, abs=0.02
        )
        assert side["late"] > 100
        assert side["doubled"] == 0


def test_the_same_seed_gives_the_same_bits_as_ever() -> None:
    run = teleop.simulate("waves", there=ROUGH, seconds=3, seed=7)
    rows = np.array([run[name][::100] for name in ("true_x", "slave_x", "force", "network")])
    np.testing.assert_array_equal(rows, np.load(GOLDEN)["rows"])
    again = teleop.simulate("waves", there=ROUGH, seconds=3, seed=8)
    assert not np.array_equal(run["slave_x"], again["slave_x"])


@pytest.mark.parametrize("name", list(teleop.SCHEMES))
def test_a_lost_link_is_held_faded_and_reported(name: str) -> None:
    link = Link(delay=0.02, cut_every=4, cut_length=1)
    run = teleop.simulate(name, there=link, seconds=6, slave=SlaveModel(contact_stiffness=100))
    lost = run["master_state"] >= 2
    assert lost.any()
    assert (run["slave_state"] >= 2).any()
    held = run["target"][run["slave_state"] >= 2]
    assert np.ptp(held) == 0
    after = np.flatnonzero(lost)[0] + 250  # fade and lag are over
    assert np.abs(run["force"][after : np.flatnonzero(lost)[-1]]).max() < 1e-9
    assert run["session"][-1] == 2
    assert run["master_state"][-1] == 1
    step = np.abs(np.diff(run["target"])).max()
    assert step < 1e-3  # nothing jumps when it goes on


@pytest.mark.parametrize("name", ["ebac", "waves", "two-port-passivity", "two-port-ebac"])
def test_cuts_do_not_let_the_slave_walk_away(name: str) -> None:
    """Each session began where both were: 60 s with cuts led to 26 mm behind the stick's range."""
    run = teleop.simulate(
        name,
        there=Link(delay=0.02, cut_every=7, cut_length=1),
        seconds=60,
        hand=Hand(path=[Sine(centre=0.02, amplitude=0.015, frequency=0.2, phase=-1.5708)]),
    )
    assert run["session"][-1] >= 8
    assert run["slave_x"].min() > -1e-3
    assert run["slave_x"].max() < run["true_x"].max() + 1e-3
    assert np.abs(np.diff(run["target"])).max() < 2e-4


@pytest.mark.parametrize("name", ["ebac", "two-port-ebac", "waves"])
def test_cuts_do_not_renew_the_reserve(name: str) -> None:
    """A hand that holds still drew a reserve in every session: 6.7 mJ of `ebac`, 2.2 mJ of waves."""
    hand = Hand(
        mass=0.54,
        damping=24.6,
        stiffness=194,
        path=MinimumJerk(target=0.0255, at=1.2, duration=0.8),
    )
    run = teleop.simulate(
        name,
        hand=hand,
        there=Link(delay=0.06, cut_every=4, cut_length=1),
        slave=SlaveModel(contact=0.0033, contact_stiffness=663),
        consent_after=0.2,
        seconds=60,
    )
    assert run["session"].max() > 12
    assert run.least_master_J > -3e-3
    if name == "waves":
        assert run.least_network_J > -6e-3


@pytest.mark.parametrize("name", ["ebac", "two-port-ebac", "two-port-passivity", "waves"])
def test_no_slave_freezes_after_many_cuts(name: str) -> None:
    """A slave whose reserve stayed spent never moved again: nothing came in at a master without a force."""
    run = teleop.simulate(
        name,
        hand=Hand(path=Sine(centre=0.02, amplitude=0.015, frequency=0.5, phase=-np.pi / 2)),
        there=Link(delay=0.02, cut_every=7, cut_length=1),
        seconds=120,
    )
    last = run["t"] > 100
    assert np.ptp(run["true_x"][last]) > 0.02
    assert np.ptp(run["target"][last]) > 2e-3


def test_a_buffer_beyond_the_receivers_memory_and_a_time_out_within_a_tick_are_refused() -> None:
    quick, slow = (Scenario(timing=Timing(dt=dt)) for dt in (2.5e-4, 0.02))
    with pytest.raises(ValueError, match=r"Coupling.buffer = 0.3 s: must lie in \[0, 0.2555\]"):
        teleop.simulate("ebac", buffer=0.3, scenario=quick)
    with pytest.raises(ValueError, match=r"Coupling.timeout = 0.01 s: must be longer than two"):
        teleop.simulate("ebac", timeout=0.01, scenario=slow)


def test_waves_over_counts_give_out_their_reserve_alone() -> None:
    """On the encoder alone they give out 20 mJ in 20 s here, and go on: bv acts in phase with its counts."""
    run = teleop.simulate(
        "waves",
        hand=Hand(
            mass=1.06,
            damping=30,
            stiffness=217,
            path=Sine(centre=0.047, amplitude=0.0233, frequency=0.2),
        ),
        there=Link(delay=0.07),
        slave=SlaveModel(contact=0.003, contact_stiffness=708),
        seconds=60,
        impedance=20,
    )
    assert run.least_network_J > -5.5e-3
    took = run["energy"][-1]
    assert run["work"][-1] + run["damped"][-1] == pytest.approx(took, abs=2e-3)


def test_the_network_is_shown_the_observers_estimate() -> None:
    """Counts that the slave followed were blows: the force rippled by newtons at rest."""
    seen = teleop.simulate("ebac", seconds=6)
    blind = teleop.simulate("ebac", seconds=6, scenario=Scenario(observer=False))
    assert np.ptp(seen.tail("force")) < 0.1
    assert np.ptp(blind.tail("force")) > 5 * np.ptp(seen.tail("force"))


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
def test_two_sides_of_different_schemes_do_not_obey_each_other_and_say_so() -> None:
    command = [sys.executable, "-m", "ebac.cli", "teleop"]
    side = Slave(SlaveModel(), teleop.SCHEMES["ebac"], host="127.0.0.1", port=0)
    ticking = threading.Thread(target=side.run, args=(4.0,))
    ticking.start()
    master = subprocess.run(
        [
            *command,
            "master",
            "--peer",
            f"127.0.0.1:{side.port}",
            "--scheme",
            "waves",
            "--seconds",
            "1",
            "--json",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    ticking.join()
    assert master.returncode == 1
    assert "another scheme" in master.stderr
    assert json.loads(master.stdout)["other_scheme"] > 100
    assert side.run(0)["state"] == 0


def test_without_realignment_the_slave_goes_on_from_where_it_is() -> None:
    link = Link(delay=0.02, cut_every=2, cut_length=1)
    path = [MinimumJerk(target=0.02, at=1.2, duration=0.5)]  # while the link is cut
    free = SlaveModel(contact_stiffness=0)
    for realign, place in ((0.0, 0.0), (0.05, 0.02)):
        run = teleop.simulate(
            "ebac", there=link, seconds=3.9, hand=Hand(path=path), slave=free, realign=realign
        )
        assert run["slave_x"][-1] == pytest.approx(place, abs=1e-3)


@pytest.mark.parametrize(
    ("cuts", "message"),
    [
        (
            {"cut_every": 4, "cut_length": 5},
            "cut_length = 5 s: must lie above 0 s and below cut_every = 4 s",
        ),
        ({"cut_every": 4}, "cut_length = 0 s: must lie above 0 s"),
        ({"cut_length": 1}, "cut_length = 1 s: needs cut_every"),
    ],
)
def test_cuts_that_never_begin_or_end_are_refused(cuts: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        teleop.simulate("ebac", there=Link(**cuts), seconds=1)


def test_help_names_every_scheme() -> None:
    from ebac.cli.teleop.options import NAMES

    assert tuple(NAMES.split(", ")) == tuple(teleop.SCHEMES)


def test_a_bad_host_is_named_for_what_it_is() -> None:
    from ebac.teleop import processes

    with pytest.raises(ValueError, match=r"slave at 'no\.such\.invalid': no such host"):
        processes.Slave(SlaveModel(), teleop.scheme("ebac"), host="no.such.invalid", port=0)


def test_without_consent_nothing_goes_on() -> None:
    link = Link(delay=0.02, cut_every=4, cut_length=1)
    run = teleop.simulate("ebac", there=link, seconds=7, consent_after=np.inf)
    assert run["session"][-1] == 1
    assert run["master_state"][-1] == 3
    assert np.abs(run["force"][-1000:]).max() < 1e-9


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seconds": 0.0}, r"seconds = 0 s: must lie in \[0.1, 600\] s"),
        ({"scheme": "wave"}, "no scheme is called 'wave', did you mean 'waves'"),
        ({"impedance": 0.0}, r"Coupling.impedance = 0 N s/m: must lie in \[0.1, 1000\] N s/m"),
        ({"consent_after": -1.0}, "consent_after = -1 s: must be at least 0 s"),
        # Its place grew to a million kilometres.
        (
            {"slave": SlaveModel(mass=0.05, damping=1000)},
            r"contact_damping = 1004 N s/m: for a mass of 0.05 kg must lie in \[0, 500\] N s/m",
        ),
        (
            {
                "scenario": Scenario(timing=Timing(dt=5e-3)),
                "slave": SlaveModel(mass=0.01, damping=0, contact_stiffness=1e5),
            },
            r"contact_stiffness = 1e\+05 N/m: .* must lie in \[0, 40000\] N/m",
        ),
    ],
)
def test_wrong_input(change: dict, message: str) -> None:
    with pytest.raises((ValueError, KeyError), match=message):
        teleop.simulate(**change)
    with pytest.raises(ValueError, match=r"Link.delay = 2 s: must lie in \[0, 0.5\] s"):
        Link(delay=2)


def test_study_and_its_figures() -> None:
    found = teleop.study(
        ["waves", "ebac"], contacts={"free": 0.0, "soft": 500.0}, delays=(0.05,), hands=(300.0,)
    )
    assert [row.contact for row in found.rows] == ["free", "soft"] * 2
    assert all(row.bounded == row.runs == 1 for row in found.rows)
    title, headings, *rows = repr(found).splitlines()
    assert title.startswith("Teleoperation, simulated")
    assert "shaking [mm]" in headings
    assert len(rows) == 4
    figure = plot_teleop(found)
    assert len(figure.axes) == 6
    shown = [line.get_xdata()[0] for line in figure.axes[0].get_lines()[:2]]
    assert shown == pytest.approx([50 - 1.25, 50 + 1.25])  # beside the delay, one on each side
    with pytest.raises(KeyError, match="no network is called 'ruff'; there are: rough"):
        plot_teleop(found, "ruff")
    with pytest.raises(TypeError, match=r"plot_study takes a Study of ebac\.studies, not one of"):
        next(iter(plot_study(found)))  # type: ignore[arg-type]
    other = studies.study(Operators.sample(2), "direct", ["d1K10"])
    with pytest.raises(TypeError, match=r"plot_teleop takes a Study of ebac\.teleop\.study, not"):
        plot_teleop(other)  # type: ignore[arg-type]
    assert "log beyond -1 mJ" in figure.axes[2].get_ylabel()
    free, soft = figure.axes[4:]  # there is no transparency without a contact
    assert not free.lines
    assert [text.get_text() for text in free.texts] == ["no transparency:\nno contact, or no rest"]
    assert (free.get_ylabel(), soft.get_ylabel()) == ("", "transparency")
    assert figure.axes[2].get_xlabel() == soft.get_xlabel() == "delay each way [ms]"
    assert list(soft.get_xticks()) == [50.0]
    assert "side by side at each delay" in figure.get_suptitle()
    for ax in figure.axes[2:4]:
        drawn = [line.get_ydata() for line in ax.lines]
        assert np.min(drawn) > ax.get_ylim()[0] + 0.1  # not on the frame
    with pytest.raises(ValueError, match=r"runs = .*: is empty"):
        plot_teleop_runs([])


def test_runs_are_drawn_with_their_conditions_and_a_colour_for_each_thing() -> None:
    figure = plot_teleop_runs([teleop.simulate(name, seconds=3) for name in ("waves", "ebac")])
    assert figure.get_suptitle().splitlines() == [
        "Teleoperation, simulated",
        "each way 50 ms of delay; contact of 500 N/m at 20 mm; a hand (0.15 kg, 6 N s/m, 300 N/m, target 45 mm); "
        "the reference device (0.25 kg, 2 N s/m, sensor without noise); 1 kHz, 1 sample of delay, state observer for "
        "laws made for it; 3 s, seed 1",
    ]
    titles = [ax.get_title() for ax in figure.axes[:2]]
    assert titles == ["waves\nlaw direct", "ebac\nlaw ebac"]
    named = {line.get_label(): line.get_color() for line in figure.axes[0].get_lines()}
    named |= {line.get_label(): line.get_color() for line in figure.axes[4].get_lines()}
    assert len(named) == len(set(named.values())) == 4
    assert "log beyond" in figure.axes[4].get_ylabel()


def test_a_run_that_shakes_does_not_hide_the_others_and_is_said_to_be_cut() -> None:
    hard, far = SlaveModel(contact_stiffness=20e3), Link(delay=0.2)
    runs = [
        teleop.simulate(name, slave=hard, there=far, seconds=5)
        for name in ("position-force", "two-port-passivity")
    ]
    figure = plot_teleop_runs(runs)
    shaking, calm = figure.axes[:2]
    assert [text.get_text()[:4] for text in shaking.texts] == ["cut:"]
    assert not calm.texts
    low, high = calm.get_ylim()
    assert 1e-3 * low < runs[1]["true_x"].min()
    assert runs[1]["true_x"].max() < 1e-3 * high
    assert high - low < 3 * 1e3 * np.ptp(runs[1]["true_x"])
    alone = runs[0].plot()
    assert not alone.axes[0].texts  # nothing else is there to be hidden


def test_a_run_prints_its_results() -> None:
    run = teleop.simulate("ebac", back=Link(delay=0.02, loss=0.1), seconds=4)
    text = str(run)
    assert "there 50 ms of delay; back 20 ms of delay, 10 % lost" in text
    assert re.search(rf"contact, at rest +{run.rest_N:.2f} N\n", text)
    assert re.search(rf"transparency +{run.transparency:.4g}\n", text)
    assert "the reference device" in text
    assert len(text.splitlines()) < 20
    assert repr(run).startswith(
        f"<Run of ebac: {'still' if run.still else 'still moving'}, passive at the master's port"
    )
    assert "<img" in run._repr_html_()
    assert "rest [N]" in run._repr_html_()


@pytest.mark.parametrize(
    ("scheme", "seconds", "words"),
    [
        ("ebac", 3, "still moving"),
        ("ebac", 4, "still moving"),
        ("ebac", 10, "still"),
        ("two-port-ebac", 3, "still moving"),
        ("position-force", 3, "swings"),
        ("position-force", 10, "swings"),
    ],
)
def test_a_stick_that_is_on_its_way_does_not_swing(scheme: str, seconds: float, words: str) -> None:
    run = teleop.simulate(scheme, there=Link(delay=0.1), seconds=seconds)
    assert f": {words}, " in repr(run)
    assert run.still_moving is (words == "still moving")


def test_a_port_that_is_none_is_refused_and_not_another_one() -> None:
    with pytest.raises(ValueError, match=r"slave: port = 70000: must lie in \[0, 65535\]"):
        Slave(SlaveModel(), teleop.SCHEMES["ebac"], host="127.0.0.1", port=70000)


def ebac(*words: str) -> subprocess.Popen:
    command = [sys.executable, "-m", "ebac.cli", "teleop", *words]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
@pytest.mark.slow
def test_three_processes_with_cuts() -> None:
    slave = ebac("slave", "--port", "49411", "--seconds", "7", "--json")
    network = ebac(
        *("network", "--slave", "127.0.0.1:49411", "--port", "49410", "--seconds", "7"),
        *("--delay", "0.02", "--jitter", "0.005", "--loss", "0.05", "--corrupt", "0.02"),
        *("--cut-every", "2.5", "--cut-length", "1", "--json"),
    )
    master = ebac(
        *("master", "--peer", "127.0.0.1:49410", "--seconds", "6"),
        *("--consent-after", "0.2", "--json"),
    )
    ends = {}
    for name, process in (("master", master), ("network", network), ("slave", slave)):
        out, told = process.communicate(timeout=60)
        assert process.returncode == 0, told
        ends[name] = json.loads(out)
        if name != "network":
            assert "LINK LOST" in told
            assert told.count("running") >= 2
    for side in (ends["master"], ends["slave"]):
        assert side["session"] >= 2
        assert side["losses"] >= 1
        assert side["refused"] > 20
        assert side["arrivals"]["received"] > 2000
    assert ends["master"]["fault"] == 0
    assert ends["master"]["force_when_lost_N"] < 0.1
    assert ends["master"]["most_force_N"] < 42.4
    assert ends["slave"]["most_force_N"] <= 30
    assert ends["slave"]["moved_when_lost_m"] == 0
    assert 0.04 < ends["master"]["longest_round_trip_s"] < 2
    assert ends["slave"]["longest_round_trip_s"] is None  # not measured: 0 ms would be a quick link
    assert ends["network"]["most_force_N"] is None


@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
def test_processes_run_at_1_khz_only() -> None:
    from ebac.laws import design
    from ebac.teleop import processes

    scheme = teleop.scheme("waves")
    scenario = Scenario(timing=Timing(dt=5e-4))
    law = design(scheme.law, scenario.device, scenario.known_timing)
    with pytest.raises(ValueError, match=r"Timing.dt = 5e-04 s: .* must be 0.001 s"):
        processes.Master(scenario, law, scheme, host="127.0.0.1", port=0, peer=("127.0.0.1", 1))


@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
@pytest.mark.slow
def test_a_restarted_master_waits_for_consent() -> None:
    from ebac import Free
    from ebac.laws import design
    from ebac.teleop import processes

    scheme = teleop.scheme("ebac")
    still = Hand(path=[MinimumJerk(target=0.0, at=0.1, duration=0.1)])
    scenario = Scenario(environment=Free(), hand=still)
    law = design(scheme.law, scenario.device, scenario.known_timing)
    slave = processes.Slave(SlaveModel(), scheme, host="127.0.0.1", port=0)
    over = threading.Event()
    seen = []

    def serve() -> None:
        while not over.is_set():
            seen.append(slave.run(0.05))

    def master() -> processes.Master:
        peer = ("127.0.0.1", slave.port)
        return processes.Master(scenario, law, scheme, host="127.0.0.1", port=0, peer=peer)

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        assert master().run(0.3)["state"] == 1
        restarted = master()
        assert restarted.run(1.5)["state"] == 3
        assert seen[-1]["state"] == 3
        assert seen[-1]["moved_when_lost"] == 0
        assert restarted.consent()
        report = restarted.run(0.5)
        assert (report["state"], report["session"]) == (1, 2)
        assert report["most_force"] < 1
    finally:
        over.set()
        thread.join()


@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
@pytest.mark.slow
def test_a_slave_that_was_held_up_does_not_hit() -> None:
    """0.3 s late, it finds the stick 5 mm away: the way there was one blow of 30 N, its limit."""
    from ebac import Free
    from ebac.laws import design
    from ebac.teleop import processes

    scheme = teleop.scheme("ebac")
    swings = Hand(path=[Sine(centre=0.0, amplitude=0.015, frequency=0.4)])
    scenario = Scenario(environment=Free(), hand=swings)
    law = design(scheme.law, scenario.device, scenario.known_timing)
    free = SlaveModel(contact_stiffness=0)
    slave = processes.Slave(free, scheme, host="127.0.0.1", port=0)
    peer = ("127.0.0.1", slave.port)
    master = processes.Master(scenario, law, scheme, host="127.0.0.1", port=0, peer=peer)
    thread = threading.Thread(target=lambda: master.run(3.0))
    thread.start()
    slave.run(1.0)
    time.sleep(0.3)
    report = slave.run(0.5)
    thread.join()
    assert report["most_force"] < 22  # 40 N s/m times 0.3 m/s, and the spring


@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.real_time
def test_a_pause_between_two_runs_is_not_made_up_for() -> None:
    """It sent a thousand packets in 10 ms."""
    slave = Slave(SlaveModel(), teleop.scheme("ebac"), host="127.0.0.1", port=0)
    slave.run(0.01)
    time.sleep(0.4)
    begun = time.monotonic()
    late = slave.run(0.1)["late_ticks"]
    assert time.monotonic() - begun > 0.09
    assert late < 50
    for seconds in (float("nan"), float("inf"), -1.0):
        with pytest.raises(ValueError, match=r"seconds = .* s: must be finite and at least 0 s"):
            slave.run(seconds)


def test_endurance_finds_what_is_beyond_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    from ebac.cli.teleop.endurance import _row, _show

    monkeypatch.setattr(sys.modules["ebac.teleop.endurance"], "master_limit", lambda: -1.0)
    link = Link(delay=0.02, cut_every=3, cut_length=1)
    found = teleop.endurance(5, link=link, consent_after=0.2)
    assert [fault.split(" = ")[0] for fault in found.faults] == ["largest force of the master"]
    assert " s after the link began to run" in found.faults[0]
    assert found.reported["master"] >= found.reports["master"]["losses"] >= 1
    for name in ("master", "slave"):
        times = [t for t, _ in found.events[name]]
        assert times == sorted(times)
        assert sum("LINK LOST" in words for _, words in found.events[name]) == found.reported[name]
    assert all(len(values) > 3 for values in found.memory.values())
    _show([_row(found, name) for name in found.reports], found.faults)  # a network has no force


@pytest.mark.parametrize(
    ("last_words", "fault"),
    [
        ("sys.exit('out of memory')", "slave ended with 1: out of memory"),
        ("sys.exit()", "slave ended after 0 s: must run for 600 s"),
    ],
)
def test_a_process_that_dies_ends_the_endurance_run_and_the_others_report(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, last_words: str, fault: str
) -> None:
    module: Any = sys.modules["ebac.teleop.endurance"]
    waits = "while not all(map(os.path.exists, ('network', 'master'))): time.sleep(0.01)"
    reports = "print(json.dumps({'command': sys.argv[1]})); sys.exit()"

    @contextlib.contextmanager
    def started(words: list[str]) -> Iterator[Child]:
        name = words[1]
        works = (
            f"signal.signal(15, lambda *_: exec({reports!r})); open({name!r}, 'w'); time.sleep(60)"
        )
        code = "import json, os, signal, sys, time\n"
        code += f"{waits}\n{last_words}" if name == "slave" else works
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            command = [sys.executable, "-S", "-c", code, name]
            process = subprocess.Popen(command, stdout=out, stderr=err, cwd=tmp_path)
            try:
                yield Child(process, out, err)
            finally:
                end(process)

    monkeypatch.setattr(module, "started", started)
    monkeypatch.setattr(module, "BEFORE", 0.0)
    monkeypatch.setattr(module, "EVERY", 0.02)
    found = teleop.endurance(600)
    assert found.faults == [fault]
    assert {"network", "master"} <= set(found.reports)
    assert found.reports["master"] == {"command": "master"}


def test_a_process_that_does_not_end_is_killed() -> None:
    deaf = (
        "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(flush=True); input()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", deaf], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        end(process, patience=0.1)
        assert process.returncode == -signal.SIGKILL


def test_memory_is_judged_after_the_start() -> None:
    def growth(values: list[int]) -> int:
        memory = {"master": values}
        return teleop.Endurance(reports={}, reported={}, memory=memory, faults=[]).growth("master")

    assert growth([30, 60, 60, 60, 60]) == growth([]) == 0
    assert growth([1] * 20 + [5] * 20) == 4


def test_command_line(tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from ebac.cli import app

    out = str(tmp_path / "t")
    words = ["teleop", "run", "--scheme", "waves,ebac", "--seconds", "3", "--json", "--out", out]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    assert [row["scheme"] for row in json.loads(done.stdout)["rows"]] == ["waves", "ebac"]
    assert (tmp_path / "t" / "runs.png").exists()
    noisy = CliRunner().invoke(app, [*words[:-1], str(tmp_path / "n"), "--device-noise", "0.03"])
    assert json.loads(noisy.stdout)["rows"] != json.loads(done.stdout)["rows"]
    wide = CliRunner().invoke(app, [*words[:7], "--device", "joystick"])
    assert "has 2 axes; teleoperation is for one axis" in wide.output
    wrong = CliRunner().invoke(app, ["teleop", "master", "--peer", "nowhere"])
    assert wrong.exit_code == 2
    assert "must be an address and a port" in wrong.output
    wrong = CliRunner().invoke(app, ["teleop", "master", "--peer", "127.0.0.1:99999"])
    assert "--peer 127.0.0.1:99999: the port must lie in [1, 65535]" in wrong.output


@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
def test_a_master_without_a_slave_shows_where_it_looks_for_one_and_what_to_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It waited silently, and the remedy came when it was stopped."""
    from typer.testing import CliRunner

    from ebac.cli import app
    from ebac.cli.teleop import processes

    monkeypatch.setattr(processes, "PATIENCE", 0.3)
    words = ["teleop", "master", "--peer", "127.0.0.1:9", "--seconds", "0.7"]
    done = CliRunner().invoke(app, words)
    first, *later = done.stdout.splitlines()
    assert first.endswith(", peer 127.0.0.1:9. Ctrl-C stops it.")
    hint = "master: no slave has answered; start it first, and give its address by --peer (127.0.0.1:9)"
    assert sum(hint in one for one in later) == 1
    assert done.exit_code == 1


@pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
def test_an_address_that_is_not_this_machine_s_is_named_with_a_remedy() -> None:
    from typer.testing import CliRunner

    from ebac.cli import app

    done = CliRunner().invoke(app, ["teleop", "slave", "--host", "192.0.2.1", "--seconds", "0"])
    text = " ".join(done.output.split())
    assert done.exit_code == 2
    assert text.startswith(
        "Error: UDP at 192.0.2.1:49201: this machine has no such address; `ip address` lists those it has"
    )


def test_a_study_and_an_endurance_run_of_the_wrong_type_are_refused_by_name() -> None:
    names = ("schemes", "delays", "networks", "hands")
    for name, wrong in itertools.product(names, (3, "rough")):
        with pytest.raises(TypeError, match=rf"{name} = {wrong!r} \(.*\): must be a sequence"):
            teleop.study(**{name: wrong})
    for name in names:
        with pytest.raises(ValueError, match=rf"{name} = \[\]: is empty"):
            teleop.study(**{name: []})
    for name, twice, of in (
        ("delays", [0.1, 0.05, 0.1], r" s: 0.1 s"),
        ("networks", ["rough", "rough"], ": 'rough'"),
    ):
        text = rf"{name} = {re.escape(repr(twice))}{of} stands there twice; give each once"
        with pytest.raises(ValueError, match=text):
            teleop.study(**{name: twice})
    one = teleop.scheme("ebac")
    for schemes in ([one, one.changed(buffer=0)], ["waves", "ebac", one]):
        with pytest.raises(
            ValueError, match=r"two schemes are called 'ebac': .*replace\(scheme, name="
        ):
            teleop.study(schemes)
    for contacts in ([1], "soft"):
        with pytest.raises(TypeError, match=r"study takes contacts by name, as in \{'soft': 500\}"):
            teleop.study(contacts=contacts)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"contacts = \{\}: is empty"):
        teleop.study(contacts={})
    with pytest.raises(KeyError, match="no network is called 3; there are: rough, clean"):
        teleop.study(networks=[3])  # type: ignore[list-item]
    for run in (teleop.endurance, gastroscope.chain):
        with pytest.raises(TypeError, match=r"link = 3 \(int\): must be a Link"):
            run(link=3)  # type: ignore[operator]
    with pytest.raises(TypeError, match="seconds = 'x': must be a number"):
        teleop.endurance(seconds="x")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"seconds = 4 s: must lie in \[5, 86400\] s"):
        teleop.endurance(np.int64(4))  # type: ignore[arg-type]


def test_seed_0_is_a_seed_of_its_own() -> None:
    from typer.testing import CliRunner

    from ebac.cli import app

    run = ["teleop", "run", "--scheme", "waves", "--jitter", "0.01", "--loss", "0.1", "--json"]
    runs = [[*run, "--seconds", "3", "--seed", seed] for seed in ("0", "1", "0")]
    zero, one, again = (json.loads(CliRunner().invoke(app, words).stdout)["rows"] for words in runs)
    assert zero == again
    assert zero != one


def test_a_run_equals_itself_alone() -> None:
    one, other = (teleop.simulate("waves", seconds=0.2) for _ in range(2))
    assert one == one
    assert one != other


def test_a_run_that_did_not_end_is_no_calm_one_in_the_figure() -> None:
    """It was drawn at the lower edge, as the calmest of all."""
    from types import SimpleNamespace

    from ebac.plot.teleop import _values

    known = {"least_network_J": 0.0, "transparency": 1.0}
    rows: Any = [SimpleNamespace(shaking_m=one, **known) for one in (4e-3, float("inf"))]
    shaking, _, _ = _values(rows)
    assert shaking[0] == pytest.approx(4.0)
    assert np.isnan(shaking[1])
