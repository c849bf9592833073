"""ale-replay and ale-foxglove on bags of ROS 1 and ROS 2 and on MCAP, written by PyPI's rosbags and foxglove-sdk."""
import math
import os
import pathlib
import subprocess
import sys

import ale
import pytest

from at_hand import BINARIES, LONG, ROOT
from test_foxglove import converted, events, messages

rosbag1 = pytest.importorskip("rosbags.rosbag1", reason="PyPI's rosbags is not here")
rosbag2 = pytest.importorskip("rosbags.rosbag2", reason="PyPI's rosbags is not here")
foxglove = pytest.importorskip("foxglove", reason="PyPI's foxglove-sdk is not here")

import numpy as np  # noqa: E402
from rosbags.typesys import Stores, get_typestore  # noqa: E402

PYTHON_FIRST = {**os.environ, "PATH": f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"}
LOG = ROOT / "tests/digest/apartment.log.gz"
MOUNTED = (0.1, -0.05, 0.2)


def run(name, *words, env=None):
    return subprocess.run([BINARIES / name, *map(str, words)], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False,
                          env=env or PYTHON_FIRST)


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """Scans and odometry of a recording, as messages of LCM."""
    path = tmp_path_factory.mktemp("drive") / "drive.lcm"
    assert run("ale-replay", LOG, "--lcm", path).returncode == 0
    kinds = {"ALE_SCAN": ale.scan_t, "ALE_ODOMETRY": ale.odometry_t}
    return [(name, kinds[name].decode(data)) for _, name, data in events(path) if name in kinds]


class Maker:
    """Messages of one generation of ROS."""

    def __init__(self, store, frames="tf2_msgs/msg/TFMessage"):
        self.store, self.types, self.frames = store, store.types, frames

    def header(self, utime, frame):
        kind = self.types["std_msgs/msg/Header"]
        stamp = self.types["builtin_interfaces/msg/Time"](sec=utime // 1000000, nanosec=utime % 1000000 * 1000)
        return kind(stamp=stamp, frame_id=frame) if "seq" not in kind.__dataclass_fields__ else kind(seq=0, stamp=stamp, frame_id=frame)

    def turn(self, theta):
        return self.types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=math.sin(theta / 2), w=math.cos(theta / 2))

    def scan(self, scan, echoes=False):
        first = scan.utime - round(scan.stamp_beam * scan.beam_time_us)
        without = {0x81: math.inf, 0x85: -math.inf}
        ranges = np.array([r / 1000 if code == 0 else without.get(code, math.nan) for r, code in zip(scan.range_mm, scan.codes)], np.float32)
        kind, empty = "LaserScan", np.array([], np.float32)
        if echoes:
            kind, echo, empty = "MultiEchoLaserScan", self.types["sensor_msgs/msg/LaserEcho"], []
            ranges = [echo(echoes=np.array([r, r + 1], np.float32)) for r in ranges]
        return f"sensor_msgs/msg/{kind}", self.types[f"sensor_msgs/msg/{kind}"](
            header=self.header(first, "laser"), angle_min=scan.first_bearing, angle_max=scan.first_bearing + 681 * scan.step,
            angle_increment=scan.step, time_increment=scan.beam_time_us / 1e6, scan_time=0.1, range_min=0.02, range_max=scan.range_max,
            ranges=ranges, intensities=empty)

    def odometry(self, sample):
        point, vector = self.types["geometry_msgs/msg/Point"], self.types["geometry_msgs/msg/Vector3"]
        pose = self.types["geometry_msgs/msg/Pose"](position=point(x=sample.x, y=sample.y, z=0.0), orientation=self.turn(sample.theta))
        still = self.types["geometry_msgs/msg/Twist"](linear=vector(x=0.0, y=0.0, z=0.0), angular=vector(x=0.0, y=0.0, z=0.0))
        nothing = np.zeros(36)
        return "nav_msgs/msg/Odometry", self.types["nav_msgs/msg/Odometry"](
            header=self.header(sample.utime, "odom"), child_frame_id="base_footprint",
            pose=self.types["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=nothing),
            twist=self.types["geometry_msgs/msg/TwistWithCovariance"](twist=still, covariance=nothing))

    def link(self, utime, parent, child, x, y, theta):
        move = self.types["geometry_msgs/msg/Vector3"](x=x, y=y, z=0.1)
        return self.types["geometry_msgs/msg/TransformStamped"](
            header=self.header(utime, parent), child_frame_id=child,
            transform=self.types["geometry_msgs/msg/Transform"](translation=move, rotation=self.turn(theta)))

    def mounting(self, utime, mounted):
        """base_footprint -> base_link -> laser."""
        return self.frames, self.types[self.frames](transforms=[self.link(utime, "base_footprint", "base_link", 0.0, 0.0, 0.0),
                                                                self.link(utime, "base_link", "laser", *mounted)])

    def moved(self, sample):
        return self.frames, self.types[self.frames](transforms=[self.link(sample.utime, "odom", "base_footprint", sample.x, sample.y, sample.theta)])

    def messages(self, drive, echoes=False, mounted=(0.0, 0.0, 0.0), late=False, by_tf=False):
        """(topic, type, utime, message). late: the mounting is told at the end; by_tf: odometry by /tf alone."""
        static = ("/tf_static", *self.stamped(drive[-1 if late else 0][1].utime, self.mounting(drive[0][1].utime, mounted)))
        yield from () if late else (static,)
        for name, message in drive:
            topic, make = ("/scan", lambda scan: self.scan(scan, echoes)) if name == "ALE_SCAN" else (
                ("/tf", self.moved) if by_tf else ("/odom", self.odometry))
            yield topic, *self.stamped(message.utime, make(message))
        yield from (static,) if late else ()

    @staticmethod
    def stamped(utime, made):
        return made[0], utime, made[1]


TF_OF_ROS1 = "geometry_msgs/TransformStamped[] transforms\n"


def ros1_store(frames):
    from rosbags.typesys import get_types_from_msg
    store = get_typestore(Stores.ROS1_NOETIC)
    if frames not in store.types:
        store.register(get_types_from_msg(TF_OF_ROS1, frames))
    return store


def write_ros1(path, drive, frames="tf2_msgs/msg/TFMessage", **how):
    maker = Maker(ros1_store(frames), frames)
    with rosbag1.Writer(path) as bag:
        connections = {}
        for topic, kind, utime, message in maker.messages(drive, **how):
            if topic not in connections:
                connections[topic] = bag.add_connection(topic, kind, typestore=maker.store)
            bag.write(connections[topic], utime * 1000, maker.store.serialize_ros1(message, kind))
    return path


def write_ros2(path, drive, storage=rosbag2.StoragePlugin.SQLITE3, **how):
    maker = Maker(get_typestore(Stores.ROS2_HUMBLE))
    with rosbag2.Writer(path, version=9, storage_plugin=storage) as bag:
        connections = {}
        for topic, kind, utime, message in maker.messages(drive, **how):
            if topic not in connections:
                connections[topic] = bag.add_connection(topic, kind, typestore=maker.store)
            bag.write(connections[topic], utime * 1000, maker.store.serialize_cdr(message, kind))
    return path


def write_mcap_bag(path, drive):
    return write_ros2(path, drive, rosbag2.StoragePlugin.MCAP)


def write_single_mcap(path, drive):
    """The file of a bag, without the folder about it."""
    return next(write_mcap_bag(path, drive).glob("*.mcap"))


def poses(log, folder, *words):
    done = run("ale-replay", log, "--trajectory-live", folder / "live.tum", *words)
    assert done.returncode == 0, done.stderr
    return [[float(word) for word in line.split()] for line in (folder / "live.tum").read_text(encoding="utf-8").splitlines()]


def apart(was, now):
    """The largest distance of poses at the same time: in ROS a scan's is that of its first beam."""
    times, x, y = (np.array([row[k] for row in was]) for k in range(3))
    return max(math.hypot(np.interp(t, times, x) - at_x, np.interp(t, times, y) - at_y) for t, at_x, at_y, *_ in now if t >= times[0])


@pytest.mark.parametrize("write, name", [(write_ros1, "drive.bag"), (write_ros2, "drive"), pytest.param(write_mcap_bag, "drive", marks=LONG),
                                         pytest.param(write_single_mcap, "drive", marks=LONG)])
def test_a_bag_is_replayed_to_the_poses_and_the_map_of_the_log_it_was_made_of(write, name, drive, tmp_path):
    bag = write(tmp_path / name, drive)
    was = poses(LOG, tmp_path)
    now = poses(bag, tmp_path, "--map", tmp_path / "map.png", "--points")
    assert len(now) == len(was)
    assert apart(was, now) < 0.005
    assert (tmp_path / "map.png").stat().st_size > 1000


def test_of_messages_of_one_time_odometry_counts_before_the_scan(drive, tmp_path):
    ways = {"before": [], "after": []}
    sample = None
    for name, message in drive:
        if name == "ALE_ODOMETRY":
            sample = message
        elif sample:
            at_once = ale.odometry_t.decode(sample.encode())
            at_once.utime = message.utime
            scan = (name, message)
            ways["before"] += [("ALE_ODOMETRY", at_once), scan]
            ways["after"] += [scan, ("ALE_ODOMETRY", at_once)]
    before, after = (poses(write_ros2(tmp_path / name, way), tmp_path) for name, way in ways.items())
    assert before == after


def write_old_ros1(path, drive, **how):
    return write_ros1(path, drive, frames="tf/msg/tfMessage", **how)


@pytest.mark.parametrize("write, name", [(write_ros1, "drive.bag"), pytest.param(write_ros2, "drive", marks=LONG),
                                         pytest.param(write_old_ros1, "drive.bag", marks=LONG)])
def test_where_a_bag_has_no_odometry_the_way_is_that_of_tf(write, name, drive, tmp_path):
    by_tf, told = tmp_path / "tf", tmp_path / "told"
    by_tf.mkdir()
    told.mkdir()
    was = poses(write(told / name, drive, mounted=MOUNTED), told)
    assert poses(write(by_tf / name, drive, mounted=MOUNTED, by_tf=True), by_tf) == was
    wheels = [ale.odometry_t.decode(data) for _, channel, data in events(converted(by_tf / name, by_tf / "bag.lcm")) if channel == "ALE_ODOMETRY"]
    assert len(wheels) == len(drive) - scans_in(drive)


@LONG
@pytest.mark.parametrize("how", [{}, {"late": True}, {"by_tf": True}])
def test_the_mounting_of_the_laser_is_that_of_tf(drive, how, tmp_path):
    bag = write_ros2(tmp_path / "bag", drive[:6], mounted=MOUNTED, **how)
    assert run("ale-foxglove", "convert", bag, tmp_path / "bag.lcm").returncode == 0
    scan = next(ale.scan_t.decode(data) for _, name, data in events(tmp_path / "bag.lcm") if name == "ALE_SCAN")
    assert (scan.sensor_x, scan.sensor_y, scan.sensor_theta) == pytest.approx(MOUNTED)


@LONG
def test_the_first_echo_of_many_counts(drive, tmp_path):
    bag = write_ros2(tmp_path / "echoes", drive[:60], echoes=True)
    plain = write_ros2(tmp_path / "plain", drive[:60])
    assert poses(bag, tmp_path) == poses(plain, tmp_path)


def write_foxglove(path, drive):
    """LaserScan alone, without what this bridge keeps of the recording."""
    from foxglove import channels
    from foxglove.messages import LaserScan, Timestamp
    context = foxglove.Context()
    with foxglove.open_mcap(str(path), context=context):
        scans = channels.LaserScanChannel("/lidar", context=context)
        for name, scan in drive:
            if name == "ALE_SCAN":
                scans.log(LaserScan(timestamp=Timestamp(sec=scan.utime // 1000000, nsec=scan.utime % 1000000 * 1000), frame_id="laser",
                                    start_angle=scan.first_bearing, end_angle=scan.first_bearing + scan.step * (scan.num_ranges - 1),
                                    ranges=[r / 1000 if code == 0 else math.inf for r, code in zip(scan.range_mm, scan.codes)]),
                          log_time=scan.utime * 1000)
    return path


def scans_in(drive):
    return sum(name == "ALE_SCAN" for name, _ in drive)


def test_what_foxglove_has_recorded_of_another_robot_is_replayed(drive, tmp_path):
    assert len(poses(write_foxglove(tmp_path / "other.mcap", drive), tmp_path)) == scans_in(drive)


@pytest.mark.parametrize("write, name", [(write_ros1, "drive.bag"), pytest.param(write_ros2, "drive", marks=LONG), (write_foxglove, "other.mcap"),
                                         pytest.param(write_single_mcap, "drive", marks=LONG)])
def test_a_bag_becomes_a_scip_recording_of_the_same_drive(write, name, drive, tmp_path):
    bag = write(tmp_path / name, drive)
    was, now = poses(bag, tmp_path), poses(converted(bag, tmp_path / "bag.scip"), tmp_path)
    assert len(was) == len(now) == scans_in(drive)
    assert apart(was, now) < 0.001


@pytest.mark.parametrize("write, name", [(write_ros2, "drive"), pytest.param(write_ros1, "drive.bag", marks=LONG),
                                         pytest.param(write_single_mcap, "drive", marks=LONG), pytest.param(write_foxglove, "other.mcap", marks=LONG)])
def test_a_bag_becomes_an_mcap_with_poses_and_the_map_and_comes_back_as_it_was(write, name, drive, tmp_path):
    bag = write(tmp_path / name, drive)
    shown = converted(bag, tmp_path / "bag-shown.mcap")
    counts = {topic: len(found) for topic, found in messages(shown).items()}
    assert counts["/scan"] == counts["/pose"] == counts["/lines"] == scans_in(drive) and counts["/map"] > 5 and counts["/graph"] > 5
    assert counts.get("/odometry", 0) == (0 if write is write_foxglove else len(drive) - scans_in(drive))
    assert converted(shown, tmp_path / "back.lcm").read_bytes() == converted(bag, tmp_path / "bag.lcm").read_bytes()


def test_a_bag_without_scans_is_told_so(tmp_path):
    maker = Maker(get_typestore(Stores.ROS2_HUMBLE))
    with rosbag2.Writer(tmp_path / "bag", version=9) as bag:
        bag.add_connection("/chatter", "std_msgs/msg/String", typestore=maker.store)
    done = run("ale-replay", tmp_path / "bag")
    assert done.returncode == 1 and "no LaserScan" in done.stderr and done.stderr.count("\n") == 1


def test_what_is_to_be_installed_is_told_where_it_is_missing(drive, tmp_path):
    """A Python that has none of the packages."""
    bare = tmp_path / "bin"
    bare.mkdir()
    (bare / "python3").write_text('#!/bin/sh\nexec /usr/bin/python3 -I -S "$@"\n', encoding="utf-8")
    (bare / "python3").chmod(0o755)
    bag = write_ros1(tmp_path / "drive.bag", drive[:10])
    done = run("ale-replay", bag, env={**os.environ, "PATH": f"{bare}:{os.environ['PATH']}"})
    assert done.returncode == 1 and "pip install rosbags" in done.stderr and done.stderr.count("\n") == 1


def test_a_damaged_bag_fails_in_one_line(drive, tmp_path):
    bag = write_ros1(tmp_path / "drive.bag", drive[:10])
    bag.write_bytes(bag.read_bytes()[:2000])
    done = run("ale-replay", bag)
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and done.stderr.startswith(f"ale-replay: {bag}: ")
    (tmp_path / "junk.mcap").write_bytes(b"\x89MCAP0\r\n" + bytes(100))
    done = run("ale-replay", tmp_path / "junk.mcap")
    assert done.returncode == 1 and done.stderr.count("\n") == 1
