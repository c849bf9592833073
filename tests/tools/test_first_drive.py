"""ale-calibrate wheels --live: a first drive is watched, and what is wrong with its odometry is said."""
import math
import subprocess
import threading
import time

import ale
import lcm
import pytest

from at_hand import BINARIES, WORLDS
from lcm_url import free_lcm_url
from waiting import wait_until

PERIOD_S = 0.05
FASTER = 3  # than a robot that drives carefully


class Robot:
    """Drives by itself: ahead, to the left, ahead; says where it is and what its wheels count."""

    def __init__(self, url, spoil):
        self.bus = lcm.LCM(url)
        self.spoil = spoil
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._drive)
        self.thread.start()

    def _drive(self):
        x = y = theta = 0.0
        begin = before = time.monotonic()
        beats = 0
        while not self.stopping.wait(PERIOD_S):
            now = time.monotonic()
            phase = (now - begin) * FASTER % 12
            speed, turn = (0.2, 0) if phase < 4 or 7 <= phase < 11 else (0, 0.5) if phase < 7 else (0, 0)
            step, before = (now - before) * FASTER, now
            x, y, theta = x + step * speed * math.cos(theta), y + step * speed * math.sin(theta), theta + step * turn
            beats += 1
            self.bus.publish("ALE_ODOMETRY", self._odometry(x, y, theta))
            if beats % 2:
                pose = ale.pose_t()
                pose.utime, pose.x, pose.y, pose.theta, pose.state = time.time_ns() // 1000, x, y, math.remainder(theta, 2 * math.pi), 2
                self.bus.publish("ALE_POSE", pose.encode())

    def _odometry(self, x, y, theta):
        sample = ale.odometry_t()
        sample.utime = time.time_ns() // 1000
        sample.x, sample.y, sample.theta = self.spoil(x, y, math.remainder(theta, 2 * math.pi))
        return sample.encode()

    def stop(self):
        self.stopping.set()
        self.thread.join()


def checked(url, *words):
    return subprocess.run([BINARIES / "ale-calibrate", "wheels", "--live", "--lcm-url", url, *words], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=180, check=False)


@pytest.fixture(name="drive")
def a_robot_that_drives():
    robots = []

    def check(spoil):
        url = free_lcm_url()
        robots.append(Robot(url, spoil))
        return checked(url)

    yield check
    for robot in robots:
        robot.stop()


def words_of(done):
    return {line.split()[1]: line for line in done.stdout.splitlines()}


def test_odometry_as_it_should_be_is_fine(drive):
    done = drive(lambda x, y, theta: (x, y, theta))
    assert done.returncode == 0, done.stdout + done.stderr
    assert [line.split()[:2] for line in done.stdout.splitlines()] == [["fine", subject] for subject in ("way", "turns", "axes", "time")]
    assert "Drive slowly" in done.stderr


def test_millimetres_degrees_and_exchanged_wheels_are_said(drive):
    done = drive(lambda x, y, theta: (1000 * x, -1000 * y, -math.degrees(theta)))
    assert done.returncode == 1
    said = words_of(done)
    assert said["way"].startswith("WRONG way      x and y are in millimetres")
    assert said["turns"].startswith("WRONG turns    theta is in degrees") and "left and right wheel exchanged" in said["turns"]
    assert said["axes"].startswith("fine") and said["time"].startswith("fine")


def test_no_robot_and_a_recording_beside_it_are_refused(tmp_path):
    silent = checked(free_lcm_url(), "--seconds", "1")
    assert silent.returncode == 1 and "ale-calibrate: no robot is heard" in silent.stderr and silent.stdout == ""
    for words in (("noise", "--live"), ("wheels", "some.log", "--live"), ("wheels", "--live", "--out", "robot.ini")):
        refused = subprocess.run([BINARIES / "ale-calibrate", *words], capture_output=True, text=True, check=False, cwd=tmp_path)
        assert (refused.returncode, refused.stderr.count("\n")) == (2, 1), refused.stderr


def test_the_robot_of_the_simulator_passes(tmp_path):
    """The real firmware, told by scans and wheels alike."""
    url, port = free_lcm_url(), tmp_path / "urg"
    (tmp_path / "robot.ini").write_text("")
    simulator = subprocess.Popen([BINARIES / "ale-sim", "--world", WORLDS / "home.world", "--pty", port, "--lcm-url", url],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    firmware = None
    try:
        wait_until(port.exists, 180, "the scanner")
        firmware = subprocess.Popen([BINARIES / "ale-slamd", "--config", tmp_path / "robot.ini", "--port", port, "--lcm-url", url],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        done = checked(url)
        assert done.returncode == 0, done.stdout + done.stderr
    finally:
        for process in filter(None, (firmware, simulator)):
            process.terminate()
            process.wait()
