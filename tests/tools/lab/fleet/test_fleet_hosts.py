"""ale-fleet over a scheduler and workers on two hosts."""
import os
import subprocess

import pytest

from fleet_at_work import LOGS, fleet_words, gated, said_by
from waiting import wait_until

pytest.importorskip("distributed", reason="python3-distributed is not here")
import two_hosts  # noqa: E402


def test_two_hosts_give_the_table_of_one_also_when_the_second_leaves(drives, tmp_path):
    if missing := two_hosts.why_not():
        pytest.skip(missing)
    words = ["replay", *(drives / f"d{k}.log" for k in range(LOGS)), "--against", drives / "truths", "--out"]
    said_by(*words, tmp_path / "here.csv", "--workers", "1")
    program, gate = gated(tmp_path)
    part, said = tmp_path / "there.csv.part", tmp_path / "dask.txt"
    with two_hosts.scheduler(tmp_path) as (address, here, workers):
        wait_until(lambda: said.read_text(encoding="utf-8").count("Registered to:") == 2, 60, "both workers are there")
        running = subprocess.Popen([*here, *fleet_words(*words, tmp_path / "there.csv", "--scheduler", address, "--program", program)])
        wait_until(part.exists, 60, "a row is done")
        workers[1].kill()
        gate.touch()
        assert running.wait() == 0
    assert (tmp_path / "there.csv").read_bytes() == (tmp_path / "here.csv").read_bytes()


def test_a_scheduler_that_is_not_there_is_said(drives, tmp_path):
    said = said_by("replay", drives / "d0.log", "--out", tmp_path / "t.csv", "--scheduler", "tcp://127.0.0.1:9", code=1,
                   env={**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "1s"})
    assert said.splitlines()[-1].startswith("ale-fleet: ")
    assert "Traceback" not in said
