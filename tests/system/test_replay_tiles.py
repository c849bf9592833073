"""ale-replay in a map of tiles: at the scans that the firmware would, and so the same every time."""
import json
import math
import subprocess

import pytest

from at_hand import BINARIES
from chain import Truth
from tile_building import Building, write_tiles, write_world

GOOD = 2


def replay(*words):
    return subprocess.run([BINARIES / "ale-replay", *map(str, words)], capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def driven(tmp_path_factory):
    """A log of a way through rooms of a large building, its truth, the building's tiles, and where it begins."""
    folder = tmp_path_factory.mktemp("tiles")
    building = Building(20, 20)
    tiles, world, log, truth = (folder / name for name in ("building.tiles", "way.world", "way.log", "truth.tum"))
    assert write_tiles(tiles, building.panels()) > 2048
    start = write_world(world, building, 10, 10, 13)
    subprocess.run([BINARIES / "ale-sim", "--world", world, "--write-log", log, "--truth", truth], check=True, capture_output=True)
    return log, Truth(truth), tiles, ",".join(map(str, start))


def test_poses_are_right_in_the_building_and_the_same_every_time(driven, tmp_path):
    log, truth, tiles, start = driven
    texts = []
    for name in ("one", "two"):
        done = replay(log, "--load-map", tiles, "--start", start, "--poses", tmp_path / name)
        assert done.returncode == 0, done.stderr
        texts.append((tmp_path / name).read_text())
    assert texts[0] == texts[1]
    poses = [json.loads(line) for line in texts[0].splitlines()]
    good = [math.dist((pose["map_x"], pose["map_y"]), place[:2]) for pose, place in zip(poses, truth.world) if pose["state"] == GOOD]
    assert len(good) > 0.9 * len(poses) and max(good) < 0.05


def test_without_a_place_it_is_lost_and_never_sure(driven, tmp_path):
    log, _, tiles, _ = driven
    replay(log, "--load-map", tiles, "--poses", tmp_path / "poses")
    assert all(json.loads(line)["state"] == 0 for line in (tmp_path / "poses").read_text().splitlines())


def test_a_start_belongs_to_a_map(driven):
    done = replay(driven[0], "--start", "1,2,3")
    assert done.returncode == 2 and "--load-map" in done.stderr


def test_a_damaged_tile_is_said(driven, tmp_path):
    log, _, tiles, start = driven
    data = tiles.read_bytes()
    at = data.index(b"\nend ") + 200
    spoilt = tmp_path / "spoilt.tiles"
    spoilt.write_bytes(data[:at] + data[at:].replace(b" 20\n", b" 21\n"))
    done = replay(log, "--load-map", spoilt, "--start", start)
    assert done.returncode == 0 and "could not be read, and count as empty; the last: tile " in done.stderr
