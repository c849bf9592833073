"""ale-watch: what it says each second and what it leaves behind, fed by a robot double."""
import csv
import math
import re
import signal
import subprocess
import time
import xml.etree.ElementTree as ElementTree

import ale
import pytest

from robot_double import WALLS
from at_hand import BINARIES
from watching import lcm_url, robot  # noqa: F401 (fixtures)

SCANS = 25


def run_watch(*arguments):
    return subprocess.run([BINARIES / "ale-watch", *map(str, arguments)], capture_output=True, text=True, timeout=180,
                          check=False)


class Watch:
    """ale-watch, listening."""

    def __init__(self, lcm_url, *arguments):
        self.process = subprocess.Popen([BINARIES / "ale-watch", "--lcm-url", lcm_url, *map(str, arguments)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.messages = self.process.stderr.readline()

    def lines_until(self, pattern):
        """What it says each second, to the first line that has it."""
        lines, end = [], time.monotonic() + 180
        for line in self.process.stdout:
            lines.append(line.rstrip("\n"))
            if re.search(pattern, line):
                return lines
            if time.monotonic() > end:
                break
        raise AssertionError(f"no {pattern} in {lines}")

    def end(self, number=None):
        if number:
            self.process.send_signal(number)
        out, err = self.process.communicate(timeout=180)
        return self.process.returncode, out.splitlines(), err


@pytest.mark.parametrize("arguments", [["--map", "picture.jpeg"], ["--seconds", "soon"], ["--seconds", "-1"],
                                       ["--until-silent", "0"], ["--seconds", "nan"], ["--unknown"], ["word"]])
def test_wrong_use_is_told_in_one_line_and_ends_with_2(arguments):
    done = run_watch(*arguments)
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1 and done.stdout == ""


def test_without_a_robot_it_says_so_and_fails(lcm_url, tmp_path):
    done = run_watch("--lcm-url", lcm_url, "--seconds", 0.2, "--trajectory", tmp_path / "t.tum")
    assert done.returncode == 1
    assert "no pose came" in done.stderr
    assert not (tmp_path / "t.tum").exists()


def test_everything_that_came_is_in_the_files(lcm_url, robot, tmp_path):
    names = ["map.png", "map.svg", "t.tum", "p.csv"]
    files = {name: tmp_path / name for name in names}
    watch = Watch(lcm_url, "--map", files["map.png"], "--map", files["map.svg"],
                  "--trajectory", files["t.tum"], "--csv", files["p.csv"])
    robot.drive(SCANS)
    last = watch.lines_until("poses +25 ")[-1]
    code, lines, err = watch.end(signal.SIGINT)
    assert code == 0, err
    assert re.match(r" +\d+ s  poses +25  .*  x .* lines  5 corners  3  map  12  worst match 0\.31 ms  dropped 0  "
                    r"latency 1\.40 ms", last)
    assert lines[-1].startswith("25 poses, 0 missing, 0 predicted; good 25, weak 0, lost 0; 0 malformed")

    assert files["map.png"].read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse(files["map.svg"]).getroot().tag.endswith("svg")
    check_trajectory(files["t.tum"], robot)
    rows = list(csv.DictReader(files["p.csv"].open()))
    assert [int(row["scan"]) for row in rows] == list(range(SCANS))
    assert all(row["lines"] == "5" and row["corners"] == "3" and row["state"] == "2" for row in rows)
    assert {int(row["latency_us"]) for row in rows} == {1400}


def check_trajectory(path, robot):
    poses = [list(map(float, line.split())) for line in path.read_text().splitlines()]
    assert len(poses) == SCANS
    for scan, (_, x, y, z, qx, qy, qz, qw) in enumerate(poses):
        robot.scan = scan
        assert (x, y, z, qx, qy) == pytest.approx((*robot.where[:2], 0, 0, 0), abs=2e-6)
        assert 2 * math.atan2(qz, qw) == pytest.approx(robot.where[2], abs=1e-6)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_its_files_written(lcm_url, robot, tmp_path, number):
    path = tmp_path / "t.tum"
    watch = Watch(lcm_url, "--trajectory", path)
    robot.drive(5)
    watch.lines_until("poses +5 ")
    code, _, err = watch.end(number)
    assert code == 0, err
    assert len(path.read_text().splitlines()) == 5


@pytest.mark.parametrize("option, name", [("--trajectory", "t.tum"), ("--csv", "t.csv"), ("--map", "m.png")])
def test_a_file_that_cannot_be_written_is_named_before_anything_is_waited_for(lcm_url, tmp_path, option, name):
    path = tmp_path / "absent" / name
    watch = Watch(lcm_url, option, path)
    code, lines, _ = watch.end()
    assert code == 1 and str(path) in watch.messages and lines == []


def test_missing_and_predicted_poses_are_counted(lcm_url, robot):
    watch = Watch(lcm_url, "--until-silent", 1.2)
    for scan in (0, 1, 4, 5):  # 2 and 3 are lost on the way
        robot.scan = scan
        pose = robot.pose()
        pose.predicted, pose.state = scan == 5, 2 if scan < 5 else 0
        robot.bus.publish("ALE_POSE", pose.encode())
    code, lines, _ = watch.end()
    assert code == 0
    assert "LOST" in lines[0] and "dropped 3" in lines[0]
    assert lines[-1].startswith("4 poses, 2 missing, 1 predicted; good 3, weak 0, lost 1")


def test_silence_is_said(lcm_url, robot):
    watch = Watch(lcm_url, "--seconds", 60)
    robot.drive(1)
    watch.lines_until("SILENT for [2-9] s")
    assert watch.end(signal.SIGINT)[0] == 0


def test_hostile_messages_are_counted_and_leave_no_trace(lcm_url, robot, tmp_path):
    path = tmp_path / "t.tum"
    watch = Watch(lcm_url, "--until-silent", 1.5, "--trajectory", path)
    robot.publish_pose()
    robot.bus.publish("ALE_POSE", b"nonsense")
    bad = robot.pose()
    bad.map_x = float("inf")
    robot.bus.publish("ALE_POSE", bad.encode())
    scan = ale.scan_t()
    scan.codes, scan.num_codes, scan.num_ranges, scan.range_mm = b"\0", 1, 2, [1, 2]
    robot.bus.publish("ALE_SCAN", scan.encode())
    code, lines, err = watch.end()
    assert code == 0, err
    assert lines[-1].endswith("3 malformed messages")
    assert len(path.read_text().splitlines()) == 1


def test_the_walls_of_the_map_are_in_the_picture(lcm_url, robot, tmp_path):
    path = tmp_path / "map.dxf"
    watch = Watch(lcm_url, "--until-silent", 0.5, "--map", path)
    robot.drive(3)
    assert watch.end()[0] == 0
    assert path.read_text().count("WALLS") >= len(WALLS)


def test_a_map_that_is_not_joined_is_said_and_another_colour_in_the_picture(lcm_url, robot, tmp_path):
    path = tmp_path / "map.svg"
    watch = Watch(lcm_url, "--map", path)
    robot.map_id, robot.maps, robot.wheels = 1, 2, "late"
    robot.publish_pieces([5, 6, 7])
    robot.drive(3)
    watch.lines_until("new map, not joined yet  wheels: late")
    assert watch.end(signal.SIGTERM)[0] == 0
    groups = {group.get("id"): len(group) for group in ElementTree.parse(path).getroot() if group.get("id")}
    assert groups["apart"] == 3 and groups["walls"] == len(WALLS) - 3
    assert ">not joined<" in path.read_text()
