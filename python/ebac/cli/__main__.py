"""`python -m ebac.cli` is the command `ebac`."""

from ebac.cli import app

app()
