"""A robot PC day by day: Debian with systemd and the packages, switched on, and off by cutting its power (part of `make hil-vm`).

Each day is the same: the clock stands at 1970, there is no network, the scanner is plugged in as soon as the firmware has said that
it is missing, the network 20 s later, NTP sets the clock 40 s later, and some time after that the power goes. BOOTS says how many
days, SEED which instants.
"""
import os
import random
import subprocess
import time

import pytest

from at_hand import BINARIES, WORLDS
from chain import Chain
from lcm_url import free_lcm_url
from virtual_disk import Disk, lay, run_in
from virtual_machine import NoMachine, need_machine, set_clock
from virtual_robot import LCM_GROUP, LCM_PORT, Lan, Line, network_card, scanner_socket

BOOTS = int(os.environ.get("BOOTS", "2"))
SEED = int(os.environ.get("SEED", "1"))
BOOT_S = 120
NETWORK_S, NTP_S = 20, 40  # from the scanner on, as all that follows
CUT_S = (46, 60)
IN_TIME_S = 15  # from the scanner to its first pose
SCAN_S = 0.1
GOOD = 2
CONFIG = "/etc/ale-slam/ale-slamd.ini"
KEYS = "/etc/ale-slam/robot.keys"
STATE = "/var/lib/ale-slam"
# As the README of firmware/deploy says for a bus that is shared.
SHARED_BUS = "[Service]\nExecStartPre=\nIPAddressDeny=\nIPAddressAllow=\n"
NETWORK = f"[Match]\nType=ether\n[Network]\nAddress=10.0.0.2/24\nLinkLocalAddressing=no\n[Route]\nDestination={LCM_GROUP}\nScope=link\n"
OPERATOR = "[Service]\nExecStart=\nExecStart=-/sbin/agetty --autologin root --keep-baud 115200 %I dumb\n"


def set_up(root):
    """As somebody does who sets up a robot: port, bus, keys, network; and a root shell on the console."""
    config = (root / CONFIG.lstrip("/")).read_text(encoding="utf-8")
    for before, after in (("/dev/ale-scanner", "/dev/ttyUSB0"), ("# [commands]", "[commands]"), ("# robot =", "robot ="), ("# keys =", "keys =")):
        config = config.replace(before, after)
    lay(root, CONFIG, f"{config}\n[lcm]\nurl = udpm://{LCM_GROUP}:{LCM_PORT}?ttl=1\n")
    run_in(root, "ale-keys", "alice", "--secret", "/root/alice.key", "--robot", KEYS)
    lay(root, "/etc/systemd/system/ale-slamd.service.d/bus.conf", SHARED_BUS)
    lay(root, "/etc/systemd/network/lan.network", NETWORK)
    lay(root, "/etc/systemd/system/serial-getty@ttyS0.service.d/operator.conf", OPERATOR)
    lay(root, "/etc/hostname", "robot\n")
    run_in(root, "systemctl", "enable", "systemd-networkd")


class Day:
    """One of them, lived by its creation; then what came of it."""

    def __init__(self, folder, disk, cut_s):
        self.chain = Chain(folder, free_lcm_url(), channels=())
        self.lan = Lan(self.chain.url)
        self.chain.simulator("--world", WORLDS / "home.world")
        self.machine = disk.boot(folder / "machine", *scanner_socket(folder), "-device", "qemu-xhci", *network_card(self.lan),
                                 "-rtc", "base=1970-01-01T00:00:00")
        self.line = Line(self.chain.port, folder / "uart")
        try:
            self._live(cut_s)
        finally:
            self.machine.cut()
            self.line.stop()
            self.lan.stop()
            self.chain.stop()

    def _live(self, cut_s):
        self.machine.rebuild("set_link lan off")
        self._until_the_scanner_is_missed()
        self.machine.rebuild("device_add usb-serial,chardev=scanner")
        self.scanner_at = time.monotonic()
        self._until(NETWORK_S)
        self.machine.rebuild("set_link lan on")
        self._until(NTP_S)
        assert self.poses, self.machine.said()
        # Poses have been numbered from the first on, also while there was no network that could carry them.
        self.first_pose_s = NTP_S - SCAN_S * self.poses[-1].scan
        self.poses_before_ntp = len(self.poses)
        self.counters_before_ntp = self._counters()
        set_clock(self.machine, "date -s @")
        # Typed in pieces, so that the end is not found in the line that asks for it.
        self.machine.order("journalctl --boot --unit ale-slamd --output cat --no-pager; echo the end of the 'log'")
        self.machine.wait_for("the end of the log", 60)
        self._until(cut_s)
        self.counters = self._counters()

    def _until_the_scanner_is_missed(self):
        self.machine.wait_for("root@robot:~#", BOOT_S)
        self.machine.order("until journalctl --boot --unit ale-slamd | grep -q 'no such serial device'; do sleep 0.2; done; echo it is 'missed'")
        self.machine.wait_for("it is missed", BOOT_S)

    def _until(self, seconds):
        while time.monotonic() < self.scanner_at + seconds:
            assert self.machine.running(), self.machine.said()
            time.sleep(0.01)

    def _counters(self):
        assert self.lan.messages["ALE_STATUS"], self.machine.said()
        status = self.lan.messages["ALE_STATUS"][-1]
        return dict(zip(status.counter_name, status.counter_value))

    @property
    def poses(self):
        return self.lan.messages["ALE_POSE"]


@pytest.fixture(scope="module", name="days")
def all_days(tmp_path_factory, multicast):
    try:
        disk = Disk(tmp_path_factory.mktemp("disk"), need_machine(), set_up)
    except NoMachine as error:
        pytest.skip(str(error))
    instants = random.Random(SEED)
    before = disk.files(tmp_path_factory.mktemp("before") / "files", CONFIG, KEYS, f"{KEYS}.secret")
    days = []
    for number in range(BOOTS):
        folder = tmp_path_factory.mktemp(f"day-{number}")
        days.append(Day(folder, disk, instants.uniform(*CUT_S)))
        days[-1].before = before
        days[-1].files = disk.files(folder / "files", CONFIG, KEYS, f"{KEYS}.secret", STATE)
    return days


def test_each_day_poses_come_soon_after_the_scanner(days):
    for day in days:
        print(f"first pose {day.first_pose_s:.1f} s after the scanner; {len(day.poses)} heard, from scan {day.poses[0].scan} on")
        assert 0 < day.first_pose_s < IN_TIME_S
        assert day.counters["scans_lost"] == 0


def test_each_day_the_robot_knows_where_it_is_and_no_pose_is_missing_when_ntp_sets_the_clock(days):
    for day in days:
        numbers = [pose.scan for pose in day.poses]
        assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
        assert len(day.poses) > day.poses_before_ntp > 0
        assert all(pose.state == GOOD for pose in day.poses[day.poses_before_ntp:])


def test_each_day_odometry_is_taken_before_ntp_and_after_it(days):
    for day in days:
        assert day.counters["odometry"] > day.counters_before_ntp["odometry"] > 0
        assert {name: day.counters[name] for name in day.counters if name.startswith("odometry_") and name != "odometry_senders"
                and day.counters[name]} == {}


def test_each_day_the_log_tells_what_came_and_what_was_missing(days):
    for day in days:
        said = day.machine.said()
        at = [said.index(words) for words in ("no route for multicast: going on without", "streaming", "there is a route for multicast: joined",
                                              "the end of the log")]
        assert at == sorted(at), said
        assert "no scanner: /dev/ttyUSB0: no such serial device" in said


def test_no_cut_breaks_a_file(days, tmp_path):
    log = tmp_path / "drive.log"
    subprocess.run([BINARIES / "ale-sim", "--world", WORLDS / "home.world", "--write-log", log], check=True, stdout=subprocess.DEVNULL)
    for day in days:
        for path in (CONFIG, KEYS, f"{KEYS}.secret"):
            assert (day.files / path.lstrip("/")).read_bytes() == (day.before / path.lstrip("/")).read_bytes(), path
        kept = day.files / STATE.lstrip("/") / "kept.map"
        done = subprocess.run([BINARIES / "ale-replay", log, "--load-map", kept], check=False, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        for flight in kept.parent.glob("flight-*"):
            done = subprocess.run([BINARIES / "ale-replay", flight], check=False, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
