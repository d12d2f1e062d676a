"""Coverage of tracking hands with and without the motor's column: `python tests/recordings/tracking.py [LOGS]`."""

import sys
from collections import Counter
from dataclasses import replace

from ebac import simulate
from ebac.identify import Recording, Target, fit_arm
from ebac.identify.cases import draw
from ebac.identify.parameters import HAND


def main(logs: int) -> None:
    """Print how many intervals contain the true value, of those that are determined."""
    number, found, counts = 0, 0, Counter[tuple[str, str]]()
    while found < logs:
        case = draw(number, 21)
        number += 1
        if case.task != "tracking":
            continue
        found += 1
        whole = Recording.from_trace(simulate(case.scenario, case.law))
        target = Target.of(case.scenario.hand, whole.t)
        for kind, recording in (("with", whole), ("without", replace(whole, motor=None))):
            result = fit_arm(recording, target)
            for name in HAND:
                e = result[name]
                counts[kind, f"{name} determined"] += e.determined
                counts[kind, f"{name} covered"] += (
                    e.determined and e.low <= case.truth()[name] <= e.high
                )
    for kind in ("with", "without"):
        words = (
            f"{n} {counts[kind, f'{n} covered']} of {counts[kind, f'{n} determined']}" for n in HAND
        )
        print(f"{kind} the motor's column: {', '.join(words)}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 60)
