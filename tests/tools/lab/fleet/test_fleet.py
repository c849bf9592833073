"""ale-fleet: the same table however it came about, and nothing lost."""
import importlib
import json
import pathlib
import subprocess
import sys

import pytest

from at_hand import BINARIES, WORLDS

pytest.importorskip("distributed", reason="python3-distributed is not here")

SCANS = 60
LOGS = 4


@pytest.fixture(scope="module")
def drives(tmp_path_factory):
    """A folder of short logs, one broken, and of the truth of each."""
    folder = tmp_path_factory.mktemp("drives")
    log, truth = folder / "whole", folder / "truth"
    subprocess.run([BINARIES / "ale-sim", "--world", WORLDS / "home.world", "--write-log", log, "--truth", truth], check=True, capture_output=True)
    lines = log.read_text(encoding="ascii").splitlines(keepends=True)
    head, scans = [line for line in lines if line.startswith("#")], [line for line in lines if not line.startswith("#")]
    (folder / "truths").mkdir()
    for k in range(LOGS):
        (folder / f"d{k}.log").write_text("".join(head + scans[SCANS * k:SCANS * (k + 1)]), encoding="ascii")
        (folder / "truths" / f"d{k}.tum").write_bytes(truth.read_bytes())
    (folder / "d2.log").write_text("broken", encoding="ascii")
    return folder


def fleet(folder, out, program=BINARIES / "ale-replay", code=1, logs=LOGS):
    done = subprocess.run([BINARIES / "ale-fleet", "replay", *(f"{folder}/d{k}.log" for k in range(logs)), "--against", f"{folder}/truths",
                           "--set", "sensor.x=0,0.1", "--out", out, "--workers", "2", "--page", f"{out}.page", "--program", program],
                          capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stderr
    assert not pathlib.Path(f"{out}.part").exists()
    return pathlib.Path(out).read_bytes(), done.stderr


def test_a_worker_that_is_killed_on_the_way_changes_no_byte(drives, tmp_path):
    table, said = fleet(drives, tmp_path / "one.csv")
    assert "d2.log: has no line of a known format" in said
    rows = [line.split(",") for line in table.decode().splitlines()]
    assert rows[0] == ["log", "sensor.x", "scans", "dropped", "lost", "weak", "pieces", "ate_mm", "error"]
    assert [(pathlib.Path(row[0]).name, row[1]) for row in rows[1:]] == [(f"d{k}.log", x) for k in range(LOGS) for x in ("0", "0.1")]
    assert all(float(row[7]) < 20 for row in rows[1:] if row[2] and row[1] == "0")
    assert len(list((tmp_path / "one.csv.page").glob("*.png"))) == 2 * (LOGS - 1)
    program = tmp_path / "replay"  # the first to come ends the worker that has called it
    program.write_text(f'#!/bin/sh\nmkdir "{tmp_path}/killed" 2>/dev/null && kill -9 $PPID\nexec "{BINARIES}/ale-replay" "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    again, _ = fleet(drives, tmp_path / "two.csv", program)
    assert (tmp_path / "killed").is_dir()
    assert again == table


def test_a_run_goes_on_from_what_is_done(drives, tmp_path):
    sys.path.insert(0, str(BINARIES / "ale-fleet"))
    module = importlib.import_module("ale_fleet.main")
    task = (f"{drives}/d0.log", f"{drives}/truths/d0.tum", (("sensor.x", "0"),))
    row = {**dict.fromkeys(module.one_replay.RESULTS, ""), "scans": "12345"}
    part = tmp_path / "table.csv.part"
    part.write_text(json.dumps([module.Tasks.key(task), row, ""]) + "\n" + '["cut sho', encoding="utf-8")
    table, said = fleet(drives, tmp_path / "table.csv", code=0, logs=1)
    assert "1 of 2 are to be done" in said
    assert [line.split(",")[2] for line in table.decode().splitlines()[1:]] == ["12345", str(SCANS)]
