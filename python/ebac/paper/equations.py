"""Eq. (2), (3) and (8) to (12): the laws, passivity, the limits of the joints, the wall."""

from __future__ import annotations

import numpy as np

from ebac import presets
from ebac._core import TCA, EBACPrinted, Gimbal, Wall
from ebac._util import formatting
from ebac.metrics import contact
from ebac.paper.finding import Claim, Finding, Row, judge, row
from ebac.scenario import Scenario
from ebac.simulation import simulate

#: Relative tolerance of two computations of one number.
AGREES = 1e-9
#: Conditions under which eq. (3) is tried with 60 hands each: an impact, letting go, pumping.
CONDITIONS = ("d1K10", "slow-let-go-K20", "pumping")
LAWS = ("tca", "eba", "eba-account", "ebac-printed", "ebac")
#: A wall soft enough for eq. (9) to hold unlimited, and one behind air where eq. (10) locks.
SOFT, BEHIND_AIR = Wall(stiffness=500), Wall(position=0.005, stiffness=100)
CONSTANT_LIMIT = 2000.0  # N/m, b/T of the reference device


def eq2() -> Finding:
    """Check the force loop of TCA against eq. (2), written out."""
    law = TCA(kp=0.5, kd=0.0005, filter=0.0)
    trace = simulate(Scenario(), law)
    desired, command = trace["f_env"][1:], trace["f_cmd"][1:]
    error = trace["f_env"] - trace["f_meas"]
    derivative = np.diff(error) / trace["dt"][1:]
    wanted = np.clip(
        desired + law.kp * error[1:] + law.kd * derivative, -law.peak_force, law.peak_force
    )
    off = float(np.abs(command - wanted).max())
    return Finding(
        name="eq2",
        title="Eq. (2): torque control",
        claim="tau_C = tau_static + F_D + K_p (F_D - F_M) + K_d d(F_D - F_M)/dt.",
        rows=[
            row("largest command", float(np.abs(command).max()), "N"),
            row("largest difference to eq. (2) written out", off, "N"),
        ],
        verdict=judge(off < AGREES * law.peak_force),
        why="K_p 0.5, K_d 0.5 ms, commands limited to the peak force. The library low-passes the "
        "derivative by default (5 ms), which the paper does not mention; the static torque is the "
        "compensation of a device.",
    )


def eq3() -> Finding:
    """Check the passivity condition over 60 hands, for each law."""
    from ebac.laws import design
    from ebac.laws.making import reserve_of
    from ebac.operators import Operators
    from ebac.studies import study

    found = study(Operators.grid(), list(LAWS), list(CONDITIONS))
    least = {
        law: min(float(r.least_energy_J or 0.0) for r in found.rows if r.law == law) for law in LAWS
    }
    base = Scenario()
    lent = {
        law: reserve_of(design(law, base.device, base.timing), base) or 0.0
        for law in ("ebac", "ebac-printed")
    }
    claims = tuple(
        Claim(
            text=f"{law}: the energy never falls below -e(0)",
            holds=least[law] >= -given - 1e-9,
            evidence=f"least {formatting.quantity(least[law], 'J')}, e(0) {formatting.quantity(given, 'J')}",
        )
        for law, given in {"eba": 0.0, "eba-account": 0.0, **lent}.items()
    )
    return Finding(
        name="eq3",
        title="Eq. (3): passivity",
        claim="The integral of F V, plus the initial energy e(0), is never negative, for all F and V.",
        rows=[
            row(f"{law}: least energy over {len(CONDITIONS)} x 60 hands", least[law], "J")
            for law in LAWS
        ]
        + [row("e(0) that the completed EBAC declares", lent["ebac"], "J")],
        verdict=judge(*claims),
        why="With counts, lag and delay the bound of EBA alone does not keep it; with an account of the "
        "port's energy (eba-account) EBA does, and so does the completed EBAC, within the e(0) it "
        "declares and for hands that pull less than it declares (20 N). The equations as printed do "
        "not. A simulation tries some forces and motions, not all.",
        claims=claims,
    )


def eq8() -> Finding:
    """Check that the printed law steps by beta times the displacement."""
    trace = simulate(Scenario(), "ebac-printed")
    dx, beta, force = trace["dx"][1:], trace["law.beta"][1:], trace["law.f_d"]
    steps = np.where(dx != 0, np.where(dx != 0, beta, 0.0) * dx, 0.0)
    off = float(np.abs(np.diff(force) - steps).max())
    return Finding(
        name="eq8",
        title="Eq. (8): the force follows the motion",
        claim="F_d(t) = F_d(t-1) + beta(t) V_d(t).",
        rows=[
            row("largest F_d", float(np.abs(force).max()), "N"),
            row("largest difference to eq. (8) over a run", off, "N"),
        ],
        verdict=judge(off < AGREES * float(np.abs(force).max())),
        why="With the displacement of a tick for V_d, so that beta is a stiffness in N/m.",
    )


def eq9() -> Finding:
    """Check that beta as defined gives the force that is asked for, and how often it is undefined."""
    trace = simulate(Scenario(environment=SOFT, seconds=3.0), "ebac-printed")
    inside = (trace["dx"] != 0) & (trace["f_env"] != 0)
    free = inside & ~trace["law.clamped"].astype(bool)
    off = float(np.abs(trace["law.f_d"] - trace["f_env"])[free].max(initial=0.0))
    rest = float(np.mean(trace["dx"][trace["f_env"] != 0] == 0))
    return Finding(
        name="eq9",
        title="Eq. (9): beta",
        claim="beta(t) = (F_e(t) - F_d(t-1)) / V_d(t), V_d(t) not 0; unlimited, it gives F_d = F_e.",
        rows=[
            row("ticks in contact with eq. (9) unlimited", float(free.sum()), "1"),
            row("largest F_d - F_e in them", off, "N"),
            row("share of ticks in contact with V_d = 0", rest, "share"),
        ],
        verdict=judge(bool(free.any()) and off < 1e-9),
        why=f"Wall of {SOFT.stiffness:g} N/m. The encoder shows V_d = 0 in most ticks of a contact, where "
        "eq. (9) has no value and the force stays as it is: this is why EBA rests beside the ideal.",
    )


def eq10() -> Finding:
    """Check the limits on beta: what they do as printed, and with limits that the paper leaves open."""
    trace = simulate(Scenario(environment=BEHIND_AIR, seconds=3.0), "ebac-printed")
    moving = trace["dx"] != 0
    beta = trace["law.beta"]
    low, high = trace["law.beta_min"], trace["law.beta_max"]
    outside = moving & ((beta > high * (1 + 1e-9)) | (beta < low - 1e-6))
    locked = moving & (trace["f_env"] != 0) & (beta == 0)
    constant = contact(simulate(Scenario(), EBACPrinted(constant_limit=CONSTANT_LIMIT)))
    bounded = contact(simulate(Scenario(), "ebac-printed"))
    both = _both_rows(-1.0, 1.2, 0.8)
    claims = (
        Claim(
            text="rows 1 and 2, with Kim and Ryu's bound for beta_min and beta_max, keep the contact stable",
            holds=bounded.quiet,
            evidence=f"swing {formatting.quantity(bounded.swing_m, 'm')}",
        ),
        Claim(
            text="any constant beta_min and beta_max do",
            holds=constant.quiet,
            evidence=f"+-b/T: swing {formatting.quantity(constant.swing_m, 'm')}, "
            f"energy {formatting.quantity(constant.least_energy_J, 'J')}",
        ),
        Claim(
            text="the rows exclude each other",
            holds=not both,
            evidence="for beta(t-1) = -1 kN/m, rows 3 and 4 both apply to beta = -1 kN/m"
            if both
            else "rows 3 and 4 never both apply",
        ),
        Claim(
            text="beta keeps its limits after rows 3 and 4",
            holds=not outside.any(),
            evidence=f"outside in {int(outside.sum())} of {int(moving.sum())} moving ticks",
        ),
        Claim(
            text="the force follows the wall from free air on",
            holds=not locked.any(),
            evidence=f"beta held at 0 by beta(t-1) = 0 in {int(locked.sum())} ticks of contact",
        ),
    )
    return Finding(
        name="eq10",
        title="Eq. (10): limits on beta and its change",
        claim="beta within [beta_min, beta_max] and within the ratios c_1 and c_2 of its last value; "
        "0.8 <= c_2 < 1 < c_1 <= 1.2.",
        rows=_limits(int(outside.sum()), int(locked.sum()), constant.least_energy_J),
        verdict=judge(*claims),
        why="The paper gives neither beta_min nor beta_max; constants make energy. For beta(t-1) < 0 the "
        "ratios swap, beta(t-1) = 0 holds beta at 0, and the ratio rows come after the bound and may "
        "leave it. The completed law sorts the ratios, adds a floor, and applies the bound last.",
        claims=claims,
    )


def _both_rows(before: float, growth: float, decay: float) -> bool:
    """Whether rows 3 and 4 both apply to a beta that has not changed."""
    return before > growth * before and before < decay * before


def _limits(outside: int, locked: int, energy: float | None) -> list[Row]:
    return [
        row("moving ticks with beta outside its limits, wall of 100 N/m", float(outside), "1"),
        row("ticks of contact with beta held at 0, wall of 100 N/m", float(locked), "1"),
        row("least energy with constant limits of +-b/T", energy, "J"),
    ]


def eq11() -> Finding:
    """Check the limits of the joints."""
    kinematics = presets.device("joystick").kinematics
    assert isinstance(kinematics, Gimbal)
    limit = float(np.degrees(kinematics.limit))
    return Finding(
        name="eq11",
        title="Eq. (11): limits of the joints",
        claim="-30 deg < theta_x, theta_y < 30 deg.",
        rows=[row("limit of the joystick's joints, an input", limit, "deg")],
        verdict="nothing to compute",
        why="The limits are inputs, typed from the paper. What they mean for the workspace is in fig7.",
    )


def eq12() -> Finding:
    """Check the wall: pressed, left alone, and left quickly."""
    wall = Wall(stiffness=10e3, damping=20.0)
    x, v = np.meshgrid(np.linspace(-5e-3, 5e-3, 41), np.linspace(-1.0, 1.0, 41))
    force = np.array([wall.force([a], [b])[0] for a, b in zip(x.flat, v.flat, strict=True)])
    printed = np.where(x.ravel() >= 0, wall.stiffness * x.ravel() + wall.damping * v.ravel(), 0.0)
    off = np.abs(force - printed)
    pulls = printed < 0
    claims = (
        Claim(
            text="F = K x + B v in the wall, 0 outside",
            holds=bool(off[~pulls].max() < 1e-9),
            evidence=f"largest difference {formatting.quantity(float(off[~pulls].max()), 'N')}",
        ),
        Claim(
            text="a wall that only pushes",
            holds=not pulls.any(),
            evidence=f"as printed it pulls by up to {formatting.quantity(-float(printed.min()), 'N')} "
            "on a handle that leaves at 1 m/s",
        ),
    )
    return Finding(
        name="eq12",
        title="Eq. (12): the virtual wall",
        claim="F = K x + B v for x >= 0, F = 0 for x < 0.",
        rows=[
            row("largest difference where eq. (12) pushes", float(off[~pulls].max()), "N"),
            row("hardest pull of eq. (12), B = 20 N s/m at -1 m/s", -float(printed.min()), "N"),
            row("hardest pull of the library's wall", abs(float(min(force.min(), 0.0))), "N"),
        ],
        verdict=judge(*claims),
        why="The same where the wall pushes. With v < 0 the printed damper pulls the handle back into the "
        "wall; the library's wall never pulls. The reference wall has B = 0, where both agree.",
        claims=claims,
    )
