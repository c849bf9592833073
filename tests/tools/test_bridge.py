"""ale-bridge: two LCM ports that do not hear each other, and a unicast link between them, good and bad."""
import contextlib
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


class Keys:
    """Of one robot and its operators."""

    def __init__(self, folder):
        self.folder = folder
        self.robot = folder / "robot.keys"
        for name in ("alice", "bob"):
            subprocess.run([BINARIES / "ale-keys", name], cwd=folder, check=True, capture_output=True)

    def operator(self, name="alice"):
        return self.folder / f"{name}.key"


@pytest.fixture(name="keys")
def some_keys(tmp_path):
    return Keys(tmp_path)


def robots_end(keys, address, url):
    return start("--listen", address, "--keys", keys.robot, "--lcm-url", url)


def operators_end(keys, address, url, name="alice"):
    return start("--connect", address, "--keys", keys.operator(name), "--lcm-url", url)


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


def kill(*processes):
    for process in processes:
        process.kill()
        process.communicate()


def wait_for_each_other(*processes):
    for process in processes:
        assert "is there" in process.stderr.readline()


@contextlib.contextmanager
def over(way, sides, keys):
    """Both ends, which have found each other over this way (a class), and the way between them."""
    port = free_udp_port()
    between = way(port)
    both = robots_end(keys, f"127.0.0.1:{port}", sides[0].url), operators_end(keys, f"127.0.0.1:{between.port}", sides[1].url)
    try:
        wait_for_each_other(*both)
        yield both, between
    finally:
        kill(*both)
        between.stop()


@pytest.fixture
def ends(sides, keys):
    """Both ends of a good link, which have found each other."""
    port = free_udp_port()
    robot = robots_end(keys, f"127.0.0.1:{port}", sides[0].url)
    operator = operators_end(keys, f"127.0.0.1:{port}", sides[1].url)
    wait_for_each_other(operator, robot)
    yield robot, operator
    kill(robot, operator)


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
    for channel in ("ALE_TRACKING", "ALE_MAP_PIECES", "ALE_GRAPH"):
        for k in range(20):  # at once: nothing of it is thinned
            robot.bus.publish(channel, bytes([k]) * 40)
        wait_until(lambda: operator.on(channel) == [bytes([k]) * 40 for k in range(20)], 180, channel)


def test_wheels_are_told_twenty_times_a_second_at_most(sides, ends):
    robot, operator = sides
    begin = time.monotonic()
    for k in range(100):
        robot.bus.publish("ALE_ODOMETRY", bytes([k]) * 28)
        time.sleep(0.005)
    seconds = time.monotonic() - begin
    wait_until(lambda: len(operator.on("ALE_ODOMETRY")) >= 5, 180, "odometry")
    assert len(operator.on("ALE_ODOMETRY")) <= 20 * seconds + 2


def test_commands_go_to_the_robot_and_nothing_else_does(sides, ends):
    robot, operator = sides
    operator.bus.publish("ALE_ODOMETRY", b"not for the robot")
    operator.bus.publish("ALE_COMMAND", b"for the robot")
    wait_until(lambda: robot.on("ALE_COMMAND") == [b"for the robot"], 180, "the command")
    assert not robot.on("ALE_ODOMETRY")


def port_of(end_):
    return int(end_.args[2].rsplit(":", 1)[1])


def test_what_a_stranger_injects_is_refused_and_answered_by_nothing(sides, ends):
    robot, _ = sides
    stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    stranger.settimeout(1)
    old = b"ALEB\x01\x01" + bytes(8) + bytes([11]) + b"ALE_COMMAND" + b"evil"
    data = b"ALEB\x02\x03" + bytes(16) + b"ALE_COMMAND" + bytes(100)
    hello = b"ALEB\x02\x01" + bytes(250)
    sent = (old, data, hello, b"", b"ALEB", b"\xff" * 60000)
    for bytes_ in sent:
        stranger.sendto(bytes_, ("127.0.0.1", port_of(ends[0])))
    robot.bus.publish("ALE_POSE", pose(1))
    wait_until(lambda: sides[1].on("ALE_POSE") == [pose(1)], 180, "the pose, still to the right end")
    with pytest.raises(socket.timeout):
        stranger.recv(65536)
    assert not robot.on("ALE_COMMAND")
    assert end(ends[0])["refused"] == len(sent)
    stranger.close()


class Tap(BadLink):
    """Somebody on the way who passes everything on and keeps it."""

    def __init__(self, to_port):
        self.passed = []
        super().__init__(to_port)

    def pass_on(self, data, to):
        self.passed.append((data, to))
        self.socket.sendto(data, to)


def test_nothing_that_crosses_can_be_read_played_again_or_moved(sides, keys):
    robot, operator = sides
    with over(Tap, sides, keys) as (_, tap):
        operator.bus.publish("ALE_COMMAND", b"drive into the open")
        wait_until(lambda: robot.on("ALE_COMMAND"), 180, "the command")
        recorded = [data for data, to in list(tap.passed) if to == tap.robot]
        assert not any(b"ALE_COMMAND" in data or b"open" in data for data in recorded)
        for data in recorded:
            tap.socket.sendto(data, tap.robot)
            if len(data) > 22 and data[5] == 3:  # its sequence far ahead
                tap.socket.sendto(data[:18] + b"\x7f\xff\xff\xf0" + data[22:], tap.robot)
        for k in range(20):
            operator.bus.publish("ALE_COMMAND", b"stop %d" % k)
        wait_until(lambda: len(robot.on("ALE_COMMAND")) >= 21, 180, "all that came after")
        assert robot.on("ALE_COMMAND") == [b"drive into the open"] + [b"stop %d" % k for k in range(20)]


def test_a_played_again_hello_does_not_take_the_operators_place(sides, keys):
    """And brings whoever plays it no more than one short answer each."""
    robot, operator = sides
    with over(Tap, sides, keys) as (_, tap), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        stranger.setblocking(False)
        hellos = [data for data, to in list(tap.passed) if data[5] == 1]
        assert hellos
        sent = received = 0
        for k in range(200):
            stranger.sendto(hellos[0], tap.robot)
            sent += len(hellos[0])
            robot.bus.publish("ALE_POSE", pose(k))
            time.sleep(0.005)
            try:
                received += len(stranger.recv(65536))
            except BlockingIOError:
                pass
        wait_until(lambda: operator.on("ALE_POSE") and ale.pose_t.decode(operator.on("ALE_POSE")[-1]).scan == 199, 180, "all poses")
        assert received < sent


def test_ten_thousand_hostile_datagrams_hold_up_no_command(sides, keys):
    """Played again, changed, cut, invented: two thousand a second while the operator's commands cross."""
    robot, operator = sides
    with over(Tap, sides, keys) as (_, tap), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        for k in range(20):
            operator.bus.publish("ALE_COMMAND", b"before %d" % k)
        wait_until(lambda: len(robot.on("ALE_COMMAND")) == 20, 180, "commands")
        recorded = [data for data, to in list(tap.passed) if to == tap.robot]
        chance = random.Random(3)

        def hostile():
            data = bytearray(chance.choice(recorded))
            how = chance.randrange(4)
            if how == 0:
                data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
            elif how == 1:
                del data[chance.randrange(len(data)):]
            elif how == 2:
                data[6:] = chance.randbytes(chance.randrange(300))
            return bytes(data)

        sent, crossed, begin = 0, [], time.monotonic()
        while sent < 10000:
            for _ in range(100):
                stranger.sendto(hostile(), tap.robot)
            sent += 100
            word, asked = b"after %d" % sent, time.monotonic()
            operator.bus.publish("ALE_COMMAND", word)
            wait_until(lambda of=word: of in robot.on("ALE_COMMAND")[-3:], 180, "the command")
            crossed.append(time.monotonic() - asked)
            time.sleep(max(0.0, begin + sent / 2000 - time.monotonic()))
        crossed.sort()
        print(f"{sent} hostile datagrams; a command crosses in {crossed[len(crossed) // 2] * 1000:.0f} ms, at most {crossed[-1] * 1000:.0f} ms")
        assert crossed[int(0.9 * len(crossed))] < 0.3, "a busy machine may hold up some"
        assert len(robot.on("ALE_COMMAND")) == 120, "and nothing else came in"


def test_two_operators_at_a_time(sides, ends, keys):
    robot, first = sides
    second = Side()
    other = operators_end(keys, f"127.0.0.1:{port_of(ends[0])}", second.url, "bob")
    try:
        assert "is there" in other.stderr.readline()
        assert "bob" in ends[0].stderr.readline()
        robot.bus.publish("ALE_POSE", pose(3))
        for side in (first, second):
            wait_until(lambda to=side: to.on("ALE_POSE") == [pose(3)], 180, "the pose")
        first.bus.publish("ALE_COMMAND", b"of alice")
        second.bus.publish("ALE_COMMAND", b"of bob")
        wait_until(lambda: sorted(robot.on("ALE_COMMAND")) == [b"of alice", b"of bob"], 180, "both commands")
    finally:
        kill(other)
        second.stop()


def test_who_has_no_key_is_not_let_in(sides, keys, tmp_path):
    """Nor is a robot believed that is another one."""
    (tmp_path / "elsewhere").mkdir()
    strangers = Keys(tmp_path / "elsewhere")
    port = free_udp_port()
    robot = robots_end(keys, f"127.0.0.1:{port}", sides[0].url)
    operator = operators_end(strangers, f"127.0.0.1:{port}", sides[1].url)
    try:
        for k in range(20):
            sides[0].bus.publish("ALE_POSE", pose(k))
            sides[1].bus.publish("ALE_COMMAND", b"evil")
            time.sleep(0.1)
        assert not sides[1].on("ALE_POSE") and not sides[0].on("ALE_COMMAND")
        assert end(robot)["refused"] >= 3
    finally:
        kill(robot, operator)


def test_over_a_bad_link_nothing_comes_twice_or_out_of_order(sides, keys):
    robot, operator = sides
    with over(BadLink, sides, keys) as (both, _):
        for k in range(300):
            robot.bus.publish("ALE_POSE", pose(k))
            time.sleep(0.002)
        wait_until(lambda: operator.on("ALE_POSE") and ale.pose_t.decode(operator.on("ALE_POSE")[-1]).scan > 290, 180,
                   "the last poses")
        numbers = [ale.pose_t.decode(data).scan for data in operator.on("ALE_POSE")]
        assert numbers == sorted(set(numbers))
        assert len(numbers) > 200
        counted = end(both[1])
        assert counted["lost"] > 10 and counted["late"] > 10


def test_an_operator_who_comes_back_is_taken_up_again(sides, ends, keys):
    robot, operator = sides
    end(ends[1])
    port = ends[0].args[2].rsplit(":", 1)[1]
    again = operators_end(keys, f"127.0.0.1:{port}", operator.url)
    try:
        assert "is there" in ends[0].stderr.readline(), "he does not wait until the robot has missed him"
        assert "is there" in again.stderr.readline()
        assert "is silent" in ends[0].stderr.readline(), "of what was there before"
        robot.bus.publish("ALE_POSE", pose(7))
        wait_until(lambda: operator.on("ALE_POSE") == [pose(7)], 180, "the pose")
    finally:
        kill(again)


def test_a_host_that_cannot_be_found_is_a_failure_and_no_wrong_use(keys):
    done = subprocess.run([BINARIES / "ale-bridge", "--connect", "no-such-host.invalid:7700", "--keys", keys.operator()], capture_output=True, text=True,
                          timeout=180, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("ale-bridge: no-such-host.invalid:7700: ") and done.stderr.count("\n") == 1


@pytest.mark.parametrize("words, part", [
    ([], "--listen"), (["--listen", "1", "--connect", "a:1"], "--listen"), (["--listen", "0"], "--keys is missing"),
    (["--connect", "7700", "--keys", "alice.key"], "HOST:PORT"),
    (["--listen", "127.0.0.1:none", "--keys", "robot.keys"], "no such address"),
    (["--listen", "99999", "--keys", "robot.keys"], "no such address: 99999"),
    (["--listen", "0", "--keys", "robot.keys", "--send", "A:0"], "rate"),
    (["--listen", "0", "--keys", "robot.keys", "--send", "ALE_COMMAND"], "round for ever"), (["word"], "word"),
])
def test_wrong_use_is_told_in_one_line_and_ends_with_2(words, part, keys):
    done = subprocess.run([BINARIES / "ale-bridge", *words], capture_output=True, text=True, timeout=180, check=False, cwd=keys.folder)
    assert done.returncode == 2
    assert part in done.stderr and done.stderr.count("\n") == 1


def test_without_a_key_or_a_robot_to_believe_it_does_not_start(keys):
    keys.folder.joinpath("alice.key.robots").unlink()
    keys.folder.joinpath("robot.keys.secret").unlink()
    for words, part in ((["--connect", "127.0.0.1:1", "--keys", "alice.key"], "no robot is believed"),
                        (["--listen", "0", "--keys", "robot.keys"], "robot.keys.secret")):
        done = subprocess.run([BINARIES / "ale-bridge", *words], capture_output=True, text=True, timeout=180, check=False, cwd=keys.folder)
        assert done.returncode == 1 and part in done.stderr and done.stderr.count("\n") == 1
