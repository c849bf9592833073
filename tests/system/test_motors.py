"""The motor side obeys the robot alone: a shared key over LCM, or a line that no bus reaches."""
import math
import os
import pty
import re
import subprocess
import threading
import time
import tty

import ale
import pytest

from at_hand import BINARIES
from commanded import Commanded
from waiting import Ear, Pulse, wait_until

STANDS_M = 0.02
IN_TIME_S = 0.3 + 0.3  # of a machine that others use too: the stop is obeyed at once, the message may wait for a processor


class Recorder(Ear):
    """Keeps set points with a tag, and where the robot's wheels say it is."""

    def __init__(self, url):
        self.keyed, self.where = [], None
        super().__init__(url, ["ALE_DRIVE_KEYED", "ALE_ODOMETRY"], self._take)

    def _take(self, channel, data):
        if channel == "ALE_ODOMETRY":
            self.where = ale.odometry_t.decode(data)
        else:
            self.keyed.append(data)

    def moved_from(self, place):
        return math.hypot(self.where.x - place.x, self.where.y - place.y)


@pytest.fixture(name="heard")
def a_recorder(chain):
    recorder = Recorder(chain.url)
    yield recorder
    recorder.stop()


@pytest.fixture(name="pulses")
def several_pulses():
    running = []

    def start(period_s, beat):
        running.append(Pulse(period_s, beat))
        return running[-1]
    yield start
    for pulse in running:
        pulse.stop()


def set_point(v, utime=None):
    message = ale.drive_t()
    message.utime, message.v, message.w = utime or int(time.time() * 1e6), v, 0.0
    return message.encode()


def test_who_has_no_key_drives_nothing(chain, heard, pulses):
    key = chain.folder / "drive.key"
    subprocess.run([BINARIES / "ale-keys", "--drive", key], check=True, stdout=subprocess.DEVNULL)
    chain.simulator("--world", "tools/lab/worlds/home.world", "--drive", "--drive-key", key)
    robot = Commanded(chain, f"[drive]\nkey = {key}\n", simulator=False)
    wait_until(lambda: heard.where is not None and len(heard.keyed) > 50, 180, "wheels and set points")
    bus = chain.listener.bus
    place = heard.where

    def forge():
        bus.publish("ALE_DRIVE", set_point(0.5))
        bad = ale.drive_keyed_t.decode(heard.keyed[-1])
        bad.v_um_s, bad.counter = 500000, bad.counter + 1000
        bus.publish("ALE_DRIVE_KEYED", bad.encode())

    forging = pulses(0.01, forge)
    wait_until(lambda: len(forging.beats) > 200, 180, "200 forged set points")
    assert heard.moved_from(place) < STANDS_M

    wait_until(lambda: robot.send("--seconds", "2", "drive", "0.2", "0")[0], 180, "driving")
    assert heard.moved_from(place) > 0.1, "the robot's own are obeyed all the while"
    driven = [data for data in heard.keyed if ale.drive_keyed_t.decode(data).v_um_s > 0 and
              ale.drive_keyed_t.decode(data).v_um_s < 400000]
    assert driven
    replaying = pulses(0.01, lambda: [bus.publish("ALE_DRIVE_KEYED", data) for data in driven[::10]])
    assert robot.send("stop")[0]
    begin = time.monotonic()
    place = heard.where
    wait_until(lambda: len(replaying.beats) > 200, 180, "200 rounds of old set points")
    assert heard.moved_from(place) < 0.2 * IN_TIME_S, f"{time.monotonic() - begin} s after the stop"


def test_what_was_recorded_moves_nothing_when_the_robot_is_off(chain, heard, pulses):
    key = chain.folder / "drive.key"
    subprocess.run([BINARIES / "ale-keys", "--drive", key], check=True, stdout=subprocess.DEVNULL)
    simulator = chain.simulator("--world", "tools/lab/worlds/home.world", "--drive", "--drive-key", key)
    robot = Commanded(chain, f"[drive]\nkey = {key}\n", simulator=False)
    wait_until(lambda: chain.listener.poses, 180, "poses")
    wait_until(lambda: robot.send("--seconds", "1", "drive", "0.2", "0")[0], 180, "driving")
    driven = [data for data in heard.keyed if ale.drive_keyed_t.decode(data).v_um_s > 0]
    assert len(driven) > 10
    assert robot.firmware.end() == 0
    place = standing(heard)
    replaying = pulses(0.04, iter_publish(chain.listener.bus, driven))
    wait_until(lambda: len(replaying.beats) > 2 * len(driven), 180, "all that was recorded, twice")
    assert simulator.running() and heard.moved_from(place) < STANDS_M


def standing(heard):
    """Where the robot is, once it has come to rest."""
    places = [heard.where]

    def rests():
        time.sleep(0.3)
        places.append(heard.where)
        return math.hypot(places[-1].x - places[-2].x, places[-1].y - places[-2].y) < 0.001
    wait_until(rests, 180, "the robot to come to rest")
    return places[-1]


def iter_publish(bus, messages):
    state = {"next": 0}

    def beat():
        bus.publish("ALE_DRIVE_KEYED", messages[state["next"] % len(messages)])
        state["next"] += 1
    return beat


class Controller:
    """The far end of a serial line: keeps the lines."""

    def __init__(self):
        self.far, near = pty.openpty()
        tty.setraw(near)
        self.path = os.ttyname(near)
        self.near = near
        self.lines = []
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._read)
        self.thread.start()

    def _read(self):
        rest = b""
        os.set_blocking(self.far, False)
        while not self.stopping.wait(0.002):
            try:
                rest += os.read(self.far, 4096)
            except OSError:
                continue
            *whole, rest = rest.split(b"\n")
            self.lines += [line.decode().strip() for line in whole]

    def stop(self):
        self.stopping.set()
        self.thread.join()
        os.close(self.far)
        os.close(self.near)


def crc(text):
    total = 0xFFFF
    for byte in text.encode():
        total ^= byte << 8
        for _ in range(8):
            total = (total << 1 ^ 0x1021 if total & 0x8000 else total << 1) & 0xFFFF
    return total


def test_set_points_go_over_a_serial_line_that_no_bus_reaches(chain, heard, pulses):
    """And by messages with a tag beside it: each way has a counter of its own."""
    controller = Controller()
    key = chain.folder / "drive.key"
    subprocess.run([BINARIES / "ale-keys", "--drive", key], check=True, stdout=subprocess.DEVNULL)
    try:
        robot = Commanded(chain, f"[drive]\nport = {controller.path}\nkey = {key}\n")
        pulses(0.01, lambda: chain.listener.bus.publish("ALE_DRIVE", set_point(0.7)))
        wait_until(lambda: len(controller.lines) > 10, 180, "lines")
        wait_until(lambda: chain.listener.poses, 180, "poses")
        assert robot.send("--seconds", "1", "drive", "0.2", "-0.1")[0]
        assert robot.send("stop")[0]
        before = len(controller.lines)
        wait_until(lambda: len(controller.lines) > before + 10, 180, "lines after the stop")
        parsed = [re.fullmatch(r"\$(ALE,(\d+),(-?\d+),(-?\d+))\*([0-9A-F]{4})", line) for line in controller.lines[1:]]
        assert all(parsed), controller.lines
        assert all(crc(one[1]) == int(one[5], 16) for one in parsed)
        for counters in ([int(one[2]) for one in parsed], [ale.drive_keyed_t.decode(data).counter for data in heard.keyed]):
            assert len(counters) > 20 and counters == list(range(counters[0], counters[0] + len(counters)))
        assert {(int(one[3]), int(one[4])) for one in parsed} >= {(0, 0), (200, -100)}
        assert all(0 <= int(one[3]) <= 200 for one in parsed), "what others say on the bus is not in it"
        assert all(one[3] == "0" for one in parsed[before:]), "stands"
    finally:
        controller.stop()


def test_a_line_that_is_not_there_is_said_and_tried_again(chain):
    link = chain.folder / "motors"
    robot = Commanded(chain, f"[drive]\nport = {link}\n", simulator=False)
    words = f"motor controller: {link}: "
    wait_until(lambda: f"{words}no such serial device" in robot.firmware.err(), 180, "the words")
    controller = Controller()
    try:
        link.symlink_to(controller.path)
        wait_until(lambda: len(controller.lines) > 10, 180, "lines")
        wait_until(lambda: f"{words}there again" in robot.firmware.err(), 180, "a word that it is there")
    finally:
        controller.stop()
    wait_until(lambda: robot.firmware.err().count(words) == 3, 180, "a word that it is gone")
    assert robot.send("stop")[0], "a line that is gone holds nothing up"
    assert robot.firmware.err().count(words) == 3, "and is not said again and again"
