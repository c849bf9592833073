"""ale-plot: numbers against an independent computation, panels for what there is, trouble in one line."""
import gzip
import json
import struct
import subprocess

import ale
import numpy as np
import pytest

from at_hand import BINARIES, ROOT

PLOT = BINARIES / "ale-plot"
LOG = ROOT / "tests/digest/apartment.log.gz"
PNG = b"\x89PNG\r\n\x1a\n"


def plot(*words, code=0, **options):
    done = subprocess.run([PLOT, *map(str, words)], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=170, check=False, **options)
    assert done.returncode == code, done.stderr
    return done


@pytest.fixture(autouse=True, scope="module")
def matplotlib():
    if subprocess.run(["/usr/bin/python3", "-c", "import matplotlib"], check=False, capture_output=True).returncode:
        pytest.skip("matplotlib is not installed (python3-matplotlib)")


def put_tum(path, poses):
    path.write_text("".join(f"{t} {x} {y} 0 0 0 {np.sin(a / 2)} {np.cos(a / 2)}\n" for t, x, y, a in poses), encoding="utf-8")


def put_poses(path, poses, sigma, state=2):
    path.write_text("".join(json.dumps({
        "t": t, "map_x": x, "map_y": y, "map_theta": a, "cov": [sigma**2, 0, 0, 0, sigma**2, 0, 0, 0, 1e-6], "state": state,
        "predicted": False, "lag_us": 0, "maps": 1, "wheel_fault": "fine"}) + "\n" for t, x, y, a in poses), encoding="utf-8")


@pytest.fixture
def drive():
    t = np.arange(200) * 0.1
    return np.column_stack([t, 3 * np.cos(t / 3), 3 * np.sin(t / 3), t / 3 + np.pi / 2])


def moved(poses, turn, x, y):
    c, s = np.cos(turn), np.sin(turn)
    return np.column_stack([poses[:, 0], c * poses[:, 1] - s * poses[:, 2] + x, s * poses[:, 1] + c * poses[:, 2] + y, poses[:, 3] + turn])


def column(printed, name):
    head, *lines = printed.splitlines()
    right = head.index(name) + len(name)
    return [line[:right].split()[-1] for line in lines]


def test_the_error_is_that_of_a_least_squares_fit(drive, tmp_path):
    """The same drive, turned and moved and noisy, against rotation by singular values."""
    noisy = moved(drive, 0.7, 4, -2)
    noisy[:, 1:3] += np.random.default_rng(5).normal(0, 0.02, (len(drive), 2))
    put_tum(tmp_path / "truth.tum", drive)
    put_tum(tmp_path / "run.tum", noisy)
    a, b = noisy[:, 1:3] - noisy[:, 1:3].mean(axis=0), drive[:, 1:3] - drive[:, 1:3].mean(axis=0)
    u, _, v = np.linalg.svd(b.T @ a)
    error = 1000 * np.linalg.norm(a @ (u @ v).T - b, axis=1)
    printed = plot(tmp_path / "run.tum", "--truth", tmp_path / "truth.tum", "--out", tmp_path / "p.png").stdout
    assert float(column(printed, "ATE rmse mm")[0]) == pytest.approx(np.sqrt(np.mean(error**2)), abs=0.06)
    assert float(column(printed, "worst mm")[0]) == pytest.approx(error.max(), abs=0.06)
    assert (tmp_path / "p.png").read_bytes()[:8] == PNG
    far = plot(tmp_path / "run.tum", "--truth", tmp_path / "truth.tum", "--align", "none", "--out", tmp_path / "p.png").stdout
    assert float(column(far, "ATE rmse mm")[0]) > 1000
    first = plot(tmp_path / "run.tum", "--truth", tmp_path / "truth.tum", "--align", "first", "--out", tmp_path / "p.png").stdout
    assert 20 < float(column(first, "ATE rmse mm")[0]) < 400


def test_a_page_has_every_panel_for_which_there_is_something(drive, tmp_path):
    put_tum(tmp_path / "truth.tum", drive)
    put_poses(tmp_path / "a.jsonl", drive, 0.01)
    put_poses(tmp_path / "b.jsonl", drive, 0.01, state=1)
    (tmp_path / "a.csv").write_text("scan,deskew_ns,smooth_ns,extract_ns,match_ns,map_ns,total_ns\n0,1,2,3,4,5,15\n1,1000000,0,0,0,0,3000000\n")
    out = tmp_path / "p.html"
    done = plot(f"one={tmp_path}/a.jsonl,{tmp_path}/a.csv", f"other={tmp_path}/b.jsonl", "--truth", tmp_path / "truth.tum", "--out", out)
    page = out.read_text(encoding="utf-8")
    assert [name for name in ("trajectory", "error", "honesty", "covariance", "dropped", "timing") if f'<figure id="{name}"' in page] == [
        "trajectory", "error", "honesty", "covariance", "dropped", "timing"]
    assert "http" not in page.replace("http://www.w3.org", "").replace("https://matplotlib.org", "").replace("http://purl.org", "").replace(
        "http://creativecommons.org", ""), "needs nothing beside it"
    assert column(done.stdout, "weak") == ["0", "200"] and column(done.stdout, "mean ms") == ["1.500", "-"]
    plot(tmp_path / "a.csv", "--out", out)
    assert '<figure id="timing"' in out.read_text() and '<figure id="trajectory"' not in out.read_text()


def statuses(path, rows, more=()):
    """An event log of LCM: (second, {counter: value}, deadlines missed) of a robot, and other events."""
    events = list(more)
    for second, counted, misses in rows:
        status = ale.status_t()
        status.utime, status.robot, status.deadline_misses = int(second * 1e6), "rover", misses
        status.counter_name, status.counter_value = list(counted), list(counted.values())
        status.num_counters = len(counted)
        events.append((status.utime, b"ALE_STATUS", status.encode()))
    with open(path, "wb") as file:
        for number, (utime, name, data) in enumerate(sorted(events)):
            file.write(struct.pack(">IqqII", 0xEDA1DA01, number, utime, len(name), len(data)) + name + data)
    return path


COUNTED = [(0, {"bad_checksum": 5, "odometry": 0, "repeated": 1}, 0), (1, {"bad_checksum": 7, "odometry": 20, "repeated": 1}, 0),
           (2, {"bad_checksum": 1, "odometry": 3, "repeated": 0}, 0), (3, {"bad_checksum": 4, "odometry": 9, "repeated": 0}, 1)]


def test_what_the_robot_counted_is_drawn_and_told_also_of_a_log_without_scans(tmp_path):
    """It starts anew after the second status, and counts from nothing."""
    done = plot(f"drive={statuses(tmp_path / 'drive.lcm', COUNTED)}", "--out", tmp_path / "p.html")
    told = [line.split() for line in done.stdout.splitlines() if line.startswith("drive ")][1:]
    assert sorted(told) == [["drive", "bad_checksum", "6"], ["drive", "deadline_misses", "1"]]
    page = (tmp_path / "p.html").read_text(encoding="utf-8")
    assert '<figure id="counters"' in page and '<figure id="trajectory"' not in page and "counters only" in done.stderr
    quiet = plot(statuses(tmp_path / "quiet.lcm", COUNTED[:1]), "--out", tmp_path / "p.html", "--only", "counters")
    assert "counted" not in quiet.stdout and "nothing was dropped" in (tmp_path / "p.html").read_text(encoding="utf-8")


def test_a_log_with_scans_and_counters_has_both(tmp_path):
    subprocess.run([BINARIES / "ale-replay", LOG, "--lcm", tmp_path / "scans.lcm"], check=True, capture_output=True, timeout=170)
    data, at, events = (tmp_path / "scans.lcm").read_bytes(), 0, []
    while at < len(data):
        _, _, utime, name, size = struct.unpack_from(">IqqII", data, at)
        events.append((utime, data[at + 28:at + 28 + name], data[at + 28 + name:at + 28 + name + size]))
        at += 28 + name + size
    begin = events[0][0] * 1e-6
    log = statuses(tmp_path / "both.lcm", [(begin + second, counted, misses) for second, counted, misses in COUNTED], events)
    (tmp_path / "both.lcm.gz").write_bytes(gzip.compress(log.read_bytes()))
    done = plot(tmp_path / "both.lcm.gz", "--out", tmp_path / "p.html")
    page = (tmp_path / "p.html").read_text(encoding="utf-8")
    assert all(f'<figure id="{name}"' in page for name in ("trajectory", "dropped", "counters", "timing"))
    assert "bad_checksum" in done.stdout and column(done.stdout.partition("\n\n")[0], "scans") == ["120"]


def test_a_log_goes_through_ale_replay(tmp_path):
    done = plot(LOG, "--out", tmp_path / "p.png")
    assert column(done.stdout, "scans") == ["120"] and float(column(done.stdout, "mean ms")[0]) > 0
    assert (tmp_path / "p.png").stat().st_size > 20000


@pytest.mark.parametrize("words, code, part", [
    ("", 2, "which run?"), ("absent.tum", 1, "absent.tum: No such file"), ("bad.tum", 1, "bad.tum: not what its ending says"),
    ("bad.jsonl", 1, "bad.jsonl: not what its ending says"), ("bad.csv", 1, "bad.csv: not what its ending says"),
    ("empty", 1, "empty: holds none of trajectory.tum"), ("good.tum --out p.gif", 2, "must end in .png or .html"),
    ("good.tum --align left", 2, "there are all, first, none"), ("good.tum --only colour", 2, "there are trajectory"),
    ("good.tum --only timing", 1, "nothing to draw"), ("good.tum --truth late.tum", 1, "no run has a pose within"),
    ("good.tum --truth bad.tum", 1, "no trajectory"), ("good.tum --out absent/p.png", 1, "absent/p.png: No such file"),
    ("good.tum --out absent/p.html", 1, "absent/p.html: No such file"), ("bad.log", 1, "bad.log")])
def test_trouble_is_told_in_one_line(words, code, part, drive, tmp_path):
    put_tum(tmp_path / "good.tum", drive)
    put_tum(tmp_path / "late.tum", drive + [[1e4, 0, 0, 0]])
    (tmp_path / "empty").mkdir()
    for name in ("bad.tum", "bad.jsonl", "bad.csv", "bad.log"):
        (tmp_path / name).write_text("what is this\n", encoding="utf-8")
    told = plot(*words.split(), code=code, cwd=tmp_path).stderr
    assert part in told and told.count("\n") == 1, told
