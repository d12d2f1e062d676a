"""A log as that of `ebac demo arm`, of 6 s: a hand that is held in one place while the motor shakes it."""

from ebac import Device, ForceSensor, Free, Hand, Scenario, Step, simulate
from ebac.datasets.logs import NOISE, Perturbation
from ebac.identify import Recording, excitation

#: The hand [kg, N s/m, N/m].
TRUE = {"M0": 0.35, "B0": 6.0, "K0": 300.0}


def pushed_arm() -> Recording:
    """Return the log."""
    _, force = excitation.multisine(6.0, low=0.3, high=20.0, seconds=6.0, tries=0)
    scenario = Scenario(
        device=Device(sensor=ForceSensor(noise=NOISE)),
        hand=Hand(mass=TRUE["M0"], damping=TRUE["B0"], stiffness=TRUE["K0"], path=Step(target=0.0)),
        environment=Free(),
        seconds=6.0,
    )
    return Recording.from_trace(simulate(scenario, Perturbation(force)))
