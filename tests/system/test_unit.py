"""The systemd unit: how exposed it is, and that the firmware works within what it leaves."""
import functools
import re
import shutil
import subprocess
import sys

import pytest

from at_hand import ROOT
from chain import BINARIES, FIRMWARE, Program
from hosts import two_hosts
from plain_lcm import PlainLcm
from test_commands import Rover
from waiting import wait_until

UNIT = ROOT / "firmware/deploy/ale-slamd.service.in"
MOST_EXPOSED = 2.5
LCM_URL = "udpm://239.255.76.67:7667?ttl=0"

needs_systemd = pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="no systemd-analyze here")


@needs_systemd
def test_the_unit_is_exposed_little(tmp_path):
    unit = tmp_path / "ale-slamd.service"
    unit.write_text(UNIT.read_text(encoding="utf-8").replace("@PREFIX@", "/usr").replace("@SYSCONFDIR@", "/etc"), encoding="utf-8")
    done = subprocess.run(["systemd-analyze", "security", "--offline=yes", "--no-pager", unit], capture_output=True, text=True,
                          check=False)
    found = re.search(r"Overall exposure level for ale-slamd\.service: ([\d.]+)", done.stdout)
    if not found:
        pytest.skip(f"this systemd-analyze looks at no files: {done.stderr.strip()}")
    print(f"exposure {found[1]}")
    assert float(found[1]) <= MOST_EXPOSED


@needs_systemd
@pytest.mark.skipif(FIRMWARE != (BINARIES / "ale-slamd").resolve(), reason="the emulation of RTAI makes calls of its own")
def test_all_that_the_firmware_does_passes_its_system_call_filter(chain):
    """Scans, driving, exploration, recordings, maps: each other call would have ended it."""
    filtered = (sys.executable, ROOT / "tests/system/under_filter.py", UNIT)
    chain.firmware = functools.partial(chain.firmware, prefix=filtered)
    rover = Rover(chain)
    try:
        for words in (("drive", "0.1", "0"), ("stop",), ("record",), ("save_map", "here"), ("explore", "on"), ("explore", "off"),
                      ("load_map", "here"), ("reset",)):
            rover.send("alice", *words)
            assert rover.firmware.running(), f"{words}: ended with {rover.firmware.process.returncode}"
        assert rover.firmware.end() == 0
    finally:
        rover.motors.stop()


def unit_lines(key):
    return [line.split("=", 1)[1].strip() for line in UNIT.read_text(encoding="utf-8").splitlines() if line.startswith(f"{key}=")]


def test_it_is_started_again_for_ever():
    """Also before there is a network, which it does not wait for."""
    assert unit_lines("StartLimitIntervalSec") == ["0"]
    assert unit_lines("Restart") == ["always"]
    assert not any("network-online" in after for after in unit_lines("After") + unit_lines("Wants"))


def behind_the_address_lists(host):
    """The unit's lists in the words of nft."""
    for rule in ("table inet unit", "chain inet unit in { type filter hook input priority 0; }",
                 "rule inet unit in ip saddr != 127.0.0.0/8 drop",
                 "chain inet unit out { type filter hook output priority 0; }",
                 "rule inet unit out ip daddr != { 127.0.0.0/8, 239.255.76.67 } drop"):
        host.run("nft", "add", *rule.split())


def said_at_start(host, folder):
    """What the firmware says when it finds no scanner."""
    firmware = Program(folder, "ale-slamd", "--port", "/dev/none", "--lcm-url", LCM_URL, prefix=host.prefix)
    firmware.wait_until(lambda: "no scanner" in firmware.err(), "the start")
    assert firmware.end() == 0
    return firmware.err()


def test_its_address_lists_let_this_machine_through_and_nobody_else(tmp_path):
    """On a computer with a network: LCM is deaf behind them, and the firmware says so, but for what the unit runs first."""
    if subprocess.run(["unshare", "--net", "nft", "add", "table", "inet", "unit"], check=False, capture_output=True).returncode != 0:
        pytest.skip("no nft, or not allowed here")
    assert not unit_lines("ExecStopPost"), "others on this machine use the route, too"
    assert unit_lines("IPAddressDeny") == ["any"]
    assert unit_lines("IPAddressAllow") == ["localhost 239.255.76.67"]
    with two_hosts() as (robot, other):
        behind_the_address_lists(robot)
        assert "does not come back" in said_at_start(robot, tmp_path)
        for command in unit_lines("ExecStartPre"):
            robot.run(*command.removeprefix("+").split())
        assert "does not come back" not in said_at_start(robot, tmp_path)
        heard = []
        ear = PlainLcm(LCM_URL, on=robot.socket).subscribe("WHO", lambda _, data: heard.append(data))
        own = PlainLcm(LCM_URL, on=robot.socket)
        stranger = PlainLcm(LCM_URL.replace("ttl=0", "ttl=1"), on=other.socket)
        for _ in range(3):
            stranger.publish("WHO", b"stranger")
            own.publish("WHO", b"own")
        wait_until(lambda: ear.handle_timeout(100) or heard.count(b"own") == 3, 60, "its own")
        assert b"stranger" not in heard
