"""A real recording, played over the pseudo terminal to its end."""
import math
import subprocess

from at_hand import BINARIES, shared
from chain import tally
from waiting import wait_until

SPEED = 20


def test_exp1_is_answered_scan_by_scan(chain):
    log = shared("data/urg04lx/exp1.dat")
    config = subprocess.run([BINARIES / "ale-sim", "--log", log, "--describe"], stdout=subprocess.PIPE, text=True,
                            check=True).stdout
    firmware = chain.firmware(config, speed=SPEED)
    sim = chain.simulator("--log", log, "--once", speed=SPEED)
    assert sim.wait(300) == 0, sim.err()
    sent = tally(sim)["sent"]
    wait_until(lambda: len(chain.listener.poses) >= sent, 5, "the last pose")
    assert firmware.end() == 0
    poses = chain.listener.poses
    assert len(poses) == sent
    assert sum(pose.predicted for pose in poses) <= 0.02 * sent
    lost = sum(pose.state == 0 for pose in poses)
    print(f"{sent} scans, {sum(pose.predicted for pose in poses)} predicted, {lost} lost")
    assert lost <= 0.02 * sent
    for before, after in zip(poses, poses[1:]):
        dt = (after.utime - before.utime) * 1e-6
        assert math.hypot(after.x - before.x, after.y - before.y) <= 3.0 * dt + 0.05
