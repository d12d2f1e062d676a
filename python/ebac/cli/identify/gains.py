"""`ebac identify gains`: K_p and K_d of eq. (2) from logged steps."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import completion, output, setting
from ebac.cli.by_name import one_law
from ebac.cli.by_option import columns_in_options
from ebac.cli.identify import options as given
from ebac.cli.identify import report as reporting

if TYPE_CHECKING:
    from ebac import Device, Wall
    from ebac.identify import GainsResult, LoopModel

LIMITS = "Constraints"
#: Share by which a log may differ from the file of its device.
OTHER_DEVICE = 0.2


def gains(
    logs: given.Logs,
    reading: given.Reading,
    target: given.TargetOptions,
    to: reporting.ReportOptions,
    law: Annotated[
        str,
        typer.Option(
            "--law",
            "-l",
            help="A law with the force loop of eq. (2), see `ebac laws`.",
            rich_help_panel=given.FIT,
            autocompletion=completion.laws,
        ),
    ] = "tca-damped",
    fix: given.Fix = None,
    robust: given.Robust = None,
    scenario: Annotated[
        Path | None,
        typer.Option(
            help="A scenario, or a configuration of `ebac run`, in TOML with your device: motor, drive, encoder; with "
            "[environment] the wall is that of the file, not of the log, and with [timing] the delay.",
            show_default="the reference device",
            rich_help_panel=given.FIT,
        ),
    ] = None,
    delay: Annotated[
        int | None,
        typer.Option(
            help="Transport delay [samples].",
            min=0,
            show_default="1, or that of the file",
            rich_help_panel=given.FIT,
        ),
    ] = None,
    vary: Annotated[
        float,
        typer.Option(
            help="Also try hands that differ from the identified one by this share.",
            min=0,
            max=3,
            rich_help_panel=given.FIT,
        ),
    ] = 0.3,
    overshoot: Annotated[
        float | None,
        typer.Option(
            help="Largest overshoot beyond the rest at an ideal wall [m].",
            min=0,
            max=1,
            show_default="a quarter more than the default gains show",
            rich_help_panel=LIMITS,
        ),
    ] = None,
    max_force: Annotated[
        float | None,
        typer.Option(
            help="Largest force [N].",
            min=0.001,
            max=10000,
            show_default="the motor's peak",
            rich_help_panel=LIMITS,
        ),
    ] = None,
    max_current: Annotated[
        float | None,
        typer.Option(
            help="Largest current [A].",
            min=0.001,
            max=1000,
            show_default="the drive's peak",
            rich_help_panel=LIMITS,
        ),
    ] = None,
    noise_gain: Annotated[
        float,
        typer.Option(
            help="Largest ratio of the noise of the command to that of the force reading.",
            min=0,
            max=100,
            rich_help_panel=LIMITS,
        ),
    ] = 0.5,
    energy: Annotated[
        float,
        typer.Option(
            help="Most energy that the port may give out [J].",
            min=0,
            max=100,
            rich_help_panel=LIMITS,
        ),
    ] = 0.010,
    as_json: output.AsJson = False,
) -> None:
    """Choose the gains K_p and K_d of eq. (2) from logged presses.

    Arm, device and wall are identified first. Every pair of gains is then simulated on the identified hand, on the
    ends of its interval and on hands around it. No hand may violate a constraint; settling, swing and noise are
    compared with those of the default gains, and none of the three may get worse. The table, which is simulated, also
    shows the gains by the paper's rule on the step response.

    **Examples**

    * `ebac demo press`, then `ebac identify gains press.csv --switch 1.0`

    * `ebac identify gains press.csv --switch 1.0 --law tca --out report`

    * `ebac presets reference > device.toml`, then `ebac identify gains press.csv --switch 1.0 --scenario device.toml`:
    on your device, as described in a file
    """
    from ebac import Timing
    from ebac.identify import Limits, fit_gains, fit_loop

    to.folder()
    with output.refusing(), output.counting("choosing", quiet=as_json) as progress:
        limits = Limits(
            overshoot=overshoot,
            force=max_force,
            current=max_current,
            noise_gain=noise_gain,
            energy=energy,
        )
        law = one_law(law)
        pairs = given.given_logs(logs, reading, target)
        recordings, targets = [r for r, _ in pairs], [one for _, one in pairs]
        device, wall, usual = _parts(scenario)
        timing = Timing(dt=round(recordings[0].dt, 9), delay=usual if delay is None else delay)
        loop = fit_loop(
            recordings, targets, device=device, wall=wall, timing=timing, fixed=given.numbers(fix, "--fix"),
            robust=robust,
        )  # fmt: skip
        result = fit_gains(loop, law, limits=limits, vary=vary, progress=progress)
    if scenario is not None and device is not None:
        _note_other_device(scenario, device, loop)
    files = _write(to, result, scenario)
    if as_json:
        more = result.to_dict()
        rows = more.pop("rows")
        typer.echo(output.document("identify gains", rows, **more))
        return
    for text in (*(f"{r.name}: {text}" for r in recordings for text in r.remarks), *loop.remarks):
        output.say(columns_in_options(text), style="dim")
    table = _cells(result)  # a pair of gains is a column: eleven of them would not fit side by side
    heading, *names = table[0]
    grid = output.table([heading, *(row[heading] for row in table)], numbers=(1, 2, 3))
    for name in names:
        grid.add_row(name, *(row[name] for row in table))
    output.show(output.filled(grid))
    for text in _notes(result, scenario):
        output.say(text)
    output.say("In a configuration of `ebac run`:")
    output.indented(_table_of_law(result))
    output.say("Simulated, not measured.", style="bold")
    if to.out is not None:
        output.list_files(to.out, files)


def _parts(file: Path | None) -> tuple[Device | None, Wall | None, int]:
    """Return device, wall and delay [samples] of a scenario file; None where a part is not that of a file."""
    from ebac import Linear, Wall
    from ebac._util.text_file import read_text
    from ebac._util.toml import parsed
    from ebac.identify.gains.gains import NO_SENSOR

    base = setting.device_base(file)
    if file is None:
        return None, None, base.timing.delay
    device = base.device
    if not device.sensor.fitted:
        raise ValueError(f"--scenario {file}: {NO_SENSOR}")
    if not isinstance(device.kinematics, Linear):
        device = device.replace(
            kinematics=Linear(radius=device.radius)
        )  # presses go along one axis
    if "environment" not in parsed(read_text(file)):
        return device, None, base.timing.delay
    if not isinstance(base.environment, Wall):
        raise ValueError(
            f"--scenario {file}: environment is a {type(base.environment).__name__}: gains are chosen at a wall; give "
            "a file with a wall, or one without [environment]"
        )
    return device, base.environment, base.timing.delay


def _note_other_device(file: Path, device: Device, loop: LoopModel) -> None:
    """Say on stderr what of the device in the log is not that of the file, beyond its interval and a share."""
    if loop.found is None:
        return
    for name, what, value in (
        ("M_h", "mass at the handle", device.mass),
        ("B_h", "damping", device.mechanics.damping),
        ("coulomb", "coulomb", device.mechanics.coulomb),
    ):
        found = loop.found.estimates.get(name)
        if found is None or not found.determined or found.low <= value <= found.high:
            continue
        if abs(found.value - value) > OTHER_DEVICE * max(abs(value), abs(found.value)):
            output.note(
                f"--scenario {file}: {what} = {value:.4g} {found.unit}, but the log shows {name} = {found.value:.4g} "
                f"{found.unit} ({found.low:.4g} to {found.high:.4g}), and the gains are chosen for that of the log; "
                "check that it is a log of this device"
            )


def _cells(result: GainsResult) -> list[dict[str, str]]:
    def seconds(value: float) -> str:
        return f"{value:.3f} s" if value < 1e9 else "never"

    return [
        {
            "gains": row["gains"],
            "Kp": f"{row['kp']:.3g}",
            "Kd": f"{1e3 * row['kd_s']:.3f} ms",
            "cost": f"{row['cost']:.3f}",
            "settles (median)": seconds(row["settled_median_s"]),
            "swing (worst)": f"{1e3 * row['swing_worst_m']:.3f} mm",
            "noise": f"{row['noise_mean_N']:.3f} N",
            "noise gain": f"{row['noise_gain']:.2f}",
            "overshoot (worst)": f"{1e3 * row['overshoot_worst_m']:.2f} mm",
            "least energy": f"{1e3 * row['least_energy_J']:.1f} mJ",
            "violates": ", ".join(row["broken"]) or "nothing",
        }
        for row in result.rows()
    ]


def _notes(result: GainsResult, file: Path | None) -> list[str]:
    from ebac.identify.gains.gains import gains_to_copy

    limits = result.limits
    whose = (
        "the reference device: --scenario FILE takes those of yours" if file is None else str(file)
    )
    kp, kd = gains_to_copy(result)
    first = []
    if len({round(one.cost, 9) for one in result.tried}) == 1:
        first = [
            f"No pair of gains changes anything: with the observer {result.name} has no force loop. --law tca-damped "
            "has."
        ]
    elif kp == kd == 0:
        first = [
            "The force loop buys nothing here: kp = 0. Without it settling, swing and noise are the same as with the "
            "chosen gains, within half a tick and a hundredth."
        ]
    elif kp == 0 < result.kp or kd == 0 < result.kd:
        none, other = ("kp", "kd") if kp == 0 else ("kd", "kp")
        first = [f"{none} buys nothing here: {none} = 0. The force loop acts by {other} alone."]
    return [
        *first,
        f"{output.plural(len(result.hands), 'hand')}, "
        f"{output.plural(len(result.chosen.presses.goals), 'press', 'presses')}, "
        f"{output.plural(len(result.tried), 'pair')} of gains. "
        "Relative to the default gains, geometric mean over the presses: "
        + ", ".join(f"{name} {value:.3f}" for name, value in result.chosen.ratios.items())
        + ".",
        "cost: all three in one number, below 1 is better than the default gains; noise: changes of the command from "
        "tick to tick over the last 30 %, RMS over the square root of two, mean of the presses; noise gain: RMS of the "
        "command for 1 N RMS of white noise of the reading, of K_p and K_d alone; step-response: for comparison, the "
        "gains that a textbook rule gives for the force after a step of the command, the handle held.",
        "Constraints: overshoot "
        f"{1e3 * (limits.overshoot or 0):.2f} mm, force {limits.force:.1f} N, current {limits.current:.2f} A, "
        f"noise gain {limits.noise_gain:g}, energy {1e3 * limits.energy:g} mJ.",
        f"Motor, drive and encoder are those of {whose}.",
        f'In Python: ebac.Variant("{result.name}", {{"kp": {kp:.4g}, "kd": {kd:.4g}}})',
    ]


def _table_of_law(result: GainsResult) -> str:
    """Return the gains as the table of a configuration of `ebac run`."""
    from ebac.identify.gains.gains import gains_to_copy

    kp, kd = gains_to_copy(result)
    return f'[law]\nname = "{result.name}"\nkp = {kp:.4g} # 1\nkd = {kd:.4g} # s'


def _write(to: reporting.ReportOptions, result: GainsResult, scenario: Path | None) -> list[str]:
    from ebac.identify.figures import plot_gains

    hand = [str(e) for e in result.loop.arm.estimates.values() if e.name in ("M0", "B0", "K0")]
    return reporting.report(
        to,
        "gains",
        title=f"K_p and K_d of eq. (2) for {result.name}",
        rows=_cells(result),
        careful=[],
        notes=[
            *hand,
            *map(columns_in_options, result.loop.remarks),
            *_notes(result, scenario),
            _table_of_law(result),
            "Simulated, not measured.",
        ],
        draw=[lambda: plot_gains(result)],
    )
