"""Small simulated data sets: the logs, paths and files that the documentation uses.

A first look::

    import ebac

    trace = ebac.datasets.arm()  # computed now, the same on every call
    recording = ebac.identify.Recording.from_trace(trace)
    print(ebac.identify.fit_arm(recording))
    print(trace.scenario.hand)  # the true arm

`ebac demo` lists them, `ebac demo arm` writes the file `arm.csv`. Nothing here was measured.
"""

from ebac.datasets.files import DATASETS, Dataset, write
from ebac.datasets.logs import arm, device, press, sway, tapping
from ebac.datasets.others import circle, hands, joystick, joystick_text, line

__all__ = [
    "DATASETS",
    "Dataset",
    "arm",
    "circle",
    "device",
    "hands",
    "joystick",
    "joystick_text",
    "line",
    "press",
    "sway",
    "tapping",
    "write",
]


def __dir__() -> list[str]:
    return __all__
