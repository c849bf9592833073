"""A Hokuyo UST-10LX over TCP: 1,081 beams forty times a second; refused, pulled out, put back."""
import math

import pytest

from at_hand import WORLDS, free_tcp_port
from chain import Truth, trajectory_error

ATE_M = 0.030


@pytest.fixture
def port():
    return free_tcp_port()


def simulator(chain, port, *words):
    return chain.start("ale-sim", "--world", WORLDS / "home.world", "--sensor", "ust-10lx", "--tcp", port, "--lcm-url",
                       chain.url, *words)


def firmware(chain, port, config=""):
    return chain.firmware(config, "--port", f"tcp:127.0.0.1:{port}")


def told(chain):
    return "\n".join(status.driver_state for status in chain.listener.statuses)


def test_it_keeps_up_at_forty_scans_a_second(chain, port):
    sim = simulator(chain, port, "--truth", chain.truth_path, "--once")
    slamd = firmware(chain, port)
    counted = chain.play_to_the_end(sim, slamd)
    poses = chain.listener.poses
    metres, radians, count = trajectory_error(poses, Truth(chain.truth_path))
    print(f"error {metres * 1000:.1f} mm, {math.degrees(radians):.2f} degrees over {count} scans of {counted['sent']}")
    assert counted["sent"] > 2000 and len(poses) > 0.98 * counted["sent"]
    assert chain.listener.counters()["overloaded"] < 0.02 * counted["sent"]
    assert metres < ATE_M


def test_refused_then_there_then_pulled_out_then_there(chain, port):
    slamd = firmware(chain, port)
    slamd.wait_until(lambda: "connection refused" in told(chain), "the word of a refused connection")
    simulator(chain, port, "--faults", "unplug:2@3")
    slamd.wait_until(lambda: chain.listener.poses, "poses")
    slamd.wait_until(lambda: chain.listener.counters().get("reopens", 0) > 0, "the cable pulled out")
    before = len(chain.listener.poses)
    slamd.wait_until(lambda: len(chain.listener.poses) > before + 50, "poses again")
    assert slamd.end() == 0


def test_a_wrong_address_is_told(chain):
    slamd = chain.firmware("", "--port", "tcp:scanner:10940")
    slamd.wait_until(lambda: "no numeric address and port" in told(chain), "the word of a wrong address")
    assert slamd.end() == 0
