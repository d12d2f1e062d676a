"""Table I of the paper, and what its two rows can and cannot mean.

"SD" and "Error" are not defined there. For one set of distances d from one fitted path, with the mean m = mean |d|:

* the largest |d| is never below the root mean square. Error is below SD in all six columns: it is **not** the
  largest deviation, and not the root mean square either;
* m never exceeds the root mean square. All six columns have m / SD in 0.64 to 0.88: a sine wave has 0.90, evenly
  spread errors 0.87, one bow 0.86, normal ones 0.80, double-exponential ones 0.71. Error **can be the mean
  absolute distance**;
* were SD that of |d| about m, SD / Error would be 0.76 for normal errors; the table has 1.14 to 1.57, which needs tails
  longer than an exponential's. SD is the one **about the fitted path**.

So here sd = sqrt(sum d^2 / (n - p)), error = mean |d|. A mean offset from the true ruler would fit the numbers too,
but the fitted red lines of Fig. 8 and 9 take any offset out.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class TableEntry:
    """One column of Table I, in metres."""

    shape: str
    sd_m: float
    error_m: float

    @property
    def ratio(self) -> float:
        """Error / SD; see above for its meaning."""
        return self.error_m / self.sd_m


#: Table I: three sets of a line, three of a circle.
TABLE_I = (
    TableEntry(shape="line", sd_m=0.92e-3, error_m=0.78e-3),
    TableEntry(shape="line", sd_m=1.07e-3, error_m=0.89e-3),
    TableEntry(shape="line", sd_m=0.98e-3, error_m=0.86e-3),
    TableEntry(shape="circle", sd_m=1.46e-3, error_m=0.93e-3),
    TableEntry(shape="circle", sd_m=1.25e-3, error_m=0.91e-3),
    TableEntry(shape="circle", sd_m=1.31e-3, error_m=0.97e-3),
)


def mean(shape: str) -> TableEntry:
    """Return the mean of the three sets of "line" or "circle"."""
    entries = [e for e in TABLE_I if e.shape == shape]
    if not entries:
        raise ValueError(f"shape = {shape!r}: must be 'line' or 'circle'")
    n = len(entries)
    return TableEntry(
        shape=shape,
        sd_m=sum(e.sd_m for e in entries) / n,
        error_m=sum(e.error_m for e in entries) / n,
    )
