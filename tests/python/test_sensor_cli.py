"""`ebac sensor`, and the page of a sensor."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from ebac.cli import app
from ebac.sensor import (
    EmulatorOptions,
    EmulatorTrouble,
    SensorConfig,
    SensorError,
    SimulatedSensor,
    read_page,
)
from ebac.sensor.page import parse_page


def run(*words: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["sensor", *words])
    return result.exit_code, result.stdout, " ".join(result.stderr.split())


@pytest.fixture
def simulated() -> Iterator[SimulatedSensor]:
    """Give a simulated sensor with a page, whose counts are its own."""
    options = EmulatorOptions(counts_per_force=1e5, counts_per_torque=2e5, load=2)
    with SimulatedSensor((3.0, 0.0, 0.0), http_port=0, options=options) as sensor:
        yield sensor


def at(sensor: SimulatedSensor, *, page: bool = True) -> list[str]:
    host, port = sensor.address
    words = ["--host", host, "--port", str(port)]
    assert sensor.http_address is not None
    return [*words, "--page", "--http-port", str(sensor.http_address[1])] if page else words


# --- the page ---

PAGE = (
    "<?xml version='1.0'?><netft><prodname>Net F/T</prodname><setserial>FT1</setserial>"
    "<scfgfu>{fu}</scfgfu><scfgtu>{tu}</scfgtu><cfgcpf>{cpf}</cfgcpf><cfgcpt>1000000</cfgcpt>"
    "<comrdte>Enabled</comrdte><comrdtrate>7000</comrdtrate></netft>"
)


def test_a_page_says_what_counts_are_worth(simulated: SimulatedSensor) -> None:
    assert simulated.http_address is not None
    host, port = simulated.http_address
    page = read_page(host, http_port=port)
    assert (page.counts_per_force, page.counts_per_torque) == (1e5, 2e5)
    assert (page.force_unit, page.torque_unit) == ("N", "N-m")
    assert (page.rate, page.streams) == (1000, True)


@pytest.mark.parametrize(
    ("unit", "newtons"), [("N", 1.0), ("lbf", 4.4482216152605), ("kN", 1e3), ("kg", 9.80665)]
)
def test_units_of_a_page_become_newtons(unit: str, newtons: float) -> None:
    page = parse_page(PAGE.format(fu=unit, tu="lbf-in", cpf=1000000).encode())
    assert page.counts_per_force == pytest.approx(1e6 / newtons)
    assert page.counts_per_torque == pytest.approx(1e6 / 0.1129848290276167)
    assert page.serial == "FT1"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<html>", "is no XML"),
        ("", "is no XML"),
        ("<netft></netft>", "has no <scfgfu>"),
        (PAGE.format(fu="stone", tu="N-m", cpf=1), "'stone' is no unit known here"),
        (PAGE.format(fu="N", tu="N-m", cpf="many"), "<cfgcpf> = 'many': must be a number above 0"),
        (PAGE.format(fu="N", tu="N-m", cpf=0), "<cfgcpf> = '0'"),
        (PAGE.format(fu="N", tu="N-m", cpf="inf"), "<cfgcpf> = 'inf'"),
        ("<!DOCTYPE a [<!ENTITY b 'c'>]><netft/>", "it has a document type"),
    ],
)
def test_a_page_that_is_none_is_refused(text: str, message: str) -> None:
    with pytest.raises(SensorError, match=message):
        parse_page(text.encode())


@given(
    st.binary(max_size=300)
    | st.text(alphabet="<>/?!=netfcfgpu&; 01'\"", max_size=60).map(str.encode)
)
def test_no_page_crashes_its_reader(text: bytes) -> None:
    with pytest.raises(SensorError):
        parse_page(text)


def test_a_page_that_cannot_be_had_says_why() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        with pytest.raises(SensorError, match=r"cannot be read .*timed out"):
            read_page("127.0.0.1", http_port=port, timeout=0.1)
    with pytest.raises(SensorError, match="Connection refused"):
        read_page("127.0.0.1", http_port=port)
    with pytest.raises(ValueError, match=r"sensor.http_port = 0"):
        read_page("127.0.0.1", http_port=0)
    with pytest.raises(ValueError, match=r"sensor.timeout = nan s"):
        read_page("127.0.0.1", timeout=float("nan"))


def test_another_server_is_no_sensor() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def answer() -> None:
            for reply in (b"HTTP/1.0 404 Not Found\r\n\r\n", b"SSH-2.0-OpenSSH\r\n"):
                one, _ = listener.accept()
                with one:
                    one.recv(1000)
                    one.sendall(reply)

        thread = threading.Thread(target=answer)
        thread.start()
        port = listener.getsockname()[1]
        with pytest.raises(SensorError, match="answers 404"):
            read_page("127.0.0.1", http_port=port)
        with pytest.raises(SensorError, match="cannot be read"):
            read_page("127.0.0.1", http_port=port)
        thread.join()


# --- the commands ---


def test_read_gives_rows(simulated: SimulatedSensor) -> None:
    code, out, err = run("read", *at(simulated), "--seconds", "0.3", "--rate", "20", "--json")
    assert code == 0, err
    told = json.loads(out)
    assert told["command"] == "sensor read"
    assert told["state"] == "streaming"
    assert told["counts_per_force_per_N"] == 1e5
    assert 5 <= len(told["rows"]) <= 7
    row = told["rows"][-1]
    assert row["force_x_N"] == pytest.approx(3)
    assert row["force_z_N"] == pytest.approx(2)
    assert row["torque_y_Nm"] == pytest.approx(0.06)
    assert row["health"] == "good"
    assert row["lost"] == 0
    assert row["received"] > 0
    assert row["age_s"] >= 0


def test_read_shows_a_table(simulated: SimulatedSensor) -> None:
    simulated.inject(EmulatorTrouble(status=0x80020000))
    code, out, err = run("read", *at(simulated), "--seconds", "0.1")
    assert code == 0, err
    assert "+3.000" in out
    assert "saturated (saturated, or a converter's error)" in out
    assert "0 lost" in out


def test_bias_gives_the_line_for_the_configuration(
    simulated: SimulatedSensor, tmp_path: Path
) -> None:
    code, out, err = run("bias", *at(simulated), "--records", "50")
    assert code == 0, err
    line = next(line.strip() for line in out.splitlines() if "bias = [" in line)
    assert line == "bias = [3, 0, 2, 0, 0.06, 0]"
    file = tmp_path / "joystick.toml"
    host, port = simulated.address
    file.write_text(
        f"[sensor]\nhost = '{host}'\nport = {port}\ncounts_per_force = 1e5\n"
        f"counts_per_torque = 2e5\n{line}\n"
    )
    code, out, err = run("read", "--config", str(file), "--seconds", "0", "--json")
    assert code == 0, err
    row = json.loads(out)["rows"][0]
    assert row["force_x_N"] == pytest.approx(0, abs=1e-9)
    assert row["torque_y_Nm"] == pytest.approx(0, abs=1e-9)


def test_bias_inside_leaves_nothing(simulated: SimulatedSensor) -> None:
    code, out, err = run("bias", *at(simulated), "--records", "20", "--inside", "--json")
    assert code == 0, err
    rows = {row["what"]: (row["value"], row["unit"]) for row in json.loads(out)["rows"]}
    assert rows["force_x"] == (0.0, "N")
    assert rows["torque_y"] == (0.0, "N m")


def test_bias_shows_before_and_after(simulated: SimulatedSensor) -> None:
    code, out, err = run("bias", *at(simulated), "--records", "20", "--json")
    assert code == 0, err
    row = json.loads(out)["rows"][0]
    assert (row["what"], row["unit"]) == ("force_x", "N")
    assert [row[key] for key in ("value", "before", "after")] == pytest.approx([3, 3, 0])
    code, out, err = run("bias", *at(simulated), "--records", "20")
    assert code == 0, err
    assert "before" in out
    assert "Standard deviation before: 0.0000 N, 0.00000 N m." in out


def test_bias_names_a_force_that_may_be_that_of_a_hand(
    simulated: SimulatedSensor, tmp_path: Path
) -> None:
    code, _, err = run("bias", *at(simulated), "--records", "20")
    assert code == 0, err
    assert (
        "Note: a force of 3.61 N is taken as zero; make sure that nobody touches the handle" in err
    )
    host, port = simulated.address
    file = tmp_path / "sensor.toml"
    for x, beyond in ((2.9, ""), (2.0, "1.00 N beyond the bias of the configuration")):
        file.write_text(
            f"[sensor]\nhost = '{host}'\nport = {port}\ncounts_per_force = 1e5\n"
            f"counts_per_torque = 2e5\nbias = [{x}, 0, 2, 0, 0.06, 0]\n"
        )
        code, _, err = run("bias", "--config", str(file), "--records", "20")
        assert code == 0, err
        assert beyond in err if beyond else err == ""


@pytest.mark.slow
@pytest.mark.weekly
def test_bias_takes_no_load_without_being_told(tmp_path: Path) -> None:
    options = EmulatorOptions(load=20)
    with SimulatedSensor(options=options) as heavy:
        host, port = heavy.address
        file = tmp_path / "sensor.toml"
        file.write_text(f"[sensor]\nhost = '{host}'\nport = {port}\n")
        for more in ([], ["--inside"]):
            code, out, err = run("bias", "--config", str(file), *more)
            assert code == 1
            assert out == ""
            assert "20 N: must be at most 7.25 N (5 % of 145 N, as sensor.force_range" in err
            assert "--accept-load" in err
        code, out, err = run("bias", "--config", str(file), "--accept-load")
        assert code == 0, err
        line = next(line.strip() for line in out.splitlines() if "bias = [" in line)
        with file.open("a") as text:
            text.write(f"{line}\n")
        code, out, err = run("bias", "--config", str(file))  # from the zero it has
        assert code == 0, err
        assert line in out


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["read", "--host", "no.such.host.invalid"], 2, "no such host"),
        (["read", "--model", "mini45"], 2, "there are: net-ft, axia, other"),
        (["read", "--config", "nowhere.toml"], 2, "nowhere.toml: there is no such file"),
        (
            ["simulate", "--hand-force", "1", "0", "0", "--hand", "open"],
            2,
            "--hand-force: stands for",
        ),
        (["simulate", "--host", "192.0.2.1", "--hand-force", "1", "0", "0"], 1, "no such address"),
        (["simulate", "--hand", "nobody"], 2, "no hand is called 'nobody'"),
        (["simulate", "--load", "1e9"], 2, "--load = 1e+09 N"),
    ],
)
def test_bad_input_is_reported(words: list[str], code: int, message: str) -> None:
    got, out, err = run(*words)
    assert got == code, err
    assert out == ""
    assert message in err


def test_nobody_there_is_reported() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = str(taken.getsockname()[1])
        code, out, err = run("read", "--host", "127.0.0.1", "--port", port, "--timeout", "0.1")
    assert (code, out) == (1, "")
    assert "no answer; check its power and cable" in err


def test_a_file_without_a_sensor_is_reported(tmp_path: Path) -> None:
    file = tmp_path / "a.toml"
    for text, message in (
        ("", "has no table [sensor]"),
        ("[sensor", "is no TOML"),
        ("[sensor]\nport = 'x'", "sensor.port = 'x': must be a whole number"),
        ("[sensor]\nprt = 1", "did you mean 'port'"),
    ):
        file.write_text(text)
        code, _, err = run("read", "--config", str(file))
        assert code == 2
        assert message in err


def test_simulate_says_where_it_is_and_what_it_did() -> None:
    code, out, err = run("simulate", "--port", "0", "--http-port", "0", "--seconds", "0.1")
    assert code == 0, err
    assert "Simulated force sensor at 127.0.0.1:" in out
    assert "its page at http://127.0.0.1:" in out
    assert "0 requests obeyed" in out


def test_help_teaches() -> None:
    for command in ("read", "bias", "simulate"):
        code, out, _ = run(command, "--help")
        assert code == 0
        assert "ebac sensor" in out


def test_a_configuration_is_of_the_factory() -> None:
    assert (SensorConfig().host, SensorConfig().port) == ("192.168.1.1", 49152)
