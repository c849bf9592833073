"""Two of them: on the same channels and the same port, where each is told of the other; and with channels of their own."""
import os
import re
import signal
import subprocess

import pytest

from at_hand import BINARIES, free_udp_port
from chain import Chain
from lcm_url import free_lcm_url
from waiting import Ear, wait_until
from watching import Console
from web_socket import WebSocket


def counters(status):
    return dict(zip(status.counter_name, status.counter_value))


def test_a_second_one_disturbs_nothing_and_both_say_who_the_other_is(chain):
    chain.simulator("--world", "tools/lab/worlds/home.world", "--no-odometry")
    first = chain.firmware()
    wait_until(lambda: len(chain.listener.poses) > 20, 180, "poses")
    second = chain.firmware()
    for program, other in ((first, second), (second, first)):
        wait_until(lambda p=program, o=other: f"process {o.process.pid}, boot nonce" in p.err(), 60, "a word about the other")
        assert program.err().count("another ale-slamd speaks on the same channels") == 1
    wait_until(lambda: "no scanner" in second.err(), 60, "the cause")
    assert f"in use by another program: process {first.process.pid}" in second.err()
    assert "cable" not in second.err()
    of_first = [status for status in chain.listener.statuses if status.poses > 0]
    before = len(chain.listener.poses)
    wait_until(lambda: len(chain.listener.poses) > before + 60, 180, "more poses")
    newest = [status for status in chain.listener.statuses if status.boot == of_first[0].boot][-1]
    for name in ("scans_lost", "bad_checksum", "garbage_bytes", "stream_restarts", "reopens"):
        assert counters(newest)[name] == 0, name
    assert counters(newest)["other_speakers"] == 1
    numbers = [pose.scan for pose in chain.listener.poses]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    assert first.end() == 0
    wait_until(lambda: "streaming" in second.err(), 60, "the second one, whose port it is now")
    assert second.end() == 0


class Channels(Ear):
    """All channels that are heard, and how often."""

    def __init__(self, url):
        self.count = {}
        super().__init__(url, [".*"], self._take)

    def _take(self, channel, _):
        self.count[channel] = self.count.get(channel, 0) + 1


@pytest.fixture(name="rovers")
def two_rovers(tmp_path, multicast):
    """Two robots on one bus, each with a prefix and its own scanner."""
    url = free_lcm_url()
    chains = []
    for name, world in (("rover1", "home"), ("rover2", "office")):
        (tmp_path / name).mkdir()
        chain = Chain(tmp_path / name, url, channels=())
        chains.append(chain)
        own = f"{url}&prefix={name}."
        subprocess.run([BINARIES / "ale-keys", "alice", "--secret", chain.folder / "alice.key", "--robot", chain.folder / "robot.keys"],
                       check=True, capture_output=True)
        chain.url = own
        chain.simulator("--world", f"tools/lab/worlds/{world}.world", "--seed", len(chains))
        chain.url = url
        chain.rover = chain.firmware(f"[lcm]\nprefix = {name}.\n[commands]\nrobot = {name}\nkeys = {chain.folder / 'robot.keys'}\n")
        chain.url = own
    yield url, chains
    for chain in chains:
        chain.stop()


def test_several_robots_share_a_network_by_their_prefixes(rovers):
    url, chains = rovers
    ear = Channels(url)
    try:
        for channel in ("ALE_POSE", "ALE_STATUS", "ALE_ODOMETRY", "ALE_DRIVE"):
            for name in ("rover1", "rover2"):
                wait_until(lambda c=f"{name}.{channel}": ear.count.get(c, 0) > 5, 60, f"{name}.{channel}")
        assert not [channel for channel in ear.count if not channel.startswith(("rover1.", "rover2.", "LCM_SELF_TEST"))]
        for chain, name in zip(chains, ("rover1", "rover2")):
            watched = subprocess.run([BINARIES / "ale-watch", "--lcm-url", chain.url, "--seconds", "3"], capture_output=True, text=True, check=True)
            assert " 0 missing" in watched.stdout
            sent = subprocess.run([BINARIES / "ale-send", "--keys", chain.folder / "alice.key", "--lcm-url", chain.url, "--robot", name, "stop"],
                                  capture_output=True, text=True, check=False)
            assert sent.returncode == 0, sent.stderr
            assert "speaks on the same channels" not in chain.rover.err()
    finally:
        ear.stop()
    console = Console(chains[0].url, "127.0.0.1:0", "--lcm-url", chains[1].url)
    pages = [WebSocket(f"{console.url}&robot={name}") for name in ("rover1", "rover2")]
    for page in pages:
        page.wait_for("robots", lambda told: all(robot["state"] == "good" for robot in told["robots"]))
    assert [page.wait_for("status")["robot"] for page in pages] == ["rover1", "rover2"]
    assert console.end() == 0


def test_a_recording_and_a_bridge_choose_by_the_prefix(rovers, tmp_path):
    url, chains = rovers
    beyond = free_lcm_url()
    keys = chains[0].folder
    port = free_udp_port()
    chains[0].start("ale-bridge", "--listen", f"127.0.0.1:{port}", "--keys", keys / "robot.keys", "--lcm-url", chains[0].url)
    chains[0].start("ale-bridge", "--connect", f"127.0.0.1:{port}", "--keys", keys / "alice.key", "--lcm-url", f"{beyond}&prefix=mine.")
    ear = Channels(beyond)
    try:
        wait_until(lambda: ear.count.get("mine.ALE_POSE", 0) > 5 and ear.count.get("mine.ALE_SPEAKER"), 60, "poses beyond the bridge")
        assert not [channel for channel in ear.count if not channel.startswith(("mine.", "LCM_SELF_TEST"))]
    finally:
        ear.stop()
    os.kill(chains[0].rover.process.pid, signal.SIGTERM)
    assert chains[0].rover.wait(60) == 0
    recording = tmp_path / "r.scip"
    done = subprocess.run([BINARIES / "ale-record", "--port", chains[0].port, "--out", recording, "--lcm-url", chains[0].url, "--seconds", "4"],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert int(re.search(r"^odometry (\d+)$", done.stdout, re.MULTILINE)[1]) > 5
