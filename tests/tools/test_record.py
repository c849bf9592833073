"""ale-record on a pseudo terminal: what the sensor sends is recorded, through every fault of the line."""
import json
import os
import signal
import statistics
import subprocess

import pytest

from at_hand import BINARIES
from lcm_url import free_lcm_url
from priority import as_hardware
from waiting import wait_until

ROOM = "-1 -2 3 -2\n3 -2 3 1\n3 1 -1 1\n-1 1 -1 -2\n"
SPEED = 4
TURN_S = 0.1


def counts(text):
    return {name: int(value) for name, value in (line.split() for line in text.splitlines())}


class Bench:
    """A simulated sensor and the recorder on it."""

    def __init__(self, folder):
        self.folder = folder
        self.link = folder / "urg"
        self.out = folder / "drive.scip"
        self.programs = []
        (folder / "room.world").write_text(ROOM, encoding="utf-8")

    def program(self, name, *words, prepare=None):
        process = subprocess.Popen([BINARIES / name, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   preexec_fn=prepare)
        self.programs.append(process)
        return process

    def sensor(self, *words):
        process = self.program("ale-sim", "--world", self.folder / "room.world", "--pty", self.link, "--speed", SPEED, *words,
                               prepare=as_hardware)
        wait_until(lambda: self.link.exists() or process.poll() is not None, 180, "the pseudo terminal")
        assert process.poll() is None, process.stderr.read()
        return process

    def recorder(self, *words):
        return self.program("ale-record", "--port", self.link, "--out", self.out, "--time-scale", SPEED, *words,
                            prepare=as_hardware)  # not held up for as long as it takes the sensor to drop a scan

    def poses(self):
        poses = self.folder / "poses.jsonl"
        subprocess.run([BINARIES / "ale-replay", self.out, "--poses", poses], check=True, capture_output=True, timeout=180)
        return [json.loads(line) for line in poses.read_text(encoding="utf-8").splitlines()]


@pytest.fixture
def bench(tmp_path):
    made = Bench(tmp_path)
    yield made
    for process in made.programs:
        process.kill()
        process.communicate()


def finished(process, code=0):
    out, err = process.communicate(timeout=180)
    assert process.returncode == code, err
    return out


def stopped(process):
    process.send_signal(signal.SIGTERM)
    return counts(finished(process))


def turns(times):
    """Scans that the sensor made from the first to the last one recorded. What it sent after that, while the recorder
    was already leaving, is nobody's. By medians: on a busy machine some scans come late before the clocks agree."""
    ahead = [time - k * TURN_S for k, time in enumerate(times)]
    missing = (statistics.median(ahead[-15:]) - statistics.median(ahead[:15])) / TURN_S
    return len(times) + round(missing)


def test_every_scan_that_the_sensor_sent_is_in_the_recording(bench):
    sensor = bench.sensor("--no-odometry")
    recorded = counts(finished(bench.recorder("--no-lcm", "--seconds", 2)))
    assert recorded["scans"] > 50
    assert recorded["lost"] == 0
    assert stopped(sensor)["sent"] >= recorded["scans"]
    times = [pose["t"] for pose in bench.poses()]
    assert len(times) == recorded["scans"] == turns(times)


def test_signal_ends_the_recording_cleanly_and_leaves_the_sensor_quiet(bench):
    sensor = bench.sensor("--no-odometry")
    recorder = bench.recorder("--no-lcm")
    wait_until(lambda: bench.out.exists() and bench.out.stat().st_size >= 50000, 180, "50 kB")
    recorder.send_signal(signal.SIGINT)
    recorded = counts(finished(recorder))
    before = bench.out.stat().st_size
    assert recorded["bytes"] <= before
    sent = stopped(sensor)["sent"]
    still_leaving_s = 1
    assert sent - recorded["scans"] <= still_leaving_s * SPEED / TURN_S, "nothing is measured for nobody"


# Fault, most scans that it may cost, longest time without a scan in seconds of the sensor.
FAULTS = [("flip", 1, 0.25), ("cut", 1, 0.25), ("garbage:300", 1, 0.25), ("repeat", 0, 0.15), ("silence:2", 0, 5.0),
          ("unplug:2", 0, 5.0), ("reset11", 0, 3.0), ("hardware:55", 0, 3.0), ("wrap", 0, 0.15)]


@pytest.mark.parametrize("fault, cost, longest_s", FAULTS, ids=[fault for fault, _, _ in FAULTS])
def test_sensor_is_heard_again_within_three_seconds_after(bench, fault, cost, longest_s):
    sensor = bench.sensor("--no-odometry", "--faults", f"{fault}@2")
    recorded = counts(finished(bench.recorder("--no-lcm", "--seconds", 2)))
    sent = stopped(sensor)["sent"]
    assert recorded["lost"] <= cost
    assert recorded["scans"] + recorded["lost"] <= sent
    times = [pose["t"] for pose in bench.poses()]
    gaps = [after - before for before, after in zip(times, times[1:])]
    if longest_s < 1:
        assert turns(times) - recorded["scans"] <= cost
    assert max(gaps) < longest_s
    assert times[-1] - times[0] > 6, "it went on to the end"


def test_odometry_is_recorded_in_the_time_of_the_scans(bench, multicast):
    url = free_lcm_url()
    bench.sensor("--lcm-url", url)
    recorded = counts(finished(bench.recorder("--lcm-url", url, "--seconds", 1)))
    assert recorded["odometry"] > recorded["scans"] / 2
    done = subprocess.run([BINARIES / "ale-replay", bench.out, "--poses", bench.folder / "with.jsonl"], check=True,
                          capture_output=True, text=True, timeout=180)
    assert "scans" in done.stderr


def test_sensor_that_never_comes_is_named_and_fails(bench):
    recorder = bench.recorder("--no-lcm", "--seconds", 1)
    out, err = recorder.communicate(timeout=180)
    assert recorder.returncode == 1
    assert counts(out)["scans"] == 0
    assert str(bench.link)[:50] in err and "no such serial device" in err


def test_recording_that_cannot_be_written_fails_at_once(bench):
    recorder = bench.program("ale-record", "--port", bench.link, "--no-lcm", "--out", bench.folder / "no" / "where.scip")
    assert "No such file or directory" in finished_with_error(recorder, 1)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_full_disk_ends_the_recording(bench):
    bench.sensor("--no-odometry")
    recorder = bench.program("ale-record", "--port", bench.link, "--no-lcm", "--out", "/dev/full", "--time-scale", SPEED)
    assert "No space left" in finished_with_error(recorder, 1)


def finished_with_error(process, code):
    _, err = process.communicate(timeout=180)
    assert process.returncode == code, err
    return err


@pytest.mark.parametrize("words", [(), ("--port", "x"), ("--out", "y"), ("--port", "x", "--out", "y", "--seconds", "0"),
                                   ("--port", "x", "--out", "y", "--seconds", "soon"), ("--nonsense",),
                                   ("--port", "x", "--out", "y", "extra"),
                                   ("--port", "x", "--out", "y", "--time-scale", "1000"),
                                   ("--port", "x", "--out", "y", "--lcm-url", "u", "--no-lcm")])
def test_wrong_use_is_told_in_a_line(words):
    done = subprocess.run([BINARIES / "ale-record", *words], capture_output=True, text=True, timeout=180, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith(("ale-record: ", str(BINARIES))) and done.stderr.count("\n") == 1


@pytest.mark.parametrize("family, sensor", [("ldrobot", "ld06"), ("rplidar", "rplidar-a1")])
def test_a_scanner_of_a_whole_turn_is_recorded_and_replays(bench, family, sensor):
    bench.sensor("--sensor", sensor)
    recorder = bench.recorder("--no-lcm", "--type", family)
    wait_until(lambda: bench.out.exists() and bench.out.stat().st_size > 60000, 180, "scans")
    told = stopped(recorder)
    poses = bench.poses()
    assert len(poses) == told["scans"] + told["lost"] > 20
    assert max(abs(pose["map_x"]) + abs(pose["map_y"]) for pose in poses) < 0.05


def test_a_family_that_is_none_is_told_those_that_are(bench):
    process = bench.recorder("--no-lcm", "--type", "sick")
    _, err = process.communicate(timeout=180)
    assert process.returncode == 2
    assert err.strip() == "ale-record: --type sick: there are urg, ldrobot, rplidar, auto (see --help)"
