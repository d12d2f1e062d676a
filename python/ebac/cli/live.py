"""`ebac live`: the loop in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ebac.cli import output
from ebac.cli.files import new_file


def live(
    page: Annotated[
        Path,
        typer.Option(
            "--page", metavar="FILE", help="Write the page without a server to this file."
        ),
    ],
    force: Annotated[
        bool, typer.Option("--force", help="Replace a file of the same name.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Write a page on which you shake a virtual wall and calm it: the loop, compiled to WebAssembly.

    Any browser opens the file, on a phone, too, without a server and without a network. Everything on it is simulated.

    **Examples**

    * `ebac live --page live.html`: write the page.
    """
    from ebac.live import module
    from ebac.live import page as written

    new_file("--page", page, force=force)
    try:
        wasm = module()
    except FileNotFoundError as error:
        output.fail(str(error))
    try:
        text = written(page, wasm=wasm)
    except OSError as error:
        output.fail(f"--page {page}: cannot be written ({error.strerror}); give another file")
    size = len(text.encode())
    if as_json:
        typer.echo(output.document("live", [], written=[str(page)], size_bytes=size))
    else:
        output.say(f"{page}: {size / 1e6:.1f} MB. Open it in a browser.")
