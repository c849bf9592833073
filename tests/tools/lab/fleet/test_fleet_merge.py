"""ale-fleet merge: one map by a tree of tasks, the same whatever the workers did."""
import pytest

from at_hand import WORLDS
from fleet_at_work import said_by, script
from merging import IN_ROOM, ROOM, drive, merge

pytest.importorskip("distributed", reason="python3-distributed is not here")


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """Three days in one room, the last first; one in an arena; one that is broken."""
    folder = tmp_path_factory.mktemp("logs")
    way = "".join(f"# via {x} {y}\n" for x, y in IN_ROOM[1:])
    (folder / "room.world").write_text(f"# start {IN_ROOM[0][0]} {IN_ROOM[0][1]} 0\n{way}{ROOM}", encoding="ascii")
    made = [drive(folder, f"room{k}", folder / "room.world", k + 1, 9 - k)[0] for k in range(3)]
    (folder / "broken.log").write_text("broken", encoding="ascii")
    return [*made, drive(folder, "arena", WORLDS / "arena.world", 1, 0)[0], folder / "broken.log"]


def fleet(folder, name, logs, *words, code=0):
    said = said_by("merge", *logs, "--out", folder / f"{name}.map", "--map", folder / f"{name}.pgm", "--workers", "2", *words, code=code)
    assert not (folder / f"{name}.map.parts").exists()
    return [path.read_bytes() for path in (folder / f"{name}.map", folder / f"{name}.pgm")], said


def test_the_map_is_that_of_ale_merge_in_the_same_steps(logs, tmp_path):
    """And a worker that dies on the way changes no byte of it."""
    merge(tmp_path, *logs[:2], "--drives", "two.drives")
    merge(tmp_path, "two.drives", logs[2], "--out", "steps.map", "--map", "steps.pgm")
    # the first to join ends the worker that has called it
    program = script(tmp_path / "merge", f'case "$*" in *joined.drives*) mkdir "{tmp_path}/killed" 2>/dev/null && kill -9 $PPID;; esac', "ale-merge")
    drawn, said = fleet(tmp_path, "tree", logs[:3], "--program", program)
    assert "3 of 3 drives are one map" in said
    assert (tmp_path / "killed").is_dir()
    assert drawn == [(tmp_path / f"steps.{ending}").read_bytes() for ending in ("map", "pgm")]
    assert "image: tree.pgm" in (tmp_path / "tree.yaml").read_text(encoding="ascii")


def test_what_is_broken_or_does_not_join_is_said_and_the_rest_is_a_map(logs, tmp_path):
    _, said = fleet(tmp_path, "some", [logs[0], *logs[3:]], code=1)
    assert "broken.log: has no line of a known format" in said
    assert "room0.log is not joined: it shows no place of the others, or only what is alike" in said
    assert "1 of 2 drives are one map" in said


def test_a_merge_that_was_given_up_goes_on_from_what_is_joined(logs, tmp_path):
    program, words = tmp_path / "merge", ("--out", tmp_path / "m.map", "--workers", "2", "--program", tmp_path / "merge")
    script(program, 'case "$*" in *--out*) exit 3;; esac', "ale-merge")
    assert "was not written" in said_by("merge", *logs[:2], *words, code=1)
    assert len(list((tmp_path / "m.map.parts").iterdir())) == 2
    script(program, 'case "$*" in *read.drives*) exit 3;; esac', "ale-merge")
    assert "2 of 2 drives are one map" in said_by("merge", *logs[:2], *words)
