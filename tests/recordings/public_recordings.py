"""Identify a device and arms from public recordings, and print the estimates beside what was published.

The recordings belong to their makers and are not part of this repository. With a network:

    python tests/recordings/public_recordings.py --folder recordings

fetches what is not in the folder yet. Without one, put DATA_EMPS.mat, DATA_EMPS_PULSES.mat or symbol_data.mat there;
what is missing is left out. `public_twins` simulates files of the same shape.

EMPS: A. Janot, M. Gautier, M. Brunot, Data Set and Reference Models of EMPS, 2019 Workshop on Nonlinear System
Identification Benchmarks, Eindhoven; no licence is stated with the data. Panda: G. Braglia, D. Tebaldi,
A. E. Lazzaretti, L. Biagiotti, Panda Co-Manipulation Dataset, University of Modena and Reggio Emilia, MIT licence.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import urllib.request
from pathlib import Path
from time import process_time

import numpy as np
from numpy.typing import NDArray

from ebac import identify

Values = NDArray[np.float64]

_RAW = "https://raw.githubusercontent.com"
_EMPS = f"{_RAW}/forgi86/sysid-neural-continuous/93afc131780fb1d5477472935a18ac8405683890/examples/EMPS/data"
_PANDA = (
    f"{_RAW}/AutoLabModena/Panda-Co-Manipulation-Dataset/ff7ba9eef7921a252aed1ea6891be8c922c713c1"
)
DEVICE, VALIDATION, ARMS = "DATA_EMPS.mat", "DATA_EMPS_PULSES.mat", "symbol_data.mat"
#: Address and SHA-256 of each file.
FILES = {
    DEVICE: (f"{_EMPS}/{DEVICE}", "6cf6814ae14618795da0101aae2bb97ff0c6351b0501b5492751b02b07facf7e"),
    VALIDATION: (f"{_EMPS}/{VALIDATION}", "0eab75bb1f6b16228ee78791343a88bf9bfd9a51036ac9807d7b5fc11c0e1704"),
    ARMS: (f"{_PANDA}/Panda_CoManipulation_Data/17/{ARMS}",
           "349182d62d00af383773557dc7963a658e2feed3b83aceee721342137e330864"),
}  # fmt: skip
#: Of IDIM-LS, values and standard deviations; the offset resists +x, a weight moves towards it.
PUBLISHED = {
    "M_h": (95.1089, 0.1085),
    "B_h": (203.5034, 1.1460),
    "coulomb": (20.3935, 0.1012),
    "weight": (3.1648, 0.0444),
}
#: Sampling of the arms' recordings [Hz], by their makers' example.
ARM_RATE = 1000.0


def fetched(name: str, folder: Path, *, network: bool) -> Path | None:
    """Return a file of the folder, fetched where it is not there yet; None where it cannot be had.

    Raises
    ------
    ValueError
        When what was fetched is another file.
    """
    path, (address, checksum) = folder / name, FILES[name]
    if not path.exists() and network:
        try:
            with urllib.request.urlopen(address, timeout=30) as answer:
                content = answer.read()
        except OSError as error:
            print(f"{name}: not fetched from {address}: {error}")
            return None
        found = hashlib.sha256(content).hexdigest()
        if found != checksum:
            raise ValueError(f"{name}: SHA-256 = {found}: must be {checksum}; see {address}")
        path.write_bytes(content)
    return path if path.exists() else None


def share_explained(path: Path, values: dict[str, float]) -> tuple[float, float]:
    """Return VAF of the drive's force and its relative error, each row by the equations that were published.

    A Butterworth filter of 100 Hz both ways, central differences, one row in ten: no line of the product.
    """
    from scipy.io import loadmat
    from scipy.signal import butter, decimate, filtfilt

    log = {name: np.ravel(v).astype(float) for name, v in loadmat(path).items() if name[0] != "_"}
    q = filtfilt(*butter(4, 0.2), log["qm"])
    v = np.gradient(q, 1e-3)
    columns = {
        "M_h": np.gradient(v, 1e-3),
        "B_h": v,
        "coulomb": np.sign(v),
        "weight": -np.ones(len(v)),
    }
    model = sum(values[name] * column for name, column in columns.items())
    force, modelled = (decimate(f[50:], 10) for f in (log["gtau"] * log["vir"], model))
    e = force - modelled
    return float(1 - np.var(e) / np.var(force)), float(np.linalg.norm(e) / np.linalg.norm(force))


def fitted(path: Path) -> tuple[identify.Recording, identify.DeviceResult]:
    """Return a recording of the axis, and the device of it."""
    from scipy.io import loadmat

    recording = identify.load(
        path,
        columns={"x": "qm", "motor": "vir"},
        units={"motor": "V"},
        force_constant=float(np.ravel(loadmat(path)["gtau"])[0]),
        flip_motor=True,
    )
    return recording, identify.fit_device(recording)


def device(path: Path, validation: Path | None) -> bool:
    """Print the device of a recording beside the published one; return whether every interval holds it."""
    began = process_time()
    recording, result = fitted(path)
    print(f"{path.name}: {recording}")
    print(
        f"fitted in {process_time() - began:.2f} s of the processor; {100 * result.explained:.2f} % of the force"
    )
    held = not result.undetermined and result.estimates.keys() == PUBLISHED.keys()
    for name, (true, deviation) in PUBLISHED.items():
        e = result.estimates[name]
        inside = e.low <= true <= e.high
        held &= inside
        print(
            f"{name:8} {e.value:8.3f} ({e.low:.3f} to {e.high:.3f}) {e.unit:6} published {true:.3f} "
            f"+- {1.96 * deviation:.3f}, {100 * (e.value / true - 1):+.2f} %, {'inside' if inside else 'OUTSIDE'}"
        )
    sets = {
        "identified": {name: e.value for name, e in result.estimates.items()},
        "published": {name: true for name, (true, _) in PUBLISHED.items()},
    }
    for one in (path, validation):
        for who, values in sets.items() if one else ():
            assert one is not None
            vaf, error = share_explained(one, values)
            print(
                f"{one.name}: {who:10} VAF of the force {100 * vaf:.2f} %, relative error {100 * error:.2f} %"
            )
    if validation:
        alone = fitted(validation)[1]
        found = ", ".join(
            f"{e.name} {e.value:.4g} ({e.low:.4g} to {e.high:.4g})"
            for e in alone.estimates.values()
        )
        print(f"{validation.name} fitted alone: {found}")
    return held


def arms(path: Path) -> bool:
    """Print the verdict on a hand that leads a robot, for each trial and axis; return whether none is determined.

    Nothing but the hand moves the robot, so the log holds nothing about the hand: all multiples of hand and robot
    would have moved alike.
    """
    from scipy.io import loadmat

    right = True
    for trial in range(1, np.size(loadmat(path)["symbol_data"]) + 1):
        for number, letter in enumerate("xy"):
            columns = {
                "x": f"symbol_data_{trial}_pos_{number}",
                "force": f"symbol_data_{trial}_F_{number}",
            }
            recording = identify.load(path, columns=columns, rate=ARM_RATE)
            result = identify.fit_arm(recording, identify.Target.held())
            known = {"M0", "B0", "K0"} - set(result.undetermined)
            right &= not known
            print(
                f"{path.name}: trial {trial}, {letter}, {recording.seconds:.1f} s: "
                f"{'determines ' + ', '.join(sorted(known)) if known else 'hand not determined'}; "
                f"VAF {100 * result.explained:.3g} %"
            )
    return right


def main(words: list[str] | None = None) -> int:
    """Judge all that can be had; the exit code is 1 when one is not as expected, 2 when there is none."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--no-network", action="store_true", help="fetch nothing")
    given = parser.parse_args(words)
    given.folder.mkdir(parents=True, exist_ok=True)
    paths = {n: fetched(n, given.folder, network=not given.no_network) for n in FILES}
    for name in (name for name, path in paths.items() if path is None):
        print(f"{name}: is not there; {FILES[name][0]}")
    verdicts = []
    if axis := paths[DEVICE]:
        verdicts.append(device(axis, paths[VALIDATION]))
    if trials := paths[ARMS]:
        verdicts.append(arms(trials))
    return (0 if all(verdicts) else 1) if verdicts else 2


if __name__ == "__main__":
    sys.exit(main())
