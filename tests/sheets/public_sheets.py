"""Read public EDS and DCF files of makers, and take their drives through a profile: plan, apply, verify, enable.

The files belong to their makers and are not part of this repository. With a network:

    python tests/sheets/public_sheets.py --folder /tmp/sheets

fetches what is not in the folder yet, and prints a line for each file: how many entries it has, and what became of
the profile for it. A file without a profile is one of a drive that takes no torque, and must be refused.
"""

from __future__ import annotations

import argparse
import sys
import urllib.request
from pathlib import Path

from drive_through import drive_through

from ebac import drives

_RAW = "https://raw.githubusercontent.com"
_KIT = (
    f"{_RAW}/KITmedical/kacanopen/38fc1acc45bd08016dce0feab6f4aa43bef61006/master/share/eds_library"
)
_CRF = f"{_RAW}/Pejman712/CRF/c507aee20eaaa60706bfd70426db645b2d52d937/modules/Devices/CANopenDrivers/config"
_TMC = f"{_RAW}/analogdevicesinc/PyTrinamic"
_EPOS4 = f"{_RAW}/Roboprotos/maxon_epos4_ros1/6630475be53355c438c21a726cf6c9e1223f862a/maxon_epos4_ros_canopen/config"
#: Address of a file, and the profile that its drive takes; none for a drive without torque.
SHEETS: tuple[tuple[str, str | None], ...] = (
    (f"{_CRF}/MaxonEPOS4/MaxonEPOS4.eds", "maxon-epos4"),
    (f"{_EPOS4}/epos4_50_15_can_ec90flat_gp52c_mile800_node1.dcf", "maxon-epos4"),
    (f"{_RAW}/KIM-HC/canopen_linux/3d3fa910aa26e08a4751ba45a9ac963e9441e8a0/eds_file/elmo.eds", "elmo-gold"),
    (f"{_TMC}/2679fe6c13d7ad284a12a805903fd2bfe510b6b6/PyTrinamic/modules/TMCM1617/TMCM_1617_Hw1.2_Fw1.06.eds",
     "trinamic-tmcm"),
    (f"{_TMC}/2679fe6c13d7ad284a12a805903fd2bfe510b6b6/PyTrinamic/modules/TMCM1636/TMCM_1636_Hw1.1_Fw1.08.eds",
     "trinamic-tmcm"),
    (f"{_TMC}/59f78bad5abc76740d1394f0c67bac6e3f855f3e/examples/modules/TMCM_1636/CANopen/"
     "TMCM-1636-CANopen_Hw1.1_Fw1.12.eds", "trinamic-tmcm"),
    (f"{_RAW}/shortmr/emg_dyad_collection/6a26a1c1954647b65ad0359eef321499967ac049/CopleyAmp_yw.eds",
     "copley-guarded"),
    (f"{_KIT}/CiA_profiles/402.eds", None),
    (f"{_CRF}/MaxonEPOS2/MaxonEPOS2.eds", None),
    (f"{_CRF}/ERB415/ERB415.eds", None),
    (f"{_KIT}/MaxonMotor/epos2_347717.eds", None),
    (f"{_KIT}/Faulhaber/605.3150.51-V-EK-2-60.eds", None),
    (f"{_KIT}/Faulhaber/605.3150.67-B-EK-2-60.eds", None),
    (f"{_RAW}/hellantos/trinamic_pd42_can/f6cb0c3bd098a80dec0b07810eb65bc6a598b674/config/single-pd42/TMCM-1270.eds",
     None),
    (f"{_TMC}/16bde95783a4a35edc593a21c9ee2918ecf324d0/examples/modules/TMCM123x_0_1/CANopen/TMCM-1230.eds", None),
)  # fmt: skip


def fetched(address: str, folder: Path) -> Path:
    """Return the file of an address, fetched where it is not there yet."""
    path = folder / address.removeprefix(f"{_RAW}/").replace("/", "__")
    if not path.exists():
        with urllib.request.urlopen(address, timeout=30) as answer:
            path.write_bytes(answer.read())
    return path


def outcome(sheet: drives.Sheet, profile: str | None) -> tuple[bool, str]:
    """Return whether a drive with this sheet does what is expected, and what it does."""
    try:
        network = drives.load(profile or "generic-cia402", nodes=[1])
        drives.check_sheet(network, sheet)
        written = drive_through(sheet, network)
    except (drives.DriveError, drives.ProfileError) as error:
        return profile is None, f"refused: {str(error)[:160]}"
    return profile is not None, f"{profile}: {written} writes, verified, enabled, restored"


def main() -> int:
    """Check all; the exit code is 1 when one is not as expected."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, required=True)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    right = 0
    for address, profile in SHEETS:
        sheet = drives.read_eds(fetched(address, folder))
        good, text = outcome(sheet, profile)
        right += good
        mark = "ok " if good else "BAD"
        print(f"{mark} {address.rsplit('/', 1)[1]}: {len(sheet.entries)} entries; {text}")
    print(f"{right} of {len(SHEETS)} as expected")
    return 0 if right == len(SHEETS) else 1


if __name__ == "__main__":
    sys.exit(main())
