"""`ebac random-worlds`: laws under random hands in random worlds of several bodies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac._util.file_names import file_name
from ebac.cli import by_name, completion, interrupts, options, output, setting
from ebac.cli.files import ResultOptions

if TYPE_CHECKING:
    from ebac.studies.random_worlds_result import RandomWorldRow, RandomWorlds

_WORLD = "World"


def random_worlds(
    to: ResultOptions,
    law: Annotated[list[str] | None, options.laws("ebac")] = None,
    kind: Annotated[
        list[str] | None,
        options.option(
            text="A kind of world: planes, balls, ball-and-plane, three-planes, cavity; several separated by commas",
            default="all",
            panel=_WORLD,
            autocompletion=completion.world_kinds,
        ),
    ] = None,
    stiffness: Annotated[
        list[float] | None,
        options.option(
            text="Of every surface [N/m]; several separated by commas",
            default="10000",
            panel=_WORLD,
        ),
    ] = None,
    moving: Annotated[
        bool,
        typer.Option(
            "--moving",
            help="Let each body swing in a direction of its own, by up to 4 mm at 0.5 to 3 Hz.",
            rich_help_panel=_WORLD,
        ),
    ] = False,
    hands: Annotated[
        int,
        typer.Option(
            help="Random hands for each line of the table.",
            min=1,
            max=100_000,
            rich_help_panel=options.HAND,
        ),
    ] = 200,
    device: Annotated[
        list[str] | None,
        options.option(
            text="The reference device with 2-axes, 3-axes, or on a gimbal; several separated by commas",
            default="all",
            panel=options.DEVICE,
            autocompletion=completion.world_devices,
        ),
    ] = None,
    device_noise: Annotated[
        float,
        typer.Option(
            help="Noise of the force sensor, standard deviation [N].",
            min=0,
            max=10,
            rich_help_panel=options.DEVICE,
        ),
    ] = 0.03,
    device_lag: options.DeviceLag = None,
    delay: Annotated[
        list[int] | None,
        options.option(
            text="Ticks until a command acts [samples]; several separated by commas",
            default="1",
            panel=options.RUN,
        ),
    ] = None,
    seed: Annotated[
        int, typer.Option(help="Seed of hands and worlds.", rich_help_panel=options.RUN)
    ] = 1,
    threads: options.Threads = None,
    as_json: output.AsJson = False,
) -> None:
    """Try laws with random hands in random worlds of several bodies.

    A simulation. Each hand moves for 4 s in a world of its own: it presses, slides from one body to another, and taps.
    The table counts hands that the guard of a law holds back for longer than 0.1 s, and hands that draw more energy
    than the reserve of the law, beyond what moving bodies put in. All laws, stiffnesses and delays meet the same hands
    and worlds. The worst hand of each law in each kind of world is saved as a scenario. In Python
    `help(ebac.random_worlds)` lists the ranges from which hands and worlds are drawn.

    **Examples**

    * `ebac random-worlds --kind balls --hands 20`: two balls, on three devices

    * `ebac random-worlds --kind planes --device 2-axes --hands 20 --law direct,tca,ebac`: three laws

    * `ebac random-worlds --kind balls --device 2-axes --moving --stiffness 20000 --delay 2 --hands 50`

    * `ebac random-worlds`: all kinds and devices; a minute
    """  # fmt: skip
    from ebac.studies.random_scenario import DEVICES
    from ebac.studies.random_worlds import DELAYS, STIFFNESSES
    from ebac.studies.random_worlds import random_worlds as simulate_all
    from ebac.studies.world_kinds import KINDS

    with output.refusing():
        laws = by_name.laws(law or ["ebac"], many=True)
        folder = to.folder("random-worlds", as_json=as_json)
        interrupts.keeping(
            "nothing was written; the same command starts from the beginning, and fewer --hands, --kind or --device "
            "take less time"
        )
        with output.counting("simulating", quiet=as_json) as progress:
            found = simulate_all(
                laws,
                kinds=_names("--kind", kind, KINDS),
                devices=_names("--device", device, DEVICES),
                stiffnesses=list(dict.fromkeys(stiffness)) if stiffness else STIFFNESSES,
                delays=list(dict.fromkeys(delay)) if delay else DELAYS,
                moving=moving,
                hands=hands,
                noise=device_noise,
                **setting.given(lag=device_lag),
                seed=seed,
                threads=threads,
                progress=progress,
            )

    def show() -> None:
        _show(found)
        if folder is not None:
            _show_replay(found, folder, by_name.own_words(law or []))

    to.report(
        folder, "random-worlds", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=show,
    )  # fmt: skip


def _names(option: str, given: list[str] | None, known: Iterable[str]) -> list[str]:
    """Return the names of lists separated by commas, each once; all that are known where none is given."""
    if given is None:
        return list(known)
    names = [by_name.known_name("", option, word, known) for word in output.words(given)]
    if not names:
        raise ValueError(f"{option}: is empty; there are: {', '.join(known)}")
    return list(dict.fromkeys(names))


def _document(found: RandomWorlds) -> str:
    return output.document(
        "random-worlds", found.table(), moving=found.moving, noise_N=found.noise_N,
        lag_s=found.lag_s, seed=found.seed
    )  # fmt: skip


def _fill(draft: Path, found: RandomWorlds, to: ResultOptions) -> None:
    from ebac.plot import plot_random_worlds

    to.save(plot_random_worlds(found), draft, "random-worlds")
    output.csv_table(draft / "random-worlds.csv", found.table())
    for row in found.worst():
        found.scenario(row).save(draft / f"{_file(row)}.toml")


def _file(row: RandomWorldRow) -> str:
    return f"worst-{file_name(row.law)}-{row.kind}"


def _show(found: RandomWorlds) -> None:
    """Print a line for each row, and a sentence for each law; columns in which nothing differs are left out."""
    headings = ["world", "device", "law", "kN/m", "delay", "hands", "touched", "held back", "longest", "drawn",
                "beyond reserve", "faults"]  # fmt: skip
    grid = output.table(headings, numbers=range(5, len(headings)))
    faults = any(row.faults for row in found.rows)
    before = None
    for row in found.rows:
        if before not in (None, row.kind):
            grid.add_section()
        law = row.law if len(found.laws) > 1 else ""
        grid.add_row(
            row.kind if row.kind != before else "", row.device, law, *_numbers(row),
            _count(row.faults) if faults else "",
        )  # fmt: skip
        before = row.kind
    output.show(output.filled(grid))
    for total in found.totals():
        output.say(_sentence(total), style="bold")
    bodies = "each body swings in its own way" if found.moving else "the bodies stand still"
    output.say(
        f"Simulated, 4 s a hand; {bodies}; the force sensor with {found.noise_N:g} N of noise, its filter "
        f"{1e3 * found.lag_s:g} ms; seed {found.seed}. "
        "Touched: hands that met a body. Held back: hands for which the guard let less than half of the command "
        "through for longer than 0.1 s (law.starved), and the longest such time of all hands. Drawn: by the hand that "
        "drew most, beyond all that it had put in and what moving bodies did."
    )


def _numbers(row: RandomWorldRow) -> list[str]:
    from ebac._util import formatting

    return [
        f"{1e-3 * row.stiffness_N_per_m:g}",
        str(row.delay_samples),
        str(row.hands),
        str(row.touched),
        _count(row.held_back),
        formatting.quantity(row.longest_held_back_s, "s"),
        formatting.quantity(row.drawn_J, "J"),
        _count(row.beyond_reserve),
    ]


def _count(number: int | None) -> str:
    """Return a number of hands that should be none; "-" where the law has no such thing."""
    if number is None:
        return "-"
    return f"[red]{number}[/]" if number else "0"


def _sentence(total: RandomWorldRow) -> str:
    from ebac._util import formatting

    parts = []
    if total.held_back is not None:
        longest = formatting.quantity(total.longest_held_back_s, "s")
        parts.append(f"{total.held_back} were held back for longer than 0.1 s (longest {longest})")
    if total.beyond_reserve is not None:
        reserve = formatting.quantity(total.reserve_J, "J")
        parts.append(f"{total.beyond_reserve} drew more than the reserve of {reserve}")
    if total.faults:
        parts.append(f"{total.faults} ended by a fault")
    most = formatting.quantity(total.drawn_J, "J")
    came_to = f" {', '.join(parts)}," if parts else ""
    return f"{total.law}: of {output.plural(total.hands, 'run')}{came_to} the worst drew {most}."


def _show_replay(found: RandomWorlds, folder: Path, own: Mapping[str, str]) -> None:
    output.say("\nReplay the worst hand of each law:", style="bold")
    for total in found.totals():
        law = own.get(total.law, total.law)
        output.path(f"ebac wall --law {law} --scenario {folder / _file(total)}.toml")
