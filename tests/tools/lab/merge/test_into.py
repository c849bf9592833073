"""ale-merge --into: a building's map that is kept, and its versions."""
import hashlib
import json
import math
import resource
import signal
import subprocess

import pytest

import relocalise
from at_hand import BINARIES
from merging import ROOM, drive, merge

CORRIDOR = ["-9 0 0 0", "5 0 6 0", "6 0 6 -1.8", "6 -1.8 -4 -1.8", "-4 -1.8 -4 -2.6", "-4 -2.6 -9 -2.6", "-9 -2.6 -9 0"]
THROUGH = [(1.2, 0.8), (3.5, 0.8), (3.5, 3.2), (2.5, 1.0), (2.5, -0.9)]
BACK = [*THROUGH[::-1][1:], (1.4, 2.6)]
SHORT = THROUGH[:4]
SHED = ["0 0 6 -0.5", "6 -0.5 7 2", "7 2 4 4", "4 4 0 2.2", "0 2.2 0 0", "2 2.2 2.8 2.4", "2.8 2.4 2.5 3"]
AWAY = "--"  # no cupboard


def house(path, way, cupboard=2.5):
    """The room and its corridor, with the cupboard's lower end at this height."""
    walls = [line for line in ROOM.splitlines() if "4.4" not in line]
    if cupboard != AWAY:
        y0, y1 = cupboard, cupboard + 0.9
        walls += [f"4.4 {y0} 5 {y0}", f"5 {y1} 4.4 {y1}", f"4.4 {y1} 4.4 {y0}"]
    heading = math.atan2(way[1][1] - way[0][1], way[1][0] - way[0][0])
    via = [f"# via {x} {y}" for x, y in way[1:]]
    path.write_text("\n".join([f"# start {way[0][0]} {way[0][1]} {heading}", *via, *walls, *CORRIDOR]) + "\n", encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """Drives through the house: as it was, the other way round with the cupboard moved, and without it; two short ones; and one elsewhere."""
    folder = tmp_path_factory.mktemp("logs")
    ways = {"monday": (THROUGH, 2.5), "tuesday": (BACK, 1.3), "wednesday": (THROUGH, AWAY), "here": (SHORT, 2.5), "back": (SHORT[::-1], 2.5)}
    made = {name: drive(folder, name, house(folder / f"{name}.world", *of), day + 1, day)[0] for day, (name, of) in enumerate(ways.items())}
    (folder / "shed.world").write_text("# start 1 1 0\n# via 4 1\n# via 4 2\n" + "\n".join(SHED) + "\n", encoding="utf-8")
    return {**made, "shed": drive(folder, "shed", folder / "shed.world", 1, 5)[0]}


def versions(folder):
    """Number, and metres of walls, new, moved and gone, and the drives of each."""
    done = subprocess.run([BINARIES / "ale-merge", "--versions", "house.ale"], cwd=folder, capture_output=True, text=True, check=True)
    rows = [line.split() for line in done.stdout.splitlines()[1:]]
    assert all(row[1].startswith("20") and row[1].endswith("Z") for row in rows)
    return [(int(row[0]), *map(float, row[2:6]), row[6:]) for row in rows]


def held(folder):
    """All that is kept, by content."""
    return {path.relative_to(folder): hashlib.sha256(path.read_bytes()).digest() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.fixture(scope="module")
def kept(logs, tmp_path_factory):
    """The house after three drives, in a folder, and what was said."""
    folder = tmp_path_factory.mktemp("kept")
    said = [merge(folder, "--into", "house.ale", logs[name]) for name in ("monday", "tuesday", "wednesday")]
    return folder, said


def test_every_drive_makes_a_version_that_says_what_was_moved(kept):
    folder, said = kept
    first, moved, gone = versions(folder)
    assert [version[-1] for version in (first, moved, gone)] == [["monday.log"], ["tuesday.log"], ["wednesday.log"]]
    assert first[1] == first[2] > 30 and first[3:5] == (0, 0), "all of it is new"
    assert 0.8 < moved[3] < 2.2 and moved[4] < 0.7, "the cupboard's front, and what was seen of its sides before"
    assert 0.7 < moved[2] < 2.5, "the wall that it stood before, and what is seen of its sides now"
    assert 0.8 < gone[4] < 2.6 and gone[2] + gone[3] < 0.5
    assert "version 2: new" in said[1] and said[1].endswith("walls: house.ale.d/0002.png\n")
    assert all((folder / f"house.ale.d/000{k}.png").read_bytes().startswith(b"\x89PNG") for k in (1, 2, 3))


def test_a_robot_finds_itself_in_the_kept_map_and_is_never_wrong_while_good(kept, logs, tmp_path):
    folder, _ = kept
    log, truth = drive(tmp_path, "thursday", house(tmp_path / "thursday.world", BACK, AWAY), 9, 6)
    subprocess.run([BINARIES / "ale-replay", log, "--load-map", folder / "house.ale", "--poses", tmp_path / "poses.jsonl"], check=True, capture_output=True)
    start = relocalise.read_trajectory(logs["monday"].with_suffix(".truth"))[0][1]
    poses = [json.loads(line) for line in (tmp_path / "poses.jsonl").read_text(encoding="utf-8").splitlines()]
    near = [relocalise.is_near(pose, relocalise.seen_from(start, true)) for pose, (_, true) in zip(poses, relocalise.read_trajectory(truth), strict=True)]
    good = [is_near for pose, is_near in zip(poses, near) if pose["state"] == relocalise.GOOD]
    assert all(good) and len(good) > len(poses) / 2


def test_what_does_not_join_or_is_known_leaves_all_as_it_is(kept, logs):
    folder, _ = kept
    before = held(folder)
    assert merge(folder, "--into", "house.ale", logs["shed"], code=1).splitlines() == [
        "ale-merge: shed.log is not joined: it shows no place of the others, or only what is alike", "ale-merge: house.ale stays as it is"]
    assert merge(folder, "--into", "house.ale", logs["tuesday"]) == "ale-merge: tuesday.log is in the map already, since version 2\n"
    assert held(folder) == before


def test_a_drive_that_is_kept_no_longer_leaves_what_it_has_shown(logs, tmp_path):
    merge(tmp_path, "--into", "house.ale", logs["monday"])
    merge(tmp_path, "--into", "house.ale", "--keep", "1", logs["tuesday"])
    assert len(list((tmp_path / "house.ale.d/drives").iterdir())) == 1
    merge(tmp_path, "--into", "house.ale", "--keep", "1", logs["wednesday"])
    first, _, last = versions(tmp_path)
    assert len(list((tmp_path / "house.ale.d/drives").iterdir())) == 1
    assert last[1] > first[1] - 2.6, "the walls but for the cupboard"
    assert last[4] > 0.8
    assert "already, since version 1" in merge(tmp_path, "--into", "house.ale", logs["monday"])


@pytest.fixture(scope="module")
def first_version(logs, tmp_path_factory):
    folder = tmp_path_factory.mktemp("first")
    merge(folder, "--into", "house.ale", logs["here"])
    return folder


@pytest.fixture
def house_map(first_version, tmp_path):
    """A copy of its first version, to be damaged."""
    subprocess.run(["cp", "-a", *first_version.iterdir(), tmp_path], check=True)
    return tmp_path


def test_a_merge_that_is_killed_while_it_writes_leaves_the_old_map(house_map, logs):
    before = held(house_map)
    done = subprocess.run([BINARIES / "ale-merge", "--into", "house.ale", logs["back"]], cwd=house_map, check=False, capture_output=True,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50000, 50000)))
    assert done.returncode == -signal.SIGXFSZ
    assert held(house_map).items() >= before.items()
    assert len(held(house_map)) == len(before) + 1, "part of a log, beside its place"


@pytest.mark.parametrize("obstacle, is_made", [("house.ale.d/versions.new", False), ("house.ale.new", True)])
def test_a_merge_that_ends_between_two_files_is_as_if_it_had_not_been_or_is_finished_by_the_next(obstacle, is_made, house_map, logs):
    before = (house_map / "house.ale").read_bytes()
    (house_map / obstacle / "in_the_way").mkdir(parents=True)
    assert "File exists" in merge(house_map, "--into", "house.ale", logs["back"], code=1)
    assert (house_map / "house.ale").read_bytes() == before
    assert len(versions(house_map)) == 1 + is_made
    (house_map / obstacle / "in_the_way").rmdir()
    (house_map / obstacle).rmdir()
    assert ("in the map already" in merge(house_map, "--into", "house.ale", logs["back"])) == is_made
    assert (house_map / "house.ale").read_bytes() == (house_map / "house.ale.d/0002.map").read_bytes() != before
    assert len(versions(house_map)) == 2


def test_a_map_of_other_origin_is_not_written_over(house_map, logs, tmp_path):
    own = house_map / "house.ale"
    own.write_bytes(own.read_bytes().replace(b"ALE-SLAM map 1\n", b"ALE-SLAM map 1\n# by hand\n"))
    before = held(house_map)
    assert "another program has written it" in merge(house_map, "--into", "house.ale", logs["back"], code=1)
    assert held(house_map) == before
    (tmp_path / "alone.ale").write_bytes(own.read_bytes())
    assert "no drives are kept for it" in merge(tmp_path, "--into", "alone.ale", logs["back"], code=1)


@pytest.mark.parametrize("name, damage", [("versions", b"version 7"), ("0001.places.gz", b"\x1f\x8b"), ("0001.map", b"")])
def test_damage_is_named_and_nothing_is_written(name, damage, house_map, logs):
    (house_map / "house.ale.d" / name).write_bytes(damage)
    before = held(house_map)
    assert f"house.ale.d/{name}: " in merge(house_map, "--into", "house.ale", logs["back"], code=1)
    assert held(house_map) == before


@pytest.mark.parametrize("words, code", [("--into house.ale --out other.map some.log", 2), ("--into - some.log", 2), ("--versions one two", 2),
                                         ("--keep 0 --into house.ale some.log", 2), ("--versions house.ale", 1), ("--into some.log some.log", 2),
                                         ("--into house.ale absent.log", 1)])
def test_wrong_use_leaves_nothing(words, code, tmp_path):
    (tmp_path / "some.log").write_text("no scan", encoding="utf-8")
    assert merge(tmp_path, *words.split(), code=code).count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["some.log"]
