"""`python -m ebac` is the command `ebac`."""

import sys

from ebac._util.program import begin


def main() -> None:
    """Run the command of the command line."""
    begin()
    from ebac.cli import app

    try:
        app()
    finally:
        if sys.stdout is not None:
            sys.stdout.flush()


if __name__ == "__main__":
    main()
