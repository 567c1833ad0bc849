"""How many threads each library may use, decided in one place.

More runnable threads than cores make the spinning pools of MKL and OpenMP slow everything down several times,
so all of them get one count: the environment variable PNEUMORPH_THREADS, by default the physical cores.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from typing import TypeVar

import psutil

from pneumorph.errors import InputError

Item = TypeVar("Item")
Result = TypeVar("Result")


@cache
def thread_count() -> int:
    """Return the number of threads to use; raises InputError where PNEUMORPH_THREADS is not a positive number."""
    text = os.environ.get("PNEUMORPH_THREADS")
    if text is None:
        available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        return max(1, min(psutil.cpu_count(logical=False) or 1, available))
    if not text.isdigit() or int(text) < 1:
        raise InputError(f"PNEUMORPH_THREADS = '{text}': expected a whole number of at least 1")
    return int(text)


def limit_libraries() -> None:
    """Tell the numerical libraries their thread count; works for those that are not loaded yet."""
    for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
        os.environ[name] = str(thread_count())
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # only small dense products go there
    os.environ.setdefault("KMP_BLOCKTIME", "0")  # threads that wait do not spin


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(thread_count(), thread_name_prefix="pneumorph")


def parallel(function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """Return function(item) for all items, in order, on the pool (for kernels that release the GIL)."""
    if thread_count() == 1:
        return [function(item) for item in items]
    return list(_pool().map(function, items))


def slices(count: int) -> Iterator[slice]:
    """Yield one contiguous slice of range(count) for each thread; empty ones are left out."""
    threads = thread_count()
    bounds = [count * i // threads for i in range(threads + 1)]
    return (slice(a, b) for a, b in pairwise(bounds) if b > a)
