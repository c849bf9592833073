"""A real recording, played over the pseudo terminal to its end."""
import math
import os
import pathlib
import subprocess

import pytest

from chain import BINARIES, tally, wait_until

SHARED = os.environ.get("ALE_SHARED", "")
SPEED = 20


def recording(name):
    path = pathlib.Path(SHARED) / "data" / "urg04lx" / name
    if not SHARED or not path.exists():
        pytest.skip(f"{name} is not here (ALE_SHARED)")
    return path


def test_exp1_is_answered_scan_by_scan(chain):
    log = recording("exp1.dat")
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
