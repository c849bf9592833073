"""The firmware over many scans and under load: `make endurance`. Minutes, therefore not part of `make test`.

It is to be run on a machine that does nothing else; what it prints is what the firmware's README states. It prints, too, how long the
machine itself stood still meanwhile: a pose cannot come sooner than that.
"""
import os
import subprocess

import pytest

from chain import Chain
from lcm_url import free_lcm_url
from long_drive import resident_bytes, rounds
from standstill import Standstill
from waiting import wait_until

SCANS_UNDER_LOAD = 1000
P99_US = 10000
SPEED = 10
SCANS = 20000
SCANS_WITHOUT_A_MISS = 10000
SETTLED = 1000
GROWTH_BYTES = 64 * 1024


@pytest.fixture
def status_chain(tmp_path, multicast):
    """A chain whose listener has nothing to do but to count."""
    running = Chain(tmp_path, free_lcm_url(), channels=("ALE_STATUS",))
    yield running
    running.stop()


def await_scans(chain, firmware, count, seconds):
    """The first status after so many scans."""
    statuses = chain.listener.statuses
    wait_until(lambda: not firmware.running() or (statuses and statuses[-1].scans >= count), seconds, f"{count} scans")
    assert firmware.running(), firmware.err()
    return statuses[-1]


@pytest.fixture(autouse=True)
def standstill():
    watch = Standstill()
    yield
    print(f"the machine itself stood still for up to {1000 * max(watch.stop(), default=0):.1f} ms")


@pytest.fixture
def both_processors_loaded():
    """Other programs, at normal priority, that want all there is."""
    hogs = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(os.cpu_count() or 1)]
    yield
    for hog in hogs:
        hog.kill()
        hog.wait()


def test_99_of_100_poses_come_within_ten_milliseconds_under_load(status_chain, both_processors_loaded):
    status_chain.simulator("--world", rounds(status_chain.folder, "home", 4))
    firmware = status_chain.firmware()
    status = await_scans(status_chain, firmware, SCANS_UNDER_LOAD, 2 * SCANS_UNDER_LOAD / 10)
    assert firmware.end() == 0
    print(f"{firmware.err().splitlines()[0]}\n{status.scans} scans at 10 Hz with every processor loaded: last byte to pose median "
          f"{status.latency_p50_us / 1000:.2f} ms, p99 {status.latency_p99_us / 1000:.2f} ms, worst "
          f"{status.latency_worst_us / 1000:.2f} ms; {status.deadline_misses} deadlines missed")
    assert 0 < status.latency_p99_us < P99_US
    assert status.deadline_misses == 0


def test_no_deadline_is_missed_and_memory_does_not_grow_at_ten_times_the_speed(status_chain):
    status_chain.simulator("--world", rounds(status_chain.folder, "home", 50), speed=SPEED)
    firmware = status_chain.firmware(speed=SPEED)
    await_scans(status_chain, firmware, SETTLED, 60)
    settled = resident_bytes(firmware)
    half = await_scans(status_chain, firmware, SCANS_WITHOUT_A_MISS, 2 * SCANS_WITHOUT_A_MISS / 10 / SPEED)
    status = await_scans(status_chain, firmware, SCANS, 2 * SCANS / 10 / SPEED)
    growth = resident_bytes(firmware) - settled
    assert firmware.end() == 0
    counters = status_chain.listener.counters()
    print(f"{half.deadline_misses} deadlines missed in {half.scans} scans at {SPEED} times the speed, {status.deadline_misses} in "
          f"{status.scans}; worst {status.latency_worst_us / 1000:.2f} ms, {counters['overloaded']} set aside\n"
          f"resident memory {settled / 2 ** 20:.1f} MiB after {SETTLED} scans, {growth / 1024:+.0f} KiB by scan {status.scans}")
    assert half.deadline_misses == 0
    assert growth <= GROWTH_BYTES
