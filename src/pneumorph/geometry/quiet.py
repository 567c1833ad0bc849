"""Keep a C++ library's own printing off the terminal."""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager


class Printed:
    """The text that was caught; complete once the `with` block has ended."""

    text: str = ""


@contextmanager
def caught_output() -> Iterator[Printed]:
    """Catch what the process writes to standard output and error, below Python's own streams."""
    printed = Printed()
    with tempfile.TemporaryFile() as target:
        _flush()
        saved = os.dup(1), os.dup(2)
        try:
            os.dup2(target.fileno(), 1)
            os.dup2(target.fileno(), 2)
            yield printed
        finally:
            _flush()
            for number, copy in zip((1, 2), saved, strict=True):
                os.dup2(copy, number)
                os.close(copy)
            target.seek(0)
            printed.text = target.read().decode(errors="replace")


def _flush() -> None:
    for stream in (sys.stdout, sys.stderr):
        if stream is not None and not stream.closed:
            stream.flush()
    # C's buffers too, or text of before and after would land on the wrong side
    library = ctypes.CDLL("msvcrt" if os.name == "nt" else None)
    library.fflush(None)
