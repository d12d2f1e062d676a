"""Stable haptic rendering: laws, devices, hands and virtual walls, simulated at 1 kHz by a C++ core.

A first look::

    import ebac

    trace = ebac.simulate(ebac.Scenario(), "ebac")
    print(ebac.contact(trace))
    trace.plot()
"""

from importlib.metadata import version as _version

from ebac import logs, maps, presets, zwidth
from ebac._core import (
    EBA,
    EBAC,
    TCA,
    AdaptiveWindow,
    BackwardDifference,
    Capstan,
    Compensation,
    Corner,
    Device,
    DeviceFacts,
    Direct,
    Disc,
    Drive,
    EBACPrinted,
    Encoder,
    ExactPlant,
    Fault,
    ForceBounding,
    ForceSensor,
    Free,
    Gimbal,
    Hand,
    Limited,
    Limits,
    Linear,
    LoopState,
    LowPass,
    Mechanics,
    MinimumJerk,
    Motor,
    PassivityControl,
    Port,
    Recorded,
    RunLimits,
    Sine,
    Step,
    SteppedPlant,
    Tapping,
    TCADamped,
    Timing,
    VirtualCoupling,
    Wall,
    copley_current,
    estimate_velocity,
)
from ebac.columns import ColumnInfo
from ebac.laws import LAWS, PythonLaw, Variant, design
from ebac.logs import load, replay
from ebac.metrics import Contact, contact, ideal_rest
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.simulation import LoopFault, simulate
from ebac.specs import Spec, spec_sheet
from ebac.studies import CONDITIONS, Ablation, Condition, Study, Worst, ablation, study, worst
from ebac.sweeps import SweepInterrupted, SweepResult, sweep
from ebac.trace import Trace

__version__ = _version("ebac")

__all__ = [
    "CONDITIONS",
    "EBA",
    "EBAC",
    "LAWS",
    "TCA",
    "Ablation",
    "AdaptiveWindow",
    "BackwardDifference",
    "Capstan",
    "ColumnInfo",
    "Compensation",
    "Condition",
    "Contact",
    "Corner",
    "Device",
    "DeviceFacts",
    "Direct",
    "Disc",
    "Drive",
    "EBACPrinted",
    "Encoder",
    "ExactPlant",
    "Fault",
    "ForceBounding",
    "ForceSensor",
    "Free",
    "Gimbal",
    "Hand",
    "Limited",
    "Limits",
    "Linear",
    "LoopFault",
    "LoopState",
    "LowPass",
    "Mechanics",
    "MinimumJerk",
    "Motor",
    "Operators",
    "PassivityControl",
    "Port",
    "PythonLaw",
    "Recorded",
    "RunLimits",
    "Scenario",
    "Sine",
    "Spec",
    "Step",
    "SteppedPlant",
    "Study",
    "SweepInterrupted",
    "SweepResult",
    "TCADamped",
    "Tapping",
    "Timing",
    "Trace",
    "Variant",
    "VirtualCoupling",
    "Wall",
    "Worst",
    "__version__",
    "ablation",
    "contact",
    "copley_current",
    "design",
    "estimate_velocity",
    "ideal_rest",
    "load",
    "logs",
    "maps",
    "presets",
    "replay",
    "simulate",
    "spec_sheet",
    "study",
    "sweep",
    "worst",
    "zwidth",
]
