"""ale-sim and LCM: wheel odometry out, velocity set points in."""
import math
import os
import pathlib
import select
import time

import ale
import lcm
import pytest

from scip_client import Client, Gone
from test_sim import ROOM, STREAM, Simulator
from waiting import Pulse, wait_until
from watching import lcm_url  # noqa: F401 (fixture)


SPEED = 2
ORDER_LIFE_S = 0.5  # of silence after which the simulated robot stands, in its own time


class Wheels:
    """Keeps what comes on ALE_ODOMETRY."""

    def __init__(self, url):
        self.bus = lcm.LCM(url)
        self.reports = []
        self.bus.subscribe("ALE_ODOMETRY", self._take).set_queue_capacity(0)

    def _take(self, _, data):
        self.reports.append(ale.odometry_t.decode(data))

    def take_what_has_come(self):
        while select.select([self.bus], [], [], 0.05)[0]:
            self.bus.handle()


@pytest.fixture
def simulator(tmp_path):
    started = []

    def begin(*words, world=ROOM):
        started.append(Simulator(tmp_path, *words, world=world, odometry=True))
        return started[-1]

    yield begin
    for one in started:
        one.process.kill()
        one.process.communicate()


def play_to_its_end(link, wheels):
    client = Client(link)
    client.ask(STREAM)
    with pytest.raises(Gone):
        while True:
            client.scan()
            wheels.take_what_has_come()
    wheels.take_what_has_come()


def test_odometry_goes_out_twenty_times_a_second_stamped_with_the_time_of_day(simulator, lcm_url):
    wheels = Wheels(lcm_url)
    before = time.time()
    running = simulator("--once", "--lcm-url", lcm_url, world=ROOM + "# via 0.4 0\n")
    play_to_its_end(running.link, wheels)
    after = time.time()
    stamps = [report.utime / 1e6 for report in wheels.reports]
    assert len(stamps) > 40
    assert {round(b - a, 3) for a, b in zip(stamps, stamps[1:])} == {0.05}
    assert before < stamps[0] < stamps[-1] < after
    end = wheels.reports[-1]
    assert math.hypot(end.x, end.y) == pytest.approx(0.4, rel=0.12), "wheels err by a few per cent"


def test_at_another_speed_the_time_of_day_is_scaled(simulator, lcm_url):
    wheels = Wheels(lcm_url)
    before = time.time() * 4
    running = simulator("--once", "--speed", 4, "--lcm-url", lcm_url, world=ROOM + "# via 0.4 0\n")
    play_to_its_end(running.link, wheels)
    stamps = [report.utime / 1e6 for report in wheels.reports]
    assert before < stamps[0] < stamps[-1] < time.time() * 4
    assert {round(b - a, 3) for a, b in zip(stamps, stamps[1:])} == {0.05}


class Driver(Pulse):
    """Sends one set point, again and again, until it is told another or to be silent."""

    def __init__(self, url):
        self.bus = lcm.LCM(url)
        self.set_point = None
        super().__init__(0.05, self._send)

    def _send(self):
        if self.set_point:
            message = ale.drive_t()
            message.utime = time.time_ns() // 1000
            message.v, message.w = self.set_point
            self.bus.publish("ALE_DRIVE", message.encode())


@pytest.fixture
def driver(lcm_url):
    one = Driver(lcm_url)
    yield one
    one.stop()


def scan_until(client, condition, scans=400):
    for _ in range(scans):
        scan = client.scan()
        if condition(scan):
            return scan
    raise AssertionError("it never came to that")


def test_it_drives_as_told_stops_without_orders_and_at_walls(simulator, lcm_url, driver):
    running = simulator("--drive", "--noise", "none", "--speed", SPEED, "--lcm-url", lcm_url)
    client = Client(running.link)
    client.ask(STREAM)
    assert client.scan().values[340] == 3000, "without orders it stands"
    driver.set_point = (0.5, 0)
    scan_until(client, lambda scan: scan.values[340] < 2500)
    driver.set_point = None
    ahead = []
    scan_until(client, lambda scan: ahead.append(scan.values[340]) or len(ahead) > 3 and len(set(ahead[-4:])) == 1)
    assert ahead[-1] > 1000, "half a second of silence stops it"
    driver.set_point = (0, 0.9)
    scan_until(client, lambda scan: scan.values[340] < ahead[-1] * 0.8)
    driver.set_point = (0.5, 0)
    scan_until(client, lambda scan: scan.values[340] < 300)
    driver.set_point = (0.5, 0)
    for _ in range(10):
        scan = client.scan()
    assert scan.values[340] > 150, "the wall holds it"
    beats = driver.beats
    held_up = max(after - before for before, after in zip(beats, beats[1:])) > ORDER_LIFE_S / SPEED / 2
    collisions = running.stop()["collisions"]
    assert collisions == 1 or held_up and collisions > 1, "a busy machine's orders end on the way, and it begins anew"


def test_nonsense_on_the_channel_moves_nothing(simulator, lcm_url):
    running = simulator("--drive", "--noise", "none", "--lcm-url", lcm_url)
    client = Client(running.link)
    client.ask(STREAM)
    client.scan()
    bus = lcm.LCM(lcm_url)
    message = ale.drive_t()
    message.v, message.w = math.nan, math.inf
    bus.publish("ALE_DRIVE", message.encode())
    bus.publish("ALE_DRIVE", b"\x00" * 40)
    bus.publish("ALE_DRIVE", b"")
    for _ in range(5):
        assert client.scan().values[340] == 3000


def processor_s(process):
    """What it has used so far."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def test_orders_before_anyone_scans_do_not_keep_it_busy(simulator, lcm_url, driver):
    running = simulator("--drive", "--lcm-url", lcm_url)
    driver.set_point = (0.5, 0)
    begun, before, beats = time.monotonic(), processor_s(running.process), len(driver.beats)
    wait_until(lambda: len(driver.beats) > beats + 10, 180, "orders")
    assert processor_s(running.process) - before < 0.2 * (time.monotonic() - begun), "it had next to nothing to do"
