"""ROS 2's side of the real firmware: who may drive it from there, and who may not."""
import math
import subprocess
import time

import pytest

from at_hand import BINARIES, LONG
from chain import wrap
from commanded import Commanded
from waiting import wait_until

pytest.importorskip("cyclonedds", reason="PyPI's cyclonedds is not here")
if not (BINARIES / "ale-ros2").exists():
    pytest.skip("ale-ros2 was not built: no Cyclone DDS (cyclonedds-dev, cyclonedds-tools)", allow_module_level=True)

from ros_peer import Bridge, RosPeer, free_domain  # noqa: E402
from ros_types import (Header, Point, Pose, PoseStamped, PoseWithCovariance, PoseWithCovarianceStamped, Quaternion, Time, Twist,  # noqa: E402
                       Vector3)


def forward(metres_a_second):
    return Twist(Vector3(metres_a_second, 0.0, 0.0), Vector3())


def elsewhere():
    return PoseWithCovarianceStamped(Header(Time(), "map"), PoseWithCovariance(Pose(Point(5.0, 5.0, 0.0), Quaternion()), [0.0] * 36))


def goes_to_start(listener):
    plans = listener.messages["ALE_PLAN"]
    return plans and plans[-1].state == 3 and plans[-1].has_place and (plans[-1].place_x, plans[-1].place_y) == (0, 0)


@LONG
def test_only_a_bridge_with_a_key_that_the_robot_knows_moves_it(chain):
    robot = Commanded(chain)
    domain = free_domain()
    peer = RosPeer(domain)
    drive, place = peer.writer("cmd_vel", Twist), peer.writer("initialpose", PoseWithCovarianceStamped)
    stranger = chain.folder / "mallory.key"
    subprocess.run([BINARIES / "ale-keys", "mallory", "--secret", stranger, "--robot", chain.folder / "other.keys"], check=True,
                   capture_output=True, timeout=180)
    (chain.folder / "mallory.key.robots").unlink()  # he takes every robot at its word, and signs for it
    poses = chain.listener.poses

    def publish(seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            drive.write(forward(0.2))
            place.write(elsewhere())
            time.sleep(0.05)

    def moved_since(count):
        return max((math.hypot(pose.map_x - poses[count].map_x, pose.map_y - poses[count].map_y) for pose in poses[count:]), default=0.0)
    for words in ([], ["--keys", stranger]):
        bridge = Bridge(domain, chain.url, *words)
        before = len(poses) - 1
        publish(4)
        wait_until(lambda: len(poses) > before + 20, 180, "poses")
        assert moved_since(before) < 0.05
        assert bridge.end() == 0
    wait_until(lambda: chain.listener.counters()["command_stranger"] > 0, 180, "the stranger to be counted")
    bridge = Bridge(domain, chain.url, "--keys", robot.key)
    before = len(poses) - 1
    wait_until(lambda: drive.write(forward(0.2)) or moved_since(before) > 0.2, 180, "the robot to drive")
    assert abs(wrap(poses[-1].map_theta - poses[before].map_theta)) < 0.2
    goal = peer.writer("goal_pose", PoseStamped)
    wait_until(lambda: goal.write(PoseStamped(Header(Time(), "map"), Pose(Point(), Quaternion()))) or goes_to_start(chain.listener), 180, "the plan")
    assert bridge.end() == 0
