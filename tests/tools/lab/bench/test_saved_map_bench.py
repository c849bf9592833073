"""Recordings that begin anywhere in a saved map."""
import subprocess
import sys

import pytest

pytest.importorskip("numpy")

import saved_map_table  # noqa: E402
from at_hand import BUILD, shared  # noqa: E402
from slam_table import Bench  # noqa: E402


def test_a_drive_is_found_in_its_own_map_and_lies_where_it_lay(tmp_path):
    data = shared("data/urg04lx/exp1.dat").parents[1]
    name, of, lost, pieces, off = saved_map_table.row(Bench(BUILD, tmp_path), data, "exp1", "exp1")
    assert (name, of, pieces) == ("exp1", "exp1", "1")
    assert 0 < int(lost.split()[0]) < 100
    assert 0 < float(off.split(",")[0]) < 0.05


def test_what_is_not_there_is_named(tmp_path):
    for words, said in (([tmp_path], "no shared data there"), ([shared("data").parent, "--only", "exp9"], "--only: one of exp1,")):
        done = subprocess.run([sys.executable, saved_map_table.__file__, *map(str, words)], capture_output=True, text=True, check=False)
        assert done.returncode == 1 and said in done.stderr
