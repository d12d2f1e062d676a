"""From logs to models: the arm of eq. (4), the device, the gains of eq. (2).

A first look::

    from ebac import identify

    recording = identify.load("press.csv")
    result = identify.fit_arm(recording)
    print(result)  # estimates, intervals, what cannot be told apart
    scenario = ebac.Scenario(hand=result.hand)
"""

from ebac.identify import excitation
from ebac.identify.arm import fit_arm
from ebac.identify.device import DeviceResult, fit_device
from ebac.identify.load import load
from ebac.identify.recording import Recording
from ebac.identify.result import ArmResult, Estimate
from ebac.identify.target import Target

__all__ = [
    "ArmResult",
    "DeviceResult",
    "Estimate",
    "Recording",
    "Target",
    "excitation",
    "fit_arm",
    "fit_device",
    "load",
]
