"""What messages of ROS say, whatever reads them: scans, odometry, who is mounted where. ale.bags and ale-foxglove read bags by it.

    rig = Rig()
    for message in messages(reader, connections): rig.take(message)      # reader: rosbags.highlevel.AnyReader
    rig.mounting("laser")                                                # (x, y, theta) as seen from the robot
"""
from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

LASER, ECHOES = SCANS = ("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/MultiEchoLaserScan")
ODOMETRY = "nav_msgs/msg/Odometry"
FRAMES = "tf2_msgs/msg/TFMessage"
KINDS = (*SCANS, ODOMETRY, FRAMES)
OLD_NAMES = {"tf/msg/tfMessage": FRAMES}  # of ROS 1 before 2013


class Message(NamedTuple):
    kind: str  # one of KINDS
    topic: str
    at: int  # when it was received, nanoseconds
    content: Any


def kind_of(msgtype: str) -> str:
    return OLD_NAMES.get(msgtype, msgtype)


def messages(reader: Any, connections: list[Any]) -> Iterator[Message]:
    """In their order. None where there is no connection, which rosbags would take for all."""
    for connection, at, raw in reader.messages(connections=connections) if connections else ():
        yield Message(kind_of(connection.msgtype), connection.topic, at, reader.deserialize(raw, connection.msgtype))


def odometry_first(told: Iterable[Message]) -> Iterator[Message]:
    """Of messages of the same time, whose order a bag does not tell, odometry before the scan that it leads to."""
    for _, together in itertools.groupby(told, key=lambda message: message.at):
        yield from sorted(together, key=lambda message: message.kind in SCANS)


def frame_name(name: str) -> str:
    return name.lstrip("/")


def place(position: Any, rotation: Any) -> tuple[float, float, float]:
    """x, y, and the turn about the vertical."""
    theta = math.atan2(2 * (rotation.w * rotation.z + rotation.x * rotation.y), 1 - 2 * (rotation.y**2 + rotation.z**2))
    return position.x, position.y, theta


def ranges_of(scan: Any) -> Any:
    """Of several echoes the first."""
    several = len(scan.ranges) > 0 and hasattr(scan.ranges[0], "echoes")
    return [each.echoes[0] if len(each.echoes) else math.nan for each in scan.ranges] if several else scan.ranges


def moves(message: Message) -> list[Any]:
    """Transforms that tell where the robot is in the frame of its wheels."""
    if message.kind != FRAMES or message.topic.endswith("tf_static"):
        return []
    return [each for each in message.content.transforms if frame_name(each.header.frame_id).split("/")[-1].startswith("odom")]


class Rig:
    """Who is mounted where, and what the robot's frame is called: the first word on each counts."""

    def __init__(self) -> None:
        self._parent: dict[str, tuple[str, float, float, float]] = {}
        self._by_odometry: str | None = None
        self._by_frames: str | None = None

    def take(self, message: Message) -> None:
        if message.kind == ODOMETRY and self._by_odometry is None:
            self._by_odometry = frame_name(message.content.child_frame_id) or "base_link"
        elif message.kind == FRAMES:
            self._take_frames(message)

    def _take_frames(self, message: Message) -> None:
        for each in message.content.transforms:
            where = place(each.transform.translation, each.transform.rotation)
            self._parent.setdefault(frame_name(each.child_frame_id), (frame_name(each.header.frame_id), *where))
        if self._by_frames is None:
            self._by_frames = next((frame_name(each.child_frame_id) for each in moves(message)), None)

    @property
    def has_odometry(self) -> bool:
        """By messages of its own, and not by /tf alone."""
        return self._by_odometry is not None

    @property
    def robot(self) -> str:
        return self._by_odometry or self._by_frames or "base_link"

    def mounting(self, frame: str) -> tuple[float, float, float] | None:
        """x, y, theta of a frame as seen from the robot's, as far as it is a turn about the vertical; None: that is not told."""
        frame = frame_name(frame)
        x = y = theta = 0.0
        for _ in range(len(self._parent)):
            if frame == self.robot or frame not in self._parent:
                break
            frame, parent_x, parent_y, turn = self._parent[frame]
            c, s = math.cos(turn), math.sin(turn)
            x, y, theta = parent_x + c * x - s * y, parent_y + s * x + c * y, theta + turn
        return (x, y, theta) if frame == self.robot else None
