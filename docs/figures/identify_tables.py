"""The tables of identification: `ebac identify check`."""

from __future__ import annotations

from math import sqrt

from printed import Printed, Row, code, table

from ebac.identify.gains.check import LAWS
from ebac.identify.gains.table import HOW, NUMBERS, OVER, side_by_side, written

#: Seeds 1 to 10 were looked at while the intervals were made; what is shown is the first of those that were not.
ARM, DEVICE, SCALE = (
    f"identify check {what} --logs 200 --seed 11" for what in ("arm", "device", "scale")
)
GAINS_LOGS, GAINS_SEEDS = "identify check gains --logs 10 --seed", (1, 2, 3, 4, 5)
GAINS = f"{GAINS_LOGS} 4"
#: Groups of logs that the table of seeds shows; the default of `ebac` keeps all constraints in all of them.
SHOWN = {"tca": OVER[:2], "tca-damped": OVER, "ebac": OVER[:1]}


def share(value: float | None) -> str:
    """Return a share in percent."""
    return "-" if value is None else f"{100 * value:.2f} %"


def held(covered: float | None, logs: int) -> str:
    """Return a coverage in percent and its own 95 % interval, by Wilson (1927)."""
    if covered is None:
        return "-"
    z2 = 1.96**2
    middle = (covered + z2 / (2 * logs)) / (1 + z2 / logs)
    half = sqrt(z2 * (covered * (1 - covered) / logs + z2 / (4 * logs**2))) / (1 + z2 / logs)
    return f"{100 * covered:.1f} % ({100 * (middle - half):.0f} to {100 * (middle + half):.0f})"


def coverage(rows: list[Row]) -> str:
    """Return how often the intervals hold the truth."""
    heads = ["", "logs", "determined", "covered", "median bias", "median error"]
    shown = [row for row in rows if row["cases"] >= 20]
    return table(
        heads,
        [
            [
                row["parameter"],
                str(row["cases"]),
                str(row["determined"]),
                held(row["covered_share"], row["determined"]),
                share(row["median_bias"]),
                share(row["median_error"]),
            ]
            for row in shown
        ],
    )


def arm(printed: Printed) -> str:
    """200 random arms."""
    d = printed.document(ARM)
    text = (
        f"{d['silent_cases']} of the logs do not determine M0, B0 and K0, by the information at the true values; "
        f"{d['silent_called']} of them are reported so, and {d['telling_called']} of the {d['telling_cases']} others. "
        f"Estimates that are wrong by half and reported as determined: {d['determined_and_wrong_by_half']}."
    )
    return coverage(d["rows"]) + "\n\n" + text


def device(printed: Printed) -> str:
    """200 random devices."""
    return coverage(printed.rows(DEVICE))


def scale(printed: Printed) -> str:
    """200 random hands that sway, and sensors of another scale than the motor."""
    return coverage(printed.rows(SCALE))


def gains(printed: Printed) -> str:
    """Gains chosen from ten logs, on hands that were held out."""
    heads, *lines = side_by_side(printed.rows(GAINS))
    return table(heads, [[code(line[0]) if line[0] else "", *line[1:]] for line in lines])


def gains_by_seed(printed: Printed) -> str:
    """The same for five seeds, the medians and what is broken."""
    heads = ["law", "seed", "logs"]
    for text, *_ in NUMBERS[:3]:
        heads += [text, "better / equal / worse [1]"]
    heads.append("logs that break a constraint [1]")
    found = []
    for seed in GAINS_SEEDS:
        rows = printed.rows(f"{GAINS_LOGS} {seed}")
        pairs = zip(rows[::2], rows[1::2], strict=True)
        found += [(seed, *pair) for pair in pairs if pair[0]["over"] in SHOWN[pair[0]["law"]]]
    found.sort(key=lambda each: (LAWS.index(each[1]["law"]), OVER.index(each[1]["over"])))
    lines = []
    for seed, default, chosen in found:
        line = [code(chosen["law"]), str(seed), f"{chosen['over']} ({chosen['logs']})"]
        for _, name, measure, scale, digits in NUMBERS[:3]:
            line += [
                " to ".join(written(row[name], scale, digits) for row in (default, chosen)),
                " / ".join(str(chosen[f"{measure}_{how}"]) for how in HOW),
            ]
        broken = [str(row["logs_with_broken_constraint"]) for row in (default, chosen)]
        lines.append([*line, " to ".join(broken)])
    return table(heads, lines)
