"""After a power cut: on from the last map and pose, or lost; never sure and wrong."""
import math
import signal
import time

import pytest

from at_hand import WORLDS
from chain import Truth, wrap
from waiting import wait_until

SPEED = 10
LOST, GOOD = 0, 2
FIRST, LATER = (1.5, 1.5, 0.0), (6.75, 7.4, 3.0)  # in the living room; in the study, where nobody left it
WAY = [(3.2, 1.95), (5.8, 2.0), (4.2, 2.0)]


def world_from(folder, name, start, vias):
    """The bundled world with another way through it."""
    walls = [line for line in (WORLDS / "home.world").read_text(encoding="utf-8").splitlines()
             if line.strip() and not line.startswith("#")]
    way = [f"# start {start[0]} {start[1]} {start[2]}"] + [f"# via {x} {y}" for x, y in vias]
    path = folder / name
    path.write_text("\n".join(way + walls) + "\n", encoding="utf-8")
    return path


def config(folder):
    return f"[map]\nkeep = {folder / 'kept.map'}\nkeep_seconds = 1\n"


def kept_pose(folder):
    """Out of the file: metres and radians; None while there is no file."""
    path = folder / "kept.map"
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else []:
        if line.startswith("pose "):
            x_um, y_um, theta_bam = map(int, line.split()[1:])
            return x_um * 1e-6, y_um * 1e-6, theta_bam * 2 * math.pi / 2**32
    return None


def near(kept, pose):
    return (kept is not None and math.dist(kept[:2], (pose.map_x, pose.map_y)) < 0.01
            and abs(wrap(kept[2] - pose.map_theta)) < math.radians(0.5))


def seen_from(origin, pose):
    dx, dy = pose[0] - origin[0], pose[1] - origin[1]
    c, s = math.cos(origin[2]), math.sin(origin[2])
    return (c * dx + s * dy, c * dy - s * dx, wrap(pose[2] - origin[2]))


def of_the_next_start(poses, count):
    """Poses after so many: without those of the start before that were still on their way."""
    later = poses[count - 1:]
    return next((later[k + 1:] for k in range(len(later) - 1) if later[k + 1].scan < later[k].scan), [])


@pytest.fixture
def driven(chain):
    """A robot that drove through two rooms and stands; its firmware running, its map kept."""
    world = world_from(chain.folder, "first.world", FIRST, WAY)
    chain.simulator("--world", world, speed=SPEED)
    firmware = chain.firmware(config(chain.folder), speed=SPEED)
    poses = chain.listener.poses
    end = (WAY[-1][0] - FIRST[0], WAY[-1][1] - FIRST[1])
    wait_until(lambda: len(poses) > 150 and all(abs(p.vx) < 0.01 and abs(p.omega) < 0.01 for p in poses[-20:])
               and math.dist((poses[-1].map_x, poses[-1].map_y), end) < 0.1, 180, "a robot that stands at its way's end")
    standing = len(poses)
    wait_until(lambda: near(kept_pose(chain.folder), poses[-1]), 180, "the pose in which it stands to be kept")
    # And once more, with what it sees from there: thrice the period at least, the map being a period old at most.
    first = (chain.folder / "kept.map").stat().st_mtime_ns
    wait_until(lambda: len(poses) > standing + 3 * SPEED * 10 and (chain.folder / "kept.map").stat().st_mtime_ns != first, 180,
               "the map to be kept again")
    return chain, firmware


def test_it_goes_on_from_the_last_map_and_pose(driven):
    chain, firmware = driven
    firmware.process.send_signal(signal.SIGKILL)
    firmware.wait(10)
    before = chain.listener.poses[-1]
    count = len(chain.listener.poses)
    again = chain.firmware(config(chain.folder), speed=SPEED)
    wait_until(lambda: len(of_the_next_start(chain.listener.poses, count)) >= 30, 180, "poses again")
    assert again.end() == 0
    assert "going on from" in again.err() and "last pose" in again.err()
    after = of_the_next_start(chain.listener.poses, count)
    for pose in after:
        assert pose.state != LOST or pose is after[0]
        assert math.hypot(pose.map_x - before.map_x, pose.map_y - before.map_y) < 0.05
        assert abs(wrap(pose.map_theta - before.map_theta)) < math.radians(2)
    assert after[-1].state == GOOD


def test_carried_away_meanwhile_it_is_lost_or_right(driven):
    chain, firmware = driven
    assert firmware.end() == 0
    chain.programs[0].end()
    count = len(chain.listener.poses)
    chain.simulator("--world", world_from(chain.folder, "second.world", LATER, [(6.7, 7.45)]), speed=SPEED)
    again = chain.firmware(config(chain.folder), speed=SPEED)
    wait_until(lambda: len(of_the_next_start(chain.listener.poses, count)) >= 150, 180, "poses again")
    assert again.end() == 0
    true = seen_from(FIRST, LATER)
    after = of_the_next_start(chain.listener.poses, count)
    assert any(pose.state == LOST for pose in after)
    sure = [pose for pose in after if pose.state == GOOD]
    assert all(math.hypot(pose.map_x - true[0], pose.map_y - true[1]) < 0.3 for pose in sure)


def test_what_cannot_be_read_is_told_and_the_robot_comes_up(chain):
    (chain.folder / "kept.map").write_text("ALE-SLAM map 1\nwall 1 2\n", encoding="utf-8")
    chain.simulator("--world", WORLDS / "home.world", speed=SPEED)
    firmware = chain.firmware(config(chain.folder), speed=SPEED)
    wait_until(lambda: len(chain.listener.poses) >= 20, 180, "poses")
    assert firmware.end() == 0
    assert "starting without what was kept" in firmware.err() and "line 2" in firmware.err()


def test_killed_on_its_way_it_is_lost_or_right_when_it_comes_up_elsewhere(chain):
    world = world_from(chain.folder, "way.world", FIRST, [(3.2, 1.95), (5.8, 2.0), (7.4, 2.0), (7.4, 4.7), (6.75, 4.75),
                                                           (6.75, 7.4)])
    chain.simulator("--world", world, "--truth", chain.truth_path, speed=SPEED)
    firmware = chain.firmware(config(chain.folder), speed=SPEED)
    poses = chain.listener.poses
    wait_until(lambda: poses and poses[-1].map_x > 3 and (chain.folder / "kept.map").exists(), 180,
               "a drive whose map is kept")
    firmware.process.send_signal(signal.SIGKILL)
    firmware.wait(10)
    count = len(poses)
    way_on = time.monotonic() + 0.4  # four seconds of its way
    wait_until(lambda: time.monotonic() > way_on, 180, "the robot to drive on unseen")
    again = chain.firmware(config(chain.folder), speed=SPEED)
    wait_until(lambda: len(of_the_next_start(poses, count)) >= 150, 180, "poses again")
    assert again.end() == 0
    chain.programs[0].end()
    assert "going on from" in again.err()
    truth = Truth(chain.truth_path)
    compared = [(pose, truth.at(pose.utime * 1e-6, FIRST)) for pose in of_the_next_start(poses, count)]
    compared = [(pose, true) for pose, true in compared if true]
    assert len(compared) > 100
    assert all(pose.state == LOST or math.hypot(pose.map_x - true[0], pose.map_y - true[1]) < 0.3
               for pose, true in compared if pose.state in (LOST, GOOD))
