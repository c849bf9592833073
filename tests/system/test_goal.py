"""A goal: the robot drives to a place of the map that an operator names, through the arena, or says why it does not."""
import math
import subprocess

import pytest

from at_hand import BINARIES, WORLDS
from chain import Truth, tally
from waiting import wait_until

SPEED = 4
GOES, ARRIVED, GIVEN_UP = 3, 4, 5  # of ALE_PLAN
PLACE = (3.2, 1.1)  # behind two corners; nothing of the way there has been seen at the start


class Rover:
    def __init__(self, chain):
        self.chain = chain
        self.key, keys = chain.folder / "alice.key", chain.folder / "robot.keys"
        subprocess.run([BINARIES / "ale-keys", "alice", "--secret", self.key, "--robot", keys], check=True, timeout=180)
        chain.sim = chain.simulator("--world", WORLDS / "arena.world", "--drive", "--truth", chain.truth_path, speed=SPEED)
        self.firmware = chain.firmware("[commands]\nrobot = rover\n[recorder]\nfolder =\n", "--keys", keys, speed=SPEED)
        self.firmware.wait_until(lambda: len(chain.listener.poses) > 20 and chain.listener.map_parts, "a map and a pose")

    def send(self, *words):
        """Whether the robot obeyed, and what it said."""
        done = subprocess.run([BINARIES / "ale-send", "--keys", self.key, "--lcm-url", self.chain.url, *map(str, words)], check=False,
                              stdin=subprocess.DEVNULL, text=True, timeout=180, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        return done.returncode == 0, (done.stdout + done.stderr).strip()

    @property
    def plans(self):
        return self.chain.listener.messages["ALE_PLAN"]

    @property
    def place(self):
        pose = self.chain.listener.poses[-1]
        return pose.map_x, pose.map_y

    def goes(self):
        return bool(self.plans) and self.plans[-1].state == GOES

    def stands_at(self, place):
        return bool(self.plans) and self.plans[-1].state == ARRIVED and math.dist(self.place, place) < 0.1


@pytest.fixture
def rover(chain):
    return Rover(chain)


def test_the_robot_drives_to_the_place_and_tells_its_way(rover, chain):
    obeyed, said = rover.send("goto", *PLACE)
    assert obeyed and "rover: drives to 3.20 1.10: " in said, said
    wait_until(rover.goes, 180, "a plan")
    plan = rover.plans[-1]
    assert plan.has_place and (plan.place_x, plan.place_y) == pytest.approx(PLACE, abs=1e-3)
    assert math.dist((plan.x[-1], plan.y[-1]), PLACE) < 0.05, "the path leads there"
    wait_until(lambda: rover.plans[-1].state != GOES, 180, "the end of the drive")
    assert rover.stands_at(PLACE), rover.plans[-1].words
    assert rover.plans[-1].words == "is at 3.20 1.10"
    wait_until(lambda: chain.listener.statuses[-1].who_drives == "", 180, "nobody drives")
    assert chain.listener.statuses[-1].exploration == "is at 3.20 1.10"
    assert rover.send("goto", 0, 0)[0], "and back"
    wait_until(lambda: rover.plans[-1].state != GOES and rover.plans[-1].place_x == 0, 180, "the end of the drive")
    assert rover.stands_at((0, 0)), rover.plans[-1].words
    assert chain.sim.end() == 0
    assert tally(chain.sim)["collisions"] == 0
    truth = Truth(chain.truth_path)
    assert math.dist(truth.world[0][:2], truth.world[-1][:2]) < 0.15


def test_a_place_in_a_wall_and_one_too_far_are_refused_with_the_reason(rover):
    assert rover.send("goto", 1, -0.6) == (False, "rover: gave up 1.00 -0.60: there is no room for the robot there")
    assert rover.send("goto", 100, 0) == (False, "rover: gave up 100.00 0.00: too far away to plan a way there")
    assert rover.send("goto", "there", 0) == (False, "rover: goto wants x y, metres")
    wait_until(lambda: rover.plans and rover.plans[-1].state == GIVEN_UP, 180, "what has become of it, for those who look")
    assert math.dist(rover.place, (0, 0)) < 0.05, "and it has not moved"


@pytest.mark.parametrize("words", [("stop",), ("drive", 0, 0.2), ("explore", "off")])
def test_it_is_called_off(rover, chain, words):
    assert rover.send("goto", *PLACE)[0]
    wait_until(lambda: chain.listener.statuses[-1].who_drives == "goal" and rover.goes(), 180, "the drive")
    assert rover.send(*words)[0]
    wait_until(lambda: not rover.goes(), 180, "the end of the plan")
    wait_until(lambda: chain.listener.statuses[-1].who_drives != "goal", 180, "the status says so")
    stood_at = rover.place
    seen = len(chain.listener.poses)
    wait_until(lambda: len(chain.listener.poses) > seen + 20, 180, "two seconds")
    assert math.dist(stood_at, rover.place) < 0.3 and math.dist(rover.place, PLACE) > 1
