"""What a worker process of this machine does first; Dask loads this module there (`preload`)."""

from __future__ import annotations

import signal


def dask_setup(worker: object) -> None:
    """Leave Ctrl-C to the process that the user sees: a terminal sends it to all, and workers would show tracebacks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
