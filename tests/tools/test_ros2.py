"""ale-ros2, fed by a robot double, as PyPI's cyclonedds sees it; the bytes as PyPI's rosbags has them."""
import math
import subprocess
import time

import pytest

from at_hand import BINARIES, LONG
from robot_double import GRAPH, WALLS
from watching import commands, lcm_url, pulse, robot  # noqa: F401 (fixtures)

pytest.importorskip("cyclonedds", reason="PyPI's cyclonedds is not here")
if not (BINARIES / "ale-ros2").exists():
    pytest.skip("ale-ros2 was not built: no Cyclone DDS (cyclonedds-dev, cyclonedds-tools)", allow_module_level=True)

from ros_peer import BEST_EFFORT, LATCHED, RELIABLE, Bridge, RosPeer, free_domain  # noqa: E402
from ros_types import (DiagnosticArray, Header, LaserScan, MarkerArray, OccupancyGrid, Odometry, Point, Pose,  # noqa: E402
                       PoseStamped, PoseWithCovariance, PoseWithCovarianceStamped, Quaternion, TFMessage, Time, Twist, TwistStamped,
                       Vector3)

TOPICS = {  # as nav2, RViz2 and tf2 subscribe
    "scan": (LaserScan, BEST_EFFORT), "odom": (Odometry, BEST_EFFORT), "pose": (PoseWithCovarianceStamped, RELIABLE),
    "tf": (TFMessage, RELIABLE), "tf_static": (TFMessage, LATCHED), "map": (OccupancyGrid, LATCHED),
    "ale/lines": (MarkerArray, RELIABLE), "ale/walls": (MarkerArray, LATCHED), "ale/graph": (MarkerArray, LATCHED),
    "ale/plan": (MarkerArray, RELIABLE), "diagnostics": (DiagnosticArray, RELIABLE)}


WAY = [(0.5, -0.6), (1.0, 0.0), (2.0, 1.0)]


@pytest.fixture
def domain():
    return free_domain()


@pytest.fixture
def peer(domain):
    return RosPeer(domain)


@pytest.fixture
def bridge(domain, lcm_url):
    """Starts the bridge with further words; ends it, whatever happens."""
    started = []

    def start(*words):
        started.append(Bridge(domain, lcm_url, *words))
        return started[-1]
    yield start
    assert [each.end() for each in started] == [0] * len(started)


@pytest.fixture
def alice(tmp_path):
    subprocess.run([BINARIES / "ale-keys", "alice"], cwd=tmp_path, check=True, capture_output=True, timeout=180)
    return tmp_path / "alice.key"


def pose_of(x, y, theta):
    return Pose(Point(x, y, 0.0), Quaternion(0.0, 0.0, math.sin(theta / 2), math.cos(theta / 2)))


def header(frame):
    return Header(Time(1, 2), frame)


def initial_pose(x, y, theta, frame="map"):
    return PoseWithCovarianceStamped(header(frame), PoseWithCovariance(pose_of(x, y, theta), [0.0] * 36))


def twist(v, w, sideways=0.0):
    return Twist(Vector3(v, sideways, 0.0), Vector3(0.0, 0.0, w))


def heading(turn):
    return 2 * math.atan2(turn.z, turn.w)


def test_every_topic_comes_to_who_subscribes_as_nav2_and_rviz_do_and_in_the_very_bytes_of_rosbags(bridge, peer, robot, pulse):
    typesys = pytest.importorskip("rosbags.typesys", reason="PyPI's rosbags is not here")
    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    heard = {name: peer.reader(name, *how) for name, how in TOPICS.items()}
    bridge()
    for name, (kind, _) in TOPICS.items():
        message = shown(robot, heard[name])
        theirs = store.deserialize_cdr(message.raw, kind.ros_name)
        assert bytes(store.serialize_cdr(theirs, kind.ros_name)) == b"\0\1\0\0" + payload(message.raw), name


def shown(robot, reader, condition=lambda _: True):
    """The first message that meets it, while the robot tells its map, graph and plan again and again."""
    end = time.monotonic() + 120
    while not any(condition(message) for message in reader.poll()):
        assert time.monotonic() < end
        robot.publish_pieces([5, 6])
        robot.publish_map()
        robot.publish_graph(apart=4)
        robot.publish_plan(3, "drives to 2.00 1.00", place=(2, 1), path=WAY)
        time.sleep(0.1)
    return next(message for message in reader.messages if condition(message))


def payload(raw):
    """Without the header, whose last bits count the bytes of padding that DDS has put behind: in files there are none."""
    return raw[4:len(raw) - (raw[3] & 3)]


def test_a_scan_is_what_the_robot_saw_with_the_stamp_of_its_first_beam(bridge, peer, robot, pulse):
    scans = peer.reader("scan", LaserScan, BEST_EFFORT)
    bridge()
    scan = scans.wait(lambda message: message.scan_time > 0)
    assert scan.header.frame_id == "laser" and len(scan.ranges) == 682 and len(scan.intensities) == 0
    assert scan.angle_min == pytest.approx(-340 * math.tau / 1024) and scan.angle_increment == pytest.approx(math.tau / 1024)
    assert scan.angle_max == pytest.approx(scan.angle_min + 681 * scan.angle_increment, abs=1e-5)
    assert scan.time_increment == pytest.approx(97.656e-6)
    assert math.isnan(scan.ranges[100])  # the device's error code
    beyond = [r for r in scan.ranges if math.isinf(r)]
    measured = [r for r in scan.ranges if math.isfinite(r)]
    assert beyond and all(r > 0 for r in beyond) and all(0 < r < scan.range_max for r in measured)


def test_frames_lead_from_map_to_laser_and_there_is_one_parent_for_each(bridge, peer, robot, pulse):
    transforms, static = peer.reader("tf", TFMessage, RELIABLE), peer.reader("tf_static", TFMessage, LATCHED)
    poses = peer.reader("pose", PoseWithCovarianceStamped, RELIABLE)
    bridge()
    at = poses.wait(lambda message: message.header.stamp.sec > 0)
    same = lambda message: message.transforms[0].header.stamp == at.header.stamp  # noqa: E731
    links = {}
    for frame in ("odom", "base_link"):
        each = transforms.wait(lambda message: same(message) and message.transforms[0].child_frame_id == frame).transforms[0]
        links[each.header.frame_id, each.child_frame_id] = each.transform
    assert set(links) == {("map", "odom"), ("odom", "base_link")}
    mounted = static.wait().transforms[0]
    assert (mounted.header.frame_id, mounted.child_frame_id) == ("base_link", "laser")
    a, b = links["map", "odom"], links["odom", "base_link"]
    turn = heading(a.rotation)
    x = a.translation.x + math.cos(turn) * b.translation.x - math.sin(turn) * b.translation.y
    y = a.translation.y + math.sin(turn) * b.translation.x + math.cos(turn) * b.translation.y
    assert (x, y) == pytest.approx((at.pose.pose.position.x, at.pose.pose.position.y), abs=1e-6)
    assert at.pose.covariance[0] == pytest.approx(0.004**2) and at.pose.covariance[35] == pytest.approx(0.003**2)


@LONG
def test_who_comes_late_gets_the_map_and_the_mounting_at_once_though_nothing_new_is_sent(bridge, peer, robot):
    early = peer.reader("map", OccupancyGrid, LATCHED)
    bridge()
    shown = the_rooms_are_shown(robot, early)
    late = peer.another()
    grid = late.reader("map", OccupancyGrid, LATCHED).wait()
    assert late.reader("tf_static", TFMessage, LATCHED).wait().transforms[0].child_frame_id == "laser"
    assert grid.header.frame_id == "map" and grid.info.resolution == pytest.approx(0.05)
    assert len(grid.data) == grid.info.width * grid.info.height and set(grid.data) == {-1, 0, 100}
    assert shows_the_rooms(grid) and grid.data == shown.data
    assert cells_at(grid, -2.3, 2.3) == {-1}


@LONG
@pytest.mark.parametrize("leaps", [True, False])
def test_of_a_map_that_the_robot_has_forgotten_nothing_is_shown_any_more(bridge, peer, robot, leaps):
    """One that stands where its map began when it forgets it is told by its keyframes, which are other scans."""
    grids = peer.reader("map", OccupancyGrid, LATCHED)
    bridge()
    robot.publish_graph()
    the_rooms_are_shown(robot, grids)
    robot.drive(60)
    most = known(the_rooms_are_shown(robot, grids))
    robot.drive(2)
    if leaps:
        robot.scan = 0  # where it began: nobody drives there in a moment
    else:
        robot.publish_graph(first_scan=robot.scan)
    end = time.monotonic() + 120
    while known(grids.poll()[-1]) >= most:
        assert time.monotonic() < end
        robot.drive(1)
        time.sleep(0.2)


def the_rooms_are_shown(robot, grids):
    """The newest of the grids, when they have shown the rooms and no other comes any more."""
    end = time.monotonic() + 120
    while not any(shows_the_rooms(grid) for grid in grids.poll()):
        assert time.monotonic() < end
        robot.publish_map()
        robot.drive(3)
    newest = None
    while newest != len(grids.poll()):
        newest = len(grids.poll())
        time.sleep(2.5)
    return grids.messages[-1]


def known(grid):
    return sum(cell >= 0 for cell in grid.data)


def shows_the_rooms(grid):
    """Walls of both, and free floor where the robot is."""
    return 100 in cells_at(grid, 3.0, 1.5) and 100 in cells_at(grid, -2.0, 0.0) and 0 in cells_at(grid, 0.5, -0.6)


def cells_at(grid, x, y):
    """That one and those about it: a wall may lie on the border of two."""
    column = int((x - grid.info.origin.position.x) / grid.info.resolution)
    row = int((y - grid.info.origin.position.y) / grid.info.resolution)
    return {grid.data[k * grid.info.width + j] for k in range(max(row - 1, 0), min(row + 2, grid.info.height))
            for j in range(max(column - 1, 0), min(column + 2, grid.info.width))}


@LONG
def test_in_a_map_that_is_not_joined_nobody_is_told_where_in_map_the_robot_is(bridge, peer, robot):
    robot.map_id, robot.maps = 1, 2
    transforms = peer.reader("tf", TFMessage, RELIABLE)
    said = peer.reader("diagnostics", DiagnosticArray, RELIABLE)
    bridge()
    end = time.monotonic() + 120
    while len(transforms.poll()) < 20:
        assert time.monotonic() < end
        robot.drive(2)
    assert {message.transforms[0].child_frame_id for message in transforms.messages} == {"base_link"}
    robot.drive(10)
    message = said.wait(lambda each: any("not joined" in status.message for status in each.status))
    assert message.status[0].level == 1


@LONG
def test_a_silent_robot_is_stale(bridge, peer):
    said = peer.reader("diagnostics", DiagnosticArray, RELIABLE)
    bridge()
    assert said.wait().status[0].level == 3


def test_topics_may_stand_in_a_namespace(bridge, peer, pulse):
    scans = peer.reader("rover1/scan", LaserScan, BEST_EFFORT)
    bridge("--namespace", "rover1")
    assert scans.wait().header.frame_id == "laser"


def drawn(message):
    """{name: its points}; what has none is taken away."""
    assert {marker.header.frame_id for marker in message.markers} == {"map"}
    assert all(marker.action == (0 if marker.points else 2) and marker.scale.x > 0 and marker.color.a == 1 for marker in message.markers)
    return {marker.ns: [(point.x, point.y) for point in marker.points] for marker in message.markers}


def test_rviz_is_shown_walls_keyframes_loops_and_the_way_and_what_is_not_joined_by_itself(bridge, peer, robot):
    bridge()
    walls = shown(robot, peer.reader("ale/walls", MarkerArray, LATCHED), lambda message: drawn(message)["walls apart"])
    ends = [place for wall in WALLS for place in (wall[:2], wall[2:])]
    assert drawn(walls)["walls"] == [pytest.approx(place) for place in ends[:10] + ends[14:]]
    assert drawn(walls)["walls apart"] == [pytest.approx(place) for place in ends[10:14]]
    graph = drawn(shown(robot, peer.reader("ale/graph", MarkerArray, LATCHED)))
    assert graph["keyframes"] + graph["keyframes apart"] == [pytest.approx(place[:2]) for place in GRAPH] and len(graph["keyframes apart"]) == 4
    assert [len(graph[name]) // 2 for name in ("ties", "ties apart", "recognised", "closed", "joined")] == [17, 3, 1, 1, 0]
    assert graph["closed"] == [pytest.approx(GRAPH[k][:2]) for k in (0, 20)]
    plan = shown(robot, peer.reader("ale/plan", MarkerArray, RELIABLE))
    assert drawn(plan) == {"way": [pytest.approx(place) for place in WAY], "place": [(2, 1)]}
    assert plan.markers[0].lifetime.sec == 3 and walls.markers[0].lifetime.sec == 0
    late = peer.another()
    assert drawn(late.reader("ale/walls", MarkerArray, LATCHED).wait()) == drawn(walls)
    assert drawn(late.reader("ale/graph", MarkerArray, LATCHED).wait()) == graph


def publish_until(writer, message, condition):
    end = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < end
        writer.write(message)
        time.sleep(0.05)


def test_a_publisher_moves_nothing_where_the_bridge_has_no_key(bridge, peer, pulse, commands):
    running = bridge()
    writers = [(peer.writer("cmd_vel", Twist), twist(0.3, 0.1)), (peer.writer("initialpose", PoseWithCovarianceStamped), initial_pose(1, 2, 3)),
               (peer.writer("goal_pose", PoseStamped), PoseStamped(header("map"), pose_of(1, 1, 0)))]
    said = peer.reader("diagnostics", DiagnosticArray, RELIABLE)

    def all_refused():
        fresh = said.poll()
        counts = dict((value.key, int(value.value)) for value in fresh[-1].status[-1].values) if fresh else {}
        return all(counts.get(f"{topic} refused", 0) > 0 for topic in ("/cmd_vel", "/initialpose", "/goal_pose"))
    end = time.monotonic() + 120
    while not all_refused():
        assert time.monotonic() < end
        for writer, message in writers:
            writer.write(message)
        time.sleep(0.05)
    assert commands(1, seconds=1) == []
    assert running.end() == 0
    assert any("/cmd_vel is refused: this bridge has no key" in line for line in running.said)


def test_with_a_key_ros_drives_and_says_where_the_robot_is_and_is_to_go(bridge, peer, pulse, commands, alice):
    bridge("--keys", alice)
    drive, place = peer.writer("cmd_vel", Twist), peer.writer("initialpose", PoseWithCovarianceStamped)
    heard = lambda verb: [each for each in commands(0) if each.verb == verb]  # noqa: E731

    def driven():
        commands(lambda so_far: any(each.verb == "drive" for each in so_far), seconds=0.05)
        return heard("drive")
    publish_until(drive, twist(0.25, -0.5), driven)
    assert heard("drive")[0].args == ["0.250000", "-0.500000"] and heard("drive")[0].operator_name == "alice"

    def placed():
        commands(lambda so_far: any(each.verb == "relocate" for each in so_far), seconds=0.05)
        return heard("relocate")
    publish_until(place, initial_pose(1.5, -2.0, 0.5), placed)
    assert [float(word) for word in heard("relocate")[0].args] == pytest.approx([1.5, -2.0, 0.5])

    def sent():
        commands(lambda so_far: any(each.verb == "goto" for each in so_far), seconds=0.05)
        return heard("goto")
    publish_until(peer.writer("goal_pose", PoseStamped), PoseStamped(header("map"), pose_of(2.0, 1.0, 0.5)), sent)
    assert heard("goto")[0].args == ["2.000000", "1.000000"]
    numbers = [each.counter for each in commands(0)]
    assert numbers == sorted(set(numbers))


@LONG
def test_a_stamped_twist_is_taken_where_that_is_asked_for(bridge, peer, pulse, commands, alice):
    bridge("--stamped", "--keys", alice)
    writer = peer.writer("cmd_vel", TwistStamped)
    publish_until(writer, TwistStamped(header("base_link"), twist(0.1, 0.0)), lambda: commands(1, seconds=0.05))
    assert commands(1)[0].args == ["0.100000", "0.000000"]


NO_COMMANDS = [
    ("cmd_vel", Twist, twist(0.1, 0.0, sideways=0.2), "sideways"),
    ("initialpose", PoseWithCovarianceStamped, initial_pose(0, 0, 0, frame="\x1b[31m" + "x" * 10000), "only those in")]
MORE_NO_COMMANDS = [
    ("cmd_vel", Twist, twist(math.nan, 0.0), "out of this world"),
    ("cmd_vel", Twist, twist(0.1, math.inf), "out of this world"),
    ("initialpose", PoseWithCovarianceStamped, initial_pose(0, 0, 0, frame="odom"), 'frame "odom"'),
    ("initialpose", PoseWithCovarianceStamped, initial_pose(1e9, 0, 0), "out of this world"),
    ("initialpose", PoseWithCovarianceStamped,
     PoseWithCovarianceStamped(header("map"), PoseWithCovariance(Pose(Point(), Quaternion(0.0, 0.0, 0.0, 0.0)), [0.0] * 36)), "no heading")]


@pytest.mark.parametrize("topic, kind, message, why", NO_COMMANDS + [pytest.param(*each, marks=LONG) for each in MORE_NO_COMMANDS])
def test_what_is_no_command_is_refused_in_words(bridge, peer, pulse, commands, alice, topic, kind, message, why):
    running = bridge("--keys", alice)
    said = peer.reader("diagnostics", DiagnosticArray, RELIABLE)
    publish_until(peer.writer(topic, kind), message,
                  lambda: any(why in each.status[-1].message for each in said.poll()))
    assert commands(1, seconds=0.3) == []
    assert running.end() == 0
    assert all(line.isprintable() for line in running.said[1:])


@pytest.mark.parametrize("words", [["--domain", "233"], ["--domain", "x"], ["--namespace", "a b"], ["--namespace", "/a"], ["word"]])
def test_wrong_use_ends_with_2_and_one_line(words):
    done = subprocess.run([BINARIES / "ale-ros2", *words], capture_output=True, text=True, timeout=180, check=False)
    assert done.returncode == 2 and len(done.stderr.strip().splitlines()) == 1
