"""`ebac zwidth`: which walls a device can render under each law."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import options, output, setting

if TYPE_CHECKING:
    from ebac.zwidth import ZWidth

DEFAULT_OUT = Path("ebac-zwidth")
_WALLS, _RUN = "Walls", "Run"


def zwidth(
    law: Annotated[
        list[str] | None,
        typer.Option(
            "--law",
            "-l",
            help="A law by name, see `ebac laws`; repeat it for several.",
            show_default="all",
            rich_help_panel=_RUN,
        ),
    ] = None,
    delay: Annotated[
        list[int] | None,
        typer.Option(
            help="Ticks until a command acts [samples]; repeat it for several.",
            show_default="0, 1, 2",
            rich_help_panel=_RUN,
        ),
    ] = None,
    most_damping: Annotated[
        float,
        typer.Option(help="Wall damping goes from 0 to this [N s/m].", rich_help_panel=_WALLS),
    ] = 20.0,
    points: Annotated[
        int, typer.Option(help="Wall dampings.", min=2, max=1000, rich_help_panel=_WALLS)
    ] = 9,
    least: Annotated[
        float,
        typer.Option(help="The search begins at this stiffness [N/m].", rich_help_panel=_WALLS),
    ] = 100.0,
    top: Annotated[
        float, typer.Option(help="And ends at this one [N/m].", rich_help_panel=_WALLS)
    ] = 1e5,
    epsilon: Annotated[
        float, typer.Option(help="Energy a law may take out of the port [J].", rich_help_panel=_RUN)
    ] = 1e-3,
    hand: options.HandName = None,
    device: options.DeviceName = None,
    rate: options.Rate = None,
    seconds: Annotated[
        float | None,
        typer.Option(help="Length of a run [s].", show_default="3", rich_help_panel=_RUN),
    ] = None,
    scenario: options.ScenarioFile = None,
    threads: options.Threads = None,
    out: Annotated[Path | None, options.out_folder("figure and tables", DEFAULT_OUT)] = None,
    as_json: output.AsJson = False,
) -> None:
    """Find the stiffest wall each law can render, over wall damping and delay (Z-width). A simulation.

    *quiet*: no limit cycle, for a press and a tap. *energy*: takes no more than epsilon out of the port.
    *usable*: both, and shows at least half of the stiffness asked for. The score is the area under the border.

    **Examples**

    * `ebac zwidth`: every law at 0, 1 and 2 samples of delay.

    * `ebac zwidth --law direct --law ebac --delay 1 --most-damping 50 --points 21`
    """
    import numpy as np

    from ebac.zwidth import zwidth as search

    with output.refusing():
        names = setting.law_names(law or ["all"])
        base = setting.base_scenario(scenario)
        long = seconds or (3.0 if scenario is None else base.seconds)
        base = base.replace(
            device=setting.choose_device(base.device, device),
            hand=setting.choose_hand(base.hand, hand, None),
            timing=setting.choose_timing(base.timing, rate, None),
            seconds=long,
        )
        with output.counting("searching", quiet=as_json) as progress:
            found = search(
                base, names, delays=delay or (0, 1, 2), dampings=np.linspace(0, most_damping, points),
                least=least, top=top, epsilon=epsilon, threads=threads, progress=progress,
            )  # fmt: skip
    folder = out or (None if as_json else DEFAULT_OUT)
    files = _write(folder, found) if folder else []
    if as_json:
        typer.echo(_document(found))
        return
    _show(found)
    if folder is not None:
        output.list_files(folder, files)


def _document(found: ZWidth) -> str:
    return output.document(
        "zwidth", found.rows(), epsilon_J=found.epsilon, top_N_per_m=found.top, scores=found.scores()
    )  # fmt: skip


def _write(folder: Path, found: ZWidth) -> list[str]:
    from ebac.plot import plot_zwidth

    with output.results(folder) as draft:
        if draft is None:
            return []
        plot_zwidth(found).savefig(draft / "zwidth.png")
        (draft / "zwidth.json").write_text(_document(found) + "\n", encoding="utf-8")
        output.csv_table(draft / "zwidth.csv", found.rows())
        output.csv_table(draft / "scores.csv", found.scores())
        found.base.save(draft / "scenario.toml")
    return ["zwidth.png", "zwidth.json", "zwidth.csv", "scores.csv", "scenario.toml"]


def _show(found: ZWidth) -> None:
    from ebac import wording
    from ebac.zwidth import CRITERIA

    grid = output.table(["delay", "law", *CRITERIA], numbers=range(2, 5))
    for number, delay in enumerate(found.delays):
        if number:
            grid.add_section()
        linear = f"{found.area('spectral', '', delay) / 1e3:.0f}        "
        grid.add_row(str(delay), "linear loop, no law", linear)
        for row in found.scores():
            if row["delay_samples"] == delay:
                grid.add_row(str(delay), row["law"], *(_cell(row, name) for name in CRITERIA))
    output.console().print(grid)
    full, most = found.top / 1e3, found.dampings[-1]
    output.say(
        f"Area under the border in kN/m N s/m, both axes linear, up to {full:g} kN/m and {most:g} N s/m: "
        f"{full * most:.0f} is all of it. In brackets, times that of direct."
    )
    output.say("Simulated, not measured, but for wall and delay:", style="bold")
    output.indented(wording.describe(found.base).replace("; ", "\n"))


def _cell(row: dict[str, Any], name: str) -> str:
    times = row[f"{name}_times_direct"]
    behind = "" if times is None else f"({times:.1f})"
    return f"{row[f'{name}_area'] / 1e3:.0f} {behind:>7}"
