"""Stable haptic rendering: laws, devices, hands and virtual walls, simulated at 1 kHz by a C++ core.

A first look::

    import ebac

    trace = ebac.simulate(ebac.Scenario(), "ebac")
    print(ebac.contact(trace))
    trace.plot()
"""

import ebac._util.parent  # noqa: F401 - which notes it now
from ebac._util.lazy import from_stub

__getattr__, __dir__, __all__ = from_stub(__name__, __file__)
