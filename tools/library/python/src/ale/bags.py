"""ROS 1 and ROS 2 bags, without ROS (PyPI rosbags): their laser scans and odometry, in the order in which they were taken, and where the
scanner sits."""
from __future__ import annotations

import contextlib
import itertools
import os
import pathlib
from collections.abc import Iterator
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from .ros_messages import FRAMES, ODOMETRY, SCANS, Message, Rig, kind_of, messages, moves, odometry_first, place, ranges_of
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
    """As sensor_msgs/LaserScan or MultiEchoLaserScan tells it: stamped at its first beam."""
    return Scanner(first_bearing=message.angle_min, step=message.angle_increment, range_min=max(message.range_min, 0.0),
                   range_max=min(message.range_max, 80.0), beam_time=message.time_increment, beams=len(message.ranges))


def read(path: str | os.PathLike[str], scan_topic: str | None = None, odometry_topic: str | None = None) -> Iterator[Event]:
    """Scans (of several echoes the first) and odometry of a bag (.bag file, folder of a ROS 2 bag, .mcap file) by their
    stamps. Without topics the only ones of their types; where there is no Odometry, what /tf says from `odom` to the robot."""
    with _opened(path) as reader:
        scans = _topic(reader, SCANS, scan_topic, path)
        wheels = _topic(reader, (ODOMETRY,), odometry_topic, path, needed=odometry_topic is not None)
        for message in odometry_first(messages(reader, [*scans, *(wheels or _of_kind(reader, (FRAMES,)))])):
            yield from _events_of(message)


def mounting(path: str | os.PathLike[str], scan_topic: str | None = None) -> tuple[float, float, float] | None:
    """x, y, theta of the scanner on the robot as /tf_static or /tf tell it, as far as it is a turn about the vertical; None: they
    do not."""
    with _opened(path) as reader:
        scan = next(messages(reader, _topic(reader, SCANS, scan_topic, path)), None)
        rig = Rig()
        for message in (*itertools.islice(messages(reader, _of_kind(reader, (ODOMETRY,))), 1), *messages(reader, _of_kind(reader, (FRAMES,)))):
            rig.take(message)
    return None if scan is None else rig.mounting(scan.content.header.frame_id)


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
    return [connection for connection in reader.connections if kind_of(connection.msgtype) in kinds]


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


def _seconds(header: Any) -> float:
    return float(header.stamp.sec) + float(header.stamp.nanosec) * 1e-9


def _events_of(message: Message) -> Iterator[Event]:
    if message.kind in SCANS:
        yield Scan(_seconds(message.content.header), np.asarray(ranges_of(message.content), np.float32), scanner_of(message.content))
    elif message.kind == ODOMETRY:
        pose = message.content.pose.pose
        yield Odometry(_seconds(message.content.header), *place(pose.position, pose.orientation))
    for each in moves(message):
        yield Odometry(_seconds(each.header), *place(each.transform.translation, each.transform.rotation))
