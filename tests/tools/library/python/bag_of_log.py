"""A ROS bag of a CARMEN log, written by rosbags: rosbag of version 1 (a file) or 2 (a folder)."""
import gzip
import math
import pathlib
import sys

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore


def header_of(types, stamp, frame):
    time = types["builtin_interfaces/msg/Time"](sec=int(stamp), nanosec=round(stamp % 1 * 1e9))
    ros1 = {"seq": 0} if "seq" in types["std_msgs/msg/Header"].__dataclass_fields__ else {}
    return types["std_msgs/msg/Header"](**ros1, stamp=time, frame_id=frame)


def messages(log, types):
    """(topic, message, stamp) of every ROBOTLASER1 line."""
    with gzip.open(log, "rt", encoding="ascii") as lines:
        for words in (line.split() for line in lines if line.startswith("ROBOTLASER1")):
            beams = int(words[8])
            ranges = np.array(words[9:9 + beams], np.float32)
            x, y, theta = map(float, words[13 + beams:16 + beams])
            stamp = float(words[21 + beams])
            yield "/odom", odometry(types, header_of(types, stamp, "odom"), x, y, theta), stamp
            yield "/scan", types["sensor_msgs/msg/LaserScan"](
                header=header_of(types, stamp, "laser"), angle_min=-2.086213872, angle_max=2.092349795, angle_increment=2 * math.pi / 1024,
                time_increment=97.656e-6, scan_time=0.1, range_min=0.02, range_max=5.6, ranges=ranges,
                intensities=np.zeros(0, np.float32)), stamp


def odometry(types, header, x, y, theta):
    point, turn = types["geometry_msgs/msg/Point"], types["geometry_msgs/msg/Quaternion"]
    vector = types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
    pose = types["geometry_msgs/msg/Pose"](position=point(x=x, y=y, z=0.0),
                                           orientation=turn(x=0.0, y=0.0, z=math.sin(theta / 2), w=math.cos(theta / 2)))
    none = np.zeros(36)
    return types["nav_msgs/msg/Odometry"](
        header=header, child_frame_id="base_link", pose=types["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=none),
        twist=types["geometry_msgs/msg/TwistWithCovariance"](
            twist=types["geometry_msgs/msg/Twist"](linear=vector, angular=vector), covariance=none))


def write(log, path):
    of_ros1 = path.suffix == ".bag"
    store = get_typestore(Stores.ROS1_NOETIC if of_ros1 else Stores.LATEST)
    with Writer1(path) if of_ros1 else Writer2(path, version=9) as bag:
        connections = {}
        for topic, message, stamp in messages(log, store.types):
            kind = message.__msgtype__
            if topic not in connections:
                connections[topic] = bag.add_connection(topic, kind, typestore=store)
            raw = store.serialize_ros1(message, kind) if of_ros1 else store.serialize_cdr(message, kind)
            bag.write(connections[topic], round(stamp * 1e9), raw)


if __name__ == "__main__":
    write(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
