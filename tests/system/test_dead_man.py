"""A daemon that is killed while it drives: the simulated robot stands, and so does what obeys ALE_DRIVE as the example does."""
import math
import os
import subprocess
import time

import ale
import pytest

from at_hand import ROOT
from test_commands import Rover
from waiting import Ear, wait_until

EXAMPLE = ROOT / "tools/library/motors/motors.c"
SPEED = 0.2
STANDS_WITHIN_S = 1.5  # half a second until the simulated board gives up, and its braking
TRACK = 0.4


@pytest.fixture(name="board", scope="module")
def the_example(tmp_path_factory):
    folder = tmp_path_factory.mktemp("board")
    subprocess.run(["lcm-gen", "-c", "--c-cpath", folder, "--c-hpath", folder, ROOT / "lib/messages/ale.lcm"], check=True,
                   env={**os.environ, "PATH": "/usr/bin:/bin"})
    subprocess.run(["cc", "-w", "-c", folder / "ale_drive_t.c", "-o", folder / "type.o"], check=True)
    subprocess.run(["cc", "-D_GNU_SOURCE", "-std=c11", "-Wall", "-Wextra", "-Werror", "-isystem", folder, EXAMPLE, folder / "type.o",
                    "-llcm", "-lm", "-o", folder / "motors"], check=True)
    return folder / "motors"


def speed_of(before, after):
    return math.hypot(after.x - before.x, after.y - before.y) / max((after.utime - before.utime) * 1e-6, 1e-3)


def test_a_daemon_that_dies_while_it_drives_leaves_a_robot_that_stands(chain, board):
    told = []
    rover = Rover(chain)
    ear = Ear(chain.url, ["ALE_ODOMETRY"], lambda _, data: told.append(ale.odometry_t.decode(data)))
    motors = subprocess.Popen([board, str(TRACK)], stdout=subprocess.PIPE, text=True, env={**os.environ, "LCM_DEFAULT_URL": chain.url})
    wheels = []
    try:
        os.set_blocking(motors.stdout.fileno(), False)

        def lines():
            wheels.extend(tuple(map(float, line.split())) for line in motors.stdout.readlines())
            return wheels
        with rover.held_stick("alice", str(SPEED), "0"):
            wait_until(lambda: len(told) > 1 and speed_of(told[-2], told[-1]) > SPEED / 2, 180, "a robot that moves")
            wait_until(lambda: lines() and wheels[-1][0] > 0, 180, "wheels that turn")
            rover.firmware.kill()
            killed_us = time.time() * 1e6
            wait_until(lambda: told[-1].utime > killed_us + (STANDS_WITHIN_S + 1) * 1e6, 180, "odometry of afterwards")
        after = [odometry for odometry in told if odometry.utime > killed_us + STANDS_WITHIN_S * 1e6]
        assert max(speed_of(one, another) for one, another in zip(after, after[1:])) < 0.001
        wait_until(lambda: lines()[-1] == (0, 0), 180, "wheels that stand")
    finally:
        motors.kill()
        motors.wait()
        ear.stop()
        rover.motors.stop()


def test_the_example_says_what_it_wants(board):
    done = subprocess.run([board], check=False, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "usage: motors TRACK_METRES" in done.stderr
