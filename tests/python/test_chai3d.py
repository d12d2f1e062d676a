"""examples/chai3d: CHAI3D's scenes under the laws of ebac, and a device of ebac in a program of CHAI3D."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from busy_machine import patient_file

ROOT = Path(__file__).parents[2]
#: Folders of chai3dConfig.cmake and of an installed core (`cmake --install BUILD --component core --prefix ...`).
NEEDED = ("CHAI3D_DIR", "EBAC_PREFIX")

missing = [name for name in NEEDED if name not in os.environ]
pytestmark = pytest.mark.skipif(
    bool(missing) or shutil.which("cmake") is None,
    reason=f"needs cmake, an installed CHAI3D and an installed core; not set: {', '.join(missing) or 'PATH'}",
)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    build = tmp_path_factory.mktemp("chai3d")
    command = ["cmake", "-S", str(ROOT / "examples" / "chai3d"), "-B", str(build)]
    command += [f"-DCHAI3D_DIR={os.environ['CHAI3D_DIR']}", "-DCMAKE_BUILD_TYPE=Release"]
    command += [f"-DCMAKE_PREFIX_PATH={os.environ['EBAC_PREFIX']}"]
    subprocess.run(command, check=True)
    subprocess.run(["cmake", "--build", str(build)], check=True)
    return build


def rows(program: Path, *options: str) -> list[dict[str, Any]]:
    done = subprocess.run([program, *options, "--json"], check=True, capture_output=True, text=True)
    found: list[dict[str, Any]] = json.loads(done.stdout)["rows"]
    return found


def test_scenes_of_chai3d_are_quiet_under_ebac(built: Path) -> None:
    found = rows(built / "chai3d_scenes")
    assert {row["scene"] for row in found} == {
        "box shape",
        "box mesh",
        "ball and wall",
        "sphere mesh",
    }
    for row in found:
        assert row["fault"] == 0
        if row["law"] == "ebac":
            assert row["swing_m"] < 0.25e-3
            assert row["least_energy_J"] > -1e-3
        if row["law"] == "direct" and row["stiffness_N_per_m"] == 20e3:
            assert row["swing_m"] > 5e-3


@pytest.mark.parametrize("options", [[], ["--hold"], ["--can"]], ids=" ".join)
def test_a_program_of_chai3d_runs_on_a_device_of_ebac(built: Path, options: list[str]) -> None:
    direct, ebac = rows(built / "chai3d_program", "--seconds", "2", *options)
    assert (direct["law"], ebac["law"]) == ("direct", "ebac")
    assert direct["swing_m"] > 5e-3
    assert ebac["swing_m"] < 0.25e-3
    assert ebac["least_energy_J"] > -1e-3
    again = rows(built / "chai3d_program", "--seconds", "2", *options)
    assert [row["rest_m"] for row in again] == [direct["rest_m"], ebac["rest_m"]]


@pytest.mark.real_time
def test_a_program_of_chai3d_is_the_world_of_a_run_on_drives(built: Path, tmp_path: Path) -> None:
    from ebac import datasets

    file = datasets.write("joystick", tmp_path)
    file.write_text(patient_file(file.read_text(encoding="utf-8")), encoding="utf-8")
    program = f"{built / 'chai3d_program'} --engine --stiffness 20000"
    command = [sys.executable, "-m", "ebac.cli", "run", str(file), "--simulated", "--seconds", "4"]
    done = subprocess.run(
        [*command, "--engine-command", program, "--json"],
        capture_output=True,
        text=True,
        check=True,
    )
    told = json.loads(done.stdout)
    assert told["engine"]["models"] > 500
    assert told["engine"]["trouble"] == ""
    assert told["rows"][0]["touched"]


def test_a_program_of_chai3d_without_a_loop_says_so(built: Path) -> None:
    bare = {name: value for name, value in os.environ.items() if name != "EBAC_ENGINE_CHANNEL"}
    done = subprocess.run(
        [built / "chai3d_program", "--engine"],
        env=bare,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "no channel to a loop is named" in done.stderr
