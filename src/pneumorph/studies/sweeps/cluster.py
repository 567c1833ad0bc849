"""The workers of a sweep, by Dask distributed; no other module imports dask.

Processes of this machine by default, those of a running scheduler, or jobs of a SLURM cluster through dask-jobqueue.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from logging import CRITICAL, getLogger
from typing import Any

from pneumorph.errors import EngineError, InputError
from pneumorph.studies.sweeps import worker
from pneumorph.studies.sweeps.schema import SlurmSection
from pneumorph.threads import thread_count

# a worker computes one design on one core: see `pneumorph.threads`
ONE_THREAD = dict.fromkeys(
    ("PNEUMORPH_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1"
)
_SETTINGS = {
    "distributed.scheduler.allowed-failures": 1,  # a design that ends its worker gets one more try
    # a worker that outgrows its share of the memory is ended and its design fails; nothing is gained by pausing it
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
}
_PATIENCE = "10s"  # for a scheduler to answer

_GONE = "the scheduler went away; designs that ended are kept: go on with --resume"

Call = tuple[Any, ...]


@dataclass(frozen=True)
class Workers:
    """Where designs are computed.

    count: processes of this machine, by default as many as `thread_count`. scheduler: address of a running Dask
    scheduler, such as "tcp://10.0.0.1:8786". slurm: jobs of a SLURM cluster. Raises InputError for more than one of
    them, or a count below 1.
    """

    count: int | None = None
    scheduler: str | None = None
    slurm: SlurmSection | None = None

    def __post_init__(self) -> None:
        if self.count is not None and self.count < 1:
            raise InputError(f"workers = {self.count}: expected at least 1")
        if self.scheduler is not None and self.count is not None:
            raise InputError("workers and scheduler are both given: a running scheduler has its own workers")
        if self.scheduler is not None and self.slurm is not None:
            raise InputError("scheduler and slurm are both given: choose one")

    @property
    def text(self) -> str:
        """Where the work is done, in words."""
        if self.scheduler is not None:
            return f"workers of {self.scheduler}"
        if self.slurm is not None:
            return f"{self.slurm.jobs} SLURM jobs"
        count = self.count or thread_count()
        return f"{count} worker{'s' if count > 1 else ''} of one thread on this machine"

    def compute(self, function: Callable[..., Any], calls: Sequence[Call]) -> Iterator[tuple[int, Any]]:
        """Yield (number of the call, what function(*call) returns, or the exception that it raised) as they end.

        No more calls are handed out than there are workers, so that one that ends its worker takes no other with it.
        Raises EngineError where no scheduler answers or it goes away, InputError for workers of several threads.
        """
        from dask.distributed import as_completed

        with _client(self) as client:
            waiting = iter(enumerate(calls))
            running: dict[Any, int] = {}
            ended = as_completed(loop=client.loop)

            def hand_out() -> None:
                free = max(1, _capacity(client)) - len(running)
                for number, call in (item for _, item in zip(range(free), waiting, strict=False)):
                    future = client.submit(function, *call, pure=False)
                    running[future] = number
                    ended.add(future)

            hand_out()
            while running:
                future = next(ended)
                error = None if future.status == "finished" else future.exception()
                if future.cancelled() or isinstance(error, CancelledError):
                    raise EngineError(_GONE)
                number = running.pop(future)
                yield number, future.result() if error is None else error
                hand_out()


def _capacity(client: Any) -> int:
    """Return how many designs the workers compute at a time; raises InputError for workers of several threads."""
    try:
        threads: Mapping[str, int] = client.nthreads()
    except OSError as error:
        raise EngineError(_GONE) from error
    for address, count in threads.items():
        if count != 1:
            raise InputError(
                f"the worker {address} has {count} threads, allowed: 1; start workers with "
                "PNEUMORPH_THREADS=1 dask worker ADDRESS --nthreads 1 --nworkers COUNT"
            )
    return len(threads)


@contextmanager
def _client(workers: Workers) -> Iterator[Any]:
    """Start or join a cluster, and leave it."""
    import dask.config
    from dask.distributed import Client, LocalCluster

    with ExitStack() as stack:
        stack.enter_context(dask.config.set(_SETTINGS))
        stack.enter_context(_quiet())
        place: Any
        if workers.scheduler is not None:
            place = workers.scheduler
        elif workers.slurm is not None:
            place = stack.enter_context(slurm_cluster(workers.slurm))
            place.scale(jobs=workers.slurm.jobs)
        else:
            stack.enter_context(_environment(ONE_THREAD))
            place = stack.enter_context(
                LocalCluster(
                    n_workers=workers.count or thread_count(),
                    threads_per_worker=1,
                    processes=True,
                    host="127.0.0.1",
                    dashboard_address="127.0.0.1:0",  # any free port: sweeps may run beside each other
                    preload=[worker.__name__],
                )
            )
        try:
            client = stack.enter_context(Client(place, timeout=_PATIENCE, set_as_default=False))
        except (OSError, ValueError) as error:
            raise EngineError(f"no Dask scheduler answers at {place}: {error}") from error
        yield client


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    """Set variables of the environment, which new processes inherit; Dask's own settings would yield to those set."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep Dask's log of workers that come and go away from the progress; what matters comes back as an exception."""
    logger = getLogger("distributed")
    before = logger.level
    logger.setLevel(CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(before)


def slurm_cluster(section: SlurmSection) -> Any:
    """Return the cluster, without jobs yet, of a [slurm] section. Raises EngineError without dask-jobqueue."""
    try:
        from dask_jobqueue import SLURMCluster
    except ImportError as error:
        raise EngineError("[slurm] needs dask-jobqueue: pip install 'pneumorph[slurm]'") from error
    return SLURMCluster(
        queue=section.queue,
        account=section.account,
        cores=section.workers,
        processes=section.workers,
        memory=section.memory,
        walltime=section.walltime,
        job_script_prologue=[*(f"export {name}={value}" for name, value in ONE_THREAD.items()), *section.prologue],
        job_extra_directives=list(section.directives),
        scheduler_options={"dashboard_address": ":0"},
    )
