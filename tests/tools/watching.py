"""Fixtures for tests of the programs that watch the robot: a free LCM URL, ale-console, a pulse of scans."""
import os
import pathlib
import random
import socket
import subprocess
import threading
import urllib.request

import pytest

from robot_double import RobotDouble

BINARIES = pathlib.Path(os.environ.get("ALE_BUILD", "build")) / "bin"


def free_lcm_url():
    while True:
        port = random.randint(20000, 60000)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("", port))
            except OSError:
                continue
            return f"udpm://239.255.76.67:{port}?ttl=0"


@pytest.fixture
def lcm_url():
    return free_lcm_url()


class Console:
    """ale-console on a free port."""

    def __init__(self, lcm_url, http="127.0.0.1:0"):
        self.process = subprocess.Popen([BINARIES / "ale-console", "--http", http, "--lcm-url", lcm_url],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()

    def get(self, path=""):
        return urllib.request.urlopen(self.url + path, timeout=10)

    def end(self, signal_number=15):
        self.process.send_signal(signal_number)
        self.process.communicate(timeout=10)
        return self.process.returncode


@pytest.fixture
def console(lcm_url):
    running = Console(lcm_url)
    yield running
    if running.process.poll() is None:
        assert running.end() == 0


@pytest.fixture
def robot(lcm_url):
    return RobotDouble(lcm_url)


class Pulse:
    """Ten scans a second from the robot double until it is stopped."""

    def __init__(self, robot):
        self.robot = robot
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._beat)
        self.thread.start()

    def _beat(self):
        while not self.stopping.wait(0.1):
            self.robot.step()

    def stop(self):
        self.stopping.set()
        self.thread.join()


@pytest.fixture
def pulse(robot):
    beating = Pulse(robot)
    yield beating
    beating.stop()
