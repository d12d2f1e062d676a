"""Bilateral teleoperation: a master with a law, a network with delay and loss, a slave in contact.

::

    from ebac import teleop

    run = teleop.simulate("waves", there=teleop.Link(delay=0.1))
    print(run.swing_m, run.passive, run.transparency)
"""

from ebac._core import Coupling, Link, SlaveModel
from ebac._core import TeleopPacket as Packet
from ebac.teleop.endurance import Endurance, endurance
from ebac.teleop.run import Run, simulate
from ebac.teleop.schemes import SCHEMES, Scheme, scheme
from ebac.teleop.study import CONTACTS, DELAYS, NETWORKS, Study, StudyRow, study
from ebac.teleop.tuning import tuned

__all__ = [
    "CONTACTS",
    "DELAYS",
    "NETWORKS",
    "SCHEMES",
    "Coupling",
    "Endurance",
    "Link",
    "Packet",
    "Run",
    "Scheme",
    "SlaveModel",
    "Study",
    "StudyRow",
    "endurance",
    "scheme",
    "simulate",
    "study",
    "tuned",
]


def __dir__() -> list[str]:
    return __all__
