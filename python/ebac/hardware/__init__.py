"""A law on hardware, in real time: configuration, device, run.

::

    with ebac.Device.open("examples/joystick.toml", simulate=True) as device:
        trace = device.run("ebac", seconds=10, log="run.mcap")
"""

from ebac.hardware.configuration import Configuration
from ebac.hardware.device import OpenDevice
from ebac.hardware.interrupts import Terminated
from ebac.hardware.law import designed
from ebac.hardware.place import Place, virtual_can
from ebac.hardware.report import Report, Times, times, under_the_law
from ebac.hardware.run import Run
from ebac.hardware.tables import ConfigurationError

__all__ = [
    "Configuration",
    "ConfigurationError",
    "OpenDevice",
    "Place",
    "Report",
    "Run",
    "Terminated",
    "Times",
    "designed",
    "times",
    "under_the_law",
    "virtual_can",
]
