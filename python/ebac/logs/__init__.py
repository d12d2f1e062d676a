"""Logs: MCAP files of a run, one message per row, written while it runs and read in any state.

::

    with ebac.logs.Recorder(rows, "run.mcap", law="ebac"):
        ...
    log = ebac.logs.read("run.mcap")
    log.trace.plot()
"""

from ebac.logs.about import About
from ebac.logs.events import Event
from ebac.logs.files import FORMATS, load, save
from ebac.logs.log import Gap, Log
from ebac.logs.reader import read
from ebac.logs.recorder import Recorder
from ebac.logs.records import Condition
from ebac.logs.repair import repair
from ebac.logs.replay import replay
from ebac.logs.ros2 import Bag, to_ros2
from ebac.logs.writer import LogWriter

__all__ = [
    "FORMATS",
    "About",
    "Bag",
    "Condition",
    "Event",
    "Gap",
    "Log",
    "LogWriter",
    "Recorder",
    "load",
    "read",
    "repair",
    "replay",
    "save",
    "to_ros2",
]


def __dir__() -> list[str]:
    return __all__
