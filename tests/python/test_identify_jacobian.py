"""The derivatives of the prediction errors: exact, for every parameter of an arm."""

import numpy as np
import pytest

from ebac._core import ArmRecord

NAMES = ("mass", "damping", "stiffness", "delay", "onset", "bend", "share", "level 1", "level 2")
#: Two inside a tick, one on a row, one within the tick of a delay.
THETA = np.array([0.7, 9.0, 250.0, 2.3e-3, 0.4e-3, 0.1, 0.3, 0.01, -0.02])
STEPS = np.array([1e-4, 1e-3, 1e-1, 1e-5, 1e-5, 1e-2, 1e-2, 1e-5, 1e-5])


def record(lag: float) -> ArmRecord:
    draw = np.random.default_rng(3)
    t = 1e-3 * np.arange(800)
    waves = [sum(a * np.sin(w * t + w) for w, a in ((9, 1.0), (31, 0.4), (150, 0.1)))]
    variance = np.where(draw.random(len(t)) < 0.6, np.inf, 1e-9)
    return ArmRecord(
        x=0.02 * waves[0] + 1e-5 * draw.standard_normal(len(t)),
        force=3 * np.roll(waves[0], 7) + 0.02 * draw.standard_normal(len(t)),
        variance=variance,
        early=np.where(draw.random(len(t)) < 0.5, 5e-4, 0.0),
        known=0.005 * np.sin(5 * t),
        doubt=np.zeros(len(t)),
        inputs=[np.cos(40 * t)],
        switches=[0.1502, 0.3507, 0.55013],
        segments=[0, 1, 0, 1],
        dt=1e-3,
        lag=lag,
    )


@pytest.mark.parametrize("drift", [0.0, 0.2])
@pytest.mark.parametrize("lag", [0.0, 1.7e-3])
def test_the_jacobian_is_that_of_differences_without_their_error(lag: float, drift: float) -> None:
    """Fails for forward differences: they are off by a hundred-thousandth and more."""
    log = record(lag)
    gains = log.gains(THETA, 0.02, drift, drift)
    errors, J = log.linearised(THETA, gains, list(range(len(THETA))))
    assert (errors == log.innovations(THETA, gains)).all()
    for i, (name, h) in enumerate(zip(NAMES, STEPS, strict=True)):

        def central(h: float, i: int = i) -> np.ndarray:
            up, down = THETA.copy(), THETA.copy()
            up[i] += h
            down[i] -= h
            return (log.innovations(up, gains) - log.innovations(down, gains)) / (2 * h)

        extrapolated = (4 * central(h / 2) - central(h)) / 3  # Richardson
        assert J[i] == pytest.approx(extrapolated, abs=1e-7 * np.abs(extrapolated).max()), name


def test_columns_come_in_the_order_asked_for_and_one_by_one() -> None:
    log = record(1e-3)
    gains = log.gains(THETA, 0.02)
    _, J = log.linearised(THETA, gains, list(range(len(THETA))))
    assert (log.linearised(THETA, gains, [8, 2, 0, 5, 3, 1])[1] == J[[8, 2, 0, 5, 3, 1]]).all()
    errors, none = log.linearised(THETA, gains, [])
    assert none.shape == (0, 800)
    assert (errors == log.innovations(THETA, gains)).all()
    with pytest.raises(ValueError, match="no such parameter"):
        log.linearised(THETA, gains, [9])
