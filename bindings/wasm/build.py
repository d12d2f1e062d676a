"""Compile the core to WebAssembly: `python bindings/wasm/build.py [OUT]`.

Needs the `ziglang` wheel, a C++ compiler with the libraries of wasm32-wasi, and Eigen's headers: in a clone
`pip install '.[wasm]'`. EBAC_WASM_CXX may name another such compiler: ziglang's compiles its libraries first, which
takes three times as long as the module. Without OUT the module goes where the installed package looks for it.
"""

import os
import shlex
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

HERE = Path(__file__).parent
CPP = HERE.parents[1] / "cpp"
#: What a simulated tick and the measures of a contact need of the core. One translation unit: the headers, Eigen's
#: among them, are most of the work.
CORE = (
    *("core/check", "core/fields", "core/matrix_exponential"),
    *("control/laws", "control/turned_ports", "control/virtual_coupling"),
    *("loop/axis_observer", "loop/plausibility", "loop/safety_limiter", "loop/signal_chain"),
    "loop/state_observer",
    *(
        "model/device",
        "model/environment",
        "model/exact_axis",
        "model/exact_plant",
        "model/hand",
        "model/hand_model",
    ),
    *("model/joint_dynamics", "model/kinematics", "model/limits", "model/linear_flow"),
    *("model/port_space", "model/stepped_plant"),
    *("sim/simulated_device", "sim/contact", "sim/perceived_ripple"),
)
OWN = ("settings", "catalogue", "exports")
#: As the core is compiled elsewhere: the bits are the same where the libraries' functions are.
FLAGS = (
    *("-target", "wasm32-wasi", "-mexec-model=reactor", "-std=c++20", "-O2", "-DNDEBUG"),
    *("-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-w", "-s"),
    *("-Wl,--gc-sections", "-Wl,--export=__stack_pointer"),
)


def sources() -> list[Path]:
    """Return all that the module is made of."""
    return [*CPP.rglob("*.[hc]pp"), *HERE.glob("*.[hc]pp"), Path(__file__)]


def eigen() -> Path:
    """Return the folder of Eigen's headers: the system's, or that of cmeel-eigen."""
    places = [Path("/usr/include"), *(Path(p, "cmeel.prefix", "include") for p in sys.path)]
    for place in places:
        if (place / "eigen3" / "Eigen" / "Core").is_file():
            return place / "eigen3"
    raise SystemExit("Eigen's headers are missing: pip install cmeel-eigen")


def compiler() -> list[str]:
    """Return the command of the compiler, empty where there is none."""
    if named := os.environ.get("EBAC_WASM_CXX"):
        return shlex.split(named)
    return [sys.executable, "-m", "ziglang", "c++"] if find_spec("ziglang") else []


def build(out: Path) -> None:
    """Compile the module to `out`."""
    if not compiler():
        raise SystemExit("ziglang, which compiles to WebAssembly, is missing: pip install ziglang")
    out.parent.mkdir(parents=True, exist_ok=True)
    files = len(CORE) + len(OWN) + 1
    print(f"compiling {files} files to WebAssembly in one step, about two minutes ...", flush=True)
    with tempfile.TemporaryDirectory() as room:
        unit = Path(room, "ebac.cpp")
        files = [
            *(CPP / "ebac" / f"{name}.cpp" for name in CORE),
            *(HERE / f"{n}.cpp" for n in OWN),
        ]
        unit.write_text("".join(f'#include "{file}"\n' for file in files), encoding="utf-8")
        made = Path(room, "ebac.wasm")
        subprocess.run(
            [*compiler(), *FLAGS, f"-I{CPP}", f"-I{HERE}", "-isystem", str(eigen()),
             str(unit), str(HERE / "throw.cpp"), "-o", str(made)],
            check=True,
        )  # fmt: skip
        out.write_bytes(made.read_bytes())


def fresh(out: Path) -> bool:
    """Return whether `out` is there and no source is newer."""
    return out.exists() and out.stat().st_mtime >= max(p.stat().st_mtime for p in sources())


def built(out: Path) -> Path:
    """Return `out`, compiled again where a source is newer; of several processes one compiles."""
    import fcntl

    out.parent.mkdir(parents=True, exist_ok=True)
    with out.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not fresh(out):
            build(out)
    return out


def default() -> Path:
    """Return where the installed package looks for the module."""
    found = find_spec("ebac")
    origin = found.origin if found else None
    package = Path(origin).parent if origin else HERE.parents[1] / "python" / "ebac"
    return package / "live" / "ebac.wasm"


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else default()
    build(target)
    print(f"{target}: {target.stat().st_size / 1e3:.0f} kB")
