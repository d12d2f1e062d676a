"""How the forecast of `ebac identify log` compares with the fit: `python tests/recordings/forecast.py [LOGS]`."""

import sys
from collections import Counter

from ebac import simulate
from ebac.identify import Recording, Target, check_log, fit_arm
from ebac.identify.cases import draw
from ebac.identify.parameters import HAND


def main(logs: int) -> None:
    """Print by task of the hand how many parameters were forecast, and how many of these the fit determined."""
    forecast, determined = Counter[str](), Counter[str]()
    for number in range(logs):
        case = draw(number, 9, 6.0)
        recording = Recording.from_trace(simulate(case.scenario, case.law))
        target = Target.of(case.scenario.hand, recording.t)
        try:
            result, check = fit_arm(recording, target), check_log(recording, target)
        except ValueError:  # too few readings
            continue
        for name in HAND:
            forecast[case.task] += check.determines(name)
            determined[case.task] += check.determines(name) and result[name].determined
    for task, count in sorted(forecast.items()):
        print(f"{task}: {count} forecast, the fit determined {determined[task]} of these")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 60)
