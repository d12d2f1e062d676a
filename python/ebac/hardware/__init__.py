"""Run a law on hardware in real time: configuration, device, run.

::

    with ebac.Device.open("joystick.toml", simulate=True) as device:
        trace = device.run("ebac", seconds=10, log="run.mcap")
"""

from ebac.hardware.axis_positions import AxisPosition, PositionError, axis_positions, distances
from ebac.hardware.backends import Backend, virtual_can
from ebac.hardware.configuration import Configuration
from ebac.hardware.device import OpenDevice
from ebac.hardware.encoder_signs import find_encoder_signs
from ebac.hardware.find_signs import AxisSigns, find_signs
from ebac.hardware.interrupts import Terminated
from ebac.hardware.law import designed
from ebac.hardware.motor_profile import profile_for
from ebac.hardware.report import Report, Times, times
from ebac.hardware.run import Run
from ebac.hardware.signs import Signs
from ebac.hardware.tables import ConfigurationError
from ebac.hardware.zero import Zero
from ebac.trace.acting import under_the_law

__all__ = [
    "AxisPosition",
    "AxisSigns",
    "Backend",
    "Configuration",
    "ConfigurationError",
    "OpenDevice",
    "PositionError",
    "Report",
    "Run",
    "Signs",
    "Terminated",
    "Times",
    "Zero",
    "axis_positions",
    "designed",
    "distances",
    "find_encoder_signs",
    "find_signs",
    "profile_for",
    "times",
    "under_the_law",
    "virtual_can",
]


def __dir__() -> list[str]:
    return __all__
