"""`ebac` beside `tank`, a law of a few dozen lines on the same observer: 60 hands, then the worst hand of a search.

`python compare.py` takes some seconds, `python compare.py 2000` with the search of 2000 runs a family three minutes.
"""

import sys

from my_laws import Tank

import ebac

base = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))  # N
laws = {"tank": Tank, "ebac": "ebac"}
conditions = ["d1K10", "d2K20", "slow-waves-K20", "slow-press-d2K20"]
for row in ebac.study(ebac.Operators.grid(), laws, conditions, base=base).rows:
    print(
        f"{row.condition:16s} {row.law:4s} good {row.good}, exact and still {row.exact_and_still}, "
        f"in time {row.settled_in_time} of 60; on impact {100 * (row.median_impact_share or 0):.0f} %; drawn in any "
        f"window {1e3 * row.most_drawn_J:.1f} mJ"
    )

if len(sys.argv) > 1:
    for condition in conditions[:2]:
        for name, law in laws.items():
            found = ebac.worst(law, condition=condition, evaluations=int(sys.argv[1]), base=base)
            most = max(hand.energy_J for hand in found.hands)
            print(f"{condition} {name}: the worst hand draws {1e3 * most:.2f} mJ")
