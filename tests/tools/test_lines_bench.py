"""The line benchmark's program, and its judgement beside an independent one where that is at hand."""
import json
import os
import subprocess
import sys

import pytest

from at_hand import BUILD, ROOT, shared

PROGRAM = BUILD / "bench/lines"


@pytest.fixture(scope="module")
def program():
    subprocess.run(["make", "-s", "-C", ROOT, f"BUILD={os.path.relpath(BUILD, ROOT)}",
                    f"{os.path.relpath(BUILD, ROOT)}/bench/lines"], check=True, capture_output=True)
    return PROGRAM


def lines(program, *words):
    done = subprocess.run([program, *words], check=True, capture_output=True, text=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_every_extractor_is_measured_and_figures_are_percentages(program):
    rows = lines(program, "accuracy", "--noise", "3mm", "--scans", "1")
    assert len(rows) >= 11
    for row in rows:
        assert row["scans"] == 10
        assert 0 <= row["fp"] <= 100 and 30 <= row["tp"] <= 100, row["extractor"]


def test_the_same_seed_gives_the_same_figures_and_another_others(program):
    def figures(seed):
        row, = lines(program, "accuracy", "--noise", "urg", "--scans", "2", "--extractor", "ale", "--seed", seed)
        row.pop("us_a_scan")
        return row

    assert figures("5") == figures("5")
    assert figures("5") != figures("6")


@pytest.mark.parametrize("words", [["--scans"], ["nonsense"], ["accuracy", "--extractor", "nobody"], ["--colour"]])
def test_wrong_use_exits_2_with_one_line(program, words):
    done = subprocess.run([program, *words], check=False, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_a_missing_recording_is_named(program, tmp_path):
    done = subprocess.run([program, "rest", tmp_path / "none.log"], check=False, capture_output=True, text=True)
    assert done.returncode == 1
    assert "none.log" in done.stderr


def test_where_a_real_scanner_rests_its_mirror_image_has_the_same_lines(program):
    recording = shared("data/urg04lx/test_lab.dat")
    done = subprocess.run([sys.executable, ROOT / "tools/lab/bench/rest_table.py", "--program", program, recording],
                          check=True, capture_output=True, text=True)
    assert "| test_lab, scan 260 | 35 | as recorded |" in done.stdout
    assert done.stdout.endswith("Mirrored the lines are the same.\n")


@pytest.mark.parametrize("noise", ["urg", "real"])
def test_the_score_agrees_with_an_independent_one(program, tmp_path, noise):
    score = shared("bench/lines/score.py")
    replay = BUILD / "bin/ale-replay"
    if not replay.exists():
        pytest.skip("ale-replay is not built")
    subprocess.run([program, "write", tmp_path, "--noise", noise, "--scans", "3"], check=True)
    subprocess.run([replay, tmp_path / "scans.log", "--lines-only", "--features", tmp_path / "out.jsonl"], check=True,
                   capture_output=True)
    theirs = json.loads(subprocess.run(
        [sys.executable, score, tmp_path / "truth.jsonl", tmp_path / "out.jsonl", "--json"],
        check=True, capture_output=True, text=True).stdout)
    ours, = lines(program, "accuracy", "--noise", noise, "--scans", "3", "--extractor", "ale")
    for mine, other, tolerance in (("tp", "TP75", 0), ("fp", "FP75", 0), ("error_rms", "R_rms", 0.02),
                                   ("end_mm", "end_mm", 0.2), ("corner_precision", "cP", 0),
                                   ("corner_recall", "cR", 0), ("corner_mm", "c_mm", 0.1)):
        assert ours[mine] == pytest.approx(theirs[other], abs=tolerance + 1e-9), mine
