"""Power cuts while maps, keys and recordings are written (part of `make hil-vm`): a virtual machine is killed again and again.

Programs of the packages write to its disk as fast as they can, and tell on the console what is done. Every other cut falls anywhere,
the others as soon as something is told. After each cut: what was told is there, and whatever is there is whole. CUTS says how often,
SEED at which instants.
"""
import os
import random
import re
import subprocess
import time

import pytest

from at_hand import BINARIES, WORLDS
from virtual_disk import Disk, lay, run_in
from virtual_machine import NoMachine, need_machine
from waiting import wait_until

CUTS = int(os.environ.get("CUTS", "5"))
SEED = int(os.environ.get("SEED", "1"))
CUT_S = (0, 8)  # after the first map
CUT_TOLD = (2, 20)  # or when so much was told
SOME_SCANS = 20  # are enough to load a map
ROBOT = "/robot"
CONFIG = f"""[map]
keep = {ROBOT}/kept.map
keep_seconds = 1
folder = {ROBOT}/maps
[commands]
robot = robot
keys = {ROBOT}/robot.keys
[recorder]
folder = {ROBOT}/flights
megabytes = 1
"""
# The kernel hands its word cut=NUMBER on as a variable. What a line says is done: program and file system have answered.
WRITERS = f"""#!/bin/sh
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t tmpfs run /run
mkdir -p /dev/shm /dev/pts {ROBOT}/maps {ROBOT}/flights {ROBOT}/lists
mount -t tmpfs shm /dev/shm
mount -t devpts devpts /dev/pts
ip link set lo up multicast on
ip route add 224.0.0.0/4 dev lo
cd {ROBOT}
ale-sim --world /usr/share/ale-slam/worlds/home.world --pty /run/urg > /run/sim.log 2>&1 &
sed "s,/flights,/flights/$cut," robot.ini > /run/robot.ini
mkdir flights/$cut
ale-slamd --config /run/robot.ini --port /run/urg > /run/slamd.log 2>&1 &
send() {{ ale-send --keys alice.key "$@" > /run/answer 2>&1; }}
until send save_map first$cut; do sleep 0.1; done
echo "map first$cut"
number=0
while ale-keys somebody$number --secret /run/secret$cut.$number --robot lists/$cut > /run/keys.log 2>&1; do
    echo "key somebody$number"
    number=$((number + 1))
done &
while :; do
    for name in a b c; do
        send save_map $name && echo "map $name"
        send record && echo "recording $(cat /run/answer)"
    done
done
"""


def set_up(root):
    lay(root, f"{ROBOT}/robot.ini", CONFIG)
    lay(root, f"{ROBOT}/writers", WRITERS, 0o755)
    run_in(root, "ale-keys", "alice", "--secret", f"{ROBOT}/alice.key", "--robot", f"{ROBOT}/robot.keys")


class Cut:
    """One start of the machine, and its end."""

    def __init__(self, folder, disk, number, instants):
        machine = disk.boot(folder / "machine", words=f"init={ROBOT}/writers cut={number}")
        try:
            machine.wait_for(f"map first{number}", 120)
            if number % 2:
                enough = instants.randint(*CUT_TOLD)
                wait_until(lambda: machine.said().count("\n") >= enough, 120, f"{enough} files written")
            else:
                time.sleep(instants.uniform(*CUT_S))
        finally:
            machine.cut()
        self.number = number
        self.said = machine.said().replace("\r", "")
        self.robot = disk.files(folder / "files", ROBOT) / ROBOT.lstrip("/")

    def told(self, what):
        """Whole lines: the last one may have been cut, too."""
        return re.findall(rf"^{what} (.+)\n", self.said, re.MULTILINE)


@pytest.fixture(scope="module", name="cuts")
def all_cuts(tmp_path_factory):
    try:
        disk = Disk(tmp_path_factory.mktemp("disk"), need_machine(), set_up)
    except NoMachine as error:
        pytest.skip(str(error))
    instants = random.Random(SEED)
    done = []
    for number in range(CUTS):
        done.append(Cut(tmp_path_factory.mktemp(f"cut-{number}"), disk, number, instants))
    return done


def accepted(*words):
    """A program of this computer takes a file."""
    done = subprocess.run([BINARIES / words[0], *map(str, words[1:])], check=False, capture_output=True, text=True)
    assert done.returncode == 0, f"{' '.join(map(str, words))}: {done.stderr}"
    return done.stdout


def test_the_cuts_fell_into_the_work(cuts):
    told = [len(cut.told("map")) + len(cut.told("key")) + len(cut.told("recording")) for cut in cuts]
    print(f"{len(cuts)} cuts, after {min(told)} to {max(told)} files that were written")
    assert sum(told) > 3 * len(cuts)


def test_a_key_that_was_made_is_there_and_every_list_is_whole(cuts):
    for cut in cuts:
        lists = {path.name: accepted("ale-keys", "--list", path) for path in cut.robot.glob("lists/*[0-9]")}
        for name in lists:
            accepted("ale-slamd", "--check-config", "--keys", cut.robot / "lists" / name)
        assert set(cut.told("key")) <= set(lists.get(str(cut.number), "").split())


def test_a_map_that_was_saved_is_there_and_every_map_is_whole(cuts, tmp_path):
    log = tmp_path / "drive.log"
    accepted("ale-sim", "--world", WORLDS / "home.world", "--write-log", log)
    log.write_text("\n".join(log.read_text(encoding="utf-8").split("\n")[:SOME_SCANS]) + "\n", encoding="utf-8")
    for cut in cuts:
        for name in cut.told("map"):
            assert (cut.robot / f"maps/{name}.map").exists(), name
        for path in cut.robot.rglob("*.map"):
            accepted("ale-replay", log, "--load-map", path)


def test_a_recording_that_was_written_is_there_and_every_recording_replays(cuts):
    for cut in cuts:
        flights = list(cut.robot.glob(f"flights/{cut.number}/*.scip"))
        assert len(flights) >= len(cut.told("recording"))
        for flight in flights:
            accepted("ale-replay", flight)


def test_what_nobody_writes_is_as_it_was(cuts):
    for cut in cuts:
        for name in ("robot.ini", "robot.keys", "robot.keys.secret", "alice.key"):
            assert (cut.robot / name).read_bytes() == (cuts[0].robot / name).read_bytes(), name
