"""One estimated parameter and its interval."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """One estimated parameter with its 95 % interval, all in `unit`."""

    name: str
    value: float
    unit: str
    low: float
    high: float
    fixed: bool
    determined: bool

    def row(self) -> dict[str, str]:
        """Return it as text, for a table."""
        bounds = "" if self.fixed else f"{self.low:.4g} to {self.high:.4g}"
        said = "given" if self.fixed else "yes" if self.determined else "NO"
        return {
            "parameter": self.name,
            "value": f"{self.value:.4g} {self.unit}",
            "95 % interval": bounds,
            "determined": said,
        }

    def __str__(self) -> str:
        """Return "K0 = 301.2 N/m (298.1 to 304.3)"."""
        if self.fixed:
            return f"{self.name} = {self.value:.4g} {self.unit} (given)"
        loose = "" if self.determined else ", NOT DETERMINED by this log"
        return (
            f"{self.name} = {self.value:.4g} {self.unit} ({self.low:.4g} to {self.high:.4g}{loose})"
        )
