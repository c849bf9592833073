"""ale-console as its clients meet it: HTTP, the web socket, LCM; no browser (see test_console_page.py)."""
import json
import os
import random
import re
import shutil
import signal
import socket
import struct
import subprocess
import time
import urllib.error
import urllib.request

import ale
import lcm
import pytest

from robot_double import GRAPH, WALLS, RobotDouble
from at_hand import BINARIES
from waiting import Pulse, wait_until
from watching import Console, alice, commands, console, lcm_url, pulse, robot  # noqa: F401 (fixtures)
from web_socket import Refused, WebSocket


def run_console(*arguments):
    return subprocess.run([BINARIES / "ale-console", *arguments], capture_output=True, text=True, timeout=180, check=False)


def one_line(text):
    return len(text.strip().splitlines()) == 1


@pytest.mark.parametrize("arguments", [["--http", "nonsense"], ["--http", "127.0.0.1:70000"], ["--http", "127.0.0.1:8x"],
                                       ["--http", ":8080"], ["--token", "short"], ["--token", "with blanks in it"], ["--token", "abcdefghijkl1", "--token-file", "f"],
                                       ["--cert", "f"], ["--key", "f"], ["--origin", "robot.example"], ["--origin", "https://a/b"], ["--http", "no.such.host.invalid:80"], ["--unknown"], ["word"]])
def test_wrong_use_is_told_in_one_line_and_ends_with_2(arguments):
    done = run_console(*arguments)
    assert done.returncode == 2
    assert one_line(done.stderr) and done.stdout == ""


def test_a_port_that_is_taken_is_named():
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        done = run_console("--http", f"127.0.0.1:{port}")
    assert done.returncode == 1
    assert one_line(done.stderr) and str(port) in done.stderr and "in use" in done.stderr


def test_keys_that_cannot_be_read_are_named(tmp_path):
    done = run_console("--keys", str(tmp_path / "absent"))
    assert done.returncode == 1 and "absent" in done.stderr and one_line(done.stderr)


def command(page, *words):
    page.send(json.dumps({"type": "command", "words": words}))
    return page.wait_for("sent")


def test_a_command_of_the_page_leaves_signed_for_this_start_of_this_robot(alice, robot, commands):
    page = WebSocket(alice.url)
    assert page.wait_for("hello")["operator"] == "alice"
    assert "no robot" in command(page, "stop")["refusal"]
    robot.publish_status()
    assert page.wait_for("status")["takes_commands"] is True
    numbers = [command(page, "relocate", "1.5", "-2", "0.1")["number"], command(page, "drive", "0.1", "0")["number"]]
    sent = commands(2)
    assert [(c.verb, c.args) for c in sent] == [("relocate", ["1.5", "-2", "0.1"]), ("drive", ["0.1", "0"])]
    assert [c.counter for c in sent] == numbers and numbers[1] > numbers[0]
    for one in sent:
        assert (one.robot, one.boot, one.operator_name, one.num_signature) == ("double", robot.boot, "alice", 64)
        assert one.utime < one.expiry_utime <= one.utime + 10_000_000


def test_what_others_say_in_the_robots_name_changes_nothing_that_is_signed(alice, robot, commands):
    """Clocks, starts and names that nobody vouches for, before the robot's own word and after it."""
    def forge():
        for boot, ahead_us in ((robot.boot, 60_000_000), (robot.boot + 1, 0), (77, 2 ** 60)):
            status = robot.status()
            status.boot, status.utime = boot, status.utime + ahead_us
            robot.bus.publish("ALE_STATUS", status.encode())

    page = WebSocket(alice.url)
    forge()
    told = page.wait_for("status")
    assert told["vouched"] is False and "no robot whose key is known vouches" in told["warnings"][0]
    for words in (("stop",), ("drive", "0.1", "0")):
        assert "no robot whose key is known" in command(page, *words)["refusal"]
    robot.publish_status()
    while not page.wait_for("status")["vouched"]:
        pass
    for words in (("drive", "0.1", "0"), ("stop",)) * 20:
        forge()
        assert command(page, *words)["refusal"] is None
    now = time.time() * 1e6
    for one in commands(40):
        assert one.boot == robot.boot and one.robot == "double" and abs(one.utime - now) < 10_000_000


def test_poses_that_are_not_the_robots_own_are_told_as_such_and_take_the_place_of_none(alice, robot):
    """Ten a second, each with a forged one behind it that is numbered 6 ahead. As of a scanner that turns, numbers keep pace
    with the clock, whatever the machine has to do: the console takes for forged what is numbered ahead of that."""
    page = WebSocket(alice.url)
    robot.publish_status()
    while not page.wait_for("status")["vouched"]:
        pass
    begin = time.monotonic()

    def beat():
        due = int((time.monotonic() - begin) * 10)
        if due // 10 > robot.scan // 10:
            robot.publish_status()
        robot.scan = due
        robot.publish_pose()
        other = robot.pose()
        other.scan, other.map_x = robot.scan + 6, 90.0
        robot.bus.publish("ALE_POSE", other.encode())

    both = Pulse(0.1, beat)
    try:
        until(page, lambda message: message["type"] == "status" and any("not the robot's own" in line for line in message["warnings"]), "a warning")
        first, sent_before = robot.scan + 2, len(both.beats)
        taken = until(page, lambda message: message["type"] == "pose" and message["map"][0] < 80 and message["scan"] >= first + 40, "its own poses")
        sent = len(both.beats) - sent_before
    finally:
        both.stop()
    shown = [message for message in taken if message["type"] == "pose" and message["scan"] >= first]
    forged = [pose["scan"] for pose in shown if pose["map"][0] > 80]
    assert len(forged) <= 3, "some that were on their way when it was found out"
    assert 45 * (len(shown) - len(forged)) >= 40 * sent, "its own are shown, nearly every one"


def test_poses_of_another_program_take_the_place_of_none_whatever_their_number(alice, robot, lcm_url):
    """Each with the number that the robot's next one will have. They are told, and then the robot alone is shown."""
    bus, page = lcm.LCM(lcm_url), WebSocket(alice.url)

    def beat():
        if robot.scan % 10 == 0:
            robot.publish_status()
        robot.publish_pose()
        other = robot.pose()
        other.scan, other.map_x = robot.scan + 1, 90.0
        bus.publish("ALE_POSE", other.encode())
        robot.scan += 1

    both = Pulse(0.1, beat)
    try:
        until(page, lambda message: message["type"] == "status" and any("not the robot's own" in line for line in message["warnings"]), "a warning")
        first = robot.scan + 2
        taken = until(page, lambda message: message["type"] == "pose" and message["scan"] >= first + 40, "poses")
    finally:
        both.stop()
    shown = [message for message in taken if message["type"] == "pose" and message["scan"] >= first]
    assert not [pose["scan"] for pose in shown if pose["map"][0] > 80]
    assert len(shown) > 30, "nearly every one"


def test_one_page_drives_at_a_time(alice, robot, commands):
    robot.publish_status()
    first, second = WebSocket(alice.url), WebSocket(alice.url)
    first.wait_for("status")
    assert command(first, "drive", "0.1", "0")["refusal"] is None
    assert "another page" in command(second, "drive", "0.1", "0")["refusal"]
    assert command(second, "stop")["refusal"] is None  # anybody may stop it
    assert [c.verb for c in commands(2)] == ["drive", "stop"]


@pytest.mark.parametrize("words", [("drive\0", "0.1", "0"), ("drive", "0.1\n", "0"), ("st\x1bop",), ("st\u00f6p",), ("\x7f",)])
def test_words_with_characters_that_no_command_has_are_not_sent(alice, robot, commands, words):
    """A NUL ends a word for some: with it a second page drove beside the first."""
    robot.publish_status()
    first, second = WebSocket(alice.url), WebSocket(alice.url)
    first.wait_for("status")
    assert command(first, "drive", "0.1", "0")["refusal"] is None
    assert "character" in command(second, *words)["refusal"]
    assert command(first, "stop")["refusal"] is None
    assert [c.verb for c in commands(2)] == ["drive", "stop"]


def test_a_console_without_a_key_sends_nothing(console, robot):
    page = WebSocket(console.url)
    assert page.wait_for("hello")["operator"] is None
    robot.publish_status()
    page.wait_for("status")
    assert "--keys" in command(page, "stop")["refusal"]


@pytest.mark.parametrize("http, options", [("127.0.0.1:0", ["--token", "abcdefghijkl1"]), ("0.0.0.0:0", []), ("127.0.0.1:0", [])],
                         ids=["given", "its own, reached from elsewhere", "its own, on the loopback"])
def test_page_and_web_socket_are_for_those_who_have_the_token(lcm_url, http, options):
    running = Console(lcm_url, http, *options)
    address, token = re.sub("//[^:]+:", "//127.0.0.1:", running.url).split("?token=")
    assert len(token) >= 12
    for wrong in ("", "?token=", "?token=" + token[:-1], "?token=" + token + "x", "?token=" + "x" * len(token)):
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(address + wrong, timeout=180)
        assert refused.value.code == 403
        with pytest.raises(Refused, match="403"):
            WebSocket(address + wrong)
    assert urllib.request.urlopen(f"{address}?token={token}", timeout=180).status == 200
    WebSocket(f"{address}?token={token}").wait_for("hello")
    assert running.end() == 0


@pytest.mark.skipif(os.geteuid() != 0 or shutil.which("unshare") is None, reason="needs root and unshare to take the network away")
def test_without_a_multicast_route_it_says_so():
    done = subprocess.run(["unshare", "-n", BINARIES / "ale-console", "--http", "127.0.0.1:0"], capture_output=True,
                          text=True, timeout=180, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("ale-console: LCM: no route for multicast") and done.stderr.count("\n") == 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_0(lcm_url, number):
    running = Console(lcm_url)
    watching = WebSocket(running.url)
    watching.wait_for("hello")
    assert running.end(number) == 0


def test_the_page_comes_whole_and_bound_to_this_origin(console):
    with console.get() as answer:
        assert answer.headers["content-type"] == "text/html; charset=utf-8"
        assert "default-src 'none'" in answer.headers["content-security-policy"]
        page = answer.read().decode()
    assert page.rstrip().endswith("</html>")
    for name, kind in (("console.css", "text/css"), ("console.js", "text/javascript")):
        assert name in page
        with console.get(name) as answer:
            assert answer.headers["content-type"].startswith(kind)
            assert len(answer.read()) == int(answer.headers["content-length"])


@pytest.mark.parametrize("path", ["absent.js", "../main.cpp", "%2e%2e/main.cpp", "page/index.html"])
def test_nothing_else_is_served(console, path):
    with pytest.raises(urllib.error.HTTPError) as refused:
        console.get(path)
    assert refused.value.code in (403, 404)


def test_a_web_socket_from_a_foreign_page_is_refused(console):
    for origin, host in (("http://evil.example", None), ("null", None), (console.origin + "1", None), (console.origin.replace("http", "https"), None),
                         ("http://evil.example:80", "evil.example:80")):  # the last: a name made to resolve to us
        with pytest.raises(Refused, match="403"):
            WebSocket(console.url, origin=origin, host=host)


def test_a_web_socket_from_its_own_page_is_accepted(console):
    WebSocket(console.url, origin=console.origin).wait_for("hello")


def test_a_pose_arrives_as_it_was_sent(console, robot):
    watching = WebSocket(console.url)
    watching.wait_for("hello")
    sent = robot.pose()
    sent.state, sent.predicted, sent.scan = 1, True, 17
    robot.bus.publish("ALE_POSE", sent.encode())
    pose = watching.wait_for("pose")
    assert (pose["scan"], pose["state"], pose["predicted"]) == (17, "weak", True)
    assert pose["map"] == pytest.approx([sent.map_x, sent.map_y, sent.map_theta], abs=1e-4)
    assert pose["cov"] == pytest.approx(sent.cov, rel=1e-5)
    assert pose["latency_us"] == sent.utime + sent.age_us - sent.arrival_utime
    assert pose["stages_us"] == pytest.approx([ns / 1000 for ns in sent.stage_ns], abs=0.1)


def test_the_map_is_whole_only_with_all_its_parts(console, robot):
    watching = WebSocket(console.url)
    watching.wait_for("hello")
    parts = list(robot.map_parts(version=1))
    assert len(parts) > 1
    robot.bus.publish("ALE_MAP", parts[0].encode())  # the rest is lost on the way
    for part in reversed(list(robot.map_parts(version=2))):
        robot.bus.publish("ALE_MAP", part.encode())
    received = watching.wait_for("map")
    assert received["version"] == 2
    assert sorted((l["x1"], l["y1"], l["x2"], l["y2"]) for l in received["lines"]) == sorted(WALLS)


def test_which_walls_are_in_another_map_is_told_before_or_after_them(console, robot):
    watching = WebSocket(console.url)
    watching.wait_for("hello")

    def apart(message):
        return sorted(line["id"] for line in message["lines"] if line.get("map_id") == 1)
    robot.publish_pieces([1, 3], version=1)
    robot.publish_map(version=1)
    assert apart(watching.wait_for("map", lambda m: m["version"] == 1)) == [1, 3]
    robot.publish_map(version=2)
    assert apart(watching.wait_for("map", lambda m: m["version"] == 2)) == []
    robot.publish_pieces([2], version=2)
    assert apart(watching.wait_for("map", lambda m: m["version"] == 2)) == [2]


def test_keyframes_and_loops_arrive_as_they_were_sent(console, robot):
    watching = WebSocket(console.url)
    robot.step()
    robot.publish_graph(apart=4, left_out=7)
    graph = watching.wait_for("graph")
    assert [each["at"] for each in graph["keyframes"]] == [pytest.approx(place, abs=1e-3) for place in GRAPH]
    assert [each["map_id"] for each in graph["keyframes"]] == [0] * 18 + [1] * 4
    assert [k for k, each in enumerate(graph["keyframes"]) if not each["tied"]] == [0, 18]
    assert graph["loops"] == [{"from": 0, "to": 20, "kind": "closed"}, {"from": 1, "to": 18, "kind": "recognised"}]
    assert graph["left_out"] == [7, 0]


def test_the_map_and_the_wheels_of_every_pose_arrive(console, robot):
    watching = WebSocket(console.url)
    watching.wait_for("hello")
    robot.map_id, robot.maps, robot.wheels = 3, 2, "reversed"
    robot.publish_tracking()
    tracking = watching.wait_for("tracking")
    assert (tracking["map_id"], tracking["maps"], tracking["wheels"], tracking["wheel_faults"]) == (3, 2, "reversed", 1)


def test_scan_and_features_keep_their_geometry(console, robot):
    watching = WebSocket(console.url)
    watching.wait_for("hello")
    robot.step()
    scan = watching.wait_for("scan")
    assert len(scan["ranges_mm"]) == 682 and scan["ranges_mm"][100] == 0 and scan["ranges_mm"][340] > 0
    assert [7, 1] in scan["codes"]
    assert scan["step"] == pytest.approx(0.006135923, abs=1e-8)
    robot.step()
    features = watching.wait_for("features")
    assert len(features["lines"]) == 5 and len(features["corners"]) == 3
    assert features["corners"][0]["kind"] == "concave"


def test_who_comes_late_gets_map_status_and_the_whole_trail(console, robot):
    first = WebSocket(console.url)
    robot.drive(40)
    first.wait_for("pose", lambda pose: pose["scan"] == 39)
    late = WebSocket(console.url)
    wanted = {"map", "status", "trail", "pose", "tracking", "features", "scan"}
    while wanted:
        message = late.next()
        late.got()
        if message["type"] == "trail":
            assert message["anew"] and len(message["points"]) > 40
        wanted.discard(message["type"])


def test_a_restarted_robot_is_shown_from_anew(console, robot):
    watching = WebSocket(console.url)
    robot.drive(20)
    watching.wait_for("pose", lambda pose: pose["scan"] == 19)
    robot.scan, robot.boot = 0, 2
    robot.step()
    watching.wait_for("hello")
    trail = watching.wait_for("trail", lambda trail: trail["anew"])
    assert len(trail["points"]) <= 4


def announce(robot, name, process):
    """As its firmware does."""
    message = ale.speaker_t()
    message.boot, message.process = robot.boot, process
    message.host, message.robot = b"lab\x1b".ljust(64, b"\0"), name.encode().ljust(32, b"\0")
    robot.bus.publish("ALE_SPEAKER", message.encode())


def until(watching, condition, what):
    """All that arrives until the condition holds for one of the messages."""
    taken = []

    def comes():
        taken.append(watching.next())
        watching.got()
        return condition(taken[-1])

    wait_until(comes, 60, what)
    return taken


def test_two_robots_on_the_same_channels_are_told_apart(console, robot, lcm_url):
    """The first one is shown for as long as it speaks, and of the other it is told who that is."""
    other = RobotDouble(lcm_url, boot=77)
    other.maps = 3
    watching = WebSocket(console.url)
    robot.drive(12)
    for _ in range(25):
        other.step()
        robot.step()
        announce(other, "second", 4711)
        announce(robot, "double", 42)
        time.sleep(0.02)
    taken = until(watching, lambda message: message["type"] == "status" and message["warnings"], "a warning")
    taken += until(watching, lambda message: message["type"] == "link" and message["poses"] >= 37, "the robot's poses")
    assert taken[-1]["poses"] == 37 and taken[-1]["lost_poses"] == 0
    warnings = [words for message in taken if message["type"] == "status" for words in message["warnings"]]
    assert any("second on lab?, process 4711" in words for words in warnings)
    assert not any("process 42" in words for words in warnings)
    assert {message["maps"] for message in taken if message["type"] == "tracking"} == {1}
    assert [message["type"] for message in taken].count("hello") == 1, "nothing was forgotten"


def test_when_the_robot_that_is_shown_has_gone_the_other_one_is(console, robot, lcm_url):
    other = RobotDouble(lcm_url, boot=77)
    watching = WebSocket(console.url)
    robot.drive(12)
    watching.wait_for("pose", lambda pose: pose["scan"] == 11)
    pulse = Pulse(0.02, other.step)
    try:
        watching.wait_for("status", lambda status: status["boot"] == "77", 60)
    finally:
        pulse.stop()


def test_the_prefix_in_its_url_chooses_the_robot(lcm_url, robot):
    mine = Console(f"{lcm_url}&prefix=rover1.")
    try:
        watching = WebSocket(mine.url)
        watching.wait_for("hello")
        for scan, prefix in ((5, ""), (6, "rover2."), (7, "rover1.")):
            pose = robot.pose()
            pose.scan = scan
            robot.bus.publish(f"{prefix}ALE_POSE", pose.encode())
        assert watching.wait_for("pose")["scan"] == 7
    finally:
        assert mine.end() == 0


def test_an_overtaken_pose_does_not_turn_back_time(console, robot):
    watching = WebSocket(console.url)
    for scan in (5, 7, 6, 8):
        robot.scan = scan
        robot.publish_pose()
    assert watching.wait_for("pose", lambda pose: pose["scan"] == 8)
    assert watching.wait_for("link", lambda link: link["poses"] == 3)["lost_poses"] == 1


def test_a_client_that_does_not_keep_up_skips_to_the_newest(console, robot):
    watching = WebSocket(console.url)
    watching.wait_for("hello")

    def next_pose():
        robot.publish_pose()
        robot.scan += 1

    poses = Pulse(0.005, next_pose)
    backlog = [watching.next() for _ in range(32)]  # never more on the way
    held_back = robot.scan
    wait_until(lambda: robot.scan > held_back + 10, 180, "more poses")
    poses.stop()
    watching.socket.settimeout(0.7)
    with pytest.raises(TimeoutError):
        watching.next()
    watching.socket.settimeout(180)
    watching.got()
    assert watching.wait_for("pose", lambda pose: pose["scan"] == robot.scan - 1)
    assert max(message["scan"] for message in backlog if message["type"] == "pose") < robot.scan - 2
    assert watching.wait_for("link", lambda link: link["skipped"] > 0)


@pytest.mark.parametrize("text", ["", "nonsense", "[1]", '{"type":"got"}', '{"type":"got","count":-1}',
                                  '{"type":"got","count":1000000}', '{"type":"drive","v":1}', "x" * 2000])
def test_a_client_that_talks_nonsense_is_hung_up_on_and_nobody_else(console, robot, text):
    other, rude = WebSocket(console.url), WebSocket(console.url)
    rude.send(text)
    with pytest.raises(OSError):
        while True:
            rude.next()
    robot.publish_pose()
    assert other.wait_for("pose")["scan"] == 0


def empty_scan():
    scan = ale.scan_t()
    scan.codes = b""
    return scan


def hostile_messages():
    """Bytes that no honest robot sends: cut, with counts beyond reason, with numbers that are none."""
    whole = {"ALE_POSE": ale.pose_t(), "ALE_FEATURES": ale.features_t(), "ALE_SCAN": empty_scan(),
             "ALE_MAP": ale.map_t(), "ALE_STATUS": ale.status_t(), "ALE_TRACKING": ale.tracking_t(),
             "ALE_MAP_PIECES": ale.map_pieces_t(), "ALE_GRAPH": ale.graph_t()}
    for channel, message in whole.items():
        data = message.encode()
        yield channel, b""
        yield channel, data[:-1]
        yield channel, b"\0" * len(data)
    counts = {"ALE_FEATURES": 8 + 8 + 4 + 12, "ALE_SCAN": 8 + 8 + 4 * 10, "ALE_MAP": 8 + 8 + 4 + 4, "ALE_MAP_PIECES": 8 + 8 + 4 + 4,
              "ALE_GRAPH": 8 + 8 + 4 * 3}
    for channel, offset in counts.items():
        for count in (-1, 1 << 20, 0x7FFFFFFF):
            data = bytearray(whole[channel].encode())
            struct.pack_into(">i", data, offset, count)
            yield channel, bytes(data)
    for name in ("map_x", "map_theta"):
        pose = ale.pose_t()
        setattr(pose, name, float("nan"))
        yield "ALE_POSE", pose.encode()
    pose = ale.pose_t()
    pose.state = 7
    yield "ALE_POSE", pose.encode()


def test_hostile_messages_are_counted_and_survived(console, robot):
    watching = WebSocket(console.url)
    watching.wait_for("hello")
    count = 0
    for channel, data in hostile_messages():
        robot.bus.publish(channel, data)
        count += 1
        time.sleep(0.002)
    assert watching.wait_for("link", lambda link: link["malformed"] == count)
    robot.publish_pose()
    assert watching.wait_for("pose")["scan"] == 0


def test_random_bytes_are_survived(console, robot):
    watching = WebSocket(console.url)
    rng = random.Random(4)
    prints = {"ALE_POSE": ale.pose_t(), "ALE_MAP": ale.map_t(), "ALE_STATUS": ale.status_t(), "ALE_SCAN": empty_scan()}
    for _ in range(400):
        channel, message = rng.choice(list(prints.items()))
        fingerprint = message.encode()[:8]
        robot.bus.publish(channel, fingerprint + rng.randbytes(rng.randrange(300)))
        time.sleep(0.0005)
    robot.publish_pose()
    assert watching.wait_for("link", lambda link: link["malformed"] > 100)
    assert console.process.poll() is None


HOUR_US = 3_600_000_000


@pytest.mark.parametrize("boots_on", [5, 0], ids=["of an earlier start", "of this start"])
def test_a_stop_that_was_made_by_a_recorded_word_is_made_again_by_the_robots_own(alice, robot, commands, boots_on):
    page = WebSocket(alice.url)
    old = robot.status()
    old.boot, old.utime = robot.boot + boots_on, old.utime - HOUR_US
    robot.bus.publish("ALE_VOUCHED", robot.vouch(old))
    while not page.wait_for("status")["vouched"]:
        pass
    assert command(page, "stop")["refusal"] is None
    robot.publish_status()

    def of_now(so_far):
        return [one for one in so_far if one.boot == robot.boot and one.utime > old.utime + HOUR_US // 2]
    assert [one.verb for one in of_now(commands(of_now))] == ["stop"]


@pytest.fixture(name="trusting")
def a_console_that_believes_everybody(lcm_url, tmp_path):
    """And a robot whose word nobody has vouched for."""
    subprocess.run([BINARIES / "ale-keys", "alice"], cwd=tmp_path, check=True, capture_output=True, timeout=180)
    (tmp_path / "alice.key.robots").unlink()
    (tmp_path / "robot.keys.secret").unlink()
    running = Console(lcm_url, "127.0.0.1:0", "--keys", str(tmp_path / "alice.key"))
    yield running
    assert running.end() == 0


def forged_by_nobody(double, **different):
    status = double.status()
    for name, value in different.items():
        setattr(status, name, value)
    double.bus.publish("ALE_STATUS", status.encode())


def test_a_stop_that_was_made_by_a_forged_start_is_made_again_where_nobody_vouches(trusting, robot, commands):
    page = WebSocket(trusting.url)
    forged_by_nobody(robot, boot=robot.boot + 5)
    page.wait_for("status")
    assert command(page, "stop")["refusal"] is None
    commands(1)
    robot.publish_status()
    heard = commands(lambda so_far: any(one.boot == robot.boot for one in so_far))
    assert {(one.verb, one.boot) for one in heard} == {("stop", robot.boot + 5), ("stop", robot.boot)}


def test_a_stop_goes_to_every_robot_that_is_heard_also_after_it(trusting, robot, commands):
    """A name that somebody has forged is heard first: the robot itself is a rival, and stops none the less."""
    page = WebSocket(trusting.url)
    forged_by_nobody(robot, boot=7, robot="ghost")
    page.wait_for("status")
    assert command(page, "stop")["refusal"] is None
    robot.publish_status()
    heard = commands(lambda so_far: any(one.robot == "double" for one in so_far))
    assert {(one.verb, one.robot, one.boot) for one in heard} == {("stop", "ghost", 7), ("stop", "double", robot.boot)}
    forged_by_nobody(robot, boot=7, robot="ghost")
    assert any("STOP goes to all" in line for line in page.wait_for("status")["warnings"])
    assert "two robots" in command(page, "drive", "0.1", "0")["refusal"]
    before = len(heard)
    assert command(page, "stop")["refusal"] is None
    assert {one.robot for one in commands(before + 2)[before:]} == {"ghost", "double"}
