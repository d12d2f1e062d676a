"""Compile the core to WebAssembly: `python bindings/wasm/build.py [OUT]`.

Needs the `ziglang` wheel, a C++ compiler with the libraries of wasm32-wasi, and Eigen's headers: in a clone
`pip install '.[wasm]'`. EBAC_WASM_CXX may name another such compiler: ziglang's compiles its libraries first, which
takes three times as long as the module. Without OUT the module goes where the installed package looks for it.
"""

import hashlib
import json
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path

HERE = Path(__file__).parent
CPP = HERE.parents[1] / "cpp"
#: What a simulated tick and the measures of a contact need of the core. One translation unit: the headers, Eigen's
#: among them, are most of the work.
CORE = (
    *("core/check", "core/fields", "core/matrix_exponential"),
    *("control/laws", "control/turned_ports", "control/virtual_coupling"),
    *("loop/axis_observer", "loop/gain_schedule", "loop/plausibility", "loop/safety_limiter"),
    *("loop/signal_chain", "loop/state_observer"),
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
    *("-target", "wasm32-wasi", "-std=c++20", "-O2", "-DNDEBUG"),
    *("-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-w"),
)
LINKED = ("-mexec-model=reactor", "-s", "-Wl,--gc-sections", "-Wl,--export=__stack_pointer")


def contents(files: Iterable[Path]) -> dict[str, str]:
    """Return the SHA-256 of each of these files."""
    return {str(f): hashlib.sha256(f.read_bytes()).hexdigest() for f in sorted(files)}


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


def build(out: Path) -> dict[str, str]:
    """Compile the module to `out`; return the files of this repository that it is made of, with their SHA-256."""
    if not compiler():
        raise SystemExit("ziglang, which compiles to WebAssembly, is missing: pip install ziglang")
    out.parent.mkdir(parents=True, exist_ok=True)
    own = [*(CPP / "ebac" / f"{name}.cpp" for name in CORE), *(HERE / f"{n}.cpp" for n in OWN)]
    throw = HERE / "throw.cpp"
    print(
        f"compiling {len(own) + 1} files to WebAssembly in one step, about two minutes ...",
        flush=True,
    )
    with tempfile.TemporaryDirectory() as room:
        unit, made, used = (Path(room, f"ebac.{kind}") for kind in ("cpp", "wasm", "d"))
        unit.write_text("".join(f'#include "{file}"\n' for file in own), encoding="utf-8")
        command = [*compiler(), *FLAGS, f"-I{CPP}", f"-I{HERE}", "-isystem", str(eigen())]
        subprocess.run([*command, "-MM", "-MF", str(used), str(unit)], check=True)
        words = used.read_text(encoding="utf-8").replace("\\\n", " ").split()
        included = {Path(word).resolve() for word in words[1:]} - {unit.resolve()}
        made_of = contents([*included, throw, Path(__file__)])
        subprocess.run([*command, *LINKED, str(unit), str(throw), "-o", str(made)], check=True)
        out.write_bytes(made.read_bytes())
    return made_of


def fresh(out: Path) -> bool:
    """Return whether `built` has compiled `out` from the files as they are now."""
    made_of = out.with_suffix(".json")
    if not out.exists() or not made_of.exists():
        return False
    then: dict[str, str] = json.loads(made_of.read_text(encoding="utf-8"))
    try:
        return contents(Path(f) for f in then) == then
    except FileNotFoundError:
        return False


def built(out: Path) -> Path:
    """Return `out`, compiled again where a file that it is made of has changed; of several processes one compiles."""
    import fcntl

    out.parent.mkdir(parents=True, exist_ok=True)
    with out.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not fresh(out):
            out.with_suffix(".json").write_text(json.dumps(build(out)), encoding="utf-8")
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
