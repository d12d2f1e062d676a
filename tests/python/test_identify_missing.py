"""A log that lacks a signal: what was read of it, what is left, and how to name the column."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac.cli import app
from ebac.identify import check_log, fit_arm, fit_device, frequency_response, load

T = 1e-3 * np.arange(200)
X = 3e-5 * np.round(1e3 * np.sin(20 * T))
F = np.cos(20 * T)


def text(head: str, *columns: np.ndarray) -> bytes:
    rows = [",".join(f"{value:.6g}" for value in row) for row in zip(*columns, strict=True)]
    return "\n".join([head, *rows, ""]).encode()


def test_a_position_that_is_not_found_names_the_argument_or_the_option(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_bytes(text("t,Handle Way [m],force", T, X, F))
    with pytest.raises(ValueError, match="which is it") as refused:
        load(log)
    assert "columns={'x': 'Handle Way'}" in str(refused.value)
    assert "--column" not in str(refused.value)
    assert load(log, columns={"x": "Handle Way"}).x == pytest.approx(X, rel=1e-4, abs=1e-9)
    said = " ".join(CliRunner().invoke(app, ["identify", "arm", str(log)]).output.split())
    assert '--column "x=Handle Way"' in said
    assert "columns=" not in said
    log.write_bytes(text("t,way,force", T, X, F))
    assert "--column x=way" in CliRunner().invoke(app, ["identify", "arm", str(log)]).output


def test_a_force_that_is_not_found_names_what_is_left_and_the_option(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_bytes(text("t,x,Temp,Hand Load [N]", T, X, T, F))
    for call in (fit_arm, check_log, frequency_response):
        with pytest.raises(ValueError, match="only t, x; the file also has Temp, Hand Load") as no:
            call(load(log))
        assert "columns={'force': 'Hand Load'}" in str(no.value), "by its unit"
    for command in ("arm", "log", "gains"):
        done = CliRunner().invoke(app, ["identify", command, str(log)])
        assert done.exit_code == 2
        assert '--column "force=Hand Load"' in " ".join(done.output.split())
    assert load(log, columns={"force": "Hand Load"}).unread == ("Temp",)
    log.write_bytes(text("t,x", T, X))
    with pytest.raises(
        ValueError, match=r"only t, x; name its column, columns=\{'force': 'NAME'\}"
    ):
        fit_arm(load(log))


def test_forces_that_are_both_missing_name_what_is_left(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_bytes(text("t,x,Drive", T, X, F))
    with pytest.raises(ValueError, match=r"neither the motor's force nor the hand's.* 'Drive'"):
        fit_device(load(tmp_path / "log.csv"))


def test_a_time_that_is_not_found_names_the_option(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_bytes(text("Clock [ms],x,force", 1e3 * T, X, F))
    with pytest.raises(ValueError, match=r"no time among Clock .*columns=\{'t': 'Clock'\}.*rate="):
        load(log)
    done = CliRunner().invoke(app, ["identify", "arm", str(log)])
    assert "--column t=Clock. Or say how many rows a second" in " ".join(done.output.split())


def test_a_file_of_a_time_and_a_force_has_no_column_to_propose(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_bytes(text("t,force", T, F))
    with pytest.raises(
        ValueError, match="found no position among t, force; the file needs a column of it"
    ):
        load(tmp_path / "log.csv")


def test_all_that_a_log_lacks_is_asked_for_at_once_and_named_in_one_option(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_bytes(text("a,b,my force", T, X, F))
    with pytest.raises(ValueError, match="no time and no position and no force of the hand") as no:
        load(log)
    assert "which are they? For example columns={'t': 'a', 'x': 'b', 'force': 'my force'}" in str(
        no.value
    )
    done = CliRunner().invoke(app, ["identify", "arm", str(log)])
    assert '--column t=a --column x=b --column "force=my force"' in " ".join(done.output.split())
    assert "no position and no force" in CliRunner().invoke(
        app, ["identify", "arm", str(log), "--rate", "1000"]
    ).output.replace("\n", " ")
    named = ["--column", "t=a,x=b,force=my force"]
    shown = CliRunner().invoke(app, ["identify", "log", str(log), *named]).output
    assert "found no" not in shown
    assert "there is no column" not in shown
