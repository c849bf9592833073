"""The score of a map: walls that stand twice, and what is told of files that are none."""
import subprocess
import sys

import numpy as np
import pytest

import map_score

PLAN = "0 0 4 0\n4 0 4 3\n4 3 0 3\n0 3 0 0\n"


def dxf(walls):
    pairs = [("0", "SECTION")]
    for x1, y1, x2, y2 in walls:
        pairs += [("0", "LINE"), ("8", "WALLS"), ("10", x1), ("20", y1), ("11", x2), ("21", y2)]
    return "".join(f"{code}\n{value}\n" for code, value in [*pairs, ("0", "EOF")])


def scored(folder, walls, *more):
    (folder / "map.dxf").write_text(dxf(walls), encoding="ascii")
    return subprocess.run([sys.executable, map_score.__file__, folder / "map.dxf", *more], check=False, capture_output=True, text=True)


def test_a_wall_beside_itself_stands_twice_and_one_that_faces_away_does_not():
    beside, away = [0.5, 0.1, 2.5, 0.1], [2.5, 0.2, 0.5, 0.2]
    assert map_score.standing_twice(np.array([[0.0, 0, 4, 0], beside, away])) == (1, 2.0)


def test_what_the_plan_has_two_walls_for_does_not_stand_twice():
    drawn = np.array([[0.0, 0, 4, 0], [0.5, 0.3, 2.5, 0.3], [0.5, 0.02, 2.5, 0.02]])
    wall, cabinet = [0.0, 0, 4, 0], [0.5, 0.3, 2.5, 0.3]
    assert map_score.standing_twice(drawn[:2], np.array([wall])) == (1, 2.0)
    assert map_score.standing_twice(drawn[:2], np.array([wall, cabinet])) == (0, 0)
    assert map_score.standing_twice(drawn[::2], np.array([wall, cabinet])) == (1, 2.0)


def test_what_is_drawn_where_no_wall_is_is_not_right_and_a_wall_that_is_not_drawn_is_not_found(tmp_path):
    (tmp_path / "plan").write_text(PLAN, encoding="ascii")
    (tmp_path / "truth").write_text("0 1 1 0 0 0 0 1\n" * 50, encoding="ascii")
    in_map = [[x1 - 1, y1 - 1, x2 - 1, y2 - 1] for x1, y1, x2, y2 in np.loadtxt(tmp_path / "plan")]
    done = scored(tmp_path, in_map, tmp_path / "plan", tmp_path / "truth")
    assert "right 100.0 %, found 100.0 %" in done.stdout
    done = scored(tmp_path, [in_map[0], in_map[1], [-1, 0.5, 3, 0.5]], tmp_path / "plan", tmp_path / "truth")
    right, found = (float(done.stdout.split(word)[1].split("%")[0]) for word in ("right", "found"))
    assert right == pytest.approx(100 * 7 / 11, abs=1)
    assert found < 80


@pytest.mark.parametrize("words, part", [
    (["absent.dxf"], "absent.dxf: No such file"),
    ([__file__], "no walls in it"),
])
def test_what_is_no_map_is_told_in_one_line(words, part):
    done = subprocess.run([sys.executable, map_score.__file__, *words], check=False, capture_output=True, text=True)
    assert done.returncode == 1
    assert part in done.stderr and done.stderr.count("\n") == 1


def test_a_plan_of_other_things_is_named(tmp_path):
    (tmp_path / "plan").write_text("1 2 three 4\n", encoding="ascii")
    done = scored(tmp_path, [[0, 0, 1, 0]], tmp_path / "plan", tmp_path / "plan")
    assert done.returncode == 1
    assert "plan: not 4 numbers in every line" in done.stderr
