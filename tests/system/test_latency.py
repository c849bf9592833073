"""From the last byte of a scan to its pose on the wire, in real time at ten scans a second."""
import statistics

from chain import wait_until

SCANS = 80
MEDIAN_US = 5000


def test_the_median_is_under_five_milliseconds(chain):
    chain.simulator("--world", "tools/worlds/home.world")
    firmware = chain.firmware()
    wait_until(lambda: len(chain.listener.poses) >= SCANS, 30, f"{SCANS} poses")
    assert firmware.end() == 0
    by_message = statistics.median(pose.age_us - (pose.arrival_utime - pose.utime) for pose in chain.listener.poses)
    status = chain.listener.statuses[-1]
    print(f"median {status.latency_p50_us:.0f} us ({by_message:.0f} us at sending), "
          f"p99 {status.latency_p99_us:.0f} us, worst {status.latency_worst_us:.0f} us")
    assert 0 < by_message < MEDIAN_US
    assert 0 < status.latency_p50_us < MEDIAN_US
    assert status.deadline_misses <= 1
