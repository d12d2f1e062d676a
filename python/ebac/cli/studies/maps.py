"""`ebac map`: a law over a grid of two quantities."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import options, output, setting

if TYPE_CHECKING:
    from ebac.maps import StabilityMap

DEFAULT_OUT = Path("ebac-map")
#: Folder of a sweep's bundles inside the results, for `--resume`.
BUNDLES = "sweep-{}"
_GRID, _RUN = "Grid", "Run"


def _end(text: str) -> Any:
    return typer.Option(help=text, show_default="its own range", rich_help_panel=_GRID)


def map_(
    kind: Annotated[
        str, typer.Argument(help="KB, Kd or MB, or two quantities, X,Y; see below.")
    ] = "KB",
    law: Annotated[
        list[str] | None,
        typer.Option(
            "--law",
            "-l",
            help="A law by name, see `ebac laws`; repeat it for several, `all` for every law.",
            show_default="ebac",
            rich_help_panel=_RUN,
        ),
    ] = None,
    side: Annotated[
        int, typer.Option(help="Values along each axis.", min=2, max=5000, rich_help_panel=_GRID)
    ] = 200,
    x_low: Annotated[float | None, _end("Where x begins, in its unit.")] = None,
    x_high: Annotated[float | None, _end("Where x ends.")] = None,
    y_low: Annotated[float | None, _end("Where y begins, in its unit.")] = None,
    y_high: Annotated[float | None, _end("Where y ends.")] = None,
    stiffness: options.Stiffness = None,
    damping: options.Damping = None,
    hand: options.HandName = None,
    device: options.DeviceName = None,
    rate: options.Rate = None,
    delay: options.Delay = None,
    seconds: Annotated[
        float | None,
        typer.Option(help="Length of a run [s].", show_default="2", rich_help_panel=_RUN),
    ] = None,
    scenario: options.ScenarioFile = None,
    threads: options.Threads = None,
    out: Annotated[Path | None, options.out_folder("figures and numbers", DEFAULT_OUT)] = None,
    resume: Annotated[bool, options.resume("map")] = False,
    as_json: output.AsJson = False,
) -> None:
    """Map where a law is stable, over two quantities of wall, hand, device or time. A simulation.

    KB is wall stiffness over wall damping, Kd wall stiffness over delay, MB damping over mass of the hand.
    Quantities: stiffness, damping, delay, hand-mass, hand-damping, hand-stiffness, device-mass, device-damping.

    **Examples**

    * `ebac map`: 200 x 200 walls under EBAC.

    * `ebac map Kd --law all --side 50`: stiffness over delay, every law.

    * `ebac map hand-stiffness,device-damping --law eba --stiffness 5000`
    """
    from ebac.maps import AXES

    with output.refusing():
        x, y = _quantities(kind)
        names = setting.law_names(law or ["ebac"])
        base = setting.base_scenario(scenario)
        base = base.replace(
            device=setting.choose_device(base.device, device),
            hand=setting.choose_hand(base.hand, hand, None),
            environment=setting.choose_wall(base.environment, stiffness=stiffness, damping=damping),
            timing=setting.choose_timing(base.timing, rate, delay),
            seconds=seconds or (2.0 if scenario is None else base.seconds),
        )
        xs = AXES[x].values(side, x_low, x_high)
        ys = AXES[y].values(side, y_low, y_high)
    folder = out or (None if as_json else DEFAULT_OUT)
    if resume and folder is None:
        output.fail("--resume continues in a folder: give it with --out")
    given = {"base": base, "x": x, "y": y, "xs": xs, "ys": ys, "threads": threads}
    maps = [_run(name, given, folder, resume, quiet=as_json) for name in names]
    files = _write(folder, maps, quiet=as_json) if folder else []
    if as_json:
        typer.echo(_document(maps))
        return
    _show(maps)
    if folder is not None:
        output.list_files(folder, files)


def _quantities(kind: str) -> tuple[str, str]:
    from ebac.document import unknown
    from ebac.maps import AXES, PRESETS

    if kind in PRESETS:
        return PRESETS[kind]
    x, comma, y = kind.partition(",")
    for name in (x, y) if comma else (kind,):
        if name not in AXES:
            raise ValueError(unknown(f"map {kind}", name, [*AXES] if comma else [*PRESETS, "X,Y"]))
    if not comma:
        raise ValueError(f"map {kind}: a map needs two quantities, {kind},Y")
    return x, y


def _run(
    law: str, given: dict[str, Any], folder: Path | None, resume: bool, *, quiet: bool
) -> StabilityMap:
    from ebac.maps import stability_map
    from ebac.sweeps import SweepInterrupted

    kept = None if folder is None else folder / BUNDLES.format(law)
    try:
        with output.refusing(), output.counting(f"mapping {law}", quiet=quiet) as progress:
            return stability_map(law, out=kept, resume=resume, progress=progress, **given)
    except SweepInterrupted as stopped:
        more = f"; continue with --resume --out {folder}" if folder is not None else ""
        output.fail(f"{law}: {stopped}{more}", code=output.INTERRUPTED)


def _rows(maps: list[StabilityMap]) -> list[dict[str, Any]]:
    rows = []
    for found in maps:
        along, up = found.axes
        rows.append({
            "law": found.law,
            "x": found.x, "x_unit": along.unit, "x_low": found.xs[0], "x_high": found.xs[-1],
            "y": found.y, "y_unit": up.unit, "y_low": found.ys[0], "y_high": found.ys[-1],
            "runs": len(found.result), **found.scores(),
        })  # fmt: skip
    return rows


def _document(maps: list[StabilityMap]) -> str:
    return output.document("map", _rows(maps))


def _write(folder: Path, maps: list[StabilityMap], *, quiet: bool) -> list[str]:
    from ebac.plot import plot_map

    with output.results(folder) as draft, output.progress(len(maps), quiet=quiet) as step:
        if draft is None:
            return []
        (draft / "map.json").write_text(_document(maps) + "\n", encoding="utf-8")
        maps[0].base.save(draft / "scenario.toml")
        for found in maps:
            step(f"drawing {found.law}")
            plot_map(found).savefig(draft / f"map-{found.law}.png")
            found.to_npz(draft / f"map-{found.law}.npz")
        return sorted(file.name for file in draft.iterdir())


def _show(maps: list[StabilityMap]) -> None:
    from ebac import wording

    names = ("quiet_share", "energy_share", "quiet_and_energy_share", "exact_share")
    headings = ["law", "quiet", "at most 1 mJ", "both", "exact and quiet"]
    grid = output.table(headings, numbers=range(1, 5))
    for found in maps:
        shares = found.scores()
        grid.add_row(found.law, *(wording.quantity(shares[name], "share") for name in names))
    output.console().print(grid)
    along, up = maps[0].axes
    output.say(f"Share of the area: {_range(along, maps[0].xs)} by {_range(up, maps[0].ys)}.")
    output.say("Simulated, not measured, but for these two:", style="bold")
    output.indented(wording.describe(maps[0].base).replace("; ", "\n"))


def _range(axis: Any, values: Any) -> str:
    how = ", logarithmic" if axis.logarithmic else ""
    symbol = axis.symbol.strip("$").replace("_", "")
    return f"{symbol} {values[0]:g} to {values[-1]:g} {axis.unit} ({len(values)} values{how})"
