"""`ebac map`: a law over a grid of two quantities."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.arguments import unknown
from ebac._util.file_names import file_name
from ebac.cli import by_name, from_options, interrupts, options, output
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.laws import AnyLaw
    from ebac.scenario import Scenario
    from ebac.studies.maps import StabilityMap
    from ebac.studies.maps.axes import MapAxis

#: Folder of a sweep's bundles inside the results, for `--resume`.
BUNDLES = "sweep-{}"
_GRID = "Grid"


def _end(text: str) -> Any:
    return typer.Option(help=text, show_default="its own range", rich_help_panel=_GRID)


@dataclass(frozen=True, kw_only=True)
class _Setup(options.ScenarioOptions):
    seconds: Annotated[
        float | None,
        options.option(
            text="Length of a run [s]", default="2, or as in the file", panel=options.RUN
        ),
    ] = None


def map_(
    setup: _Setup,
    to: ResultOptions,
    kind: Annotated[
        str, typer.Argument(help="KB, Kd or MB, or two quantities, X,Y; see above.")
    ] = "KB",
    law: Annotated[list[str] | None, options.laws("ebac")] = None,
    side: Annotated[
        int, typer.Option(help="Values along each axis.", min=2, max=5000, rich_help_panel=_GRID)
    ] = 200,
    x_low: Annotated[float | None, _end("Least value of x, in its SI unit.")] = None,
    x_high: Annotated[float | None, _end("Largest value of x.")] = None,
    y_low: Annotated[float | None, _end("Least value of y, in its SI unit.")] = None,
    y_high: Annotated[float | None, _end("Largest value of y.")] = None,
    threads: options.Threads = None,
    resume: Annotated[bool, options.resume("map")] = False,
    as_json: output.AsJson = False,
) -> None:
    """Map over two quantities where a law is stable.

    A simulation. KB is wall stiffness over wall damping, Kd wall stiffness over delay, MB damping over mass of the
    hand. Quantities: stiffness, damping, delay, hand-mass, hand-damping, hand-stiffness, device-mass,
    device-damping.

    **Examples**

    * `ebac map --side 50`: 50 x 50 walls under EBAC

    * `ebac map Kd --law tca,ebac --side 20`: stiffness over delay, two laws

    * `ebac map hand-stiffness,device-damping --law eba --side 20`
    """
    from ebac.studies.maps import AXES

    with output.refusing():
        x, y = _quantities(kind)
        laws = by_name.laws(law or ["ebac"], many=True)
        base = from_options.scenario(setup, seconds=2.0)
        xs = _values("x", AXES[x], base, side, x_low, x_high)
        ys = _values("y", AXES[y], base, side, y_low, y_high)
    folder = to.folder("map", as_json=as_json, resume=BUNDLES.format(next(iter(laws))) * resume)
    given = {"base": base, "x": x, "y": y, "xs": xs, "ys": ys, "threads": threads}
    maps = [_run(name, one, given, folder, resume, quiet=as_json) for name, one in laws.items()]
    to.report(
        folder, "map", _document(maps), as_json=as_json,
        fill=lambda draft: _fill(draft, maps, to, quiet=as_json), show=lambda: _show(maps),
    )  # fmt: skip


def _values(
    along: str, axis: MapAxis, base: Scenario, side: int, low: float | None, high: float | None
) -> Any:
    """Return the values along an axis; what is out of range is refused by the option's name."""
    for end, value in (("low", low), ("high", high)):
        try:
            if value is not None:
                axis.apply(base, value)
        except (TypeError, ValueError, OverflowError) as error:
            reason = str(error).partition(": ")[2] or str(error)
            raise ValueError(
                f"--{along}-{end} = {value:g} {axis.unit} ({axis.name}): {reason}"
            ) from None
    try:
        return axis.values(side, low, high)
    except ValueError as error:
        given = "low" if low is not None else "high"
        raise ValueError(f"--{along}-{given}: {error}") from None


def _quantities(kind: str) -> tuple[str, str]:
    from ebac.studies.maps import AXES, PRESETS

    if kind in PRESETS:
        return PRESETS[kind]
    x, comma, y = kind.partition(",")
    for name in (x, y) if comma else (kind,):
        if name not in AXES:
            raise ValueError(unknown(f"KIND {kind}", name, [*AXES] if comma else [*PRESETS, "X,Y"]))
    if not comma:
        raise ValueError(f"map {kind}: a map needs two quantities, {kind},Y")
    return x, y


def _run(
    name: str, law: AnyLaw, given: dict[str, Any], folder: Path | None, resume: bool, *, quiet: bool
) -> StabilityMap:
    from ebac.studies.maps import stability_map

    kept = None if folder is None else folder / BUNDLES.format(file_name(name))
    with (
        interrupts.resumable(folder),
        output.refusing(folder),
        output.counting(f"mapping {name}", quiet=quiet) as progress,
    ):
        return stability_map(law, out=kept, resume=resume, progress=progress, **given)


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


def _fill(draft: Path, maps: list[StabilityMap], to: ResultOptions, *, quiet: bool) -> None:
    from ebac.plot import plot_map

    with output.progress(len(maps), quiet=quiet) as step:
        maps[0].base.save(draft / "scenario.toml")
        for found in maps:
            step(f"drawing {found.law}")
            name = f"map-{file_name(found.law)}"
            to.save(plot_map(found), draft, name)
            found.to_npz(draft / f"{name}.npz")


def _show(maps: list[StabilityMap]) -> None:
    from ebac._util import descriptions, formatting

    names = ("quiet_share", "energy_share", "quiet_and_energy_share", "exact_share")
    headings = ["law", "quiet", "at most 1 mJ", "both", "exact and quiet"]
    grid = output.table(headings, numbers=range(1, 5))
    for found in maps:
        shares = found.scores()
        grid.add_row(found.law, *(formatting.quantity(shares[name], "share") for name in names))
    output.show(grid)
    if why := maps[0].unjudged:
        output.say(f"Not judged exact, there is no ideal rest: {why}.")
    along, up = maps[0].axes
    output.say(f"Share of the area: {_range(along, maps[0].xs)} by {_range(up, maps[0].ys)}.")
    output.say("Simulation. Where these two vary, their values replace those of:", style="bold")
    output.indented(descriptions.describe(maps[0].base).replace("; ", "\n"))


def _range(axis: MapAxis, values: Any) -> str:
    how = ", logarithmic" if axis.logarithmic else ""
    return f"{axis.plain_symbol} {values[0]:g} to {values[-1]:g} {axis.unit} ({len(values)} values{how})"
