"""The firmware for a day, at ten times the speed: `make soak` (two hours and a half; SOAK_HOURS=1 is six minutes).

It drives round after round through the bundled home, keeps its map every ten seconds, and is listened to. Nothing may grow, and no
deadline be missed but when the machine itself stood still. To be run on a machine that does nothing else.
"""
import math
import os
import time

import pytest

from chain import Chain
from lcm_url import free_lcm_url
from long_drive import descriptors, resident_bytes, rounds, threads
from standstill import Standstill
from waiting import wait_until

HOURS = float(os.environ.get("SOAK_HOURS", "24"))
SPEED = 10
SCANS_AN_HOUR = 36000
SETTLED = 6000
LOOK_SCANS = 6000
DEADLINE_S = 0.1 / SPEED
GROWTH_BYTES = 64 * 1024
ROUND_SCANS = 600  # at least
GOOD = 2
GOOD_POSES = 100


class Look:
    """What the firmware holds at one moment."""

    def __init__(self, status, firmware):
        self.scans = status.scans
        self.late = status.deadline_misses
        self.resident = resident_bytes(firmware)
        self.held = descriptors(firmware), threads(firmware)

    def __str__(self):
        return (f"{self.scans:8} scans, {self.late} late, {self.resident / 2 ** 20:.2f} MiB, {self.held[0]} descriptors, "
                f"{self.held[1]} threads")


class Soak:
    """The whole of it: a look every ten minutes of the robot's, and how long the machine itself stood still each time."""

    def __init__(self, folder):
        chain = Chain(folder, free_lcm_url(), channels=("ALE_STATUS", "ALE_POSE"))
        watch = Standstill()
        scans = int(HOURS * SCANS_AN_HOUR)
        try:
            chain.simulator("--world", rounds(folder, "home", 2 + scans // ROUND_SCANS), speed=SPEED)
            firmware = chain.firmware(f"[map]\nkeep = {folder}/kept.map\n[recorder]\nfolder = {folder}\n", speed=SPEED)
            self.looks = all_looks(chain.listener, firmware, scans)
            self.ended = firmware.end()
            self.said = firmware.err()
        finally:
            chain.stop()
            self.stills = watch.stop()


def all_looks(listener, firmware, scans):
    taken = []
    end = time.monotonic() + 2 * scans / 10 / SPEED
    while not taken or taken[-1].scans < scans:
        wanted = taken[-1].scans + LOOK_SCANS if taken else SETTLED
        wait_until(lambda at=wanted: not firmware.running() or (listener.statuses and listener.statuses[-1].scans >= at),
                   end - time.monotonic(), f"{wanted} scans")
        assert firmware.running(), firmware.err()
        taken.append(Look(listener.statuses[-1], firmware))
        print(taken[-1], flush=True)
        assert all(pose.state == GOOD for pose in listener.poses[-GOOD_POSES:])
        listener.forget()
    return taken


@pytest.fixture(scope="module")
def soak(tmp_path_factory, multicast):
    return Soak(tmp_path_factory.mktemp("soak"))


def test_it_ends_as_it_is_told_to(soak):
    print(soak.said[-2000:])
    assert soak.ended == 0


def test_nothing_grows(soak):
    first, last = soak.looks[0], soak.looks[-1]
    assert last.resident - first.resident <= GROWTH_BYTES
    assert last.held == first.held


def test_no_deadline_is_missed_that_the_machine_did_not_take(soak):
    """A standstill makes late the scans of its own length, and the one it falls into."""
    taken = sum(math.ceil(seconds / DEADLINE_S) + 1 for seconds in soak.stills)
    print(f"the machine itself stood still {len(soak.stills)} times, for up to {1000 * max(soak.stills, default=0):.0f} ms: {taken} scans")
    assert soak.looks[-1].late <= taken
