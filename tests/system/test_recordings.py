"""A real recording, played over the pseudo terminal to its end."""
import math
import subprocess

from at_hand import BINARIES, shared

SPEEDS = (20, 5, 2)  # slower where the machine is too busy to send or to hear all of it
PERIOD_S = 0.098  # a turn of the scanner: the recording has stamps of when scans were received, some 5 ms apart


def test_exp1_is_answered_scan_by_scan(chain):
    log = shared("data/urg04lx/exp1.dat")
    config = subprocess.run([BINARIES / "ale-sim", "--log", log, "--describe"], stdout=subprocess.PIPE, text=True,
                            check=True).stdout
    for speed in SPEEDS:
        chain.listener.forget()
        firmware = chain.firmware(config, speed=speed)
        counted = chain.play_to_the_end(chain.simulator("--log", log, "--once", speed=speed), firmware)
        if chain.all_went_well(counted):
            break
    sent = counted["sent"]
    poses = chain.listener.poses
    assert len(poses) == sent
    assert sum(pose.predicted for pose in poses) <= 0.02 * sent
    lost = sum(pose.state == 0 for pose in poses)
    print(f"{sent} scans, {sum(pose.predicted for pose in poses)} predicted, {lost} lost")
    assert lost <= 0.02 * sent
    for before, after in zip(poses, poses[1:]):
        dt = max((after.utime - before.utime) * 1e-6, PERIOD_S)
        assert math.hypot(after.x - before.x, after.y - before.y) <= 3.0 * dt + 0.05
