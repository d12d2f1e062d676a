"""`ebac gastroscopy --live`: serves its page until Ctrl-C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.gastroscope import Procedure
    from ebac.laws import AnyLaw


def watch(law: AnyLaw, procedure: Procedure, port: int, *, no_browser: bool, as_json: bool) -> None:
    """Run it in real time and serve the page until it is interrupted."""
    from contextlib import ExitStack

    from ebac.cli.live import ended
    from ebac.cli.live import watch as wait
    from ebac.hardware.interrupts import Interrupts
    from ebac.live.gastroscopy import serve_gastroscopy

    with ExitStack() as stack:
        interrupts = stack.enter_context(Interrupts())
        interrupts.moving()
        try:
            server = stack.enter_context(serve_gastroscopy(law, procedure, port=port))
        except ImportError as error:
            output.fail(str(error))
        except OSError as error:
            output.fail(f"--port {port}: {error.strerror or error}; give another one")
        wait(server, interrupts, no_browser=no_browser, as_json=as_json)
    ended("Ended; all of it was simulated.")
