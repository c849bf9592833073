"""ROS 1 and ROS 2 bags, without ROS (PyPI rosbags): their laser scans and odometry, in the order in which they were taken."""
from __future__ import annotations

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


def scanner_of(message: Any) -> Scanner:
    """As sensor_msgs/LaserScan tells it: stamped at its first beam."""
    return Scanner(first_bearing=message.angle_min, step=message.angle_increment, range_min=max(message.range_min, 0.0),
                   range_max=min(message.range_max, 80.0), beam_time=message.time_increment, beams=len(message.ranges))


def read(path: str | os.PathLike[str], scan_topic: str | None = None, odometry_topic: str | None = None) -> Iterator[Event]:
    """Scans and odometry of a bag (.bag file, folder of a ROS 2 bag, .mcap) by their stamps. Without topics the only
    ones of their types."""
    try:
        with AnyReader([pathlib.Path(path)], default_typestore=get_typestore(Stores.LATEST)) as reader:
            scans = _topic(reader, "sensor_msgs/msg/LaserScan", scan_topic, path)
            wheels = _topic(reader, "nav_msgs/msg/Odometry", odometry_topic, path, needed=odometry_topic is not None)
            yield from _events(reader, [*scans, *wheels])
    except (AnyReaderError, OSError) as error:
        raise ValueError(f"{os.fspath(path)}: no bag that can be read: {error}") from error


def track(path: str | os.PathLike[str], scan_topic: str | None = None, odometry_topic: str | None = None,
          **options: Any) -> Tracker:
    """A bag through the tracker, finished. options: those of ale.Tracker (sensor, loops, settings, blind, map_file)."""
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


def _topic(reader: Any, kind: str, named: str | None, path: str | os.PathLike[str], needed: bool = True) -> list[Any]:
    of_kind = [connection for connection in reader.connections if connection.msgtype == kind]
    topics = sorted({connection.topic for connection in of_kind})
    chosen = named if named is not None else topics[0] if len(topics) == 1 else None
    if chosen in topics:
        return [connection for connection in of_kind if connection.topic == chosen]
    if not needed and not topics:
        return []
    there = ", ".join(topics) if topics else "none"
    asked = f"no topic {named} of {kind}" if named is not None else f"which topic of {kind}?"
    raise ValueError(f"{os.fspath(path)}: {asked} (there: {there})")


def _seconds(message: Any) -> float:
    stamp = message.header.stamp
    return float(stamp.sec) + float(stamp.nanosec) * 1e-9


def _events(reader: Any, connections: list[Any]) -> Iterator[Event]:
    """Of messages of the same time, whose order a bag does not tell, odometry before the scan that it leads to."""
    messages = reader.messages(connections=connections)
    for _, together in itertools.groupby(messages, key=lambda message: message[1]):
        yield from sorted((_event(reader, connection, raw) for connection, _, raw in together),
                          key=lambda event: isinstance(event, Scan))


def _event(reader: Any, connection: Any, raw: bytes) -> Event:
    message = reader.deserialize(raw, connection.msgtype)
    if connection.msgtype.endswith("LaserScan"):
        return Scan(_seconds(message), np.asarray(message.ranges, np.float32), scanner_of(message))
    pose = message.pose.pose
    q = pose.orientation
    theta = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return Odometry(_seconds(message), pose.position.x, pose.position.y, theta)
