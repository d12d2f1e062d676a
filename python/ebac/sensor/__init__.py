"""The force/torque sensor at the handle: ATI Net F/T and what speaks like it, over UDP (RDT)."""

from ebac._core import EmulatorOptions, EmulatorTrouble, LinkState, SensorStatus, SharedForce
from ebac.sensor.configuration import SensorConfig
from ebac.sensor.errors import SensorError
from ebac.sensor.page import SensorPage, read_page
from ebac.sensor.reading import SensorCounts, SensorReading
from ebac.sensor.rest import Rest
from ebac.sensor.sensor import Sensor
from ebac.sensor.simulated import SimulatedSensor
from ebac.sensor.status import explain

__all__ = [
    "EmulatorOptions",
    "EmulatorTrouble",
    "LinkState",
    "Rest",
    "Sensor",
    "SensorConfig",
    "SensorCounts",
    "SensorError",
    "SensorPage",
    "SensorReading",
    "SensorStatus",
    "SharedForce",
    "SimulatedSensor",
    "explain",
    "read_page",
]


def __dir__() -> list[str]:
    return __all__
