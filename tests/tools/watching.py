"""Fixtures for tests of the programs that watch the robot: a free LCM URL, ale-console, a pulse of scans."""
import os
import subprocess
import tempfile
import time
import urllib.request

import ale
import lcm
import pytest

from at_hand import BINARIES
from lcm_url import free_lcm_url
from recorded import RECORDED, write_map, write_recording
from robot_double import RobotDouble
from waiting import Pulse


@pytest.fixture
def lcm_url():
    return free_lcm_url()


class Console:
    """ale-console on a free port, with a token of its own."""

    def __init__(self, lcm_url, http="127.0.0.1:0", *options):
        self.state = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen([BINARIES / "ale-console", "--http", http, "--lcm-url", lcm_url, *map(str, options)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        env={**os.environ, "XDG_STATE_HOME": self.state.name})
        self.url = self.process.stdout.readline().strip()
        self.address, _, self.token = self.url.partition("?token=")

    @property
    def origin(self):
        return self.address.rstrip("/")

    def get(self, path=""):
        return urllib.request.urlopen(f"{self.address}{path}?token={self.token}", timeout=180)

    def end(self, signal_number=15):
        self.process.send_signal(signal_number)
        _, self.said = self.process.communicate(timeout=180)
        self.state.cleanup()
        return self.process.returncode


@pytest.fixture
def console(lcm_url):
    running = Console(lcm_url)
    yield running
    if running.process.poll() is None:
        assert running.end() == 0


@pytest.fixture
def alice(lcm_url, tmp_path):
    """A console with the key of an operator, a recording and a saved map."""
    subprocess.run([BINARIES / "ale-keys", "alice"], cwd=tmp_path, check=True, capture_output=True, timeout=180)
    write_recording(tmp_path / f"recordings/{RECORDED}.lcm")
    write_map(tmp_path / "maps/flat.map")
    running = Console(lcm_url, "127.0.0.1:0", "--keys", str(tmp_path / "alice.key"), "--recordings", tmp_path / "recordings", "--maps", tmp_path / "maps")
    yield running
    assert running.end() == 0


@pytest.fixture
def commands(lcm_url):
    """Commands as they pass on LCM: waits for so many, or until they meet a condition."""
    heard, bus = [], lcm.LCM(lcm_url)
    bus.subscribe("ALE_COMMAND", lambda _, data: heard.append(ale.command_t.decode(data))).set_queue_capacity(0)

    def wait(wanted, seconds=180):
        end = time.monotonic() + seconds
        while not (wanted(heard) if callable(wanted) else len(heard) >= wanted) and time.monotonic() < end:
            bus.handle_timeout(50)
        return heard
    return wait


@pytest.fixture
def robot(lcm_url, tmp_path):
    """It vouches once there is a key: in tests with `alice`."""
    return RobotDouble(lcm_url, own_key=tmp_path / "robot.keys.secret")


@pytest.fixture
def pulse(robot):
    """Ten scans a second from the robot double."""
    beating = Pulse(0.1, robot.step)
    yield beating
    beating.stop()
