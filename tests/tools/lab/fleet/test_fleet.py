"""ale-fleet replay: the same table however it came about, and nothing lost."""
import csv
import importlib
import json
import os
import pathlib
import pty
import signal
import subprocess
import sys

import pytest

from at_hand import BINARIES
from fleet_at_work import LOGS, SCANS, fleet_words, gated, said_by, script
from waiting import wait_until

pytest.importorskip("distributed", reason="python3-distributed is not here")
from dying_workers import kill_workers  # noqa: E402


@pytest.fixture(scope="module")
def with_one_broken(drives, tmp_path_factory):
    folder = tmp_path_factory.mktemp("broken")
    for k in range(LOGS):
        (folder / f"d{k}.log").write_bytes((drives / f"d{k}.log").read_bytes())
    (folder / "d2.log").write_text("broken", encoding="ascii")
    (folder / "truths").symlink_to(drives / "truths")
    return folder


def words_of(folder, out, program="ale-replay", logs=LOGS):
    return ["replay", *(f"{folder}/d{k}.log" for k in range(logs)), "--against", f"{folder}/truths", "--set", "sensor.x=0,0.1", "--out", out,
            "--workers", "2", "--program", BINARIES / program]


def fleet(*words, code=0):
    said = said_by(*words, code=code)
    out = words[words.index("--out") + 1]
    assert not pathlib.Path(f"{out}.part").exists()
    return pathlib.Path(out).read_bytes(), said


def test_a_worker_that_is_killed_on_the_way_changes_no_byte(with_one_broken, tmp_path):
    table, said = fleet(*words_of(with_one_broken, tmp_path / "one.csv"), "--page", tmp_path / "page", code=1)
    assert "d2.log: has no line of a known format" in said
    rows = [line.split(",") for line in table.decode().splitlines()]
    assert rows[0] == ["log", "sensor.x", "scans", "dropped", "lost", "weak", "pieces", "ate_mm", "error"]
    assert [(pathlib.Path(row[0]).name, row[1]) for row in rows[1:]] == [(f"d{k}.log", x) for k in range(LOGS) for x in ("0", "0.1")]
    assert all(float(row[7]) < 20 for row in rows[1:] if row[2] and row[1] == "0")
    assert len(list((tmp_path / "page").glob("*.png"))) == 2 * (LOGS - 1)
    program = script(tmp_path / "replay", f'mkdir "{tmp_path}/killed" 2>/dev/null && kill -9 $PPID')  # the first to come ends the worker that has called it
    again, _ = fleet(*words_of(with_one_broken, tmp_path / "two.csv", program), code=1)
    assert (tmp_path / "killed").is_dir()
    assert again == table


def test_two_workers_of_four_that_are_killed_change_no_byte(drives, tmp_path):
    table, _ = fleet(*words_of(drives, tmp_path / "one.csv"))
    program, gate = gated(tmp_path)
    out = tmp_path / "two.csv"
    running = subprocess.Popen(fleet_words(*words_of(drives, out, program), "--workers", "4"), stderr=subprocess.DEVNULL)
    assert kill_workers(running, tmp_path / "two.csv.part", 1, 2)
    gate.touch()
    assert running.wait() == 0
    assert out.read_bytes() == table


def test_a_run_goes_on_from_what_is_done(drives, tmp_path):
    sys.path.insert(0, str(BINARIES / "ale-fleet"))
    module = importlib.import_module("ale_fleet.many_replays")
    task = (f"{drives}/d0.log", f"{drives}/truths/d0.tum", (("sensor.x", "0"),))
    row = {**dict.fromkeys(module.one_replay.RESULTS, ""), "scans": "12345"}
    part = tmp_path / "table.csv.part"
    part.write_text(json.dumps([module.Tasks.key(task), row, ""]) + "\n" + '["cut sho', encoding="utf-8")
    table, said = fleet(*words_of(drives, tmp_path / "table.csv", logs=1))
    assert "1 of 2 are to be done" in said
    assert [line.split(",")[2] for line in table.decode().splitlines()[1:]] == ["12345", str(SCANS)]


def test_whoever_presses_ctrl_c_sees_the_bar_and_loses_nothing(drives, tmp_path):
    """On a terminal, of which the workers are, too."""
    program, gate = gated(tmp_path)
    words = words_of(drives, tmp_path / "table.csv", program)
    leader, terminal = pty.openpty()
    running = subprocess.Popen(["setsid", "--ctty", *fleet_words(*words)], stdin=terminal, stdout=terminal, stderr=terminal)
    os.close(terminal)
    seen = b""
    while b"] 2 of 8" not in seen:
        seen += os.read(leader, 4096)
    wait_until(lambda: (tmp_path / "table.csv.part").read_bytes().count(b"\n") == 2, 60, "two rows are kept")
    os.write(leader, b"\x03")
    try:
        while piece := os.read(leader, 4096):
            seen += piece
    except OSError:
        pass  # nobody has the terminal any more
    assert running.wait() == 1
    assert b"ended; what is done is kept, the same words go on" in seen
    assert b"Traceback" not in seen
    gate.touch()
    again, said = fleet(*words)
    assert "6 of 8 are to be done" in said
    assert again == fleet(*words_of(drives, tmp_path / "whole.csv"))[0]


def test_a_table_for_parquet_has_the_rows_of_csv(drives, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet", reason="PyPI's pyarrow is not here")
    table, _ = fleet(*words_of(drives, tmp_path / "table.csv", logs=1))
    fleet(*words_of(drives, tmp_path / "table.parquet", logs=1))
    assert parquet.read_table(tmp_path / "table.parquet").to_pylist() == list(csv.DictReader(table.decode().splitlines()))


@pytest.mark.parametrize("words, code, said", [
    ("replay", 2, "give replay LOG..."), ("replay a.log --out t.csv --fly", 2, "unknown option --fly"), ("fly a.log --out t.csv", 2, "give replay LOG..."),
    ("replay a.log", 2, "--out is missing"),
    ("replay a.log --out t.txt", 2, "neither .csv nor .parquet"), ("replay a.log --out t.csv --points", 2, "--points is of merge"),
    ("merge a.log --out m.map --against x", 2, "--against is of replay"), ("replay a.log --out t.csv --workers 0", 2, "one at least"),
    ("replay a.log --out t.csv --set x=1", 2, "not section.key=VALUE,VALUE"), ("merge a.log a.log --out m.map", 2, "named twice"),
    ("merge a.log --out m.map --set sensor.x=0,1", 2, "one value"), ("replay absent.log --out t.csv", 1, "absent.log: No such file or directory"),
    ("replay a.log --out absent/t.csv", 1, "absent: no such folder"), ("replay a.log --out t.csv --against absent", 1, "absent: No such file or directory"),
    ("replay elsewhere://a.log --out t.csv", 1, "Protocol not known"), ("replay a.log --out t.csv --program absent", 1, "absent: no such program")])
def test_what_cannot_be_is_said_before_the_work(tmp_path, words, code, said):
    (tmp_path / "a.log").touch()
    assert said in said_by(*words.split(), code=code, cwd=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.log"]


def test_a_run_that_is_terminated_leaves_no_worker(drives, tmp_path):
    program = script(tmp_path / "replay", f'echo $PPID >> "{tmp_path}/workers"; while [ ! -e "{tmp_path}/gate" ]; do sleep 0.02; done')
    running = subprocess.Popen(fleet_words(*words_of(drives, tmp_path / "table.csv", program)), stderr=subprocess.DEVNULL)
    pids = tmp_path / "workers"
    wait_until(lambda: pids.exists() and pids.read_text(encoding="ascii").count("\n") == 2, 60, "both workers are at work")
    running.send_signal(signal.SIGTERM)
    running.wait()
    (tmp_path / "gate").touch()
    for pid in pids.read_text(encoding="ascii").split():
        wait_until(lambda pid=pid: not pathlib.Path(f"/proc/{pid}").exists(), 60, "the workers are gone")
