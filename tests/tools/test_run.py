"""`make run`: the whole chain from the orchestrator's side."""
import os
import pathlib
import re
import shutil
import signal
import subprocess

import pytest

from at_hand import BINARIES

RUN = pathlib.Path("tools/make/run.py")
SPEEDS = (4, 2, 1)  # slower where the machine is too busy to send or to hear all of it
WORLD = """# a room and a half, and a short way
-1 -1 3 -1
3 -1 3 2
3 2 -1 2
-1 2 -1 -1
1 2 1 1.2
# start 0 0 0
# via 1.5 0
# via 2.2 0.6
"""


@pytest.fixture
def build(tmp_path):
    """A build folder of its own with the programs in it, so that runs do not disturb each other."""
    folder = tmp_path / "build"
    folder.mkdir()
    (folder / "bin").symlink_to(BINARIES.resolve())
    return folder


@pytest.fixture
def world(tmp_path):
    path = tmp_path / "room.world"
    path.write_text(WORLD)
    return path


def start(build, *arguments):
    return subprocess.Popen(["/usr/bin/python3", RUN, "--build", build, *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


def programs_of(build):
    """Processes whose command line names this build folder."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            command = entry.read_bytes()
        except OSError:
            continue
        if str(build / "bin").encode() in command and b"run.py" not in command:
            found.append(command)
    return found


def test_a_short_drive_goes_through_the_whole_chain(build, world):
    for speed in SPEEDS:
        running = start(build, "--world", world, "--speed", speed)
        out, err = running.communicate(timeout=180)
        if running.returncode == 0:
            break
    assert running.returncode == 0, out + err
    scans, poses = map(int, re.search(r"(\d+) scans sent, (\d+) poses came", out).groups())
    assert scans > 30 and poses >= scans
    assert re.search(r"http://127\.0\.0\.1:\d+/", out)
    lines = (build / "run" / "trajectory.tum").read_text().splitlines()
    assert len(lines) == poses
    assert (build / "run" / "map.png").stat().st_size > 1000
    x, y = map(float, lines[-1].split()[1:3])
    assert (x, y) == pytest.approx((2.2, 0.6), abs=0.05)
    assert programs_of(build) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_leaves_nothing_running(build, world, number):
    world.write_text(WORLD + "# via 0 0\n# via 2.2 0.6\n" * 10)
    running = start(build, "--world", world)
    assert "watch it at" in running.stdout.readline()
    assert "poses" in running.stdout.readline()
    running.send_signal(number)
    _, err = running.communicate(timeout=180)
    assert running.returncode == 130 and "interrupted" in err
    assert programs_of(build) == []
    assert not (build / "run" / "urg").is_symlink()


def test_a_recording_that_is_absent_is_named_in_one_line(build):
    running = start(build, "--log", "/absent.log")
    _, err = running.communicate(timeout=180)
    assert running.returncode == 1
    assert len(err.splitlines()) == 1 and "/absent.log" in err


def test_a_firmware_that_dies_fails_the_run(tmp_path, world):
    folder = tmp_path / "build"
    (folder / "bin").mkdir(parents=True)
    for name in ("ale-sim", "ale-console", "ale-watch"):
        (folder / "bin" / name).symlink_to((BINARIES / name).resolve())
    broken = folder / "bin" / "ale-slamd"
    broken.write_text("#!/bin/sh\necho the floor is gone >&2\nexit 3\n")
    broken.chmod(0o755)
    running = start(folder, "--world", world)
    _, err = running.communicate(timeout=180)
    assert running.returncode == 1
    assert "ale-slamd ended with 3: the floor is gone" in err
    assert programs_of(folder) == []


def test_programs_that_are_not_built_are_named(tmp_path):
    running = start(tmp_path)
    _, err = running.communicate(timeout=180)
    assert running.returncode == 1 and "ale-sim is missing" in err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.geteuid() != 0 or shutil.which("unshare") is None, reason="needs root and unshare to take the network away")
def test_without_a_multicast_route_it_uses_the_loopback(build, world):
    for speed in SPEEDS:
        done = subprocess.run(["unshare", "-n", "/usr/bin/python3", RUN, "--build", build, "--world", world, "--speed", str(speed)],
                              capture_output=True, text=True, timeout=180, check=False)
        if done.returncode == 0:
            break
    assert done.returncode == 0, done.stderr
    assert "using the loopback" in done.stdout
