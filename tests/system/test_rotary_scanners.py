"""Scanners of a whole turn on the line: drives against the simulated truth, and what can go wrong on the line."""
import math

import pytest

from at_hand import WORLDS
from chain import Truth, distance_to_wall, tally, trajectory_error, walls_of
from waiting import wait_until

SPEEDS = (2, 1, 1)  # slower where the machine is too busy
ATE_M = 0.045  # half as much again as of a URG
ATE_RAD = math.radians(0.75)
ON_A_WALL_M = 0.060
RECOVERY_S = 3
NOISE = "[noise]\nown_um = 10000\nown_ppm = 0\nshared_um = 0\nshared_ppm = 0\nsurface_um = 5000\n"

# simulated sensor, family
SENSORS = [("ld06", "ldrobot"), ("rplidar-a1", "rplidar")]

# fault, when it begins, how long it lasts (seconds of the drive), the counter that must tell of it
FAULTS = [("flip", 4, 0, "bad_checksum"), ("cut", 7, 0, None), ("garbage:300", 10, 0, "garbage_bytes"),
          ("silence:2", 14, 2, None), ("unplug:2", 20, 2, "reopens"), ("stall:2", 27, 2, None)]


def config(family):
    return f"[sensor]\ntype = {family}\n{NOISE}"


@pytest.fixture(scope="module", params=SENSORS, ids=lambda sensor: sensor[0])
def drive(request, long_chain):
    """The chain after a drive that went well, all turns answered."""
    sensor, family = request.param
    for speed in SPEEDS:
        long_chain.listener.forget()
        firmware = long_chain.firmware(config(family), speed=speed)
        simulator = long_chain.drive("home", "--sensor", sensor, speed=speed)
        long_chain.tally = long_chain.play_to_the_end(simulator, firmware)
        if long_chain.tally["swallowed"] == 0 and long_chain.listener.counters()["overloaded"] == 0:
            break
    return long_chain


def test_every_turn_is_answered_by_one_pose(drive):
    poses = drive.listener.poses
    assert abs(len(poses) - drive.tally["sent"]) <= 3, "the first and the last turn are no whole ones"
    assert [pose.scan for pose in poses] == list(range(len(poses)))
    assert all(later.utime > earlier.utime for earlier, later in zip(poses, poses[1:]))
    assert sum(pose.predicted for pose in poses) <= 2


def test_the_pose_follows_the_truth(drive):
    metres, radians, count = trajectory_error(drive.listener.poses, Truth(drive.truth_path))
    print(f"error {metres * 1000:.1f} mm, {math.degrees(radians):.2f} degrees over {count} scans")
    assert count > 0.95 * drive.tally["sent"]
    assert metres <= ATE_M and radians <= ATE_RAD
    assert all(pose.state == 2 for pose in drive.listener.poses[-20:])


def test_lines_lie_on_true_walls(drive):
    truth, walls = Truth(drive.truth_path), walls_of("home")
    distances = []
    for message in drive.listener.features[::5]:
        pose = truth.world_at(message.utime * 1e-6)
        if not pose:
            continue
        c, s = math.cos(pose[2]), math.sin(pose[2])
        for line in message.lines:
            for x, y in ((line.x1, line.y1), (line.x2, line.y2)):
                at = (pose[0] + c * x - s * y, pose[1] + s * x + c * y)
                distances.append(min(distance_to_wall(wall, *at) for wall in walls))
    on_walls = sum(distance < ON_A_WALL_M for distance in distances) / len(distances)
    print(f"{len(distances)} line ends, {100 * on_walls:.1f} % on walls")
    assert on_walls > 0.93


@pytest.fixture(scope="module", params=SENSORS, ids=lambda sensor: sensor[0])
def faulty_drive(request, long_chain):
    sensor, family = request.param
    long_chain.listener.forget()
    firmware = long_chain.firmware(config(family), speed=1)
    spec = ",".join(f"{name}@{begin}" for name, begin, _, _ in FAULTS)
    simulator = long_chain.drive("home", "--sensor", sensor, "--faults", spec, speed=1)
    assert simulator.wait(300) == 0, simulator.err()
    statuses = long_chain.listener.statuses
    wait_until(lambda: statuses and statuses[-1].driver_state.startswith("no scanner"), 180, "notice of the end")
    long_chain.said = firmware.err()
    long_chain.counted = tally(simulator)
    assert firmware.end() == 0
    return long_chain


@pytest.mark.parametrize("name, begin, duration, counter", FAULTS)
def test_it_goes_on_by_itself(faulty_drive, name, begin, duration, counter):
    poses = faulty_drive.listener.poses
    end = begin + duration
    answered = [t for t in ((pose.utime - poses[0].utime) * 1e-6 for pose in poses if not pose.predicted) if t > end]
    assert answered and answered[0] - end <= RECOVERY_S, f"{name}: {answered[:1]}"
    if counter and not (faulty_drive.listener.counters()[counter] > 0):
        assert name == "flip", f"{name} does not show in {counter}"


def test_the_pose_is_good_again_at_the_end(faulty_drive):
    poses = faulty_drive.listener.poses
    assert all(pose.state == 2 for pose in poses[-20:])
    assert math.hypot(poses[-1].map_x, poses[-1].map_y) < 0.1, "the drive ends where it began"


def test_a_wrong_rate_is_told(chain):
    firmware = chain.firmware("[sensor]\ntype = ldrobot\nbaud = 115200\n")
    chain.simulator("--world", WORLDS / "home.world", "--sensor", "ld06")
    firmware.wait_until(lambda: "at 115200 bit/s and no packet among them: a wrong rate" in
                        "".join(status.driver_state for status in chain.listener.statuses), "the word of a wrong rate")
    assert firmware.end() == 0
