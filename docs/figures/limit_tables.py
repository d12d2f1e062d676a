"""What the worst hands of `ebac` draw: at four walls, with friction, jitter, finer counts, a wrong mass, in ms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from printed import NOISE, NOISY, Printed, Row, of_two, table

import ebac
from ebac.studies import scenario_changes as to
from ebac.studies.condition import Condition
from ebac.studies.conditions import conditions

#: The walls of the searches: 10 and 20 kN/m at one and two samples of delay.
WALLS = ("d1K10", "d2K10", "d1K20", "d2K20")
#: Walls for rows of which two were searched.
ENDS = ("d1K10", "d2K20")
#: Reserve of the account [J]; more is bold.
RESERVE = 2e-3
#: How fast the own force of a hand changes at most: 20 N in a millisecond.
LIMIT = "--pull-rate 20000"


@dataclass(frozen=True, kw_only=True)
class Search:
    """A row of worst hands: label, options of `ebac worst`, walls and seeds; friction that is not declared [N]."""

    label: str
    options: str = ""
    walls: tuple[str, ...] = WALLS
    seeds: tuple[int, ...] = (1,)
    hidden: float = 0.0


SEARCHES = (
    Search(label="as declared", seeds=(1, 2, 3)),
    Search(
        label="own force of the hand at most 20 N/ms, `--pull-rate 20000`",
        options=LIMIT,
        walls=("d2K20",),
    ),
    Search(
        label="own force at most 1 N/ms, as the guard expects, `--pull-rate 1000`",
        options="--pull-rate 1000",
        walls=("d2K20",),
    ),
    Search(
        label="with 0.1 N of friction, declared, `--device-coulomb 0.1`",
        options="--device-coulomb 0.1",
        walls=ENDS,
    ),
    Search(label="with 0.3 N, declared", options="--device-coulomb 0.3", walls=ENDS),
    Search(
        label="with 0.3 N, declared and all of it compensated, `--device-friction-compensation 0.3`",
        options="--device-coulomb 0.3 --device-friction-compensation 0.3",
        walls=ENDS,
    ),
    Search(label="with 0.1 N of friction that is not declared", hidden=0.1, walls=ENDS),
    Search(label="with 0.3 N that is not declared", hidden=0.3, walls=ENDS),
    Search(
        label="with counts of 3.8 µm, `--device-counts 8192`",
        options="--device-counts 8192",
        walls=ENDS,
        seeds=(1, 2),
    ),
    Search(label="with 30 % of jitter, `-c jitter`", walls=("jitter",)),
    Search(label="with half of the true mass declared, `-c told-mass-50`", walls=("told-mass-50",)),
    Search(label="with `guard=off`", options="--change guard=off", walls=("d1K10",)),
)


def worst_hands(printed: Printed) -> str:
    """What the worst hand of a search draws at four walls, in runs of 2 to 8 s and in 5 min."""
    heads = [
        "",
        "10 kN/m, 1 sample of delay",
        "10 kN/m, 2 samples",
        "20 kN/m, 1 sample",
        "20 kN/m, 2 samples",
    ]
    rows = [["", "(default)", "`-c d2K10`", "`-c d1K20`", "`-c d2K20`"]]
    for one in SEARCHES:
        cells = ["", "", "", ""]
        for condition in one.walls:
            cells[WALLS.index(condition) if condition in WALLS else 0] = _drawn(
                printed, one, condition
            )
        rows.append([one.label, *cells])
    return table(heads, rows)


def _drawn(printed: Printed, one: Search, condition: str) -> str:
    """Return what is drawn over the seeds of a search: in a run, and where it is more, in 5 min of the same hand."""
    found = [_search(printed, one, condition, seed) for seed in one.seeds]
    short = [max(r["energy_drawn_J"] for r in rows) for rows in found]
    long = [max(r["energy_drawn_300_s_J"] for r in rows) for rows in found]
    text = _range(short)
    if max(long) > max(short) + 0.05e-3:
        text += f" ({_range(long)})"
    return f"**{text}**" if max(short) > RESERVE else text


def _search(printed: Printed, one: Search, condition: str, seed: int) -> list[Row]:
    if not one.hidden:
        words = ["worst", NOISE, "-c", condition, one.options, "--seed", str(seed)]
        return printed.rows(" ".join(filter(None, words)))
    (known,) = conditions([condition])
    change = to.together(known.change, to.untold(to.device("mechanics", coulomb=one.hidden)))
    untold = Condition(name=f"{condition}-untold", summary="", change=change)
    return printed.kept(
        f"untold-{one.hidden:g}-{condition}-{seed}",
        lambda: ebac.worst("ebac", untold, base=NOISY, seed=seed, threads=printed.threads).rows(),
    )


#: Rows of the hands that need milliseconds: what stands in front, options of `ebac worst`, walls.
SLOWED = (
    ("10 kN/m, one and two samples", "", ("d1K10", "d2K10")),
    ("20 kN/m, one and two samples", "", ("d1K20", "d2K20")),
    (
        "counts of 3.8 µm, the first and the last of these walls",
        "--device-counts 8192",
        ENDS,
    ),
    (
        "0.1 N of declared friction, 20 kN/m and two samples",
        "--device-coulomb 0.1",
        ("d2K20",),
    ),
    ("0.3 N of declared friction, 10 kN/m and one sample", "--device-coulomb 0.3", ("d1K10",)),
)


def milliseconds(printed: Printed) -> str:
    """What the worst hand draws, without and with a limit on how fast its own force changes."""
    rows = [
        [label, *(_of_walls(printed, walls, f"{options} {slow}") for slow in ("", LIMIT))]
        for label, options, walls in SLOWED
    ]
    return table(["", "any hand", "20 N/ms at most"], rows)


#: Counts of an encoder [m], counts of a turn of its motor, seeds.
COUNTS = (
    ("31 µm", 1024, (1,)),
    ("15 µm", 2048, (1,)),
    ("7.7 µm", 4096, (1,)),
    ("3.8 µm", 8192, (1, 2)),
    ("1.9 µm", 16384, (1, 2)),
    ("0.5 µm", 65536, (1,)),
)


def counts(printed: Printed) -> str:
    """What the worst hand draws at 10 kN/m and one sample of delay with finer counts, seed by seed."""
    rows = []
    for size, per_turn, seeds in COUNTS:
        search = Search(label="", options="" if per_turn == 1024 else f"--device-counts {per_turn}")
        found = [_search(printed, search, "d1K10", seed) for seed in seeds]
        drawn = [_bold(max(r["energy_drawn_J"] for r in rows)) for rows in found]
        rows.append([size, str(per_turn), f"{', '.join(drawn)} mJ"])
    return table(["counts of the encoder", "`--device-counts`", "drawn by the worst hand"], rows)


def rate(printed: Printed) -> str:
    """Hands that are good / exact and still at 500 Hz."""
    found = printed.rows(
        f"study --rate 500 {NOISE} -c d1K10,d2K10,d1K20,d2K20,d1K35 --law ebac --no-files"
    )
    hands = {row["condition"]: of_two(row["good"], row["exact_and_still"]) for row in found}
    rows = [
        [f"{stiffness} kN/m", *(hands.get(f"d{delay}K{stiffness}", "") for delay in (1, 2))]
        for stiffness in (10, 20, 35)
    ]
    return table(["wall", "1 sample of delay", "2 samples"], rows)


def _of_walls(printed: Printed, walls: Sequence[str], options: str) -> str:
    search = Search(label="", options=" ".join(options.split()))
    found = [_search(printed, search, wall, seed=1) for wall in walls]
    return f"{', '.join(_bold(max(r['energy_drawn_J'] for r in rows)) for rows in found)} mJ"


def _bold(energy: float) -> str:
    return f"**{1e3 * energy:.1f}**" if energy > RESERVE else f"{1e3 * energy:.1f}"


def _range(energies: Sequence[float]) -> str:
    if min(energies) > 1:
        return f"{max(energies):.0f} J"
    low, high = (f"{1e3 * e:.1f}" for e in (min(energies), max(energies)))
    return f"{low} mJ" if low == high else f"{low} to {high} mJ"
