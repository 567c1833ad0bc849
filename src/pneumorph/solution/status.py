"""How far a solve got."""

from __future__ import annotations

from enum import Enum


class Status(Enum):
    """RUNNING: not ended, or killed; DONE: every phase reached its end; STOPPED: the load stepping could not go on."""

    RUNNING = "running"
    DONE = "done"
    STOPPED = "stopped"
