"""`ebac live`: the loop in a browser."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Sequence
from errno import EACCES, EADDRINUSE
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, doubtful, options, output, setting
from ebac.cli.drive.options import Yes, reporting
from ebac.cli.files import new_file

if TYPE_CHECKING:
    from ebac.hardware import Configuration
    from ebac.hardware.interrupts import Interrupts
    from ebac.live.server import Server
    from ebac.scenario import Scenario


def live(
    configuration: Annotated[
        Path | None,
        typer.Argument(
            help="Configuration of device and run in TOML; see `ebac demo joystick`. Default: simulate everything."
        ),
    ] = None,
    simulated: Annotated[
        bool,
        typer.Option(
            "--simulated", help="Use simulated drives, device and hand, whatever the file contains."
        ),
    ] = False,
    virtual: Annotated[
        bool,
        typer.Option(
            "--virtual",
            help="Also simulate the clock: no tick is late, however busy the machine is.",
        ),
    ] = False,
    law: Annotated[
        str | None, options.one_law(default="as configured", own=options.COMPILED)
    ] = None,
    observer: Annotated[bool | None, options.observer(default="on; with a file as in it")] = None,
    scenario: Annotated[
        Path | None,
        typer.Option(
            help="Simulate device, hand, world and delay of a scenario in TOML, as `Save TOML` of the page writes it."
        ),
    ] = None,
    allow_control: Annotated[
        bool,
        typer.Option(
            "--allow-control",
            help="Let the page give real motors power, while its dead-man key is held.",
        ),
    ] = False,
    max_stiffness: Annotated[
        float | None,
        typer.Option(
            help="Stiffest surface that a page may choose on hardware [N/m].",
            show_default="that of the file's world",
            min=0,
        ),
    ] = None,
    max_damping: Annotated[
        float | None,
        typer.Option(
            help="Most damping of a surface that a page may choose on hardware [N s/m].",
            show_default="that of the file's world",
            min=0,
        ),
    ] = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; only this machine reaches 127.0.0.1.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port; 0 for a free one.", min=0, max=65535)] = 0,
    out: Annotated[
        Path,
        typer.Option("--out", "-o", help="Folder for logs and scenarios that the page writes."),
    ] = Path("ebac-live"),
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Do not open a browser.")
    ] = False,
    page: Annotated[
        Path | None,
        typer.Option(
            "--page",
            metavar="FILE",
            help="Write the page that needs no server to this file, and exit.",
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="With --page: replace a file of the same name.")
    ] = False,
    yes: Yes = False,
    as_json: output.AsJson = False,
) -> None:
    """Show a running loop in a browser; move its hand and change its law.

    The loop runs in real time, unless `--virtual` is given; the page shows handle, world and force, and plots of the
    last ten seconds. Drag the hand with the mouse. Law, world, stiffness, damping and delay can be changed while the
    loop runs; a change of observer, hand or device restarts it. The page can record to MCAP and save the scenario as
    TOML, in the folder of `--out`. Ctrl-C ends it.

    Without a file, or with `--simulated`, drives, device and hand are simulated in real time. With `--virtual` the
    clock is simulated, too: time advances in steps of 8 ms, pauses while the machine is late, and no tick is skipped.

    With a file **real motors may get power**, but only with `--allow-control` and while somebody holds the dead-man
    key of the page. When the key is released or the page is silent for 0.3 s, the force fades and the drives are
    switched off. The limits are those of the file; no page can change them. A page cannot choose a surface stiffer
    than that of the file, or than `--max-stiffness`.

    The printed address contains a secret; a page that has it can control the loop if no other page does. Pages at the
    second address can only watch. Nothing is encrypted: to see the loop on another machine, use an SSH tunnel rather
    than `--host`.

    With `--page` the command writes a page that needs no server, with the loop compiled to WebAssembly.

    **Examples**

    * `ebac live`: a wall of 10 kN/m, in your browser.

    * `ebac live --law tca`: plain torque control; raise the stiffness until it shakes.

    * `ebac live --virtual`: on a virtual clock, where no tick is late.

    * `ebac live --scenario wall.toml`: your device, hand and world, simulated.

    * `ebac live joystick.toml --allow-control`: your device, with the dead-man key.

    * `ebac live --page live.html`: the page that needs no server.
    """
    if page is not None:
        if scenario is not None:
            output.fail(
                "--page excludes --scenario: the page that needs no server has its own choices"
            )
        write_page(page, force=force, as_json=as_json)
        return
    if force:
        output.fail("--force belongs to --page FILE")
    if scenario is not None and configuration is not None:
        output.fail(
            f"--scenario {scenario}: excludes a configuration; give {configuration} or the scenario"
        )
    real = configuration is not None and not (simulated or virtual)
    if virtual and simulated:
        output.fail(
            "--virtual excludes --simulated: the one has a virtual clock, the other a real one"
        )
    if not real and (allow_control or max_stiffness is not None or max_damping is not None):
        output.fail(
            "--allow-control, --max-stiffness and --max-damping are for hardware: give its file, without --simulated "
            "and --virtual; a page controls what is simulated anyway"
        )
    settings = {
        "observer": observer,
        "allow_control": allow_control, "virtual": virtual, "max_stiffness": max_stiffness,
        "max_damping": max_damping, "host": host, "port": port, "folder": out,
    }  # fmt: skip
    with reporting():
        _serve(configuration, scenario, real, law, settings, no_browser, yes, as_json)


def _serve(
    file: Path | None,
    scenario: Path | None,
    real: bool,
    law: str | None,
    settings: dict[str, Any],
    no_browser: bool,
    yes: bool,
    as_json: bool,
) -> None:
    from contextlib import ExitStack

    from ebac.cli.run.chosen import observer_change
    from ebac.hardware import Configuration, OpenDevice
    from ebac.hardware.interrupts import Interrupts
    from ebac.live.serving import serve

    known: Configuration | None = None
    with output.refusing():
        known = None if file is None else Configuration.load(file)
        if known is not None:
            doubtful.note_configuration(str(file), known)
            known = known.replace(**observer_change(known, settings.pop("observer")))
        given = known if scenario is None else _scenario_of(scenario)
        wanted = None if law is None else by_name.designed_law(law, "the page")
    with ExitStack() as stack:
        interrupts = stack.enter_context(Interrupts())
        interrupts.moving()
        device = None
        if real and known is not None:
            from ebac.cli.run.confirm import can_ask, confirm, names_its_drives

            names_its_drives(known, f"give --scenario {file} for a simulation")
            if settings["allow_control"]:
                can_ask(known, yes)
            device = stack.enter_context(OpenDevice.open(known))
            if settings["allow_control"]:
                confirm(device, yes, stderr=as_json)
        try:
            server = stack.enter_context(serve(given, device=device, law=wanted, **settings))
        except ImportError as error:
            output.fail(str(error))
        except OSError as error:
            refused = error.errno in (EADDRINUSE, EACCES)  # the port, else the host
            where = f"--port {settings['port']}" if refused else f"--host {settings['host']}"
            remedy = "another one" if refused else "an address of this machine"
            output.fail(f"{where}: {error.strerror or error}; give {remedy}, or leave it out")
        watch(server, interrupts, no_browser=no_browser, as_json=as_json)
        kept = list(server.session.kept)
    ended("Ended; drives without power.", kept)


def _scenario_of(file: Path) -> Scenario:
    """Return the scenario of a file, with a note on what of it the page does not take."""
    found = setting.base_scenario(file)
    usual = type(found)()
    left = [name for name in ("seed", "jitter") if getattr(found, name) != getattr(usual, name)]
    if not isinstance(found.observer, bool):
        left.append("observer, which is designed anew")
    if left:
        output.note(f"{file}: the page does not take {', '.join(left)}")
    return found


def watch(server: Server, interrupts: Interrupts, *, no_browser: bool, as_json: bool) -> None:
    """Print the addresses of a server, open its page, and wait until it is interrupted."""
    from ebac.hardware.interrupts import Terminated

    try:
        show(server, as_json=as_json)
        if not no_browser:
            import webbrowser

            webbrowser.open(server.gate.url())
        while True:
            time.sleep(0.5)
    except (KeyboardInterrupt, Terminated):
        interrupts.ending()


def ended(how: str, kept: Sequence[Path] = ()) -> None:
    """Print on stderr how a page ended, and which files are kept."""
    files = ", ".join(map(str, kept)) if kept else "no files"
    output.console(stderr=True).print(f"{how} Kept: {files}.", soft_wrap=True, markup=False)


def show(server: Server, *, as_json: bool) -> None:
    """Print the addresses of a server that listens."""
    gate = server.gate
    if not gate.loopback:
        output.console(stderr=True).print(
            f"{gate.host}: other machines reach this page, and nothing is encrypted; "
            "an SSH tunnel to 127.0.0.1 is safer",
            markup=False,
        )
    if as_json:
        row = {"url": gate.url(), "watch_url": gate.url("watch"), "port": gate.port}
        typer.echo(
            json.dumps(json.loads(output.document("live", [], **row)))
        )  # one line: it goes on
    else:
        output.say(f"Open  {gate.url()}")
        output.say(f"Watch {gate.url('watch')}")
        output.say("Ctrl-C ends it.")
    sys.stdout.flush()


def write_page(page: Path, *, force: bool, as_json: bool) -> None:
    """Write the page without a server."""
    from ebac.live import module
    from ebac.live import page as written

    new_file("--page", page, force=force)
    try:
        wasm = module()
    except FileNotFoundError as error:
        output.fail(str(error))
    with output.writing(f"--page {page}"):
        text = written(page, wasm=wasm)
    size = len(text.encode())
    if as_json:
        typer.echo(output.document("live", [], written=[str(page)], size_bytes=size))
    else:
        output.say(f"{page}: {size / 1e6:.1f} MB. Open it in a browser.")
