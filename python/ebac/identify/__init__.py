"""Identify models from logs: the arm of eq. (4), the device, the gains of eq. (2).

A first look::

    from ebac import identify

    recording = identify.load("press.csv")
    result = identify.fit_arm(recording)
    print(result)  # estimates, intervals, parameters that cannot be separated
    scenario = ebac.Scenario(hand=result.hand)
"""

from ebac.identify import excitation
from ebac.identify.arm import fit_arm
from ebac.identify.device import fit_device
from ebac.identify.device_result import DeviceResult
from ebac.identify.estimate import Estimate
from ebac.identify.force_scale import ForceScale, force_scale
from ebac.identify.gains.gains import GainsResult, fit_gains
from ebac.identify.gains.trial import Limits
from ebac.identify.informativeness import LogCheck, check_log
from ebac.identify.load import load
from ebac.identify.loop import LoopModel, fit_loop
from ebac.identify.recording import Recording
from ebac.identify.response import Response, frequency_response
from ebac.identify.result import ArmResult
from ebac.identify.target import Target

__all__ = [
    "ArmResult",
    "DeviceResult",
    "Estimate",
    "ForceScale",
    "GainsResult",
    "Limits",
    "LogCheck",
    "LoopModel",
    "Recording",
    "Response",
    "Target",
    "check_log",
    "excitation",
    "fit_arm",
    "fit_device",
    "fit_gains",
    "fit_loop",
    "force_scale",
    "frequency_response",
    "load",
]


def __dir__() -> list[str]:
    return __all__
