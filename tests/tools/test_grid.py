"""ale-grid: what it makes of a log of LCM on its standard input."""
import json
import subprocess

import ale
import pytest

import robot_double
from at_hand import BINARIES
from recorded import RECORDED, write_recording


@pytest.fixture
def drive(tmp_path, monkeypatch):
    """Four seconds of a robot in two rooms, by the robot's clock."""
    def goes_by_the_log(robot):
        now_ns = robot.bus.now_us * 1000
        monkeypatch.setattr(robot_double.time, "time_ns", lambda: now_ns)
    write_recording(tmp_path / f"{RECORDED}.lcm", scans=40, change=goes_by_the_log)
    return (tmp_path / f"{RECORDED}.lcm").read_bytes()


def grid(events, *words):
    return subprocess.run([BINARIES / "ale-grid", *words], input=events, capture_output=True, timeout=180, check=False)


def grids(out):
    """[(head, cells)]"""
    found = []
    while out:
        line, _, out = out.partition(b"\n")
        head = json.loads(line)
        count = head["columns"] * head["rows"]
        assert len(out) >= count
        found.append((head, out[:count]))
        out = out[count:]
    return found


def test_a_drive_becomes_grids_of_walls_and_of_what_is_free(drive):
    done = grid(drive, "--every", "1")
    assert (done.returncode, done.stderr) == (0, b"")
    found = grids(done.stdout)
    assert 4 <= len(found) <= 5, "one a second, and one in the end"
    assert [head["utime"] for head, _ in found] == sorted({head["utime"] for head, _ in found})
    head, cells = found[-1]
    assert head["cell"] == 0.05 and head["x"] < -2 and head["y"] < -1.6
    assert head["columns"] >= 8 / 0.05 and head["rows"] >= 3.6 / 0.05
    assert set(cells) == {0, 100, 255} and cells.count(0) > cells.count(100) > 300
    assert grids(grid(drive, "--every", "3600").stdout)[-1] == found[-1], "the last is always written"


def test_without_messages_there_is_no_grid():
    done = grid(b"")
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def test_a_log_that_is_cut_gives_what_is_there(drive):
    done = grid(drive[:len(drive) // 2])
    assert done.returncode == 0 and grids(done.stdout)


def test_what_is_no_log_is_one_line_and_a_failure(drive):
    for junk in (b"\n" * 28, drive[:5000] + b"junk" * 20000):
        done = grid(junk)
        assert (done.returncode, done.stderr) == (1, b"ale-grid: standard input: no event of LCM\n")


def test_messages_that_make_no_sense_are_counted_and_left_out(drive):
    pose = ale.pose_t()
    pose.utime = -1
    out_of_time = pose.encode()
    events = drive
    for channel, data in ((b"ALE_POSE", b"junk"), (b"ALE_POSE", out_of_time), (b"OTHER", b"junk")):
        events += bytes.fromhex("EDA1DA01") + bytes(16) + len(channel).to_bytes(4, "big") + len(data).to_bytes(4, "big") + channel + data
    done = grid(events)
    assert (done.returncode, done.stderr) == (0, b"ale-grid: 2 messages were malformed\n")
    assert grids(done.stdout) == grids(grid(drive).stdout)


@pytest.mark.parametrize("words", [["--every", "0"], ["--every", "nan"], ["file"]])
def test_wrong_use_is_one_line(words):
    done = grid(b"", *words)
    assert done.returncode == 2 and done.stderr.count(b"\n") == 1 and done.stdout == b""
