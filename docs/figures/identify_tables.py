"""The tables of identification: `ebac identify check`."""

from __future__ import annotations

from math import sqrt

from printed import Printed, Row, code, table

#: Seeds 1 to 10 were looked at while the intervals were made; what is shown is the first of those that were not.
ARM, DEVICE = "identify check arm --logs 200 --seed 11", "identify check device --logs 200 --seed 11"
GAINS = "identify check gains --logs 10 --seed 4"


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
        f"{d['silent_cases']} of the logs cannot tell M0, B0 and K0, by the information at the true values; "
        f"{d['silent_called']} of them are called so, and {d['telling_called']} of the {d['telling_cases']} others. "
        f"Estimates that are wrong by half and said to be determined: {d['determined_and_wrong_by_half']}."
    )
    return coverage(d["rows"]) + "\n\n" + text


def device(printed: Printed) -> str:
    """200 random devices."""
    return coverage(printed.rows(DEVICE))


def gains(printed: Printed) -> str:
    """Gains chosen from ten logs, on hands that were held out."""
    heads = ["law", "gains", "Kp", "Kd", "settle", "median", "swing, worst", "noise of the command", "least energy",
             "logs with a broken constraint"]  # fmt: skip
    rows = []
    for row in printed.rows(GAINS):
        median = row["settled_median_s"]
        rows.append(
            [
                code(row["law"]),
                row["gains"],
                f"{row['kp_median']:.2g}",
                f"{1e3 * row['kd_median_s']:.3f} ms",
                f"{row['settled']} of {row['presses']}",
                "never" if median is None else f"{median:.3f} s",
                f"{1e3 * row['swing_worst_m']:.3f} mm",
                f"{1e3 * row['noise_median_N']:.1f} mN",
                f"{1e3 * row['least_energy_J']:.1f} mJ",
                f"{row['logs_with_broken_constraint']} of {row['logs']}",
            ]
        )
    return table(heads, rows)
