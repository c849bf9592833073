"""Files that somebody else has laid where the robot reads or writes: nothing hangs, nothing of others is overwritten."""
import gzip
import os
import stat
import subprocess

import pytest

from at_hand import BINARIES
from commanded import Commanded
from waiting import wait_until


def replay(*words, **how):
    return subprocess.run([BINARIES / "ale-replay", *map(str, words)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=180, check=False, **how)


@pytest.fixture
def robot(chain):
    running = Commanded(chain, f"[map]\nfolder = {chain.folder / 'maps'}\n[recorder]\nfolder =\n")
    wait_until(lambda: chain.listener.map_parts, 180, "a map")
    return running


def test_pipes_and_links_in_the_folder_of_maps_hold_nobody_up_and_harm_nothing(chain, robot):
    assert robot.send("save_map", "home")[1].startswith("rover: saved home: ")
    maps = chain.folder / "maps"
    mine = chain.folder / "mine"
    mine.write_text("not for the robot")
    os.mkfifo(maps / "pipe.map")
    (maps / "link.map").symlink_to(mine)
    (maps / "other.map.new").symlink_to(mine)
    for verb, done in (("load_map", "not loaded"), ("save_map", "not saved")):
        for name, words in (("pipe", "no regular file"), ("link", "a symbolic link, which is not followed")):
            obeyed, answer = robot.send(verb, name)
            assert not obeyed and answer == f"rover: {done}: {maps}/{name}.map: {words}"
    assert robot.send("save_map", "other")[0] and robot.send("load_map", "home")[0]
    assert mine.read_text() == "not for the robot"


def test_maps_are_for_the_robot_and_its_group(chain, robot):
    assert robot.send("save_map", "home")[0]
    for path in (chain.folder / "maps", chain.folder / "maps/home.map"):
        assert stat.S_IMODE(path.stat().st_mode) & stat.S_IRWXO == 0, path


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a file away")
def test_a_list_of_keys_of_another_user_is_refused(tmp_path):
    keys = tmp_path / "robot.keys"
    subprocess.run([BINARIES / "ale-keys", "alice", "--secret", tmp_path / "alice.key", "--robot", keys], check=True,
                   stdout=subprocess.DEVNULL)
    check = [BINARIES / "ale-slamd", "--keys", keys, "--check-config"]
    assert subprocess.run(check, check=False, timeout=180).returncode == 0
    os.chown(keys, 65534, 65534)
    done = subprocess.run(check, check=False, capture_output=True, text=True, timeout=180)
    assert done.returncode == 2 and "robot.keys: belongs to another user" in done.stderr


def test_a_pipe_as_map_of_the_start_is_told_at_once(tmp_path):
    os.mkfifo(tmp_path / "start.map")
    done = subprocess.run([BINARIES / "ale-slamd", "--map", tmp_path / "start.map", "--check-config"], check=False,
                          capture_output=True, text=True, timeout=20)
    assert done.returncode == 2 and "start.map: no regular file" in done.stderr


def test_a_log_that_swells_a_thousand_times_is_refused_in_little_memory(tmp_path):
    """3.6 MB of gzip, 3.6 GB of it: in an address space of 2 GiB."""
    bomb = tmp_path / "scans.log.gz"
    part = gzip.compress(b"FLASER 1 " + bytes(64 << 20), 9)
    bomb.write_bytes(part * 57)
    done = subprocess.run(["prlimit", f"--as={2 << 30}", BINARIES / "ale-replay", bomb], check=False, capture_output=True,
                          text=True, timeout=180)
    assert done.returncode == 1
    assert "unpacks to more than 256 MiB and a hundred times its size" in done.stderr and done.stderr.count("\n") == 1
