"""ROS 1 and ROS 2 bags, and MCAP with their messages or Foxglove's, as messages of LCM: ALE_SCAN and ALE_ODOMETRY.

    for event in bags.events(path): ...           # lcm_log.Event

Read by PyPI's `rosbags` without ROS; MCAP without a bag's folder about it by `mcap`. LaserScan, MultiEchoLaserScan (first echo),
Odometry, or /tf from `odom` to the robot where there is none; the mounting of the laser from /tf_static or /tf, as far as it is a turn
about the vertical.
"""
import json
import math
import pathlib
import sys

import ale

from .lcm_log import Event
from .near import Missing
from .ros_messages import (ECHOES, FRAMES, KINDS, LASER, ODOMETRY, Message, Rig, frame_name, kind_of, messages, moves, odometry_first,
                           place, ranges_of)

MOST_BEAMS = 1081
ROS1, MCAP = b"#ROSBAG V2.0", b"\x89MCAP0\r\n"
NO_RETURN, UNKNOWN, TOO_NEAR = 0x81, 0x82, 0x85


def is_mcap(path):
    return pathlib.Path(path).is_file() and starts_with(path, MCAP)


def is_bag(path):
    path = pathlib.Path(path)
    return (path / "metadata.yaml").exists() if path.is_dir() else starts_with(path, ROS1) or starts_with(path, MCAP)


def starts_with(path, magic):
    with open(path, "rb") as file:
        return file.read(len(magic)) == magic


def needed(name):
    try:
        return __import__(name, fromlist=["x"])
    except ImportError as error:
        package = {"mcap_protobuf.decoder": "mcap-protobuf-support"}.get(name, name.split(".")[0])
        raise Missing(f"bags and MCAP are read by Python's package {package}: pip install {package}") from error


def ros_messages(path):
    reader_module = needed("rosbags.highlevel")
    stores = needed("rosbags.typesys")
    with reader_module.AnyReader([pathlib.Path(path)], default_typestore=stores.get_typestore(stores.Stores.ROS2_HUMBLE)) as reader:
        yield from messages(reader, [connection for connection in reader.connections if kind_of(connection.msgtype) in KINDS])


def mcap_messages(path):
    """The same of a single MCAP file: ROS 2's and ROS 1's messages, and Foxglove's LaserScan."""
    readers = needed("mcap.reader")
    stores = needed("rosbags.typesys")
    store = {"cdr": stores.get_typestore(stores.Stores.ROS2_HUMBLE), "ros1": stores.get_typestore(stores.Stores.ROS1_NOETIC)}
    with open(path, "rb") as file:
        for schema, channel, message in readers.make_reader(file).iter_messages():
            name = (schema.name if schema else "").replace("/msg/", "/").replace("/", "/msg/")
            if kind_of(name) in KINDS and channel.message_encoding in store:
                types = store[channel.message_encoding]
                decode = types.deserialize_cdr if channel.message_encoding == "cdr" else types.deserialize_ros1
                yield Message(kind_of(name), channel.topic, message.log_time, decode(message.data, name))
            elif schema and schema.name == "foxglove.LaserScan":
                yield Message(LASER, channel.topic, message.log_time, foxglove_scan(schema, channel, message))


class Fields:
    """A structure of some other message, under ROS's names."""

    def __init__(self, **fields):
        self.__dict__.update(fields)


def foxglove_scan(schema, channel, message):
    if channel.message_encoding == "json":
        scan = json.loads(message.data)
        ranges = [math.nan if r is None else r for r in scan["ranges"]]
        sec, nanosec = scan["timestamp"]["sec"], scan["timestamp"]["nsec"]
        first, last, frame = scan["start_angle"], scan["end_angle"], scan.get("frame_id", "")
    else:
        factory = needed("mcap_protobuf.decoder").DecoderFactory()
        scan = factory.decoder_for(channel.message_encoding, schema)(message.data)
        ranges, sec, nanosec = list(scan.ranges), scan.timestamp.seconds, scan.timestamp.nanos
        first, last, frame = scan.start_angle, scan.end_angle, scan.frame_id
    step = (last - first) / max(len(ranges) - 1, 1)
    return Fields(header=Fields(stamp=Fields(sec=sec, nanosec=nanosec), frame_id=frame), angle_min=first, angle_increment=step,
                  time_increment=0.0, range_min=0.0, range_max=None, ranges=ranges)


def utime_of(header):
    return header.stamp.sec * 1000000 + header.stamp.nanosec // 1000


def code_of(distance, scan):
    if math.isnan(distance) or distance == 0:
        return UNKNOWN
    if distance < scan.range_min:
        return TOO_NEAR
    return 0 if distance < scan.range_max else NO_RETURN


def lcm_scan(scan, ranges, number, mounting):
    every = -(-len(ranges) // MOST_BEAMS)  # of a scanner with more beams than the core holds
    ranges = [float(r) for r in ranges[::every]]
    codes = [code_of(r, scan) for r in ranges]
    unit = max(1, math.ceil(max([r for r, code in zip(ranges, codes) if code == 0], default=0) * 1000 / 32767))
    out = ale.scan_t()
    out.utime, out.scan, out.stamp_beam = utime_of(scan.header), number, 0
    out.beam_time_us = scan.time_increment * 1e6 * every
    out.first_bearing, out.step = scan.angle_min, scan.angle_increment * every
    out.range_min, out.range_max, out.range_unit_mm = scan.range_min, scan.range_max, unit
    out.sensor_x, out.sensor_y, out.sensor_theta = mounting
    out.range_mm = [round(r * 1000 / unit) if code == 0 else 0 for r, code in zip(ranges, codes)]
    out.codes = bytes(codes)
    out.num_ranges = out.num_codes = len(ranges)
    return out


def lcm_odometry(utime, x, y, theta):
    out = ale.odometry_t()
    out.utime, out.x, out.y, out.theta = utime, x, y, theta
    return out


def bam(theta):
    return (round(theta / (2 * math.pi) * 2**32) + 2**31) % 2**32 - 2**31


def lcm_exact(utime, x, y, theta):
    """The same place, to the last bit (ALE_ODOMETRY_EXACT goes before it)."""
    out = ale.odometry_exact_t()
    out.utime = utime
    out.x_um, out.y_um, out.theta_bam = round(x * 1e6), round(y * 1e6), bam(theta)
    return out


class Survey:
    """What must be known of a bag before its first scan: who is mounted where may be told late; how far a scanner sees that does
    not say so, by its scans alone."""

    def __init__(self, told):
        self.rig, self.furthest = Rig(), 0.0
        for message in told:
            self.rig.take(message)
            if message.kind == LASER and message.content.range_max is None:
                self.furthest = max([self.furthest, *(r for r in message.content.ranges if math.isfinite(r))])

    def mounting(self, frame):
        return self.rig.mounting(frame) or (0.0, 0.0, 0.0)


class Converter:
    """One laser, that of the first scan; one odometry: the first, or what /tf says of it where there is none."""

    def __init__(self, survey):
        self.survey = survey
        self.topics = {}
        self.scans = 0
        self.ignored = set()

    def wants(self, kind, topic):
        group = LASER if kind == ECHOES else kind
        chosen = self.topics.setdefault(group, topic) == topic
        if not chosen and topic not in self.ignored:
            self.ignored.add(topic)
            print(f"ale-foxglove: {topic} is left out: {self.topics[group]} came first", file=sys.stderr)
        return chosen

    def events(self, message):
        if message.kind == FRAMES:
            yield from self.moved(moves(message))
        elif self.wants(message.kind, message.topic):
            yield from self.wheels(message.content) if message.kind == ODOMETRY else self.scan(message.content)

    def moved(self, transforms):
        for each in transforms if not self.survey.rig.has_odometry else ():
            if frame_name(each.child_frame_id) == self.survey.rig.robot:
                yield from placed(utime_of(each.header), place(each.transform.translation, each.transform.rotation))

    def wheels(self, odometry):
        return placed(utime_of(odometry.header), place(odometry.pose.pose.position, odometry.pose.pose.orientation))

    def scan(self, scan):
        made = lcm_scan(scan, ranges_of(scan), self.scans, self.survey.mounting(scan.header.frame_id))
        self.scans += 1
        yield Event(utime_of(scan.header), "ALE_SCAN", made.encode())


def placed(utime, where):
    yield Event(utime, "ALE_ODOMETRY_EXACT", lcm_exact(utime, *where).encode())
    yield Event(utime, "ALE_ODOMETRY", lcm_odometry(utime, *where).encode())


def events(path):
    """The bag is read twice (Survey)."""
    read = mcap_messages if is_mcap(path) else ros_messages
    survey = Survey(read(path))
    converter = Converter(survey)
    for message in odometry_first(read(path)):
        if message.kind == LASER and message.content.range_max is None:
            message.content.range_max = survey.furthest + 0.001
        yield from converter.events(message)
