"""The page of maps with faults: what its words mean, and that a picture and a row come of a kind."""
import subprocess
import sys

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("matplotlib")

import fault_maps  # noqa: E402
from at_hand import BUILD  # noqa: E402
from map_score import read_pieces  # noqa: E402

PLAN = np.array([[0.0, 0, 6, 0], [6, 0, 6, 4], [6, 4, 0, 4], [0, 4, 0, 0]])
FIGURES = {"ate": 0.004, "live": 0.003, "silent": 0, "lost": 0, "other_map": 0}


def drawn(walls, apart=(), **figures):
    walls = np.concatenate([PLAN, np.reshape(walls, (-1, 4))])
    return fault_maps.Drawn("home", "gap", walls, np.isin(np.arange(len(walls)), apart), np.zeros((2, 2)), PLAN, {**FIGURES, **figures}, 0.03)


@pytest.mark.parametrize("walls, apart, words", [
    ([], (), "single"),
    ([1, 0.25, 5, 0.25], (), "torn, a wall twice"),
    ([3, 2, 3, 2.5], (), "lines astray"),
    ([1, 0.1, 5, 0.1], (), "a wall twice"),
    ([1, 0.25, 5, 0.25], (4,), "in pieces"),
    ([[1, 0.25, 5, 0.25], [3, 2, 3, 2.5]], (4,), "in pieces, lines astray"),
])
def test_a_map_is_called_what_it_is(walls, apart, words):
    assert fault_maps.verdict(drawn(walls, apart), drawn([])) == words


def test_a_caption_says_the_errors_and_what_is_counted():
    assert fault_maps.caption(drawn([])) == "gap: 4 / 3 mm"
    assert fault_maps.caption(drawn([], ate=0.5, silent=3, lost=7)) == "gap: 500 / 3 mm, not within, 3 silent wrong, 7 lost"


def test_every_kind_is_on_one_sheet():
    kinds = [kind for _, of_sheet in fault_maps.SHEETS.values() for kind in of_sheet]
    assert sorted(kinds) == sorted(fault_maps.spoil.KINDS)


def test_walls_of_another_map_are_told_by_their_colour(tmp_path):
    line = "0\nLINE\n8\nWALLS\n{}10\n0\n20\n0\n11\n1\n21\n0\n"
    (tmp_path / "map.dxf").write_text(line.format("") + line.format("62\n6\n") + "0\nEOF\n", encoding="ascii")
    walls, apart = read_pieces(tmp_path / "map.dxf")
    assert len(walls) == 2 and apart.tolist() == [False, True]


def page(*words):
    return subprocess.run([sys.executable, fault_maps.__file__, "--build", BUILD, *words], check=False, capture_output=True, text=True)


def test_a_kind_has_its_picture_beside_the_drive_as_recorded_and_a_row(tmp_path):
    done = page("--out", tmp_path, "--kinds", "gap-12")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "outages.png").read_bytes().startswith(b"\x89PNG")
    assert [path.name for path in tmp_path.glob("*.png")] == ["outages.png"]
    text = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "![The scanner away for 4 to 12 s](outages.png)" in text
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("| ")][2:]
    assert [(row[0], row[2], row[3], row[-1]) for row in rows] == [("as recorded", "-", "0", "single"), ("gap-12", "yes", "0", "single")]


@pytest.mark.parametrize("words, status, part", [
    (["--kinds", "gap,fire"], 2, "--kinds fire"),
    (["--world", "palace"], 2, "--world"),
    (["--build", "absent"], 1, "no programs in absent/bin"),
])
def test_wrong_use_is_told_in_words(words, status, part, tmp_path):
    done = page("--out", tmp_path, *words)
    assert done.returncode == status
    assert part in done.stderr and "Traceback" not in done.stderr
