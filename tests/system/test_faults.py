"""Every fault of the line in one drive: the firmware goes on by itself, counts, and the pose makes no leap."""
import bisect
import math

import pytest

from chain import Truth, tally
from waiting import wait_until

SPEEDS = (2, 1, 1)  # slower where the machine is too busy to hear all of it
RECOVERY_S = 3
MAX_SPEED = 0.6  # what the simulated robot cannot exceed (0.5 m/s, 0.9 rad/s), and some
MAX_TURN = 1.1
SIGMAS_M = 0.03
SIGMAS_RAD = 0.03

# fault, when it begins, how long it lasts (seconds of the drive), the counter that must tell of it
FAULTS = [
    ("flip", 4, 0, "bad_checksum"),
    ("cut", 9, 0, "bad_frame"),
    ("garbage:300", 14, 0, "garbage_bytes"),
    ("silence:2", 19, 2, "stream_restarts"),
    ("unplug:2", 27, 2, "reopens"),
    ("reset11", 35, 0, "resets"),
    ("repeat", 42, 0, "repeated"),
    ("wrap", 47, 0, None),
]

BREAK_THE_STREAM = {"silence:2", "unplug:2", "reset11"}


@pytest.fixture(scope="module")
def drive(long_chain):
    for speed in SPEEDS:
        drive_through_the_faults(long_chain, speed)
        if long_chain.tally["swallowed"] == 0 and heard_and_in_time(long_chain):
            break
    return long_chain


def heard_and_in_time(chain):
    poses, begin = chain.listener.poses, FAULTS[0][1]
    before = [pose for pose in poses if pose.utime - poses[0].utime < begin * 1e6]
    return len(poses) == chain.listener.statuses[-1].poses and chain.scans_came_in_time(before)


def drive_through_the_faults(chain, speed):
    chain.listener.forget()
    firmware = chain.firmware(f"[robot]\nmax_speed = {MAX_SPEED}\nmax_turn = {MAX_TURN}\n", speed=speed)
    spec = ",".join(f"{name}@{begin}" for name, begin, _, _ in FAULTS)
    sim = chain.drive("home", "--faults", spec, speed=speed)
    assert sim.wait(300) == 0, sim.err()
    chain.tally = tally(sim)
    statuses = chain.listener.statuses
    wait_until(lambda: statuses and statuses[-1].driver_state.startswith("no scanner"), 180, "notice of the end")
    assert firmware.running(), "it must not end by itself"
    assert firmware.end() == 0


def seconds_of_drive(drive):
    """Poses with their time since the first scan."""
    poses = drive.listener.poses
    return [((pose.utime - poses[0].utime) * 1e-6, pose) for pose in poses]


@pytest.mark.parametrize("name, begin, duration, counter", FAULTS)
def test_it_goes_on_by_itself(drive, name, begin, duration, counter):
    end = begin + duration
    answered = [t for t, pose in seconds_of_drive(drive) if not pose.predicted and t > end]
    assert answered, f"nothing after {name}"
    assert answered[0] - end <= RECOVERY_S, f"{name}: {answered[0] - end:.2f} s"
    print(f"{name}: first scan used {answered[0] - end:.2f} s after its end")


@pytest.mark.parametrize("name, begin, duration, counter", [fault for fault in FAULTS if fault[3]])
def test_it_counts_what_happened(drive, name, begin, duration, counter):
    assert drive.listener.counters()[counter] > 0, f"{name} does not show in {counter}"


def test_the_smooth_pose_takes_no_step_that_the_robot_could_not(drive):
    poses = drive.listener.poses
    for before, after in zip(poses, poses[1:]):
        dt = (after.utime - before.utime) * 1e-6
        step = math.hypot(after.x - before.x, after.y - before.y)
        turn = abs(math.remainder(after.theta - before.theta, 2 * math.pi))
        assert step <= MAX_SPEED * dt + SIGMAS_M, f"{step:.3f} m in {dt:.3f} s before scan {after.scan}"
        assert turn <= MAX_TURN * dt + SIGMAS_RAD, f"{turn:.3f} rad in {dt:.3f} s before scan {after.scan}"


def test_every_scan_sent_is_answered_by_one_pose_also_the_damaged(drive):
    """While the stream is being set up again the sensor may send what nobody asked for any more; before and after
    that each scan sent has its pose."""
    poses = drive.listener.poses
    assert [pose.scan for pose in poses] == list(range(len(poses)))
    assert all(later.utime > earlier.utime for earlier, later in zip(poses, poses[1:]))
    assert drive.tally["damaged"] >= 3
    start = poses[0].utime * 1e-6
    times = [pose.utime * 1e-6 for pose in poses]
    for sent in Truth(drive.truth_path).times:
        being_set_up = any(begin - 0.2 <= sent - start <= begin + duration + 1
                           for name, begin, duration, _ in FAULTS if name in BREAK_THE_STREAM)
        k = bisect.bisect(times, sent)
        nearest = min(abs(time - sent) for time in times[max(0, k - 1):k + 1])
        assert nearest < 0.03 or being_set_up, f"the scan at {sent - start:.2f} s has no pose"
    assert sum(pose.predicted for pose in poses) >= 2, "a scan that did not survive is answered by prediction"


def test_the_pose_is_good_again_at_the_end(drive):
    assert all(pose.state == 2 for pose in drive.listener.poses[-20:])
    last = drive.listener.poses[-1]
    assert math.hypot(last.map_x, last.map_y) < 0.06, "the drive ends where it began"
