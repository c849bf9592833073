"""The robot explores, for half an hour with console, Foxglove bridge and ROS 2 bridge running and looked at, and before that without:
`make soak-bridges` (40 minutes; BRIDGES_MINUTES=3 is four).

No pose may come later with them than without, and nothing may grow. To be run on a machine that does nothing else; how long the
machine itself stood still is told, and taken off.
"""
import contextlib
import json
import os
import pathlib
import subprocess
import sys
import threading
import time
from dataclasses import dataclass

import pytest

from at_hand import BINARIES, WORLDS
from chain import Chain
from lcm_url import free_lcm_url
from long_drive import descriptors, resident_bytes, threads
from standstill import Standstill
from waiting import wait_until

pytest.importorskip("cyclonedds", reason="PyPI's cyclonedds is not here")
pytest.importorskip("mcap", reason="PyPI's mcap is not here")

from foxglove_client import FoxgloveClient  # noqa: E402
from ros_peer import BEST_EFFORT, LATCHED, RELIABLE, RosPeer, free_domain  # noqa: E402
from ros_types import LaserScan, MarkerArray, OccupancyGrid, TFMessage  # noqa: E402
from web_socket import WebSocket  # noqa: E402

MINUTES = float(os.environ.get("BRIDGES_MINUTES", "30"))
ALONE_PART = 1 / 3  # of it, without bridges
LOOK_S = 60
LEAST_MINUTES = 25  # to tell that memory is flat: the page's timeline fills ten of them
SCAN_S = 0.1
GROWTH_BYTES = {"ale-slamd": 64 << 10, "ale-ros2": 1 << 20, "ale-foxglove": 1 << 20, "ale-grid": 1 << 20, "ale-console": 4 << 20}  # in its second half
PYTHON_FIRST = f"PATH={pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
FOXGLOVE_TOPICS = ("/scan", "/lines", "/corners", "/tf", "/pose", "/map", "/occupancy", "/signals")
ROS_TOPICS = {"scan": (LaserScan, BEST_EFFORT), "tf": (TFMessage, RELIABLE), "map": (OccupancyGrid, LATCHED), "ale/lines": (MarkerArray, RELIABLE)}


class Robot:
    """It explores the arena, and again from a new map whenever it has finished."""

    def __init__(self, folder):
        self.chain = Chain(folder, free_lcm_url(), channels=("ALE_STATUS",))
        self.key, listed = folder / "alice.key", folder / "robot.keys"
        subprocess.run([BINARIES / "ale-keys", "alice", "--secret", self.key, "--robot", listed], check=True, timeout=180)
        self.chain.simulator("--world", WORLDS / "arena.world", "--drive")
        self.firmware = self.chain.firmware("[lcm]\npublish_scan = yes\n[recorder]\nfolder =\n", "--keys", listed)
        self.firmware.wait_until(lambda: self.chain.listener.statuses and self.chain.listener.statuses[-1].scans > 20, "scans")
        self.explorations = 0

    @property
    def status(self):
        return self.chain.listener.statuses[-1]

    def _send(self, *words):
        subprocess.run([BINARIES / "ale-send", "--keys", self.key, "--lcm-url", self.chain.url, *words], check=True, timeout=180,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)

    def explore(self, seconds, look):
        """look() every minute."""
        end, next_look = time.monotonic() + seconds, time.monotonic() + LOOK_S
        while time.monotonic() < end:
            assert self.firmware.running(), self.firmware.err()
            if self.status.exploration.startswith("finished") or self.explorations == 0:
                self._send("reset")
                self._send("explore", "on")
                self.explorations += 1
                wait_until(lambda: not self.status.exploration.startswith("finished"), 60, "the exploration")
            if time.monotonic() >= next_look:
                next_look += LOOK_S
                look()
            time.sleep(0.5)


class Child:
    """A program that another one has started."""

    def __init__(self, parent, name):
        self.parent = parent
        self.process = self
        children = {int(child) for tasks in pathlib.Path("/proc", str(parent.process.pid), "task").glob("*/children")
                    for child in tasks.read_text(encoding="ascii").split()}
        self.pid, = (child for child in children if pathlib.Path("/proc", str(child), "comm").read_text(encoding="ascii").strip() == name)

    def running(self):
        return self.parent.running() and pathlib.Path("/proc", str(self.pid), "exe").exists()


class Onlooker(threading.Thread):
    """Takes what a program sends, for as long as it lasts."""

    def __init__(self, take):
        super().__init__(daemon=True)
        self.take, self.taken, self.stopping, self.error = take, 0, threading.Event(), None

    def run(self):
        try:
            while not self.stopping.is_set():
                self.taken += self.take()
        except (OSError, AssertionError) as error:
            self.error = error

    def stop(self):
        self.stopping.set()
        self.join(timeout=30)


def one_message(socket):
    socket.next_bytes()
    socket.send(json.dumps({"type": "got", "count": socket.received}))
    return 1


def foxglove_message(client):
    client.wait_for("/scan")
    return 1


def ros_messages(readers):
    for reader in readers:
        reader.poll()
    taken = sum(len(reader.messages) for reader in readers)
    for reader in readers:
        reader.messages.clear()
    time.sleep(0.02)
    return taken


@contextlib.contextmanager
def bridges(robot):
    """The three programs, each with somebody who looks on: {name: program}, [onlookers]."""
    chain, domain = robot.chain, free_domain()
    console = chain.start("ale-console", "--lcm-url", chain.url, "--http", "127.0.0.1:0", "--keys", robot.key,
                          "--recordings", chain.folder / "recordings")
    foxglove = chain.start("ale-foxglove", "--lcm-url", chain.url, "--port", "0", "--keys", robot.key, prefix=("env", PYTHON_FIRST))
    ros2 = chain.start("ale-ros2", "--local", "--domain", str(domain), "--lcm-url", chain.url, "--keys", robot.key)
    for program in (console, foxglove):
        program.wait_until(program.out, "its address")
    page = WebSocket(console.out().strip().replace("http", "ws", 1))
    client = FoxgloveClient(foxglove.out().strip())
    for topic in FOXGLOVE_TOPICS:
        client.subscribe(topic)
    peer = RosPeer(domain)
    readers = [peer.reader(name, *how) for name, how in ROS_TOPICS.items()]
    onlookers = [Onlooker(lambda: one_message(page)), Onlooker(lambda: foxglove_message(client)), Onlooker(lambda: ros_messages(readers))]
    for onlooker in onlookers:
        onlooker.start()
    try:
        yield {"ale-slamd": robot.firmware, "ale-console": console, "ale-foxglove": foxglove, "ale-grid": Child(foxglove, "ale-grid"),
               "ale-ros2": ros2}, onlookers
    finally:
        for onlooker in onlookers:
            onlooker.stop()


@dataclass
class Latency:
    """Last byte of a scan to its pose, of one run."""
    scans: int
    median_us: int
    p99_us: int
    worst_us: int
    late: int
    stood_still_us: int

    @staticmethod
    def of(status, stills):
        return Latency(status.scans, status.latency_p50_us, status.latency_p99_us, status.latency_worst_us, status.deadline_misses,
                       int(1e6 * max(stills, default=0)))

    def __str__(self):
        return (f"{self.scans} scans, median {self.median_us / 1000:.2f} ms, p99 {self.p99_us / 1000:.2f} ms, worst "
                f"{self.worst_us / 1000:.2f} ms, {self.late} late; the machine itself stood still for up to {self.stood_still_us / 1000:.1f} ms")


def held(programs):
    return {name: (resident_bytes(each), descriptors(each), threads(each)) for name, each in programs.items()}


@contextlib.contextmanager
def robot_in(folder):
    """(the robot, how long the machine itself stood still each time, in seconds: filled in when it has ended)"""
    folder.mkdir()
    watch, stills, robot = Standstill(), [], None
    try:
        robot = Robot(folder)
        yield robot, stills
    finally:
        stills += watch.stop()
        if robot:
            robot.chain.stop()


class Soak:
    def __init__(self, folder):
        with robot_in(folder / "alone") as (robot, stills):
            robot.explore(60 * MINUTES * ALONE_PART, lambda: None)
        self.alone = Latency.of(robot.status, stills)
        print(f"without bridges: {self.alone}", flush=True)
        self.looks = []
        with robot_in(folder / "bridged") as (robot, stills), bridges(robot) as (programs, onlookers):
            robot.explore(60 * MINUTES, lambda: self._look(programs))
            self.errors = [each.error for each in onlookers if each.error]
            self.taken = [each.taken for each in onlookers]
            self.running = [name for name, each in programs.items() if each.running()]
        self.bridged = Latency.of(robot.status, stills)
        print(f"with bridges: {self.bridged}; {robot.explorations} explorations; messages to page, Foxglove, ROS 2: {self.taken}", flush=True)

    def _look(self, programs):
        self.looks.append(held(programs))
        print("; ".join(f"{name} {rss / 2 ** 20:.2f} MiB, {files} descriptors, {tasks} threads"
                        for name, (rss, files, tasks) in self.looks[-1].items()), flush=True)


@pytest.fixture(scope="module")
def soak(tmp_path_factory, multicast):
    return Soak(tmp_path_factory.mktemp("bridges"))


def test_everybody_is_served_to_the_end(soak):
    assert soak.errors == []
    assert sorted(soak.running) == sorted(GROWTH_BYTES)
    assert min(soak.taken) > 5 * 60 * MINUTES, "half of the scans at least"


def test_no_pose_comes_later_than_without_them(soak):
    assert soak.bridged.late == 0 or soak.bridged.stood_still_us > SCAN_S * 1e6
    assert soak.bridged.p99_us <= soak.alone.p99_us + soak.bridged.median_us
    assert soak.bridged.worst_us <= soak.alone.worst_us + max(soak.alone.stood_still_us, soak.bridged.stood_still_us) + soak.alone.p99_us


def test_memory_is_flat(soak):
    first, last = soak.looks[len(soak.looks) // 2], soak.looks[-1]
    for name, most in GROWTH_BYTES.items():
        assert last[name][1:] == first[name][1:], name
        assert MINUTES < LEAST_MINUTES or last[name][0] - first[name][0] <= most, name
