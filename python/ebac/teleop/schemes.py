"""The schemes of teleoperation by name: what goes over the network, and the law of the master."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ebac._core import Coupling
from ebac._util.arguments import named
from ebac._util.wrong_calls import plain_constructor

POSITION_FORCE, PASSIVITY, WAVES = 0, 1, 2


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Scheme:
    """How master and slave are coupled, and the law of the master.

    Attributes
    ----------
    name : str
        Its name.
    law : str
        Of the master, by name.
    coupling : Coupling
        What goes over the network, and its parameters.
    summary : str
        One line.
    """

    name: str
    law: str
    coupling: Coupling
    summary: str

    def changed(self, **changes: Any) -> Scheme:
        """Return the same with parameters of the coupling changed."""
        return Scheme(
            name=self.name,
            law=self.law,
            coupling=self.coupling.replace(**changes),
            summary=self.summary,
        )


#: The schemes by name, with the parameters that `ebac teleop study --tune --device-noise 0.03` finds.
SCHEMES: Mapping[str, Scheme] = {
    name: Scheme(name=name, law=law, coupling=coupling, summary=summary)
    for name, law, coupling, summary in (
        (
            "position-force",
            "direct",
            Coupling(scheme=POSITION_FORCE, measured=True),
            "position there, measured force back, nothing that keeps it passive",
        ),
        (
            "master-passivity",
            "passivity-control",
            Coupling(scheme=POSITION_FORCE, measured=True),
            "the same, with passivity control at the master alone",
        ),
        (
            "two-port-passivity",
            "direct",
            Coupling(
                scheme=PASSIVITY,
                injection=20,
                catch_up=0.02,
                stiffness=500,
                reserve=1e-3,
                buffer=0.015,
            ),
            "passivity observers and controllers at both ports (Ryu, Artigas, Preusche 2010)",
        ),
        (
            "waves",
            "direct",
            Coupling(scheme=WAVES, impedance=40, buffer=0.015),
            "wave variables, matched impedance (Niemeyer, Slotine 1991, 2004)",
        ),
        (
            "ebac",
            "ebac",
            Coupling(scheme=POSITION_FORCE, buffer=0.015),
            "position there, the controller's force back, EBAC at the master",
        ),
        (
            "two-port-ebac",
            "ebac",
            Coupling(scheme=PASSIVITY, stiffness=8000, buffer=0.015),
            "EBAC at the master, an energy bound at the slave's port",
        ),
    )
}


def scheme(name: str) -> Scheme:
    """Return a scheme by its name.

    Parameters
    ----------
    name : str
        A name of `SCHEMES`.

    Raises
    ------
    KeyError
        For an unknown name; the message names the nearest.
    """
    return named("scheme", name, SCHEMES)


def chosen_scheme(given: str | Scheme) -> Scheme:
    """Return the scheme itself, or that of the name."""
    return given if isinstance(given, Scheme) else scheme(given)
