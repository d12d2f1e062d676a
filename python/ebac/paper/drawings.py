"""Fig. 1 to 4 and 10: photographs and diagrams without data, and what corresponds to them in this package."""

from __future__ import annotations

from ebac.paper.finding import Finding


def _drawing(name: str, title: str, claim: str, here: str) -> Finding:
    return Finding(
        name=name, title=title, claim=claim, rows=[], verdict="nothing to compute", why=here
    )


def fig1() -> Finding:
    """List Fig. 1, a drawing and a photograph."""
    return _drawing(
        "fig1",
        "Fig. 1: solid design and photograph of the device",
        "The device as designed and as built.",
        "A drawing and a photograph: no data. The device's numbers are in the item specs.",
    )


def fig2() -> Finding:
    """List Fig. 2, a diagram of programs."""
    return _drawing(
        "fig2",
        "Fig. 2: the simulation system of haptic interaction",
        "Handle, encoder, drive, CHAI3D and controller in a circle.",
        "A diagram of hardware and programs: no data. The same circle is the tick of the loop here: "
        "counts, kinematics, virtual world, law, torque, current.",
    )


def fig3() -> Finding:
    """List Fig. 3, the block diagram of the force loop."""
    return _drawing(
        "fig3",
        "Fig. 3: the motor's control loop",
        "The desired force is fed forward, a PD loop acts on the measured force.",
        "A block diagram: no data. Its equation is the item eq2.",
    )


def fig4() -> Finding:
    """List Fig. 4, the network diagram."""
    return _drawing(
        "fig4",
        "Fig. 4: the haptic interaction as a network of ports",
        "Operator, device, EBA controller and environment exchange force and velocity at ports.",
        "A diagram: no data. It fixes the ports of eq. (3) to (7); the signs are the subject of eq4.",
    )


def fig10() -> Finding:
    """List Fig. 10, the sketch of the virtual wall."""
    return _drawing(
        "fig10",
        "Fig. 10: sketch of the virtual wall",
        "A ball moved by the handle meets a wall of stiffness K and damping B.",
        "A sketch: no data. Its equation is the item eq12, its experiment Fig. 11.",
    )
