"""`make explore` and `ale-explore`: exploration by the real programs, and what the one in lock step says."""
import pathlib
import re
import subprocess

import pytest

from at_hand import BINARIES

EXPLORE = pathlib.Path("tools/make/explore.py")
SPEEDS = ("4", "2", "1")  # slower where the machine is too busy: the robot stands while nobody tells it more, and takes longer
ROOM = """# a room and a half, and a chair
-1 -1 4 -1
4 -1 4 3
4 3 -1 3
-1 3 -1 -1
1.5 3 1.5 1.2
2.8 0.2 3.1 0.2
3.1 0.2 3.1 0.5
3.1 0.5 2.8 0.5
2.8 0.5 2.8 0.2
# start 0 0 0.5
"""


@pytest.fixture
def room(tmp_path):
    path = tmp_path / "room.world"
    path.write_text(ROOM)
    return path


def ask(*words):
    return subprocess.run([BINARIES / "ale-explore", *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, check=False)


def test_the_real_programs_explore_a_room_and_bring_the_robot_back(tmp_path, room):
    build = tmp_path / "build"
    build.mkdir()
    (build / "bin").symlink_to(BINARIES.resolve())
    for speed in SPEEDS:
        done = subprocess.run(["/usr/bin/python3", EXPLORE, "--build", build, "--world", room, "--speed", speed],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=300, check=False)
        if done.returncode == 0:
            break
    assert done.returncode == 0, done.stdout + done.stderr
    told = re.search(r"finished after \d+ s of the robot's time: (\d+) m2 seen.*, (\d+) collisions, back ([\d.]+) m", done.stdout)
    assert told, done.stdout
    seen, collisions, off = told.groups()
    assert 19 <= int(seen) <= 24 and int(collisions) == 0 and float(off) <= 0.1, done.stdout
    assert (build / "explore" / "map.png").stat().st_size > 1000


def test_lock_step_prints_one_line_a_seed_and_draws_the_map(tmp_path, room):
    done = ask("--world", room, "--seed", 3, "--seeds", 2, "--map", tmp_path / "map.png")
    assert done.returncode == 0, done.stdout + done.stderr
    lines = done.stdout.splitlines()
    assert [line.split(":")[0] for line in lines] == ["seed 3", "seed 4"]
    assert all(re.search(r"finished after \d+ s and [\d.]+ m, (99|100)\.\d+ % of .* 0 collisions", line) for line in lines)
    assert (tmp_path / "map.png").stat().st_size > 1000


def test_the_same_seed_gives_the_same_exploration(room):
    assert ask("--world", room, "--seed", 5).stdout == ask("--world", room, "--seed", 5).stdout


def test_an_exploration_cut_short_fails(room):
    done = ask("--world", room, "--time", 5)
    assert done.returncode == 1
    assert "NOT FINISHED after 5 s" in done.stdout


def test_the_configuration_is_the_robots(tmp_path, room):
    config = tmp_path / "robot.ini"
    config.write_text("[robot]\nwidth = 0.5\n[explore]\nspeed = 0.2\n[sensor]\nx = 0.1\ntheta = 0.2\n")
    done = ask("--world", room, "--config", config)
    assert done.returncode == 0, done.stdout + done.stderr
    slow = float(re.search(r"after (\d+) s", done.stdout)[1])
    fast = float(re.search(r"after (\d+) s", ask("--world", room).stdout)[1])
    assert slow > 1.3 * fast


@pytest.mark.parametrize("words, message", [
    ((), "--world WORLD is missing"),
    (("--world", "nowhere.world"), "nowhere.world"),
    (("--world", "tools/lab/worlds/home.world", "--seeds", "many"), "--seeds many: expected a whole number from 1 to 10000"),
    (("--world", "tools/lab/worlds/home.world", "--map", "map.jpg"), "--map map.jpg: there are .png, .svg, .dxf, .pgm, .geojson"),
    (("--world", "tools/lab/worlds/home.world", "--config", "nothing.ini"), "nothing.ini"),
    (("--world", "tools/lab/worlds/home.world", "extra"), 'what is "extra"?'),
])
def test_wrong_use_is_one_line(words, message):
    done = ask(*words)
    assert done.returncode in (1, 2) and message in done.stderr and len(done.stderr.splitlines()) == 1
