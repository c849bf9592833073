"""What steers is authenticated: forged, replayed and other robots' statuses move nobody's hand and hide no answer."""
import pathlib
import subprocess
import time

import ale
import pytest

from at_hand import BINARIES
from commanded import Commanded, may_mount
from lcm_url import free_lcm_url
from robot_double import RobotDouble
from signing import Key, digest
from waiting import Ear, Pulse, wait_until

MINUTE_US = 60_000_000


def tool(name, *words, cwd=None):
    return subprocess.run([BINARIES / name if name.startswith("ale-") else name, *map(str, words)], stdin=subprocess.DEVNULL, text=True, timeout=180, cwd=cwd,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)


@pytest.fixture(name="url")
def an_lcm_url(multicast):
    return free_lcm_url()


@pytest.fixture(name="pulses")
def several_pulses():
    running = []
    yield lambda period_s, beat: running.append(Pulse(period_s, beat))
    for pulse in running:
        pulse.stop()


@pytest.fixture(name="commands")
def heard_commands(url):
    heard = []
    ear = Ear(url, ["ALE_COMMAND"], lambda _, data: heard.append(ale.command_t.decode(data)))
    yield heard
    ear.stop()


def double(url, folder, name="double", robot="robot.keys"):
    one = RobotDouble(url, boot=len(name) * 1000 + 1, own_key=folder / f"{robot}.secret")
    one.name = name
    return one


def forged_status(robot, ahead_us=0, boot=None):
    """As the robot's, with another clock or start."""
    status = robot.status()
    status.utime += ahead_us
    status.boot = status.boot if boot is None else boot
    return status.encode()


@pytest.mark.skipif(not may_mount(), reason="another list of users wants root, and a kernel that allows namespaces of mounts")
def test_the_services_own_key_is_the_services(tmp_path):
    """Made by root beside its list: else the firmware could not read it. Anywhere else it is root's."""
    users = tmp_path / "passwd"
    users.write_text(pathlib.Path("/etc/passwd").read_text(encoding="utf-8") + "ale-slam:x:64123:64123::/:/bin/false\n", encoding="utf-8")
    for folder, owner in (("ale-slam", 64123), ("elsewhere", 0)):
        (tmp_path / folder).mkdir()
        done = tool("unshare", "--mount", "sh", "-c", f"mount --bind {users} /etc/passwd && {BINARIES}/ale-keys --own rover --robot robot.keys",
                    cwd=tmp_path / folder)
        assert done.returncode == 0, done.stderr
        own = (tmp_path / folder / "robot.keys.secret").stat()
        assert (own.st_uid, own.st_mode & 0o777) == (owner, 0o600)


def test_the_robot_vouches_for_every_status_and_for_the_poses_it_sent(chain):
    robot = Commanded(chain)
    poses, vouched = {}, []
    ear = Ear(chain.url, ["ALE_POSE", "ALE_VOUCHED"], lambda channel, data: vouched.append(data) if channel == "ALE_VOUCHED"
              else poses.update({digest(data): ale.pose_t.decode(data).scan}))
    try:
        wait_until(lambda: len(vouched) >= 4, 180, "ALE_VOUCHED")
    finally:
        ear.stop()
    own = Key(robot.keys.with_name("robot.keys.secret"))
    messages = [ale.vouched_t.decode(data) for data in vouched]
    for data, message in zip(vouched, messages):
        assert bytes(message.signature) == own.sign(data[:-64]) and message.key == own.number
        assert message.status.robot == "rover" and message.clock_ppm == 1000000 and message.utime == message.status.utime
    counters = [message.counter for message in messages]
    assert counters == sorted(set(counters))
    last = messages[-1]
    known = [poses.get(number) == scan for scan, number in zip(last.pose_scan, last.pose_digest)]
    assert len(known) == 32 and sum(known) >= 8, "what was sent since the ear was there"


def test_a_forged_clock_does_not_move_the_operators(url, tmp_path, pulses, commands):
    """Status of the right robot and start, a minute ahead: nothing is signed that could be obeyed later."""
    tool("ale-keys", "alice", cwd=tmp_path)
    robot = double(url, tmp_path)
    pulses(0.5, robot.publish_status)
    pulses(0.02, lambda: robot.bus.publish("ALE_STATUS", forged_status(robot, MINUTE_US)))
    tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "--seconds", "1", "drive", "0.2", "0")
    tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "stop")
    wait_until(lambda: commands, 180, "commands")
    assert all(one.expiry_utime < time.time() * 1e6 + 10_000_000 for one in commands)


def test_forged_clocks_and_counters_do_not_keep_a_stop_from_the_robot(chain, pulses):
    robot = Commanded(chain)
    true = chain.listener.statuses[-1]

    def forge():
        for ahead_us, boot in ((MINUTE_US, true.boot), (2 ** 61, true.boot), (MINUTE_US, true.boot + 1)):
            status = ale.status_t.decode(true.encode())
            status.utime, status.boot = int(time.time() * 1e6) + ahead_us, boot
            chain.listener.bus.publish("ALE_STATUS", status.encode())

    pulses(0.02, forge)
    for _ in range(3):
        assert robot.send("--seconds", "0.3", "drive", "0.1", "0")[0]
        assert robot.send("stop") == (True, "rover: stopped by alice")


def test_ale_send_reports_the_answer_to_its_own_command_and_no_other(url, tmp_path, pulses):
    """The robot hears nothing of it; its status tells of a later command of the same operator that was obeyed."""
    tool("ale-keys", "alice", cwd=tmp_path)
    robot = double(url, tmp_path)
    robot.answer = ("alice", 2 ** 60, "stopped by alice")
    pulses(0.3, robot.publish_status)
    done = tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "stop")
    assert done.returncode == 1 and done.stdout == "" and "double: no answer" in done.stderr


def believe_rover_and_scout(folder):
    for name in ("rover", "scout"):
        line = tool("ale-keys", "--own", name, "--robot", f"{name}.keys", cwd=folder).stdout.strip()
        words = ("alice", "--robot", "rover.keys") if name == "rover" else ("--know", line, "--secret", "alice.key")
        assert tool("ale-keys", *words, cwd=folder).returncode == 0


def test_a_robot_that_is_believed_does_not_pass_for_another_one(url, tmp_path, pulses, commands):
    believe_rover_and_scout(tmp_path)
    pulses(0.3, double(url, tmp_path, "rover", "scout.keys").publish_status)
    done = tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "--robot", "rover", "record")
    assert done.returncode == 1 and "rover is heard, but nothing" in done.stderr and commands == []


def test_of_two_robots_the_one_that_is_named_is_commanded_and_none_that_is_not(url, tmp_path, pulses, commands):
    believe_rover_and_scout(tmp_path)
    for name in ("rover", "scout"):
        pulses(0.5, double(url, tmp_path, name, f"{name}.keys").publish_status)
    for _ in range(5):
        done = tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "record")
        assert done.returncode == 1 and "two robots are heard" in done.stderr and "--robot" in done.stderr
    assert commands == []
    done = tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "stop")
    assert done.returncode == 1 and "rover: no answer" in done.stderr and "scout: no answer" in done.stderr
    assert {(one.robot, one.verb) for one in commands} == {("rover", "stop"), ("scout", "stop")}
    commands.clear()
    for name in ("rover", "scout") * 3:
        tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "--robot", name, "record")
        wait_until(lambda: commands, 180, "the command")
        assert {one.robot for one in commands} == {name}
        commands.clear()


def test_two_robots_without_keys_are_told_apart_as_well(url, tmp_path, pulses, commands):
    tool("ale-keys", "alice", cwd=tmp_path)
    for path in tmp_path.glob("*.robots"):
        path.unlink()
    for name in ("rover", "scout"):
        pulses(0.5, double(url, tmp_path, name, "none").publish_status)
    done = tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "record")
    assert done.returncode == 1 and "two robots are heard" in done.stderr and commands == []
    done = tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "--robot", "scout", "stop")
    wait_until(lambda: commands, 180, "the stop")
    assert {one.robot for one in commands} == {"scout"}
    assert "nobody vouches for what scout says" in done.stderr


def test_a_forged_name_keeps_no_robot_from_standing(chain, pulses):
    """Where nobody vouches: heard first, and again and again. Who sends is told of the one that does not answer."""
    robot = Commanded(chain)
    robot.key.with_name("alice.key.robots").unlink()
    pulses(0.05, double(chain.url, chain.folder, "ghost", "none").publish_status)
    obeyed, words = robot.send("stop")
    assert not obeyed and "rover: stopped by alice" in words and "ghost: no answer" in words
    assert "two robots" in robot.send("--seconds", "0.3", "drive", "0.1", "0")[1]
    assert robot.send("--robot", "rover", "stop")[0]


def test_what_nobody_vouches_for_gets_no_command(url, tmp_path, pulses, commands):
    tool("ale-keys", "alice", cwd=tmp_path)
    pulses(0.3, double(url, tmp_path, robot="of-nobody").publish_status)
    done = tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "stop")
    assert done.returncode == 1 and "double is heard, but nothing" in done.stderr and commands == []


def test_a_replayed_word_of_the_robot_is_not_believed(url, tmp_path, pulses, commands):
    """Words of an hour ago, of this start and of an earlier one, among those of now, in any order."""
    tool("ale-keys", "alice", cwd=tmp_path)
    robot = double(url, tmp_path)

    def words(boot, count, ago_us):
        status = robot.status()
        status.boot, status.utime = boot, status.utime - ago_us
        return [robot.vouch(status) for _ in range(count)]

    old = words(7, 50, 60 * MINUTE_US) + words(robot.boot, 50, 60 * MINUTE_US)
    robot.publish_status()
    pulses(0.5, robot.publish_status)
    pulses(0.01, lambda: [robot.bus.publish("ALE_VOUCHED", old[k]) for k in (3, 60, 2, 40, 99, 0)])
    for _ in range(4):
        before = len(commands)
        tool("ale-send", "--keys", tmp_path / "alice.key", "--lcm-url", url, "stop")
        wait_until(lambda so_far=before: len(commands) > so_far, 180, "a stop")
        fresh = [one for one in commands[before:] if one.boot == robot.boot and abs(one.utime - time.time() * 1e6) < 9_000_000]
        assert fresh, "one of them is for the robot as it is"
