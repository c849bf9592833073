"""ale-bridge: two LCM ports that do not hear each other, and a unicast link between them, good and bad."""
import random
import socket
import subprocess
import threading
import time

import ale
import pytest

from at_hand import BINARIES, free_udp_port
from lcm_url import free_lcm_url
from waiting import Ear, wait_until


class Side(Ear):
    """One LCM port: publishes, and keeps what it hears."""

    def __init__(self):
        self.url = free_lcm_url()
        self.heard = []
        super().__init__(self.url, [".*"], lambda channel, data: self.heard.append((channel, data)))

    def on(self, channel):
        return [data for name, data in list(self.heard) if name == channel]


class BadLink(threading.Thread):
    """A stretch of air: loses a part of the datagrams, doubles some, and lets some overtake others."""

    def __init__(self, to_port):
        super().__init__()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.05)
        self.port = self.socket.getsockname()[1]
        self.robot = ("127.0.0.1", to_port)
        self.client = None
        self.held = None
        self.random = random.Random(5)
        self.stopping = threading.Event()
        self.start()

    def pass_on(self, data, to):
        chance = self.random.random()
        if chance < 0.1:
            return
        if chance < 0.2 and self.held is None:
            self.held = (data, to)
            return
        self.socket.sendto(data, to)
        if chance > 0.9:
            self.socket.sendto(data, to)
        if self.held is not None:
            self.socket.sendto(*self.held)
            self.held = None

    def run(self):
        while not self.stopping.is_set():
            try:
                data, sender = self.socket.recvfrom(65536)
            except socket.timeout:
                continue
            if sender == self.robot:
                self.pass_on(data, self.client)
            else:
                self.client = sender
                self.pass_on(data, self.robot)

    def stop(self):
        self.stopping.set()
        self.join()
        self.socket.close()


def start(*words):
    return subprocess.Popen([BINARIES / "ale-bridge", *map(str, words)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


def end(process):
    """What it has counted."""
    process.terminate()
    out, err = process.communicate(timeout=180)
    assert process.returncode == 0, err
    return {name: int(number) for name, number in (line.split() for line in out.splitlines())}


@pytest.fixture
def sides():
    both = Side(), Side()
    yield both
    for side in both:
        side.stop()


@pytest.fixture
def ends(sides):
    """Both ends of a good link, which have found each other."""
    port = free_udp_port()
    robot = start("--listen", f"127.0.0.1:{port}", "--lcm-url", sides[0].url)
    operator = start("--connect", f"127.0.0.1:{port}", "--lcm-url", sides[1].url)
    assert "is there" in operator.stderr.readline()
    assert "is there" in robot.stderr.readline()
    yield robot, operator
    for process in (robot, operator):
        process.kill()
        process.communicate()


def pose(k):
    message = ale.pose_t()
    message.scan = k
    return message.encode()


def test_poses_cross_whole_and_in_order_and_scans_thinned(sides, ends):
    robot, operator = sides
    begin = time.monotonic()
    for k in range(60):
        robot.bus.publish("ALE_POSE", pose(k))
        robot.bus.publish("ALE_SCAN", bytes([k]) * 3000)
        time.sleep(0.02)
        wait_until(lambda so_far=k + 1: len(operator.on("ALE_POSE")) == so_far, 180, "every pose")
    seconds = time.monotonic() - begin
    robot.bus.publish("ALE_POSE", pose(60))  # behind the last scan
    wait_until(lambda: len(operator.on("ALE_POSE")) == 61, 180, "the last pose")
    assert operator.on("ALE_POSE") == [pose(k) for k in range(61)]
    scans = operator.on("ALE_SCAN")
    assert 2 <= len(scans) <= 2 * seconds + 2 and all(len(scan) == 3000 for scan in scans)
    counted = end(ends[0])
    assert counted["sent"] == 61 + len(scans)
    assert counted["thinned"] == 60 - len(scans)


def test_every_pose_has_its_tracking_and_every_map_its_pieces_with_it(sides, ends):
    robot, operator = sides
    for channel in ("ALE_TRACKING", "ALE_MAP_PIECES"):
        for k in range(20):  # at once: nothing of it is thinned
            robot.bus.publish(channel, bytes([k]) * 40)
        wait_until(lambda: operator.on(channel) == [bytes([k]) * 40 for k in range(20)], 180, channel)


def test_commands_go_to_the_robot_and_nothing_else_does(sides, ends):
    robot, operator = sides
    operator.bus.publish("ALE_ODOMETRY", b"not for the robot")
    operator.bus.publish("ALE_COMMAND", b"for the robot")
    wait_until(lambda: robot.on("ALE_COMMAND") == [b"for the robot"], 180, "the command")
    assert not robot.on("ALE_ODOMETRY")


def test_what_a_stranger_injects_is_refused(sides, ends):
    robot, _ = sides
    stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    port = ends[0].args[2].rsplit(":", 1)[1]
    frame = b"ALEB\x01\x01" + bytes(8) + bytes([11]) + b"ALE_COMMAND" + b"evil"
    for data in (frame, b"", b"ALEB", b"\xff" * 60000):
        stranger.sendto(data, ("127.0.0.1", int(port)))
    robot.bus.publish("ALE_POSE", pose(1))
    wait_until(lambda: sides[1].on("ALE_POSE") == [pose(1)], 180, "the pose, still to the right end")
    assert not robot.on("ALE_COMMAND")
    assert end(ends[0])["refused"] == 4
    stranger.close()


def test_over_a_bad_link_nothing_comes_twice_or_out_of_order(sides):
    robot, operator = sides
    port = free_udp_port()
    air = BadLink(port)
    ends = [start("--listen", f"127.0.0.1:{port}", "--lcm-url", robot.url),
            start("--connect", f"127.0.0.1:{air.port}", "--lcm-url", operator.url)]
    try:
        for process in ends:
            assert "is there" in process.stderr.readline()
        for k in range(300):
            robot.bus.publish("ALE_POSE", pose(k))
            time.sleep(0.002)
        wait_until(lambda: operator.on("ALE_POSE") and ale.pose_t.decode(operator.on("ALE_POSE")[-1]).scan > 290, 180,
                   "the last poses")
        numbers = [ale.pose_t.decode(data).scan for data in operator.on("ALE_POSE")]
        assert numbers == sorted(set(numbers))
        assert len(numbers) > 200
        counted = end(ends[1])
        assert counted["lost"] > 10 and counted["late"] > 10
    finally:
        for process in ends:
            process.kill()
            process.communicate()
        air.stop()


def test_an_operator_who_comes_back_is_taken_up_again(sides, ends):
    robot, operator = sides
    end(ends[1])
    port = ends[0].args[2].rsplit(":", 1)[1]
    again = start("--connect", f"127.0.0.1:{port}", "--lcm-url", operator.url)
    try:
        assert "is silent" in ends[0].stderr.readline()
        assert "is there" in again.stderr.readline()
        robot.bus.publish("ALE_POSE", pose(7))
        wait_until(lambda: operator.on("ALE_POSE") == [pose(7)], 180, "the pose")
    finally:
        again.kill()
        again.communicate()


def test_a_host_that_cannot_be_found_is_a_failure_and_no_wrong_use():
    done = subprocess.run([BINARIES / "ale-bridge", "--connect", "no-such-host.invalid:7700"], capture_output=True, text=True,
                          timeout=180, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("ale-bridge: no-such-host.invalid:7700: ") and done.stderr.count("\n") == 1


@pytest.mark.parametrize("words, part", [
    ([], "--listen"), (["--listen", "1", "--connect", "a:1"], "--listen"), (["--connect", "7700"], "HOST:PORT"),
    (["--listen", "127.0.0.1:none"], "no such address"), (["--listen", "99999"], "no such address: 99999"), (["--listen", "0", "--send", "A:0"], "rate"),
    (["--listen", "0", "--send", "ALE_COMMAND"], "round for ever"), (["word"], "word"),
])
def test_wrong_use_is_told_in_one_line_and_ends_with_2(words, part):
    done = subprocess.run([BINARIES / "ale-bridge", *words], capture_output=True, text=True, timeout=180, check=False)
    assert done.returncode == 2
    assert part in done.stderr and done.stderr.count("\n") == 1
