"""A scanner that goes away: the status tells the cause within a second of the last scan, the log once, and what becomes of tracking."""
import math
import re

import pytest

from chain import Truth, trajectory_error
from waiting import wait_until

WITHIN_S = 1.0


@pytest.mark.parametrize("fault, cause", [("unplug:4@6", "no scanner: the port is gone"), ("silence:4@6", "the sensor")])
def test_the_cause_is_told_within_a_second(chain, fault, cause):
    simulator = chain.drive("home", "--faults", fault)
    firmware = chain.firmware()
    listener = chain.listener

    def told():
        return [status for status in listener.statuses if cause in status.driver_state and not status.driver_state.startswith("streaming")]
    simulator.wait_until(told, "its cause")
    first = told()[0]
    seen = max(pose.utime for pose in listener.poses if pose.utime < first.utime and not pose.predicted)
    print(f"{(first.utime - seen) * 1e-6:.2f} s: {first.driver_state}")
    assert first.utime - seen < WITHIN_S * 1e6
    simulator.wait_until(lambda: listener.statuses[-1].driver_state.startswith("streaming"), "scans again")
    assert firmware.running()


def test_lines_of_the_log_have_a_time_and_come_once_a_change(chain):
    simulator = chain.drive("home", "--faults", "unplug:3@6")
    firmware = chain.firmware(f"[recorder]\nfolder = {chain.folder}\n")
    simulator.wait_until(lambda: firmware.err().count(": streaming") == 2, "scans again")
    wait_until(lambda: "flight recording" in firmware.err(), 60, "a recording of it")
    assert firmware.end() == 0
    lines = firmware.err().splitlines()
    assert [line for line in lines if not re.match(r"ale-slamd: \d{4}-\d\d-\d\d \d\d:\d\d:\d\d \S", line)] == []
    assert sum("scanner lost: the port is gone" in line for line in lines) == 1


def test_a_robot_that_drove_on_meanwhile_says_once_that_it_is_lost_and_is_found(chain):
    """The wheels tell where it has gone, however long it takes; what it sees there is new, until it comes home."""
    simulator = chain.drive("home", "--faults", "unplug:10@14", speed=4)
    firmware = chain.firmware(speed=4)
    firmware.wait_until(lambda: " found in the map at " in firmware.err(), "its being found")
    assert simulator.wait(300) == 0, simulator.err()
    assert firmware.end() == 0
    assert firmware.err().count(" lost at ") == firmware.err().count(" found in the map at ") == 1
    truth = Truth(chain.truth_path)
    good = [pose for pose in chain.listener.poses if pose.state == 2]
    error, turn, count = trajectory_error(good, truth)
    print(f"{count} good poses, {error * 1000:.0f} mm, {math.degrees(turn):.2f} degrees")
    assert error < 0.1
