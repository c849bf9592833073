"""ale-merge: drives of one building are one map, and drives of two are not."""
import math
import os
import pathlib
import subprocess

import pytest

from at_hand import BINARIES, WORLDS
from merging import IN_ROOM, ROOM, drive, merge

np = pytest.importorskip("numpy")
import map_score  # noqa: E402
from slam_table import aligned_errors, at_times, read_tum  # noqa: E402

MOST_ERROR_M = 0.015


def home_from_the_kitchen(path):
    """The world of the tree; the way begins elsewhere, and the armchair of the study is gone."""
    lines = (WORLDS / "home.world").read_text(encoding="utf-8").splitlines()
    way = [tuple(map(float, line.split()[2:4])) for line in lines if line.startswith(("# start", "# via"))]
    way = way[3:] + way[1:4] if math.dist(way[0], way[-1]) < 0.5 else way[3:]
    heading = math.atan2(way[1][1] - way[0][1], way[1][0] - way[0][0])
    head = [f"# start {way[0][0]} {way[0][1]} {heading}", *(f"# via {x} {y}" for x, y in way[1:])]
    path.write_text("\n".join(head + [line for line in lines if not line.startswith("#")]) + "\n", encoding="utf-8")
    return path


def test_two_drives_of_one_home_are_one_map_in_any_order(tmp_path):
    logs = [drive(tmp_path, "monday", WORLDS / "home.world", 1, 0), drive(tmp_path, "tuesday", home_from_the_kitchen(tmp_path / "w"), 7, 1)]
    results = []
    for name, order in (("one", logs), ("two", logs[::-1])):
        said = merge(tmp_path, *[log for log, _ in order], "--out", f"{name}.map", "--map", f"{name}.dxf", "--trajectories", name)
        assert said == "ale-merge: 2 of 2 drives are one map\n"
        results.append([path.read_bytes() for path in (tmp_path / f"{name}.map", tmp_path / f"{name}.dxf", *sorted((tmp_path / name).iterdir()))])
    assert results[0] == results[1]
    ways = [(read_tum(tmp_path / "one" / f"{log.stem}.tum"), read_tum(truth)) for log, truth in logs]
    errors = aligned_errors(np.concatenate([way[1] for way, _ in ways]), np.concatenate([at_times(way[0], truth)[0] for way, truth in ways]))
    assert np.sqrt(np.mean(errors ** 2)) < MOST_ERROR_M
    _, twice_m = map_score.standing_twice(map_score.read_walls(tmp_path / "one.dxf"))
    assert twice_m < 0.5
    alone = subprocess.run([BINARIES / "ale-replay", logs[0][0], "--load-map", tmp_path / "one.map"], capture_output=True, text=True, check=True)
    assert "not joined" not in alone.stderr


def test_tiles_hold_the_walls_of_the_map_and_a_robot_drives_in_them(tmp_path):
    log, truth = drive(tmp_path, "home", WORLDS / "home.world", 1, 0)
    merge(tmp_path, log, "--out", "home.map", "--tiles", "home.tiles", "--tile-side", "3")
    numbered = {line.split(maxsplit=2)[2] for line in (tmp_path / "home.map").read_text().splitlines() if line.startswith("wall ")}
    tiled = {line.split(maxsplit=2)[2] for line in (tmp_path / "home.tiles").read_text().splitlines() if line.startswith("wall ")}
    assert numbered == tiled
    assert (tmp_path / "home.tiles").read_text().count("\ntile ") > 8
    live = tmp_path / "live.tum"
    subprocess.run([BINARIES / "ale-replay", log, "--load-map", tmp_path / "home.tiles", "--start", "0,0,0", "--trajectory-live", live],
                   capture_output=True, check=True)
    assert np.sqrt(np.mean(aligned_errors(read_tum(live)[1], at_times(read_tum(live)[0], read_tum(truth))[0]) ** 2)) < MOST_ERROR_M


def test_drives_of_two_buildings_stay_apart_and_that_is_said(tmp_path):
    (home, _), (arena, _) = (drive(tmp_path, name, WORLDS / f"{name}.world", 1, 0) for name in ("home", "arena"))
    merge(tmp_path, home, arena, "--drives", "apart.drives")
    assert merge(tmp_path, "apart.drives", code=1) == merge(tmp_path, home, arena, code=1)
    said = merge(tmp_path, home, arena, "--out", "one.map", code=1)
    assert said.splitlines() == ["ale-merge: home.log is not joined: it shows no place of the others, or only what is alike",
                                 "ale-merge: 1 of 2 drives are one map"]


@pytest.mark.parametrize("first", [0, 1])
def test_rooms_that_are_alike_join_no_two_buildings(tmp_path, first):
    """The same room; one drive goes on to the left and one to the right, and behind its door each sees other walls."""
    corridors = (["-9 0 0 0", "5 0 6 0", "6 0 6 -1.8", "6 -1.8 -4 -1.8", "-4 -1.8 -4 -2.6", "-4 -2.6 -9 -2.6", "-9 -2.6 -9 0"],
                 ["-1 0 0 0", "-1 -2.4 -1 0", "-1 -2.4 3.6 -2.4", "3.6 -2.4 3.6 -3.2", "3.6 -3.2 14 -3.2", "14 -3.2 14 0", "14 0 5 0"])
    ways = ([(-7.5, -0.9)], [(2.5, -1.2), (12.5, -1.4)])
    logs = []
    for name, corridor, way in zip("ab", corridors, ways):
        world = tmp_path / f"{name}.world"
        via = "".join(f"# via {x} {y}\n" for x, y in [*IN_ROOM[1:], *way])
        world.write_text(f"# start {IN_ROOM[0][0]} {IN_ROOM[0][1]} 0\n{via}" + ROOM + "\n".join(corridor) + "\n", encoding="utf-8")
        logs.append(drive(tmp_path, name, world, ord(name), "ab".index(name) ^ first)[0])
    assert "1 of 2 drives are one map" in merge(tmp_path, *logs, code=1)


def test_a_merge_goes_on_from_drives_that_another_has_read_and_joined(tmp_path):
    """Read alone they give the bytes of their logs; joined two by two as good a map, whatever is named first."""
    worlds = (WORLDS / "home.world", home_from_the_kitchen(tmp_path / "w"), WORLDS / "home.world")
    logs = [drive(tmp_path, f"d{k}", world, k + 1, k) for k, world in enumerate(worlds)]
    merge(tmp_path, *[log for log, _ in logs[:2]], "--out", "logs.map")
    for log, _ in logs:
        assert merge(tmp_path, log, "--drives", f"{log.stem}.drives") == "ale-merge: drives: 1, joins: 0\n"
    merge(tmp_path, *[f"{log.stem}.drives" for log, _ in logs[:2]], "--out", "read.map")
    assert (tmp_path / "read.map").read_bytes() == (tmp_path / "logs.map").read_bytes()
    assert merge(tmp_path, "d2.drives", logs[0][0], "--drives", "some.drives") == "ale-merge: drives: 2, joins: 1\n"
    for log, _ in logs:
        log.unlink()
    for name, words in (("one", ("some.drives", "d1.drives")), ("two", ("d1.drives", "some.drives"))):
        assert merge(tmp_path, *words, "--out", f"{name}.map", "--trajectories", name) == "ale-merge: 3 of 3 drives are one map\n"
    assert (tmp_path / "one.map").read_bytes() == (tmp_path / "two.map").read_bytes()
    ways = [(read_tum(tmp_path / "one" / f"{log.stem}.tum"), read_tum(truth)) for log, truth in logs]
    errors = aligned_errors(np.concatenate([way[1] for way, _ in ways]), np.concatenate([at_times(way[0], truth)[0] for way, truth in ways]))
    assert np.sqrt(np.mean(errors ** 2)) < MOST_ERROR_M
    assert "d0.log and d0.log are the same drive" in merge(tmp_path, "d0.drives", "some.drives", "--out", "no.map", code=1)
    whole = (tmp_path / "d1.drives").read_bytes()
    (tmp_path / "cut.drives").write_bytes(whole[:-1])
    assert merge(tmp_path, "cut.drives", "--out", "no.map", code=1) == "ale-merge: cut.drives: damaged\n"
    assert "nothing else is written with it" in merge(tmp_path, "d1.drives", "--drives", "no.drives", "--out", "no.map", code=2)


def test_the_same_drive_twice_is_refused(tmp_path):
    log, _ = drive(tmp_path, "home", WORLDS / "home.world", 1, 0)
    again = pathlib.Path(tmp_path, "again.log")
    again.write_bytes(log.read_bytes())
    os.utime(again, (log.stat().st_mtime,) * 2)
    assert "are the same drive" in merge(tmp_path, log, again, code=1)
