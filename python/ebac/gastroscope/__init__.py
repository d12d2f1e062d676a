"""Gastroscopy in simulation: joystick, line, gastroscope, patient and physician in one loop.

::

    from ebac import gastroscope

    run = gastroscope.gastroscopy("ebac")
    print(run.findings["most_section"])  # N, largest force on the tissue

Everything here is a simulation with measures from the literature and assumptions that are named; it says nothing about
patients.
"""

from ebac._core import FarLink, Follow, Gears, Master, Patient, Physician, Polyp, Scope
from ebac.gastroscope.chain import Chain, chain
from ebac.gastroscope.far_side import LinkEvent, SideReport
from ebac.gastroscope.lumen import Lumen, Wall
from ebac.gastroscope.on_drives import configuration, run_master, run_slave
from ebac.gastroscope.procedure import Gastroscopy, Procedure, gastroscopy
from ebac.gastroscope.slave import Camera, Slave, SlaveState, camera
from ebac.gastroscope.study import Effect, GastroscopyStudy, StudyRow, gastroscopy_study

__all__ = [
    "Camera",
    "Chain",
    "Effect",
    "FarLink",
    "Follow",
    "Gastroscopy",
    "GastroscopyStudy",
    "Gears",
    "LinkEvent",
    "Lumen",
    "Master",
    "Patient",
    "Physician",
    "Polyp",
    "Procedure",
    "Scope",
    "SideReport",
    "Slave",
    "SlaveState",
    "StudyRow",
    "Wall",
    "camera",
    "chain",
    "configuration",
    "gastroscopy",
    "gastroscopy_study",
    "run_master",
    "run_slave",
]


def __dir__() -> list[str]:
    return __all__
