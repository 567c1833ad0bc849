"""The workers: processes of this machine, of a running scheduler, of SLURM jobs."""

import sys

import pytest
from dask.distributed import LocalCluster

from pneumorph.errors import EngineError, InputError
from pneumorph.studies.sweeps import Workers, cluster
from pneumorph.studies.sweeps.schema import SlurmSection

SLURM = SlurmSection(jobs=3, workers=4, memory="8 GB", walltime="01:30:00", queue="long", prologue=("module load x",))


def test_a_worker_that_dies_costs_its_own_design_only_and_workers_have_one_thread():
    calls = [("1 + 1",), ("__import__('os')._exit(1)",), ("1 / 0",), ("__import__('os').environ['PNEUMORPH_THREADS']",)]
    found = dict(Workers(count=1).compute(eval, calls))
    assert found[0] == 2
    assert type(found[1]).__name__ == "KilledWorker"
    assert type(found[2]) is ZeroDivisionError
    assert found[3] == "1"


def test_a_running_scheduler_does_the_work_with_workers_of_one_thread():
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0") as running:
        place = Workers(scheduler=running.scheduler_address)
        assert sorted(place.compute(len, [("ab",), ("abc",)])) == [(0, 2), (1, 3)]
        answers = place.compute(len, [("ab",), ("abc",)])
        next(answers)
        answers.close()  # leaves the cluster to others
        assert running.scheduler_info["workers"]


def test_a_scheduler_that_goes_away_is_said_with_how_to_go_on(monkeypatch):
    monkeypatch.setattr(cluster, "_PATIENCE", "0.5s")
    running = LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0")
    answers = Workers(scheduler=running.scheduler_address).compute(len, [("ab",), ("abc",), ("abcd",)])
    next(answers)
    running.close()
    with pytest.raises(EngineError, match="the scheduler went away; designs that ended are kept"):
        list(answers)


def test_workers_of_several_threads_are_refused():
    with (
        LocalCluster(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=":0") as running,
        pytest.raises(
            InputError, match="has 2 threads, allowed: 1; start workers with PNEUMORPH_THREADS=1 dask worker"
        ),
    ):
        list(Workers(scheduler=running.scheduler_address).compute(len, [("ab",)]))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense", "tcp://"])
def test_an_address_where_no_scheduler_answers_is_named(monkeypatch, address):
    monkeypatch.setattr(cluster, "_PATIENCE", "0.3s")
    with pytest.raises(EngineError, match=f"no Dask scheduler answers at {address}"):
        list(Workers(scheduler=address).compute(len, [("ab",)]))


def test_slurm_jobs_have_workers_of_one_thread():
    pytest.importorskip("dask_jobqueue")
    with cluster.slurm_cluster(SLURM) as made:
        script = made.job_script()
    for line in ("#SBATCH -p long", "--cpus-per-task=4", "-t 01:30:00", "export PNEUMORPH_THREADS=1", "module load x"):
        assert line in script
    assert "--nthreads 1 " in script
    assert "--nworkers 4 " in script


def test_without_dask_jobqueue_slurm_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "dask_jobqueue", None)
    with pytest.raises(EngineError, match=r"needs dask-jobqueue: pip install 'pneumorph\[slurm\]'"):
        cluster.slurm_cluster(SLURM)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"count": 0}, "workers = 0: expected at least 1"),
        ({"count": 2, "scheduler": "tcp://a:1"}, "has its own workers"),
        ({"slurm": SLURM, "scheduler": "tcp://a:1"}, "choose one"),
    ],
)
def test_workers_that_are_none_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        Workers(**given)


def test_workers_say_where_they_are():
    assert Workers(count=1).text == "1 worker of one thread on this machine"
    assert Workers(count=3).text == "3 workers of one thread on this machine"
    assert Workers(scheduler="tcp://a:1").text == "workers of tcp://a:1"
    assert Workers(slurm=SLURM).text == "3 SLURM jobs"
