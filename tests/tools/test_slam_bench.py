"""The errors of a trajectory as the benchmark of localisation and mapping tells them."""
import gzip
import json
import math
import re
import subprocess
import sys
import types

import pytest

np = pytest.importorskip("numpy")

import slam_table  # noqa: E402
from at_hand import BUILD, shared  # noqa: E402
from slam_table import normalised_error, score, trajectory_error  # noqa: E402

SCANS = 200
STEP_S = 0.1


def write_tum(path, poses):
    path.write_text("".join(f"{STEP_S * k:.6f} {x:.9f} {y:.9f} 0 0 0 {math.sin(a / 2):.9f} {math.cos(a / 2):.9f}\n"
                            for k, (x, y, a) in enumerate(poses)), encoding="utf-8")
    return path


def way():
    """Round a circle of two metres."""
    return [(2 * math.cos(0.05 * k), 2 * math.sin(0.05 * k), 0.05 * k + math.pi / 2) for k in range(SCANS)]


def seen_from_elsewhere(poses, x, y, turn):
    c, s = math.cos(turn), math.sin(turn)
    return [(x + c * px - s * py, y + s * px + c * py, a + turn) for px, py, a in poses]


def test_a_trajectory_in_another_frame_has_no_error(tmp_path):
    truth = write_tum(tmp_path / "truth.tum", way())
    moved = write_tum(tmp_path / "moved.tum", seen_from_elsewhere(way(), 3, -1, 2.5))
    assert trajectory_error(moved, truth) == pytest.approx((0, 0, 0), abs=1e-3)


def test_a_swing_to_both_sides_is_found(tmp_path):
    truth = write_tum(tmp_path / "truth.tum", way())
    swings = [(x * (1 + 0.005 * (-1) ** k), y * (1 + 0.005 * (-1) ** k), a) for k, (x, y, a) in enumerate(way())]
    ate, _, turn = trajectory_error(write_tum(tmp_path / "swings.tum", swings), truth)
    assert ate == pytest.approx(10, abs=0.1)
    assert turn == pytest.approx(0, abs=1e-3)


def test_a_drift_of_the_heading_shows_over_a_second(tmp_path):
    truth = write_tum(tmp_path / "truth.tum", way())
    drifts = [(x, y, a + math.radians(0.02) * k) for k, (x, y, a) in enumerate(way())]
    assert trajectory_error(write_tum(tmp_path / "drifts.tum", drifts), truth)[2] == pytest.approx(0.2, abs=1e-3)


def test_a_pose_that_errs_by_its_sigmas_has_a_normalised_error_of_three(tmp_path):
    truth = write_tum(tmp_path / "truth.tum", way())
    sigmas = (0.02, 0.05, 0.01)
    told = seen_from_elsewhere(way(), 3, -1, 2.5)
    rows = []
    for k, pose in enumerate(told):
        errs = (-1) ** k if k else 0
        x, y, a = (value + errs * sigma for value, sigma in zip(pose, sigmas))
        cov = np.diag(np.square(sigmas)).ravel().tolist()
        rows.append(json.dumps({"t": STEP_S * k, "map_x": x, "map_y": y, "map_theta": a, "cov": cov}))
    poses = tmp_path / "poses.jsonl"
    poses.write_text("\n".join(rows) + "\n", encoding="utf-8")
    assert normalised_error(poses, truth) == pytest.approx(3, abs=1e-3)


def test_the_errors_are_those_of_the_scorer_beside_the_project(tmp_path):
    scorer = shared("bench/slam/score.py")
    try:
        subprocess.run([sys.executable, "-c", "import scipy"], check=True, capture_output=True)
    except subprocess.CalledProcessError:
        pytest.skip("no scipy here")
    truth = write_tum(tmp_path / "truth.tum", way())
    other = write_tum(tmp_path / "other.tum",
                      [(x + 0.01 * math.sin(0.3 * k), y + 0.02 * math.cos(0.1 * k), a + 0.01 * math.sin(0.2 * k))
                       for k, (x, y, a) in enumerate(seen_from_elsewhere(way(), 1, 2, 0.5))])
    told = score(scorer, other, truth)
    mine = trajectory_error(other, truth)
    assert mine == pytest.approx((1e3 * told["ate_rmse"], 1e3 * told["rpe_1s_m"], told["rpe_1s_deg"]), rel=0.02)


def test_a_building_is_replayed_with_the_noise_of_each_seed_too():
    shared("data/corrected/freiburg-101.clf.gz")
    if not (BUILD / "bin/ale-replay").exists():
        pytest.skip("ale-replay is not built")
    done = subprocess.run([sys.executable, slam_table.__file__, "--build", BUILD, "--shared", shared("."), "--only", "freiburg-101",
                           "--jitter", "1,2"], check=True, capture_output=True, text=True)
    names = re.findall(r"^\| (freiburg-101[^|]*?) *\|", done.stdout, re.MULTILINE)
    assert names == ["freiburg-101.clf.gz", "freiburg-101.clf.gz, jitter 1", "freiburg-101.clf.gz, jitter 2"]


def test_each_seed_adds_other_noise(tmp_path):
    recorded = tmp_path / "recorded.clf"
    recorded.write_bytes(gzip.decompress(shared("data/corrected/freiburg-101.clf.gz").read_bytes()))
    bench = types.SimpleNamespace(folder=tmp_path)
    logs = {log.read_bytes() for _, log in slam_table.with_more_noise(bench, recorded, ["1", "2"])}
    assert len(logs) == 3


@pytest.mark.parametrize("words", [["--jitter", "one"], ["--seeds", "1,,2"]])
def test_seeds_that_are_no_numbers_are_told(words):
    done = subprocess.run([sys.executable, slam_table.__file__, "--build", BUILD, *words], check=False, capture_output=True, text=True)
    assert done.returncode == 2
    assert "not numbers with commas" in done.stderr and "Traceback" not in done.stderr
