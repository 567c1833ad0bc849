"""A sweep of twelve designs, killed half-way: what ended is kept, and only what is missing is computed."""

import csv
import os
import signal
import subprocess
import sys
import time

from tests.studies.sweeps.pretend import TWELVE

COMMAND = [sys.executable, "-c", "from pneumorph.cli.app import main; main()", "sweep"]


def test_a_killed_sweep_computes_only_the_missing_designs(sweep_file, tmp_path):
    file, out = sweep_file(TWELVE), tmp_path / "out"
    command = [*COMMAND, str(file), "--out", str(out), "--workers", "1"]
    ended = lambda: {path: path.stat().st_mtime_ns for path in out.glob("designs/*/design.json")}  # noqa: E731
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
        limit = time.monotonic() + 120
        while len(ended()) < 5:
            assert process.poll() is None, process.stderr.read()
            assert time.monotonic() < limit
            time.sleep(0.02)
        os.kill(process.pid, signal.SIGKILL)
    before = ended()
    assert 5 <= len(before) < 12

    result = subprocess.run([*command, "--resume"], capture_output=True, text=True, timeout=240, check=True)
    assert f"{len(before)}/12  kept from before" in result.stdout
    assert result.stdout.count("  done in ") == 12 - len(before)
    assert "12 done of 12 designs" in result.stdout
    after = ended()
    assert len(after) == 12
    assert {path: after[path] for path in before} == before
    with (out / "table.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    assert [row["status"] for row in rows] == ["done"] * 12
    # thicker and stiffer spheres give less, from row to row of the grid
    volumes = [float(row["added_volume:cavity [mL]"]) for row in rows]
    assert all(volumes[i] > volumes[i + 3] for i in range(9))
    assert all(volumes[i] > volumes[i + 1] for i in range(11) if i % 3 < 2)
    assert {"table.parquet", "report.html", "figures", "sweep.toml", "study.toml"} <= {p.name for p in out.iterdir()}
