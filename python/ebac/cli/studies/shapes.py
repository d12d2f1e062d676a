"""`ebac shapes`: laws at worlds of several shapes, on one to three axes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ebac.cli import by_name, completion, options, output, setting
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.studies.shapes import ShapeRow, Shapes


def shapes(
    to: ResultOptions,
    law: Annotated[
        list[str] | None,
        options.laws("direct, tca, tca-damped, eba, passivity-control, ebac"),
    ] = None,
    world: Annotated[
        list[str] | None,
        options.option(
            text="A world by name, see `ebac worlds`; mesh:FILE; or mesh, a ball of 1,280 triangles; several "
            "separated by commas",
            default="plane, sphere, box, edge, inside, corner, lumen, mesh",
            panel=options.WALL,
            autocompletion=completion.several(completion.worlds),
        ),
    ] = None,
    stiffness: Annotated[
        list[float] | None,
        options.option(
            text="Of the surface [N/m]; several separated by commas",
            default="2000, 10000",
            panel=options.WALL,
        ),
    ] = None,
    device: Annotated[
        list[str] | None,
        options.option(
            text="A device by name, see `ebac presets`; several separated by commas",
            default="reference, joystick, joystick-3",
            panel=options.DEVICE,
            autocompletion=completion.several(completion.devices),
        ),
    ] = None,
    device_noise: options.DeviceNoise = None,
    device_lag: options.DeviceLag = None,
    rate: options.Rate = None,
    delay: options.Delay = None,
    as_json: output.AsJson = False,
) -> None:
    """Compare laws on worlds of several shapes and stiffnesses, with devices of one to three axes.

    A simulation. A hand of 300 N/m, with its target 18 mm inside and slightly to the side, presses for 4 s. *good*
    means quiet and exact on every axis, with no more than 1 mJ given out by the port. The force sensor has no noise
    unless --device-noise gives it some.

    **Examples**

    * `ebac shapes`: six laws, eight worlds, 2 and 10 kN/m, one to three axes; half a minute

    * `ebac shapes --world corner --device joystick-3 --law direct,ebac`

    * `ebac shapes --world sphere --law ebac --device-noise 0.03`: a sensor with 0.03 N of noise

    * `ebac shapes --world texture --stiffness 20000 --delay 2 --json`: waves of 0.2 mm, two samples of delay
    """
    from ebac._core import Timing
    from ebac.studies.shapes import DEVICES, LAWS, STIFFNESSES, WORLDS
    from ebac.studies.shapes import shapes as compare

    with output.refusing():
        laws = by_name.laws(law or LAWS, many=True)
        devices = output.words(device) or DEVICES
        for name in devices:
            setting.known_device(name)
        timing = setting.choose_timing(Timing(), rate, delay)
        folder = to.folder("shapes", as_json=as_json)
        with (
            output.counting_meshes(),
            output.counting("simulating", quiet=as_json) as progress,
        ):
            found = compare(
                list(laws.values()),
                worlds=output.words(world) or WORLDS,
                stiffnesses=list(dict.fromkeys(stiffness)) if stiffness else STIFFNESSES,
                devices=[name.lower() for name in devices],
                timing=timing,
                **setting.given(noise=device_noise, lag=device_lag),
                progress=progress,
            )
    to.report(
        folder, "shapes", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=lambda: _show(found),
    )  # fmt: skip


def _document(found: Shapes) -> str:
    return output.document(
        "shapes", found.table(), missing=found.missing, noise_N=found.noise_N, lag_s=found.lag_s
    )


def _fill(draft: Path, found: Shapes, to: ResultOptions) -> None:
    from ebac.plot import plot_shapes

    to.save(plot_shapes(found), draft, "shapes")
    output.csv_table(draft / "shapes.csv", found.table())


def _show(found: Shapes) -> None:
    """Print a line for each world, stiffness and device, a column for each law."""
    laws = list(dict.fromkeys(row.law for row in found.rows))
    grid = output.table(["world", "kN/m", "axes", *laws], numbers=(1, 2))
    before = None
    for i in range(0, len(found.rows), len(laws)):
        row = found.rows[i]
        if before not in (None, row.world):
            grid.add_section()
        stiffness = row.stiffness_N_per_m
        grid.add_row(
            row.world if row.world != before else "",
            "-" if stiffness is None else f"{1e-3 * stiffness:g}",
            str(row.axes),
            *(_came_to(one) for one in found.rows[i : i + len(laws)]),
        )
        before = row.world
    output.show(grid)
    noise = f"with {found.noise_N:g} N of noise" if found.noise_N > 0 else "without noise"
    output.say(
        f"Simulated, the force sensor {noise}, its filter {1e3 * found.lag_s:g} ms. good: quiet and exact on every "
        "axis, at most 1 mJ given out. Otherwise the worst of: swing peak to peak; vibration in detection thresholds; "
        "how far from a balance of hand and world; energy given out."
    )
    for sentence in found.missing:
        output.say(sentence, style="bold")


def _came_to(row: ShapeRow) -> str:
    """Return what a run came to in a word or a number."""
    from ebac._util import formatting

    if row.swing_m is None:
        return "[red]fault[/]"
    if not row.still:
        return f"[red]swings {formatting.quantity(row.swing_m, 'm')}[/]"
    if not row.quiet:
        return f"[yellow]vibrates {row.perceived:.2g}[/]"
    if row.exact is False:
        return f"[yellow]off {formatting.quantity(row.deviation_m, 'm')}[/]"
    if not row.passive:
        return f"[yellow]gives {formatting.quantity(-(row.least_energy_J or 0.0), 'J')}[/]"
    return "[green]good[/]"
