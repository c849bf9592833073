"""Networks that come late, go and come back: the robot estimates without one, and its bus joins by itself."""
import contextlib
import re
import subprocess
import time

import ale
import pytest

from chain import Chain
from hosts import cable, two_hosts, two_separate_hosts
from lcm_url import free_lcm_url
from plain_lcm import PlainLcm
from test_hostile_bus import Ears
from waiting import wait_until

LCM_URL = "udpm://239.255.76.67:7667?ttl=1"
WITHOUT = "no route for multicast"
JOINED = "there is a route for multicast: joined"


class Robot:
    """A scanner that needs no network, and the firmware on a computer of its own."""

    def __init__(self, folder, host, words="", url=LCM_URL):
        self.chain = Chain(folder, free_lcm_url(), channels=())
        self.chain.simulator("--world", "tools/lab/worlds/home.world", "--no-odometry")
        self.chain.url = url
        self.firmware = self.chain.firmware(words, prefix=host.prefix)

    def said(self, words):
        return self.firmware.err().count(words)

    def wait_for_word(self, words, times=1):
        wait_until(lambda: self.said(words) >= times or not self.firmware.running(), 180, words)
        assert self.firmware.running(), self.firmware.err()


@contextlib.contextmanager
def robot_on(folder, host, **how):
    robot = Robot(folder, host, **how)
    try:
        yield robot
    finally:
        robot.chain.stop()


@contextlib.contextmanager
def ears_on(host):
    ears = Ears(LCM_URL, host)
    try:
        yield ears
    finally:
        ears.stop()


def assert_heard(ears, what):
    """Poses that are sent from now on, one after the other."""
    heard = len(ears.poses)
    wait_until(lambda: len(ears.poses) > heard + 10, 60, f"poses, {what}")
    numbers = [pose.scan for pose in ears.poses[-8:]]
    assert numbers == list(range(numbers[0], numbers[0] + 8)), what


def odometry_taken(ears):
    """By the newest status."""
    status = ears.statuses[-1]
    return dict(zip(status.counter_name, status.counter_value))["odometry"]


def assert_listens(ears, host, what):
    """What another computer sends now gets into the robot."""
    wait_until(lambda: ears.statuses, 60, "a status")
    before = odometry_taken(ears)
    voice = PlainLcm(LCM_URL, on=host.socket)
    message = ale.odometry_t()

    def is_taken():
        message.utime = int(time.time() * 1e6)
        voice.publish("ALE_ODOMETRY", message.encode())
        time.sleep(0.1)
        return odometry_taken(ears) > before

    wait_until(is_taken, 60, f"odometry to be taken, {what}")


def test_without_a_network_it_estimates_and_joins_when_there_is_one(tmp_path, multicast):
    with two_separate_hosts() as (host, other), robot_on(tmp_path, host) as robot:
        robot.wait_for_word("streaming")
        robot.wait_for_word(WITHOUT)
        time.sleep(4)
        cable(host, other)
        host.make_up()
        other.make_up()
        robot.wait_for_word(JOINED)
        with ears_on(other) as ears:
            wait_until(lambda: ears.poses and ears.statuses, 60, "poses and a status")
            assert ears.poses[0].scan > 30, "it has estimated before there was a network"
            assert ears.poses[-1].state == 2
            assert ears.statuses[-1].poses > 30
            assert_listens(ears, other, "after a network that came late")
        assert robot.said(WITHOUT) == robot.said(JOINED) == 1
        assert robot.said("does not come back") == 0
        assert robot.firmware.end() == 0


def test_the_drive_thread_waits_for_no_network(tmp_path, multicast):
    keys = tmp_path / "robot.keys"
    subprocess.run(["build/bin/ale-keys", "alice", "--secret", tmp_path / "alice.key", "--robot", keys], check=True, capture_output=True)
    with two_separate_hosts() as (host, _), robot_on(tmp_path, host, words=f"[commands]\nkeys = {keys}\n") as robot:
        robot.wait_for_word("streaming")
        host.run("ip", "link", "set", "lo", "up", "multicast", "on")
        host.run("ip", "route", "add", "224.0.0.0/4", "dev", "lo")
        robot.wait_for_word(JOINED)
        points = []
        ear = PlainLcm(LCM_URL, on=host.socket).subscribe("ALE_DRIVE", lambda _, data: points.append(ale.drive_t.decode(data)))
        wait_until(lambda: ear.handle_timeout(100) or len(points) > 5, 60, "set points")
        assert robot.firmware.end() == 0


def test_a_wire_is_pulled_and_put_back(tmp_path, multicast):
    with two_hosts() as (host, other), robot_on(tmp_path, host) as robot, ears_on(host) as at_home, ears_on(other) as away:
        assert_heard(away, "at first")
        other.run("ip", "link", "set", "card", "down")
        assert_heard(at_home, "without a wire")
        other.run("ip", "link", "set", "card", "up")
        other.run("ip", "route", "replace", "default", "dev", "card")
        assert_heard(away, "with the wire back")
        assert_listens(away, other, "with the wire back")
        assert robot.said(WITHOUT) == 0


def test_a_card_without_its_wire_loses_its_route(tmp_path, multicast):
    """As by a program that configures networks: it takes address and route away with the wire."""
    with two_hosts() as (host, other), robot_on(tmp_path, host) as robot, ears_on(other) as away:
        assert_heard(away, "at first")
        last = away.poses[-1].scan
        host.run("ip", "address", "flush", "dev", "card")
        host.run("ip", "link", "set", "card", "down")
        robot.wait_for_word(WITHOUT)
        host.make_up()
        robot.wait_for_word(JOINED)
        assert_heard(away, "with the wire back")
        assert away.poses[-1].scan > last + 10
        assert_listens(away, other, "with the wire back")
        assert robot.said(WITHOUT) == robot.said(JOINED) == 1


def test_the_address_changes(tmp_path, multicast):
    with two_hosts() as (host, other), robot_on(tmp_path, host) as robot, ears_on(other) as away:
        assert_heard(away, "at first")
        host.run("ip", "address", "flush", "dev", "card")
        host.address = "10.77.0.9"
        host.run("ip", "address", "add", "10.77.0.9/24", "dev", "card")
        host.run("ip", "route", "replace", "default", "dev", "card")
        assert_heard(away, "from another address")
        assert_listens(away, other, "at another address")
        assert robot.firmware.running()


def test_the_interface_is_gone_and_comes_back(tmp_path, multicast):
    """Twice: each that comes is another one to the kernel."""
    with two_hosts() as (host, other), robot_on(tmp_path, host) as robot:
        with ears_on(other) as away:
            assert_heard(away, "at first")
        for k in range(2):
            host.run("ip", "link", "delete", "card")
            robot.wait_for_word(WITHOUT, k + 1)
            cable(host, other)
            host.make_up()
            other.make_up()
            robot.wait_for_word(JOINED, k + 1)
        with ears_on(other) as away:
            assert_heard(away, "over another interface")
            assert_listens(away, other, "over another interface")
            assert away.poses[-1].state == 2


@pytest.mark.parametrize("memberships", [20, 1])
def test_the_route_moves_to_another_interface(tmp_path, multicast, memberships):
    """Without a moment in which there is none; also where the kernel lets a socket join no more."""
    with two_hosts() as (host, other), robot_on(tmp_path, host) as robot:
        host.run("sysctl", "-w", f"net.ipv4.igmp_max_memberships={memberships}")
        with ears_on(other) as away:
            assert_heard(away, "at first")
        subprocess.run(["ip", "link", "add", "second", "netns", str(host.holder.pid), "type", "veth",
                        "peer", "name", "second", "netns", str(other.holder.pid)], check=True)
        for computer, address in ((host, "10.78.0.1/24"), (other, "10.78.0.2/24")):
            computer.run("ip", "address", "add", address, "dev", "second")
            computer.run("ip", "link", "set", "second", "up")
            computer.run("ip", "route", "replace", "default", "dev", "second")
        with ears_on(other) as away:
            assert_heard(away, "over the second card")
            assert_listens(away, other, "over the second card")
        assert robot.said(WITHOUT) == 0


def poses_watched(watch):
    """By the newest line of ale-watch."""
    return max((int(number) for number in re.findall(r" poses +(\d+) ", watch.out())), default=0)


def test_a_listener_on_a_laptop_comes_back_too(tmp_path, multicast):
    with two_hosts() as (host, other), robot_on(tmp_path, host) as robot:
        watch = robot.chain.start("ale-watch", "--lcm-url", LCM_URL, prefix=other.prefix)
        wait_until(lambda: poses_watched(watch) > 0 or not watch.running(), 60, "what is watched")
        host.run("ip", "link", "delete", "card")
        robot.wait_for_word(WITHOUT)
        cable(host, other)
        host.make_up()
        other.make_up()
        robot.wait_for_word(JOINED)
        before = poses_watched(watch)
        wait_until(lambda: poses_watched(watch) > before + 10 or not watch.running(), 60, "poses, after the interface was gone")
        assert watch.running()
