"""How a result of an arm is shown: as numbers for JSON, in a notebook, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac._util import notebook

if TYPE_CHECKING:
    from ebac.identify.result import ArmResult


def numbers(result: ArmResult) -> dict[str, Any]:
    """Return plain numbers in SI units, for JSON."""
    return {
        "rows": [vars(e) for e in result.estimates.values()],
        "correlation": result.correlation.tolist(),
        "free": [result.parameters.names[i] for i in result.parameters.free],
        "inseparable": [list(pair) for pair in result.inseparable],
        "undetermined": list(result.undetermined),
        "impossible": list(result.impossible),
        "force_late_s": result.late.delay if result.late else None,
        "misses": list(result.misses),
        "notes": list(result.notes),
        "force_noise_N": result.force_noise.tolist(),
        "force_drift_N_per_sqrt_s": result.drift,
        "predictions": [vars(p) for p in result.predictions()],
        "residuals": {
            name: {
                "white": t.white,
                "whiteness_p": t.whiteness_p,
                "independent": t.independent,
                "independence_p": t.independence_p,
            }
            for name, t in result.tests.items()
        },
        "converged": result.converged,
        "evaluations": result.evaluations,
        "seconds_s": result.seconds,
    }


def page(result: ArmResult) -> str:
    """Return the figure, the estimates and what to be careful about, for a notebook."""
    names = ", ".join(r.name for r in result.recordings)
    careful = "; ".join(
        f"{a} and {b} cannot be separated ({r:+.3f})" for a, b, r in result.inseparable
    )
    title = f"Arm of eq. (4) from {names}" + (f". {careful}" if careful else "")
    return notebook.result(title, [e.row() for e in result.shown], result.plot)


def text(result: ArmResult) -> str:
    """Return the estimates, one a line, and what to be careful about."""
    names = ", ".join(r.name for r in result.recordings)
    lines = [f"Arm of eq. (4) from {names}:"]
    lines += [f"  {e}" for e in result.shown]
    lines += [
        f"  {a} and {b} cannot be separated in this log (correlation {r:+.3f})"
        for a, b, r in result.inseparable
    ]
    lines += [f"  {sentence}" for sentence in (*result.misses, *result.notes)]
    if not result.converged:
        lines.append("  the search did not converge")
    return "\n".join(lines)
