"""Clocks that jump: odometry whose sender's clock is set, is of 1970, or is none, on a drive that needs it. In a bare corridor
no scan says how far the robot has gone."""
import pytest

import ale
import lcm

from chain import Chain, Truth
from lcm_url import free_lcm_url
from waiting import Ear, wait_until

CORRIDOR = "-20 1 40 1\n-20 -1 40 -1\n# start 0 0 0\n# via 10 0\n"
SPEED = 4
HOUR_US = 3600 * 10**6
YEARS_US = 56 * 365 * 24 * HOUR_US


class Restamped:
    """Odometry of one bus on another, with the stamps of another clock: stamp(utime, how many there were)."""

    def __init__(self, url, to_url, stamp):
        self.out = lcm.LCM(to_url)
        self.stamp = stamp
        self.count = 0
        self.ear = Ear(url, ["ALE_ODOMETRY"], self._take)

    def _take(self, channel, data):
        message = ale.odometry_t.decode(data)
        message.utime = self.stamp(message.utime, self.count)
        self.count += 1
        self.out.publish(channel, message.encode())

    def stop(self):
        self.ear.stop()


def drive(folder, stamp):
    """Through the corridor; how far the robot believes to have gone, how far it has, and the counters at the end."""
    chain = Chain(folder, free_lcm_url())
    wheels_url = free_lcm_url()
    relay = Restamped(wheels_url, chain.url, stamp)
    try:
        world = folder / "corridor.world"
        world.write_text(CORRIDOR, encoding="utf-8")
        robot_url, chain.url = chain.url, wheels_url
        simulator = chain.simulator("--world", world, "--truth", chain.truth_path, "--once", "--wheels", "1,1,0", speed=SPEED)
        chain.url = robot_url
        firmware = chain.firmware(speed=SPEED)
        assert simulator.wait(300) == 0, simulator.err()
        heard = len(chain.listener.statuses)
        wait_until(lambda: len(chain.listener.statuses) > heard + 1, 180, "a status of the end")
        truth = Truth(chain.truth_path)
        far = truth.world[-1][0] - truth.world[0][0]
        believed = chain.listener.poses[-1].map_x
        assert firmware.end() == 0
        counters = chain.listener.counters()
        print(f"{far:.2f} m, believed {believed:.2f} m; {relay.count} sent; "
              f"{({name: value for name, value in counters.items() if 'odometry' in name})}")
        return far, believed, counters, relay.count, firmware.err()
    finally:
        relay.stop()
        chain.stop()


@pytest.mark.parametrize("stamp, steps", [
    (lambda utime, _: utime, 0),
    (lambda utime, k: utime + (HOUR_US if k > 60 else 0), 1),
    (lambda utime, k: utime - (HOUR_US if k > 60 else 0), 1),
    (lambda utime, _: utime - YEARS_US, 0),
    (lambda utime, k: utime - (YEARS_US if k < 60 else 0), 1),
    (lambda utime, k: utime + HOUR_US * (k > 40) - 2 * HOUR_US * (k > 80), 2),
], ids=["its own clock", "an hour ahead", "an hour back", "1970", "1970, then set", "ahead and back"])
def test_odometry_is_used_whatever_its_senders_clock_does(tmp_path, multicast, stamp, steps):
    far, believed, counters, sent, said = drive(tmp_path, stamp)
    assert believed == pytest.approx(far, abs=0.3)
    assert counters["odometry_clock_steps"] == steps
    assert counters["odometry_refused"] == counters["odometry_misdated"] <= 20 * steps
    assert counters["odometry"] + counters["odometry_refused"] >= sent - 20, "all but those before it listened"
    assert min(steps, 1) <= said.count("the clock of its sender was set") <= steps, said


def test_odometry_without_a_time_is_refused_and_counted(tmp_path, multicast):
    far, _, counters, sent, _ = drive(tmp_path, lambda utime, k: 0)
    assert far > 5
    assert sent > 50
    assert counters["odometry"] == 0
    assert counters["odometry_unstamped"] == counters["odometry_refused"] >= sent - 20
    assert counters["odometry_malformed"] == counters["odometry_misdated"] == 0
