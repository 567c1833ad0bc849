"""Where messages go: results and progress to stdout, complaints to stderr; rich only on a terminal."""

from __future__ import annotations

import sys

from rich.console import Console

# exit codes of every command
DONE, FAILED, BAD_INPUT, STOPPED, INTERRUPTED = 0, 1, 2, 3, 130


def console() -> Console:
    """Return a console on the present stdout; plain text where that is no terminal."""
    return Console(file=sys.stdout, highlight=False, soft_wrap=True)


def complain(message: str) -> None:
    """Write one message to stderr, as it is."""
    Console(file=sys.stderr, highlight=False, soft_wrap=True, markup=False).print(message)
