"""ale-latency: the times that the poses carry, added up live and from a log."""
import statistics
import subprocess

import ale
import lcm
import pytest

from robot_double import RobotDouble
from at_hand import BINARIES
from watching import lcm_url, robot  # noqa: F401 (fixtures)

SPANS = ["sweep", "wait", "deskew", "smooth", "extract", "match", "map", "send", "in all"]
STAGES = SPANS[2:7]


def run_latency(*arguments):
    return subprocess.run([BINARIES / "ale-latency", *map(str, arguments)], capture_output=True, text=True, timeout=180,
                          check=False)


def made_pose(scan, predicted=False):
    """A pose whose times are known: microseconds grow with the scan."""
    pose = ale.pose_t()
    pose.utime, pose.scan, pose.predicted = 10**12 + scan * 100000, scan, predicted
    pose.first_beam_utime = pose.utime - 30000
    pose.arrival_utime = pose.first_beam_utime + 70000
    pose.age_us = 40000 + 900 + scan
    if not predicted:
        ends = [0, 50000, 60000, 160000, 260000 + 1000 * scan, 300000 + 1000 * scan]
        pose.stage_start_ns = [ends[0] + 20000, *(end + 20000 for end in ends[1:5])]
        pose.stage_end_ns = [end + 20000 for end in ends[1:]]
        pose.stage_ns = [end - start for start, end in zip(pose.stage_start_ns, pose.stage_end_ns)]
    return pose


def write_log(path, messages):
    log = lcm.EventLog(str(path), "w", overwrite=True)
    for utime, channel, data in messages:
        log.write_event(utime, channel, data)
    log.close()


def table(text):
    """Rows of the quantiles: name -> (scans, median, p99, worst, scan of the worst)."""
    lines = text.splitlines()
    rows = lines[2:lines.index("")]
    return {row[:12].strip(): tuple(float(word) for word in row[12:].split()) for row in rows}


def histogram(text):
    lines = text.splitlines()
    rows = [line.split() for line in lines[lines.index("") + 2:]]
    return {float(row[0]): [0 if word == "." else int(word) for word in row[1:]] for row in rows}


def test_a_log_gives_every_span_with_its_quantiles_and_the_scan_of_the_worst(tmp_path):
    poses = [made_pose(scan) for scan in range(100)] + [made_pose(100, predicted=True)]
    write_log(tmp_path / "run.lcm", [(pose.utime, "ALE_POSE", pose.encode()) for pose in poses])
    done = run_latency(tmp_path / "run.lcm")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("poses 101, of them predicted 1\n")
    rows = table(done.stdout)
    assert list(rows) == SPANS
    measured = [pose for pose in poses if not pose.predicted]
    expected = {"sweep": [70000.0] * 100, "wait": [20.0] * 100,
                "send": [pose.age_us - 40000 - pose.stage_end_ns[4] / 1000 for pose in measured],
                "in all": [pose.age_us - 40000 for pose in poses],
                **{stage: [pose.stage_ns[k] / 1000 for pose in measured] for k, stage in enumerate(STAGES)}}
    for span, values in expected.items():
        count, median, p99, worst, scan = rows[span]
        assert count == len(values)
        assert worst == pytest.approx(max(values), abs=0.06)
        assert values[int(scan)] == max(values)
        assert statistics.median_low(values) - 0.1 <= median <= statistics.median_low(values) * 1.125 + 0.1
        assert median <= p99 <= worst
    counted = histogram(done.stdout)
    for k, span in enumerate(SPANS):
        assert sum(row[k] for row in counted.values()) == len(expected[span])
        for bound, row in counted.items():
            least = bound / 2 if bound > 1.1 else 0
            assert row[k] == sum(least <= value < bound for value in expected[span]), (span, bound)


def test_what_makes_no_sense_is_left_out_and_counted(tmp_path):
    backwards, strange = made_pose(1), made_pose(2)
    backwards.stage_end_ns[2] = 0
    strange.arrival_utime = strange.first_beam_utime - 1
    messages = [made_pose(0).encode(), backwards.encode(), strange.encode(), made_pose(3).encode()[:60]]
    write_log(tmp_path / "run.lcm", [(1, "ALE_POSE", data) for data in messages])
    done = run_latency(tmp_path / "run.lcm")
    assert done.returncode == 0
    assert done.stdout.startswith("poses 1,")
    assert "3 messages on ALE_POSE made no sense" in done.stderr


def test_it_listens_to_a_robot_until_it_has_what_was_asked_for(lcm_url):  # noqa: F811
    listening = subprocess.Popen([BINARIES / "ale-latency", "--lcm-url", lcm_url, "--poses", "12"],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert "listening" in listening.stderr.readline()
    RobotDouble(lcm_url).drive(12)
    out, _ = listening.communicate(timeout=180)
    assert listening.returncode == 0
    assert out.startswith("poses 12,")
    assert table(out)["match"][1:4] == pytest.approx((310, 310, 310))


@pytest.mark.parametrize("arguments", [["--poses", "0"], ["--seconds", "x"], ["--unknown"], ["a", "b"],
                                       ["log", "--seconds", "1"]])
def test_wrong_use_is_told_in_one_line_and_ends_with_2(arguments):
    done = run_latency(*arguments)
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1 and done.stdout == ""


@pytest.mark.parametrize("content", [None, b"", b"no event log"])
def test_a_log_without_poses_is_told_and_ends_with_1(tmp_path, content):
    path = tmp_path / "run.lcm"
    if content is not None:
        path.write_bytes(content)
    done = run_latency(path)
    assert done.returncode == 1
    assert str(path) in done.stderr and len(done.stderr.strip().splitlines()) == 1
