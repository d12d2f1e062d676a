"""A hand written in Python: it presses, and withdraws for a while whenever the wall pushes back too hard."""

import ebac


class Shy(ebac.hands.OwnHand):
    """A spring and a damper that let the target go when they feel more than `most` [N] for 50 ms."""

    mass, damping, stiffness = 0.15, 6.0, 300.0  # the mass moves with the handle

    def __init__(self, most: float) -> None:
        self.most = most
        self.since = 0.0  # s, when it last felt less
        self.away = 0.0  # s, until when it withdraws

    def force(self, t: float, x: float, v: float) -> float:
        """Return the force on the handle [N]; asked several times within a step, so it changes nothing."""
        target = 0.05 if t >= self.away else 0.0
        return self.stiffness * (target - x) - self.damping * v

    def advance(self, t: float, x: float, v: float) -> None:
        """Remember how long it has pressed hard."""
        if self.force(t, x, v) < self.most or x < 0.01:
            self.since = t
        if t - self.since > 0.05:
            self.away, self.since = t + 0.3, t + 0.3


wall = ebac.Wall(stiffness=10e3, position=0.01)
for most in (8.0, 50.0):
    trace = ebac.simulate(ebac.Scenario(hand=Shy(most), environment=wall, seconds=2.0), "ebac")
    inside = trace["f_env"] > 0
    touches = int((inside[1:] & ~inside[:-1]).sum())
    least = 1e3 * trace["true.energy"].min()
    print(f"withdraws above {most:g} N: {touches} contacts, least energy {least:.2f} mJ")
