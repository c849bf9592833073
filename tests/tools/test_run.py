"""`make run`: the whole chain from the orchestrator's side."""
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

import pytest

from at_hand import BINARIES, WORLDS

RUN = pathlib.Path("tools/make/run.py")
LOG_SPEEDS = (40, 20, 10)
SAME_END_M = 0.01
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


def uneven(stamp, k):
    """Stamps as logs have them: a scan now and then, pauses, steps back, a queue that was emptied."""
    pauses = 2.7 * (k // 40) + (9 if k >= 100 else 0)
    return 3 * stamp + pauses + {3: 0.21, 11: -0.43, 19: -0.4999}.get(k % 23, 0.000137 * (k % 7))


def write_uneven_log(path):
    """A drive through the home of which only every third scan was recorded."""
    whole = path.with_suffix(".whole")
    subprocess.run([BINARIES / "ale-sim", "--world", WORLDS / "home.world", "--write-log", whole], check=True,
                   capture_output=True)
    lines = whole.read_text(encoding="utf-8").splitlines()
    kept = [line.split() for line in lines if line.startswith("ROBOTLASER1")][::3]
    for k, words in enumerate(kept):
        words[-3] = words[-1] = f"{uneven(float(words[-3]), k):.6f}"
    path.write_text("\n".join(["# beam_time_us 97.65625 stamp_beam 340", *map(" ".join, kept)]) + "\n", encoding="utf-8")
    return len(kept)


def end_of(trajectory):
    return tuple(map(float, trajectory.read_text().splitlines()[-1].split()[1:3]))


def test_an_uneven_log_ends_over_the_line_where_its_replay_ends(build, tmp_path):
    log = tmp_path / "uneven.log"
    scans = write_uneven_log(log)
    for speed in LOG_SPEEDS:
        running = start(build, "--log", log, "--speed", speed)
        out, err = running.communicate(timeout=300)
        if running.returncode == 0:
            break
        assert "is too fast for this computer" in err, err
    assert running.returncode == 0, out + err
    assert f"{scans} scans sent, {scans} poses came" in out
    assert re.search(rf"{scans} poses, 0 missing, 0 predicted", out)
    assert "silent" not in (build / "run" / "ale-slamd.log").read_text()
    replayed = tmp_path / "replayed.tum"
    subprocess.run([BINARIES / "ale-replay", log, "--trajectory-live", replayed], check=True, capture_output=True)
    assert math.dist(end_of(build / "run" / "trajectory.tum"), end_of(replayed)) < SAME_END_M
    assert "the drive ends where ale-replay ends" in out


def held_up(build):
    """A build folder whose firmware stands still for half a second, again and again, as on a computer that is too slow."""
    folder = build.parent / "slow"
    (folder / "bin").mkdir(parents=True)
    for program in BINARIES.resolve().iterdir():
        (folder / "bin" / program.name).symlink_to(program)
    (folder / "bin" / "ale-slamd").unlink()
    wrapper = folder / "bin" / "ale-slamd"
    wrapper.write_text(f"""#!{sys.executable}
import signal, subprocess, sys, time
firmware = subprocess.Popen([{str((BINARIES / "ale-slamd").resolve())!r}, *sys.argv[1:]])
over = []
signal.signal(signal.SIGTERM, lambda *_: over.append(True))
while not over and firmware.poll() is None:
    time.sleep(0.5)
    firmware.send_signal(signal.SIGSTOP)
    time.sleep(0.5)
    firmware.send_signal(signal.SIGCONT)
firmware.terminate()
sys.exit(firmware.wait())
""")
    wrapper.chmod(0o755)
    return folder


def test_a_speed_that_the_computer_cannot_follow_is_said(build, world):
    world.write_text(WORLD + "# via 0 0\n# via 2.2 0.6\n")
    running = start(held_up(build), "--world", world, "--speed", 20)
    out, err = running.communicate(timeout=300)
    assert running.returncode == 1, out + err
    assert len(err.splitlines()) == 1
    assert re.search(r"20 times the speed is too fast for this computer: .*[1-9]\d* .*Try SPEED=10$", err.strip()), err
    assert programs_of(build.parent / "slow") == []


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
