"""ale-foxglove: live, as a client of its WebSocket sees it; recordings turned into each other, as `mcap` and `rosbags` read them."""
import json
import math
import os
import pathlib
import struct
import subprocess
import time
import zlib

import ale
import lcm
import pytest

from at_hand import BINARIES, LONG, ROOT
from foxglove_client import FoxgloveClient
from robot_double import GRAPH, WALLS
from watching import commands, lcm_url, pulse, robot  # noqa: F401 (fixtures)

pytest.importorskip("foxglove", reason="PyPI's foxglove-sdk is not here")
mcap_reader = pytest.importorskip("mcap.reader", reason="PyPI's mcap is not here")
stream_reader = pytest.importorskip("mcap.stream_reader", reason="PyPI's mcap is not here")
protobuf = pytest.importorskip("mcap_protobuf.decoder", reason="PyPI's mcap-protobuf-support is not here")

PYTHON_FIRST = {**os.environ, "PATH": f"{pathlib.Path(os.sys.executable).parent}:{os.environ['PATH']}"}
LOG = ROOT / "tests/digest/apartment.log.gz"


def run(*words):
    return subprocess.run([BINARIES / "ale-foxglove", *map(str, words)], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300,
                          check=False, env=PYTHON_FIRST)


def converted(source, out):
    done = run("convert", source, out)
    assert done.returncode == 0, done.stderr
    return out


class Bridge:
    def __init__(self, lcm_url, *words):
        self.process = subprocess.Popen([BINARIES / "ale-foxglove", "--lcm-url", lcm_url, "--port", "0", *map(str, words)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=PYTHON_FIRST)
        self.url = self.process.stdout.readline().strip()
        self.said = ""

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            self.said = self.process.communicate(timeout=180)[1]
        return self.process.returncode


@pytest.fixture
def bridge(lcm_url):
    started = []

    def start(*words):
        started.append(Bridge(lcm_url, *words))
        return started[-1]
    yield start
    assert [each.end() for each in started] == [0] * len(started)


@pytest.fixture
def alice(tmp_path):
    subprocess.run([BINARIES / "ale-keys", "alice"], cwd=tmp_path, check=True, capture_output=True, timeout=180)
    return tmp_path / "alice.key"


class Decoder:
    """By the schema that comes with the channel, and not by ours."""

    def __init__(self):
        self.factory = protobuf.DecoderFactory()

    def __call__(self, schema, channel, message):
        if channel.message_encoding == "json":
            return json.loads(message.data)
        return self.factory.decoder_for(channel.message_encoding, schema)(message.data)


def check_sums(path):
    """Every sum is there, and right: of chunks and of the data section, attachments in it, as mcap's reader of streams checks them; of
    the summary, which it does not."""
    with open(path, "rb") as file:
        sums = [getattr(record, name) for record in stream_reader.StreamReader(file, validate_crcs=True, emit_chunks=True).records
                for name in ("uncompressed_crc", "data_section_crc", "summary_crc") if hasattr(record, name)]
    assert len(sums) >= 2 and all(sums)
    data = path.read_bytes()
    summary_start, _, summary_sum = struct.unpack("<QQI", data[-28:-8])
    assert zlib.crc32(data[summary_start:-12]) == summary_sum


def messages(path):
    """{topic: [(schema's name, time, message)]} with every sum checked; by the index the same as from front to back."""
    found, decode, count = {}, Decoder(), 0
    check_sums(path)
    with open(path, "rb") as file:
        for schema, channel, message in mcap_reader.NonSeekingReader(file, validate_crcs=True).iter_messages():
            found.setdefault(channel.topic, []).append((schema.name, message.log_time, decode(schema, channel, message)))
            count += 1
    with open(path, "rb") as file:
        assert sum(1 for _ in mcap_reader.make_reader(file, validate_crcs=True).iter_messages()) == count
    return found


TWIST = {"linear": {"x": 0.25, "y": 0, "z": 0}, "angular": {"x": 0, "y": 0, "z": -0.5}}


def pose_message(x, y, theta, frame="map"):
    return {"header": {"frame_id": frame}, "pose": {"position": {"x": x, "y": y, "z": 0}, "orientation": {
        "x": 0, "y": 0, "z": math.sin(theta / 2), "w": math.cos(theta / 2)}}}


def test_a_client_gets_scan_lines_map_frames_and_plots_live(bridge, pulse):
    client = FoxgloveClient(bridge().url)
    wanted = {"/scan": "foxglove.LaserScan", "/lines": "foxglove.SceneUpdate", "/corners": "foxglove.SceneUpdate",
              "/tf": "foxglove.FrameTransforms", "/pose": "foxglove.PoseInFrame", "/signals": "ale.signals", "/occupancy": "foxglove.Grid"}
    for topic, schema in wanted.items():
        client.subscribe(topic)
        assert client.channels[topic]["schemaName"] == schema
    for topic in wanted:
        assert len(client.wait_for(topic)) > 10
    assert json.loads(client.wait_for("/signals"))["sigma"]["x"] == pytest.approx(0.004, rel=1e-3)
    client.close()


def test_what_is_shown_is_recorded_and_is_what_the_robot_said(bridge, robot, tmp_path):
    running = bridge("--record", tmp_path / "live.mcap")
    robot.drive(11)
    robot.publish_map()
    robot.publish_plan(3, "drives to 2.00 1.00", place=(2, 1), path=[(0.5, -0.6), (1, 0), (2, 1)])
    robot.publish_graph(apart=4)
    robot.drive(3)
    assert running.end() == 0
    found = messages(tmp_path / "live.mcap")
    frames = {(each.parent_frame_id, each.child_frame_id) for _, _, message in found["/tf"] for each in message.transforms}
    assert frames == {("map", "odom"), ("odom", "base_link"), ("base_link", "laser")}
    schema, _, scan = found["/scan"][-1]
    assert schema == "foxglove.LaserScan" and len(scan.ranges) == 682 and math.isnan(scan.ranges[100])
    assert scan.start_angle == pytest.approx(-340 * math.tau / 1024)
    walls = found["/map"][-1][2].entities[0].lines[0].points
    assert len(walls) == 2 * len(WALLS) and (walls[0].x, walls[0].y) == pytest.approx(WALLS[0][:2])
    assert len(found["/lines"][-1][2].entities[0].lines[0].points) == 10 and len(found["/corners"][-1][2].entities[0].spheres) == 3
    way = found["/plan"][-1][2].entities[0]
    assert [(point.x, point.y) for point in way.lines[0].points] == [(0.5, pytest.approx(-0.6)), (1, 0), (2, 1)]
    assert (way.spheres[0].pose.position.x, way.spheres[0].pose.position.y) == (2, 1) and way.frame_id == "map"
    graph = found["/graph"][-1][2].entities[0]
    assert [(dot.pose.position.x, dot.pose.position.y) for dot in graph.spheres] == [pytest.approx(place[:2]) for place in GRAPH]
    assert [len(line.points) // 2 for line in graph.lines] == [17, 3, 1, 1], "neighbours in two maps, two kinds of loops"
    assert (graph.lines[3].points[1].x, graph.lines[3].points[1].y) == pytest.approx(GRAPH[20][:2]) and graph.frame_id == "map"
    assert "streaming" in {message.message for _, _, message in found["/log"]}
    assert found["/health"][-1][2]["counters"]["bad_checksum"] == 3
    assert {schema for schema, _, _ in found["/occupancy"]} == {"foxglove.Grid"}
    check_cells(found["/occupancy"][-1][2])


def check_cells(grid):
    """Of the double's two rooms: walls, what it stands in, what lies behind a wall."""
    assert grid.frame_id == "map" and (grid.cell_size.x, grid.cell_size.y) == (0.05, 0.05)
    assert [(field.name, field.offset) for field in grid.fields] == [("red", 0), ("green", 1), ("blue", 2), ("alpha", 3), ("occupancy", 4)]
    assert grid.cell_stride == 5 and grid.row_stride == 5 * grid.column_count and len(grid.data) % grid.row_stride == 0

    def at(x, y):
        column, row = (math.floor((to - of) / 0.05) for to, of in ((x, grid.pose.position.x), (y, grid.pose.position.y)))
        return grid.data[row * grid.row_stride + column * 5:][:5]
    for x1, y1, x2, y2 in WALLS:  # on the border of two cells
        about = [at((x1 + x2) / 2 + dx, (y1 + y2) / 2 + dy) for dx in (-0.02, 0.02) for dy in (-0.02, 0.02)]
        assert bytes((235, 235, 235, 255, 100)) in about, "a wall is bright"
    assert at(0.5, 0.2) == bytes((110, 125, 140, 90, 0)), "free is faint"
    assert at(0.05, 0.95) == at(-2.3, 0) == bytes((0, 0, 0, 0, 255)), "within the pillar, and outside: nothing is drawn"


def test_one_robot_among_several_has_topics_frames_and_commands_of_its_own(bridge, robot, pulse, commands, alice, tmp_path):
    running = bridge("--namespace", "rover1", "--record", tmp_path / "live.mcap", "--keys", alice)
    client = FoxgloveClient(running.url)
    client.subscribe("/rover1/tf")
    client.wait_for("/rover1/tf")
    for topic, frame in (("/goal_pose", "rover1/map"), ("/rover1/goal_pose", "map")):
        client.publish(topic, "geometry_msgs/PoseStamped", pose_message(1, 1, 0, frame=frame))
    end = time.monotonic() + 120
    while not any(each.verb == "goto" for each in commands(0)):
        assert time.monotonic() < end
        client.publish("/rover1/goal_pose", "geometry_msgs/PoseStamped", pose_message(2, 1, 0, frame="rover1/map"))
        commands(lambda so_far: any(each.verb == "goto" for each in so_far), seconds=0.2)
    assert all(each.args == ["2.000000", "1.000000"] for each in commands(0) if each.verb == "goto")
    robot.publish_map()
    assert "/rover1/ale/command" in client.services
    client.close()
    assert running.end() == 0
    assert '/rover1/goal_pose: refused: a pose in the frame "map": only those in "rover1/map" are understood' in running.said
    found = messages(tmp_path / "live.mcap")
    assert {topic[:8] for topic in found} == {"/rover1/"}
    frames = {(each.parent_frame_id, each.child_frame_id) for _, _, message in found["/rover1/tf"] for each in message.transforms}
    assert frames == {("rover1/map", "rover1/odom"), ("rover1/odom", "rover1/base_link"), ("rover1/base_link", "rover1/laser")}
    for topic in ("/rover1/lines", "/rover1/corners"):
        assert {each.frame_id for _, _, message in found[topic] for each in message.entities} == {"rover1/laser"}
    assert found["/rover1/scan"][0][2].frame_id == "rover1/laser" and found["/rover1/pose"][0][2].frame_id == "rover1/map"
    assert found["/rover1/occupancy"][-1][2].frame_id == "rover1/map"


@pytest.mark.parametrize("words", [["--namespace", "a b"], ["--namespace", "/a"], ["layout", "--namespace", "a/", "F"], ["layout"], ["--port", "x"]])
def test_wrong_use_ends_with_2_and_one_line(words):
    done = run(*words)
    assert done.returncode == 2 and done.stderr.count("\n") == 1


def test_what_was_recorded_live_comes_back_as_the_robot_said_it_and_replays_the_same(bridge, lcm_url, tmp_path):
    """A log is played on the bus, each scan when the one before has been shown."""
    log = converted(LOG, tmp_path / "log.lcm")
    running, bus = bridge("--record", tmp_path / "live.mcap"), lcm.LCM(lcm_url)
    client = FoxgloveClient(running.url)
    client.subscribe("/scan")
    client.call("/ale/command", {"words": "stop"})  # refused, behind the subscription
    sent, sensed = [], ("ALE_SCAN", "ALE_ODOMETRY", "ALE_ODOMETRY_EXACT", "ALE_POSE")
    for _, channel, data in (event for event in events(log) if event[1] in sensed):
        sent.append((channel, data))
        bus.publish(channel, data)
        if channel == "ALE_SCAN":
            client.wait_for("/scan")
    assert (tmp_path / "live.mcap.lcm").exists(), "until it ends"
    client.close()
    assert running.end() == 0 and not (tmp_path / "live.mcap.lcm").exists()
    assert len(messages(tmp_path / "live.mcap")["/scan"]) == sum(channel == "ALE_SCAN" for channel, _ in sent)
    back = converted(tmp_path / "live.mcap", tmp_path / "back.lcm")
    assert [(channel, data) for _, channel, data in events(back)] == sent
    was = replayed(log, tmp_path / "was.tum")
    assert replayed(back, tmp_path / "now.tum") == was == replayed(tmp_path / "live.mcap", tmp_path / "mcap.tum")
    assert len(replayed(converted(tmp_path / "live.mcap", tmp_path / "back.scip"), tmp_path / "scip.tum")) == len(was)


def test_what_is_recorded_of_nobody_is_an_mcap_all_the_same_and_is_not_overwritten(bridge, lcm_url, tmp_path):
    assert bridge("--record", tmp_path / "live.mcap").end() == 0
    assert messages(tmp_path / "live.mcap") == {} and [path.name for path in tmp_path.iterdir()] == ["live.mcap"]
    again = run("--lcm-url", lcm_url, "--port", "0", "--record", tmp_path / "live.mcap")
    assert again.returncode == 1 and again.stderr.count("\n") == 1 and "exists" in again.stderr


def test_without_a_key_nothing_is_commanded_and_that_is_said(bridge, pulse, commands):
    running = bridge()
    client = FoxgloveClient(running.url)
    for _ in range(20):
        client.publish("/cmd_vel", "geometry_msgs/Twist", TWIST)
        client.publish("/initialpose", "geometry_msgs/PoseWithCovarianceStamped", {"pose": pose_message(1, 2, 0)["pose"],
                                                                                   "header": {"frame_id": "map"}})
    answer = client.call("/ale/command", {"words": "explore on"})
    assert answer == {"obeyed": False, "words": "this bridge has no key: it only shows (ale-foxglove --keys FILE)"}
    assert commands(1, seconds=1) == []
    client.close()
    assert running.end() == 0 and "/cmd_vel: refused: this bridge has no key" in running.said


@LONG
def test_with_a_key_a_client_drives_places_and_commands(bridge, pulse, robot, commands, alice):
    client = FoxgloveClient(bridge("--keys", alice).url)
    end = time.monotonic() + 120

    def publish_until(topic, schema, message, verb):
        while not any(each.verb == verb for each in commands(0)):
            assert time.monotonic() < end
            client.publish(topic, schema, message)
            commands(lambda so_far: any(each.verb == verb for each in so_far), seconds=0.2)
        return next(each for each in commands(0) if each.verb == verb)
    driven = publish_until("/cmd_vel", "geometry_msgs/Twist", TWIST, "drive")
    assert driven.args == ["0.250000", "-0.500000"] and driven.operator_name == "alice"
    placed = publish_until("/initialpose", "geometry_msgs/PoseWithCovarianceStamped",
                           {"header": {"frame_id": "map"}, "pose": {"pose": pose_message(1.5, -2, 0.5)["pose"]}}, "relocate")
    assert [float(word) for word in placed.args] == pytest.approx([1.5, -2.0, 0.5])
    assert publish_until("/goal_pose", "geometry_msgs/PoseStamped", pose_message(2, 1, 0.5), "goto").args == ["2.000000", "1.000000"]
    client.close()


NO_COMMANDS = [
    ("/cmd_vel", b"{", "no such message"), ("/cmd_vel", {}, "no such message"), ("/cmd_vel", b"[" * 5000, "no such message"),
    ("/cmd_vel", b'{"linear": {"x": NaN}, "angular": {"z": 0}}', "out of this world"),
    ("/cmd_vel", {"linear": {"x": 0.1, "y": 0.5}, "angular": {"z": 0}}, "sideways"),
    ("/cmd_vel", {"linear": {"x": "0.1\nstop"}, "angular": {"z": 0}}, "out of this world"),
    ("/initialpose", pose_message(0, 0, 0, frame="odom"), 'frame "odom"'),
    ("/goal_pose", {"header": {"frame_id": "map"}, "pose": {"position": {"x": 0, "y": 0}, "orientation": {}}}, "no heading")]


def test_what_is_no_command_is_refused_in_words(bridge, pulse, commands, alice):
    running = bridge("--keys", alice)
    client = FoxgloveClient(running.url)
    for topic, message, _ in NO_COMMANDS:
        client.publish(topic, "of no account", message)
    client.call("/ale/command", b"junk")  # comes behind them
    assert commands(1, seconds=0.3) == []
    client.close()
    assert running.end() == 0
    assert all(f"{topic}: refused: " in running.said and why in running.said for topic, _, why in NO_COMMANDS)
    assert f"commands: 0 obeyed, {len(NO_COMMANDS)} refused" in running.said


def test_a_recording_becomes_an_mcap_that_its_own_reader_takes_and_comes_back_the_same(tmp_path):
    scip = converted(LOG, tmp_path / "drive.scip")
    shown = converted(scip, tmp_path / "drive.mcap")
    counts = {topic: len(found) for topic, found in messages(shown).items()}
    with open(shown, "rb") as file:
        summary = mcap_reader.make_reader(file, validate_crcs=True).get_summary()
    assert counts == {summary.channels[k].topic: count for k, count in summary.statistics.channel_message_counts.items()}
    assert counts["/scan"] == counts["/pose"] == counts["/lines"] > 100 and counts["/map"] > 5
    assert counts["/occupancy"] == 3, "of twelve seconds, one every ten, and the one in the end"
    assert 10 <= counts["/graph"] <= 14, "of twelve seconds, one a second at most, and the one in the end"
    assert converted(shown, tmp_path / "again.scip").read_bytes() == scip.read_bytes()
    log = converted(shown, tmp_path / "drive.lcm")
    assert converted(converted(log, tmp_path / "log.mcap"), tmp_path / "again.lcm").read_bytes() == log.read_bytes()


def test_a_byte_that_is_wrong_is_found_by_the_sums_of_an_mcap(tmp_path):
    whole = converted(LOG, tmp_path / "drive.mcap").read_bytes()
    summary_start, = struct.unpack("<Q", whole[-28:-20])
    for at in (2000, whole.index(b"ALE_POSE", whole.index(b"original.lcm")), summary_start + 40):  # a chunk, the attachment, the summary
        data = bytearray(whole)
        data[at] ^= 1
        (tmp_path / "wrong.mcap").write_bytes(data)
        with pytest.raises((stream_reader.CRCValidationError, AssertionError)):
            check_sums(tmp_path / "wrong.mcap")


def replayed(log, out):
    done = subprocess.run([BINARIES / "ale-replay", log, "--trajectory-live", out], capture_output=True, text=True, timeout=300, check=False,
                          env=PYTHON_FIRST)
    assert done.returncode == 0, done.stderr
    return [[float(word) for word in line.split()] for line in out.read_text(encoding="utf-8").splitlines()]


def test_a_drive_stays_the_same_drive_on_its_way_through_the_formats(tmp_path):
    """Poses of the log and of what became of it: its ranges are whole millimetres, which are kept, as is the time of every scan."""
    was = replayed(LOG, tmp_path / "log.tum")
    lcm = converted(LOG, tmp_path / "a.lcm")
    for path in (lcm, converted(lcm, tmp_path / "b.scip")):
        now = replayed(path, tmp_path / "now.tum")
        assert len(now) == len(was)
        assert [row[0] for row in now] == pytest.approx([row[0] for row in was], abs=2e-6)
        assert max(math.hypot(a[1] - b[1], a[2] - b[2]) for a, b in zip(was, now)) < 0.001


def events(path):
    with open(path, "rb") as file:
        data = file.read()
    at = 0
    while at < len(data):
        _, _, utime, name, size = struct.unpack_from(">IqqII", data, at)
        yield utime, data[at + 28:at + 28 + name].decode(), data[at + 28 + name:at + 28 + name + size]
        at += 28 + name + size


def test_events_of_a_log_have_the_times_of_their_messages(tmp_path):
    log = converted(LOG, tmp_path / "a.lcm")
    found = list(events(log))
    assert {name for _, name, _ in found} == {"ALE_SCAN", "ALE_ODOMETRY", "ALE_ODOMETRY_EXACT", "ALE_POSE", "ALE_TRACKING", "ALE_FEATURES",
                                              "ALE_MAP", "ALE_MAP_PIECES", "ALE_GRAPH"}
    assert all(utime == struct.unpack_from(">q", data, 8)[0] for utime, _, data in found)
    scans = [ale.scan_t.decode(data) for _, name, data in found if name == "ALE_SCAN"]
    assert [scan.scan for scan in scans] == list(range(len(scans)))


@pytest.mark.parametrize("source, out, why", [
    ("absent", "a.mcap", "absent"), (LOG, "a.txt", "a name that ends in"), (LOG, "no/folder/a.lcm", "No such file"),
    (ROOT / "README.md", "a.lcm", "README.md")])
def test_what_cannot_be_converted_is_told_in_one_line_and_leaves_nothing(source, out, why, tmp_path):
    done = run("convert", source, tmp_path / out)
    assert done.returncode == 1 and why in done.stderr and done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("words, space", [([], ""), (["--namespace", "rover1"], "/rover1")])
def test_the_layout_names_only_what_the_bridge_sends_and_takes(words, space, tmp_path):
    assert run("layout", *words, tmp_path / "ale.json").returncode == 0
    layout = json.loads((tmp_path / "ale.json").read_text(encoding="utf-8"))
    panels = layout["configById"]
    topics = {"/map", "/occupancy", "/graph", "/plan", "/scan", "/lines", "/corners", "/pose", "/odometry"}
    assert set(panels["3D!robot"]["topics"]) == {space + topic for topic in topics}
    assert panels["3D!robot"]["followTf"] == f"{space}/map".lstrip("/") and panels["Teleop!drive"]["topic"] == f"{space}/cmd_vel"
    assert panels["CallService!command"]["serviceName"] == f"{space}/ale/command"

    def named(tree):
        return [tree] if isinstance(tree, str) else named(tree["first"]) + named(tree["second"])
    assert sorted(named(layout["layout"])) == sorted(panels)
    for each in panels["Plot!pose"]["paths"] + panels["Plot!stages"]["paths"]:
        assert each["value"].startswith(f"{space}/signals.")
