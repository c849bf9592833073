"""Signed commands to the running robot: driving and its dead-man, who drives, hostile commands, saved maps."""
import contextlib
import math
import random
import statistics
import struct
import subprocess
import time

import ale
import pytest

from at_hand import BINARIES
from waiting import Ear, wait_until

DEAD_MAN_US = 300000
SCAN_LIFE_US = 400000  # with no younger scan the robot stands; a machine that is too busy may give it none
TURN_US = 40000  # the drive thread's period
FLOOD = 100  # commands at once: fewer than may wait in the kernel and in the firmware, so that none is lost on the way


class Motors(Ear):
    """Keeps ALE_DRIVE and ALE_COMMAND as they pass."""

    def __init__(self, url):
        self.set_points = []
        self.commands = []
        super().__init__(url, ["ALE_DRIVE", "ALE_COMMAND"], self._take)

    def _take(self, channel, data):
        if channel == "ALE_DRIVE":
            self.set_points.append(ale.drive_t.decode(data))
        else:
            self.commands.append(data)


def decoded(data):
    """None: a hostile one that nobody can decode."""
    try:
        return ale.command_t.decode(data)
    except (ValueError, IndexError, struct.error):
        return None


class Rover:
    """The chain with two operators who have keys."""

    def __init__(self, chain):
        self.chain = chain
        self.keys = chain.folder / "robot.keys"
        for name in ("alice", "bob"):
            self.tool("ale-keys", name, "--secret", self.key(name), "--robot", self.keys)
        chain.simulator("--world", "tools/lab/worlds/home.world", "--drive")
        self.firmware = self.start()
        self.motors = Motors(chain.url)
        self.firmware.wait_until(lambda: self.motors.set_points, "set points")

    def start(self, *words):
        config = f"[commands]\nrobot = rover\n[map]\nfolder = {self.chain.folder / 'maps'}\n[recorder]\nfolder =\n"
        before = len(self.chain.listener.poses)
        firmware = self.chain.firmware(config, "--keys", self.keys, *words)
        firmware.wait_until(lambda: len(self.chain.listener.poses) > before + 5, "poses")
        return firmware

    def key(self, name):
        return self.chain.folder / f"{name}.key"

    def tool(self, name, *words):
        return subprocess.run([BINARIES / name, *map(str, words)], stdin=subprocess.DEVNULL, text=True, timeout=180,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)

    def send(self, who, *words):
        """Whether the robot obeyed, and what it said."""
        done = self.tool("ale-send", "--keys", self.key(who), "--lcm-url", self.chain.url, *words)
        return done.returncode == 0, (done.stdout + done.stderr).strip()

    @contextlib.contextmanager
    def held_stick(self, who, *speeds):
        """An operator drives until he lets go."""
        driving = self.chain.start("ale-send", "--keys", self.key(who), "--lcm-url", self.chain.url, "--seconds", "600", "drive",
                                   *speeds)
        wait_until(lambda: self.motors.set_points[-1].v > 0, 180, "driving")
        yield
        driving.end()

    def drive_for_a_moment(self):
        """One command to drive, and its set points to the first zero after it. A machine so busy that there is no scan all the
        while lets the robot stand: then again. The moment at which the command was made."""
        points = self.motors.set_points
        for _ in range(20):
            points.clear()
            before = self.drive_commands()
            assert self.send("alice", "drive", "0.2", "0.3") == (True, "rover: alice drives")
            wait_until(lambda: len(self.drive_commands()) > len(before), 180, "the command on the wire")
            sent = self.drive_commands()[-1].utime
            wait_until(lambda: points and points[-1].utime > sent + DEAD_MAN_US and points[-1].v == 0, 180, "the end of driving")
            if any(p.v > 0 for p in points):
                return sent
        raise AssertionError("it never moved")

    def drive_commands(self):
        return [c for c in map(decoded, list(self.motors.commands)) if c and c.verb == "drive"]

    def stick_is_let_go(self):
        commands = self.drive_commands()
        return not commands or commands[-1].utime < time.time() * 1e6 - 2 * DEAD_MAN_US

    def counters(self):
        return self.chain.listener.counters()


@pytest.fixture(name="one_for_all", scope="module")
def a_rover(long_chain):
    running = Rover(long_chain)
    yield running
    running.motors.stop()


@pytest.fixture
def rover(one_for_all):
    """Ready for commands, whatever the test before has done to it: each may run alone."""
    if not one_for_all.firmware.running():
        one_for_all.firmware = one_for_all.start()
    wait_until(one_for_all.stick_is_let_go, 180, "the last test's stick to be let go")
    return one_for_all


def test_the_set_point_is_zero_300_ms_after_the_last_valid_command(rover):
    """By the robot's own stamps; to the microsecond on a clock of its own: tests/firmware/operator/test_drive.cpp."""
    sent = rover.drive_for_a_moment()
    points = list(rover.motors.set_points)
    moving = [p for p in points if p.v > 0]
    end = next(p for p in points if p.utime > moving[-1].utime)
    print(f"zero {(end.utime - moving[0].utime) / 1000:.2f} ms after the first set point, "
          f"{(end.utime - sent) / 1000:.2f} ms after the command was made")
    assert moving[-1].utime - moving[0].utime < DEAD_MAN_US
    assert end.utime >= sent + DEAD_MAN_US or blind_at(rover, end.utime)
    assert all(abs(p.v - 0.2) < 1e-6 and abs(p.w - 0.3) < 1e-6 for p in moving)


def blind_at(rover, utime):
    return all(not utime - SCAN_LIFE_US < pose.utime <= utime for pose in rover.chain.listener.poses)


def test_set_points_come_20_times_a_second_at_least(rover):
    rover.motors.set_points.clear()

    def median():
        stamps = [point.utime for point in rover.motors.set_points[-26:]]
        return statistics.median(later - earlier for earlier, later in zip(stamps, stamps[1:])) if len(stamps) > 25 else 1e9
    wait_until(lambda: median() < 50000, 180, "set points 20 times a second")


def test_driving_drives_and_everyone_sees_who(rover):
    poses = rover.chain.listener.poses
    start = poses[-1]

    def metres():
        return math.hypot(poses[-1].map_x - start.map_x, poses[-1].map_y - start.map_y)

    with rover.held_stick("alice", "0.3", "0"):
        wait_until(lambda: rover.chain.listener.statuses[-1].who_drives == "alice", 180, "her name")
        assert rover.send("bob", "drive", "0.3", "0") == (False, "rover: alice drives")
        wait_until(lambda: metres() > 0.2, 180, "some way")
    assert metres() < 0.33 * (poses[-1].utime - start.utime) * 1e-6 + 0.1
    assert rover.send("bob", "stop") == (True, "rover: stopped by bob")


def test_a_stop_is_stronger_than_a_stick_that_is_still_held(rover):
    statuses = rover.chain.listener.statuses
    with rover.held_stick("alice", "0.1", "0"):
        before = len(statuses)
        assert rover.send("bob", "stop")[0]

        def stops():
            return [s.utime for s in statuses[before:] if s.command_result == "stopped by bob"]
        wait_until(stops, 180, "the answer")
        stopped = stops()[0]
        held = len(rover.drive_commands())

        def after():
            return [p for p in list(rover.motors.set_points) if p.utime > stopped + TURN_US]
        wait_until(lambda: len(after()) > 20 and len(rover.drive_commands()) > held + 5, 180, "more of her commands")
        assert all(p.v == 0 for p in after())


def test_10000_hostile_commands_are_all_counted_and_none_is_obeyed(rover):
    """Replayed, out of order, truncated, changed, and signed by nobody: as anyone on the network can send them."""
    rng = random.Random(7)
    bus = rover.chain.listener.bus
    assert rover.send("alice", "--seconds", "0.5", "drive", "0.01", "0")[0]
    assert rover.send("alice", "stop")[0]
    heard = list(rover.motors.commands)
    wait_until(lambda: rover.motors.set_points[-1].v == 0, 180, "rest")
    rested = rover.motors.set_points[-1].utime
    wait_until(lambda: rover.chain.listener.statuses[-1].utime > rested, 180, "a status that counts them all")
    rover.motors.set_points.clear()
    before = rover.counters()
    genuine = before["command_genuine"]
    refused = sum(value for name, value in before.items() if name.startswith("command_") and name not in
                  ("command_genuine", "command_refused"))

    def counted():
        now = rover.counters()
        assert now["command_genuine"] == genuine
        return sum(value for name, value in now.items() if name.startswith("command_") and name not in
                   ("command_genuine", "command_refused")) - refused

    for k in range(10000):
        data = bytearray(rng.choice(heard))
        if k % 4 == 1:
            data = data[:rng.randrange(len(data))]
        elif k % 4 == 2:
            data[rng.randrange(len(data))] ^= 1 + rng.randrange(255)
        elif k % 4 == 3:
            command = ale.command_t.decode(bytes(data))
            command.counter += 10**12
            command.signature = b""
            command.num_signature = 0
            data = command.encode()
        bus.publish("ALE_COMMAND", bytes(data))
        if k % FLOOD == FLOOD - 1:
            wait_until(lambda sent=k + 1: counted() >= sent, 180, f"{k + 1} refusals")
    assert counted() == 10000
    after = rover.counters()
    assert after["command_unsigned"] - before["command_unsigned"] == 2500
    assert after["command_replayed"] - before["command_replayed"] >= 2500
    assert after["command_malformed"] - before["command_malformed"] >= 2500
    assert after["command_forged"] > before["command_forged"]
    assert all(p.v == 0 and p.w == 0 for p in rover.motors.set_points)
    assert rover.firmware.running()
    assert rover.send("alice", "set", "drive_speed", "0.5")[0], "and an honest one is still obeyed"


def save_reset_and_load(rover):
    wait_until(lambda: rover.chain.listener.poses[-1].state == 2, 180, "a good pose")
    here = rover.chain.listener.poses[-1]
    assert rover.send("bob", "save_map", "home")[1].startswith("rover: saved home: ")
    assert rover.send("bob", "load_map", "nowhere")[0] is False
    assert rover.send("bob", "reset") == (True, "rover: map and pose forgotten")
    wait_until(lambda: abs(rover.chain.listener.poses[-1].map_x) + abs(rover.chain.listener.poses[-1].map_y) < 0.02, 180,
               "a new origin")
    pose = [f"{value:.6f}" for value in (here.map_x, here.map_y, here.map_theta)]
    assert rover.send("bob", "load_map", "home", *pose)[1].startswith("rover: loaded home: ")
    wait_until(lambda: rover.chain.listener.poses[-1].state == 2 and near(rover.chain.listener.poses[-1], here), 180,
               "the old place")


def test_a_map_is_saved_and_loaded_with_a_pose(rover):
    save_reset_and_load(rover)


def near(pose, other):
    return (math.hypot(pose.map_x - other.map_x, pose.map_y - other.map_y) < 0.05
            and abs(math.remainder(pose.map_theta - other.map_theta, 2 * math.pi)) < 0.03)


def test_after_a_restart_it_finds_itself_and_an_old_command_is_not_obeyed(rover):
    home = rover.chain.folder / "maps" / "home.map"
    if not home.exists():
        save_reset_and_load(rover)
    here = rover.chain.listener.poses[-1]
    old = [data for data in rover.motors.commands if b"reset" in data]  # among them are some that nobody could decode
    assert rover.firmware.end() == 0
    boots = {status.boot for status in rover.chain.listener.statuses}
    before = len(rover.chain.listener.poses)
    rover.firmware = rover.start("--map", home)
    wait_until(lambda: rover.chain.listener.statuses[-1].boot not in boots, 180, "a status of the new start")
    rover.chain.listener.bus.publish("ALE_COMMAND", old[-1])
    wait_until(lambda: rover.counters()["command_replayed"] == 1, 180, "the refusal")
    assert rover.counters()["command_genuine"] == 0
    wait_until(lambda: rover.chain.listener.poses[-1].state == 2, 180, "a good pose")
    poses = rover.chain.listener.poses[before:]
    assert poses[0].state < 2, "nobody has told it where it is: one scan is no proof"
    assert all(near(pose, here) for pose in poses if pose.state == 2)


def test_without_keys_nobody_is_obeyed_and_the_sender_is_told(rover):
    assert rover.firmware.end() == 0
    boots = {status.boot for status in rover.chain.listener.statuses}
    firmware = rover.chain.firmware()
    wait_until(lambda: rover.chain.listener.statuses[-1].boot not in boots, 180, "a status of the new start")
    obeyed, words = rover.send("alice", "stop")
    assert not obeyed and "takes no commands" in words
    assert firmware.end() == 0


@pytest.mark.parametrize("words, status, part", [
    ([], 2, "--keys is missing"),
    (["--keys", "KEY"], 2, "which verb"),
    (["stop", "--keys", "KEY"], 2, "options come before the verb: --keys"),
    (["--keys", "absent", "stop"], 1, "absent"),
    (["--keys", "KEY", "--seconds", "2", "stop"], 2, "--seconds"),
    (["--keys", "KEY", "fly"], 2, "no verb fly"),
    (["--keys", "KEY", "drive", "1"], 2, "drive takes 2 arguments, not 1"),
    (["--keys", "KEY", "set", "colour", "blue"], 2, "no setting colour"),
    (["--keys", "KEY", "stop", "x" * 64], 2, "too long"),
    (["--keys", "KEY", "--robot", "nobody", "stop"], 1, "no robot nobody is heard"),
])
def test_ale_send_says_in_one_line_what_is_wrong(chain, words, status, part):
    key = chain.folder / "alice.key"
    subprocess.run([BINARIES / "ale-keys", "alice", "--secret", key, "--robot", chain.folder / "robot.keys"],
                   check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run([BINARIES / "ale-send", "--lcm-url", chain.url, *[str(key) if w == "KEY" else w for w in words]],
                          stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, timeout=180, check=False)
    assert done.returncode == status
    assert part in done.stderr and done.stderr.count("\n") == 1
