"""ROS 1 and ROS 2 bags, without ROS (PyPI rosbags): their laser scans and odometry, in the order in which they were taken, and where the
scanner sits."""
from __future__ import annotations

import contextlib
import itertools
import math
import os
import pathlib
from collections.abc import Iterator
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from .scanner import Scanner
from .tracker import Tracker

try:
    from rosbags.highlevel import AnyReader, AnyReaderError
    from rosbags.typesys import Stores, get_typestore
except ImportError as error:
    raise ImportError("ale.bags needs rosbags: pip install 'ale-slam[bags]'") from error


class Scan(NamedTuple):
    stamp: float
    ranges: NDArray[np.float32]
    scanner: Scanner


class Odometry(NamedTuple):
    stamp: float
    x: float
    y: float
    theta: float


Event = Union[Scan, Odometry]

SCANS = ("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/MultiEchoLaserScan")
ODOMETRY = "nav_msgs/msg/Odometry"
FRAMES = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")  # the latter in ROS 1 before 2013


def scanner_of(message: Any) -> Scanner:
    """As sensor_msgs/LaserScan or MultiEchoLaserScan tells it: stamped at its first beam."""
    return Scanner(first_bearing=message.angle_min, step=message.angle_increment, range_min=max(message.range_min, 0.0),
                   range_max=min(message.range_max, 80.0), beam_time=message.time_increment, beams=len(message.ranges))


def read(path: str | os.PathLike[str], scan_topic: str | None = None, odometry_topic: str | None = None) -> Iterator[Event]:
    """Scans (of several echoes the first) and odometry of a bag (.bag file, folder of a ROS 2 bag, .mcap file) by their
    stamps. Without topics the only ones of their types; where there is no Odometry, what /tf says from `odom` to the robot."""
    with _opened(path) as reader:
        scans = _topic(reader, SCANS, scan_topic, path)
        wheels = _topic(reader, (ODOMETRY,), odometry_topic, path, needed=odometry_topic is not None)
        yield from _events(reader, [*scans, *(wheels or _of_kind(reader, FRAMES))])


def mounting(path: str | os.PathLike[str], scan_topic: str | None = None) -> tuple[float, float, float] | None:
    """x, y, theta of the scanner on the robot as /tf_static or /tf tell it, as far as it is a turn about the vertical; None: they
    do not."""
    with _opened(path) as reader:
        scans, told = _topic(reader, SCANS, scan_topic, path), _of_kind(reader, FRAMES)
        frames: dict[str, tuple[str, float, float, float]] = {}
        for message in _messages(reader, told):
            for each in message.transforms:
                frames.setdefault(_frame(each.child_frame_id), (_frame(each.header.frame_id), *_place(each.transform.translation,
                                                                                                      each.transform.rotation)))
        robot = _robot(reader, frames)
        scan = next(_messages(reader, scans), None)
    return None if scan is None else _as_seen_from(robot, _frame(scan.header.frame_id), frames)


def track(path: str | os.PathLike[str], scan_topic: str | None = None, odometry_topic: str | None = None,
          **options: Any) -> Tracker:
    """A bag through the tracker, finished. options: those of ale.Tracker (sensor, loops, settings, blind, map_file); without sensor it
    is where the bag's frames say."""
    if "sensor" not in options:
        options["sensor"] = mounting(path, scan_topic)
    tracker: Tracker | None = None
    waiting: list[Odometry] = []
    for event in read(path, scan_topic, odometry_topic):
        if isinstance(event, Odometry):
            waiting.append(event)
            continue
        if tracker is None:
            tracker = Tracker(event.scanner, **options)
        for sample in waiting:
            tracker.odometry(sample.x, sample.y, sample.theta, sample.stamp)
        waiting.clear()
        tracker.scan(event.ranges, event.stamp, event.scanner)
    if tracker is None:
        raise ValueError(f"{os.fspath(path)}: a bag without a scan")
    tracker.finish()
    return tracker


@contextlib.contextmanager
def _opened(path: str | os.PathLike[str]) -> Iterator[Any]:
    try:
        with AnyReader([pathlib.Path(path)], default_typestore=get_typestore(Stores.LATEST)) as reader:
            yield reader
    except (AnyReaderError, OSError) as error:
        raise ValueError(f"{os.fspath(path)}: no bag that can be read: {error}") from error


def _of_kind(reader: Any, kinds: tuple[str, ...]) -> list[Any]:
    return [connection for connection in reader.connections if connection.msgtype in kinds]


def _topic(reader: Any, kinds: tuple[str, ...], named: str | None, path: str | os.PathLike[str], needed: bool = True) -> list[Any]:
    of_kind = _of_kind(reader, kinds)
    topics = sorted({connection.topic for connection in of_kind})
    chosen = named if named is not None else topics[0] if len(topics) == 1 else None
    if chosen in topics:
        return [connection for connection in of_kind if connection.topic == chosen]
    if not needed and not topics:
        return []
    there = ", ".join(topics) if topics else "none"
    asked = f"no topic {named} of {kinds[0]}" if named is not None else f"which topic of {kinds[0]}?"
    raise ValueError(f"{os.fspath(path)}: {asked} (there: {there})")


def _messages(reader: Any, connections: list[Any]) -> Iterator[Any]:
    """None where there is no connection, which rosbags would take for all."""
    for connection, _, raw in reader.messages(connections=connections) if connections else ():
        yield reader.deserialize(raw, connection.msgtype)


def _seconds(header: Any) -> float:
    return float(header.stamp.sec) + float(header.stamp.nanosec) * 1e-9


def _frame(name: str) -> str:
    return name.lstrip("/")


def _place(position: Any, rotation: Any) -> tuple[float, float, float]:
    theta = math.atan2(2 * (rotation.w * rotation.z + rotation.x * rotation.y), 1 - 2 * (rotation.y**2 + rotation.z**2))
    return position.x, position.y, theta


def _moves(connection: Any, message: Any) -> list[Any]:
    """Where the robot is in the frame of its wheels."""
    changing = not connection.topic.endswith("tf_static")
    return [each for each in message.transforms if changing and _frame(each.header.frame_id).split("/")[-1].startswith("odom")]


def _robot(reader: Any, frames: dict[str, tuple[str, float, float, float]]) -> str:
    """What its frame is called: as odometry says, or /tf."""
    first = next(_messages(reader, _of_kind(reader, (ODOMETRY,))), None)
    if first is not None:
        return _frame(first.child_frame_id) or "base_link"
    return next((child for child, (parent, *_) in frames.items() if parent.split("/")[-1].startswith("odom")), "base_link")


def _as_seen_from(robot: str, frame: str, frames: dict[str, tuple[str, float, float, float]]) -> tuple[float, float, float] | None:
    x = y = theta = 0.0
    for _ in range(len(frames)):
        if frame == robot or frame not in frames:
            break
        frame, parent_x, parent_y, turn = frames[frame]
        x, y, theta = (parent_x + math.cos(turn) * x - math.sin(turn) * y, parent_y + math.sin(turn) * x + math.cos(turn) * y, theta + turn)
    return (x, y, theta) if frame == robot else None


def _events(reader: Any, connections: list[Any]) -> Iterator[Event]:
    """Of messages of the same time, whose order a bag does not tell, odometry before the scan that it leads to."""
    messages = reader.messages(connections=connections)
    for _, together in itertools.groupby(messages, key=lambda message: message[1]):
        made = [event for connection, _, raw in together for event in _events_of(connection, reader.deserialize(raw, connection.msgtype))]
        yield from sorted(made, key=lambda event: isinstance(event, Scan))


def _events_of(connection: Any, message: Any) -> Iterator[Event]:
    if connection.msgtype in SCANS:
        yield Scan(_seconds(message.header), _ranges(message), scanner_of(message))
    elif connection.msgtype == ODOMETRY:
        yield Odometry(_seconds(message.header), *_place(message.pose.pose.position, message.pose.pose.orientation))
    else:
        for each in _moves(connection, message):
            yield Odometry(_seconds(each.header), *_place(each.transform.translation, each.transform.rotation))


def _ranges(message: Any) -> NDArray[np.float32]:
    """Of several echoes the first."""
    if isinstance(message.ranges, np.ndarray):
        return np.asarray(message.ranges, np.float32)
    return np.array([each.echoes[0] if len(each.echoes) else math.nan for each in message.ranges], np.float32)
