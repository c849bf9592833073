"""Limits are limits: with a key, too, nobody drives faster than the configuration says, and no recording of a fault is lost to
those that are asked for. What is not done is refused."""
import subprocess

import pytest

from at_hand import BINARIES
from commanded import Commanded, may_mount
from waiting import Ear, wait_until
import ale

FAULTS = 10


def test_nobody_drives_faster_than_the_configuration_calls_the_most(chain):
    robot = Commanded(chain, "drive_speed = 0.4\ndrive_turn = 0.8\n[recorder]\nfolder =\n")
    points = []
    motors = Ear(chain.url, ["ALE_DRIVE"], lambda _, data: points.append(ale.drive_t.decode(data)))
    try:
        assert robot.send("set", "drive_speed", "1.7") == (False, "rover: drive_speed is a number from 0 to 0.4")
        assert robot.send("set", "drive_turn", "6") == (False, "rover: drive_turn is a number from 0 to 0.8")
        for words in (("1.7", "0"), ("0", "6"), ("-1.7", "-6")):
            points.clear()
            assert robot.send("--seconds", "0.5", "drive", *words)[0]
            wait_until(lambda: any(p.v or p.w for p in points), 180, "driving")
            assert all(abs(p.v) <= 0.4 + 1e-6 and abs(p.w) <= 0.8 + 1e-6 for p in points)
    finally:
        motors.stop()


def test_asked_recordings_take_no_faults_place(chain):
    folder = chain.folder / "flights"
    folder.mkdir()
    faults = [folder / f"flight-2026010{k}T000000.000Z-fault.scip" for k in range(FAULTS)]
    for path in faults:
        path.write_bytes(b"of a fault")
    robot = Commanded(chain, f"[recorder]\nfolder = {folder}\nmegabytes = 1\n", simulator=False)
    for _ in range(12):
        assert robot.send("record") == (True, "rover: a flight recording is written")
    assert all(path.exists() for path in faults)
    assert 0 < len(list(folder.glob("*-command.scip"))) <= 5


def test_a_recording_that_the_clock_calls_old_stays(chain):
    """As after a clock that was far ahead has been set back."""
    folder = chain.folder / "flights"
    folder.mkdir()
    for k in range(12):
        (folder / f"flight-209901{k + 10}T000000.000Z-command.scip").write_bytes(b"of another year")
    robot = Commanded(chain, f"[recorder]\nfolder = {folder}\nmegabytes = 1\n", simulator=False)
    assert robot.send("record")[0]
    assert [path for path in folder.glob("flight-*-command.scip") if "-2099" not in path.name and "flight-2099" not in path.name]


@pytest.mark.skipif(not may_mount(), reason="a disk that is full is made in a namespace of mounts: only root can")
def test_a_full_disk_is_a_refusal_and_called_that(chain):
    folder = chain.folder / "flights"
    folder.mkdir()
    full = ["unshare", "--mount", "sh", "-c",
            f'mount -t tmpfs -o size=64k tmpfs {folder} && head -c 60000 /dev/zero > {folder}/other && exec "$@"', "sh"]
    robot = Commanded(chain, f"[recorder]\nfolder = {folder}\nmegabytes = 1\n[map]\nfolder = {folder}\n"
                      f"keep = {folder}/kept.map\nkeep_seconds = 1\n", prefix=full)
    wait_until(lambda: len(chain.listener.poses) > 20, 180, "something to record")
    assert robot.send("record") == (False, "rover: not recorded: No space left on device")
    wait_until(lambda: "map and pose are not kept" in robot.firmware.err(), 180, "a word about the map that is not kept")
    assert f"not kept: {folder}/kept.map: No space left on device" in robot.firmware.err()
    assert "Input/output error" not in robot.firmware.err()
    wait_until(lambda: chain.listener.map_parts, 180, "a map")
    assert robot.firmware.running()


@pytest.mark.skipif(not may_mount(), reason="a disk that is full is made in a namespace of mounts: only root can")
@pytest.mark.parametrize("words", [["alice", "--secret", "{0}/alice.key", "--robot", "{0}/robot.keys"], ["--drive", "{0}/drive.key"],
                                   ["--own", "rover", "--robot", "{0}/robot.keys"]])
def test_a_key_that_no_disk_holds_leaves_no_file(tmp_path, words):
    """Not even an empty one, which would be in the way of the next try."""
    full = f'mount -t tmpfs -o size=64k tmpfs {tmp_path} && head -c 70000 /dev/zero > {tmp_path}/other 2> /dev/null; "$@"; echo $?; ls {tmp_path}'
    done = subprocess.run(["unshare", "--mount", "sh", "-c", full, "sh", BINARIES / "ale-keys", *(word.format(tmp_path) for word in words)],
                          capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["1", "other"]
    assert "No space left on device" in done.stderr
