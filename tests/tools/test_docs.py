"""tools/make/docs_check.py: the pages of the tree, and faults planted in a page."""
import os
import subprocess
import sys

import pytest

from at_hand import BUILD, ROOT

PAGE = """# A planted page

Drives end 2.4 mm off in 20 scans, in at most 9 ms (`make bench`; `ale-replay LOG --odometry off`); see [a file](lib/wall.c) and `lib/wall`.

<!-- check: make bench
ATE {2.4} mm .. {20} scans
took {9 at most} ms
-->
"""
MAKEFILE = "T ?=\nbench:\n\t@echo 'ATE 2.38 mm in all of 20 scans'; echo 'took 7.5 ms'\n"


def docs_check(root, *words, **environment):
    return subprocess.run([sys.executable, ROOT / "tools/make/docs_check.py", "--root", root, "--build", BUILD, *words], check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300, env={**os.environ, **environment})


@pytest.fixture
def planted(tmp_path):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib/wall.c").touch()
    (tmp_path / "Makefile").write_text(MAKEFILE)

    def check(page, *words, **environment):
        (tmp_path / "README.md").write_text(page)
        return docs_check(tmp_path, *words, **environment)

    return check


def test_the_pages_of_the_tree_name_what_is_there():
    told = docs_check(ROOT, "--no-figures")
    assert told.returncode == 0, told.stdout


def test_a_page_whose_figures_are_what_the_command_prints_is_right(planted):
    told = planted(PAGE)
    assert told.returncode == 0, told.stdout
    assert "1 pages, 2 checked lines, 0 faults" in told.stdout


@pytest.mark.parametrize("was, planted_fault, why", [
    ("2.4 mm off", "2.3 mm off", "2.4 does not stand in the block above"),
    ("2.4", "2.3", "does not print: ATE {2.3} mm"),
    ("2.4", "2.40", "does not print: ATE {2.40} mm"),
    ("at most 9 ms", "at most 8 ms", "9 does not stand in the block above"),
    ("9", "7", "does not print: took {7 at most} ms"),
    ("make bench\nATE", "make bench && false\nATE", "failed"),
    ("{20} scans\n", "{20} scans\nno figure\n", "does not print: no figure"),
    ("{2.4} mm .. {20} scans\ntook {9 at most} ms", "", "no figure is checked"),
    ("(lib/wall.c)", "(lib/hall.c)", "link to lib/hall.c: not there"),
    ("(lib/wall.c)", "(README.md#walls)", "no such heading"),
    ("`lib/wall`", "`lib/hall`", "`lib/hall`: not there"),
    ("`lib/wall`", "`hall.c`", "`hall.c`: not there"),
    ("`lib/wall`", "`make hall`", "no target hall"),
    ("`lib/wall`", "`make bench HALL=1`", "no variable HALL"),
    ("`lib/wall`", "`ale-hall`", "no such program"),
    ("--odometry off", "--hall off", "no option --hall"),
    ("# A planted page\n", "# A planted page\n" * 121, "more than 120"),
    ("see ", "| file | what |\n|---|---|\n| `hall` | walls |\n\n", "no `hall` here"),
])
def test_a_planted_fault_is_found(planted, was, planted_fault, why):
    assert was in PAGE
    page = PAGE.replace(was, planted_fault) if was != "see " else f"{PAGE}\n{planted_fault}"
    told = planted(page)
    assert told.returncode == 1 and why in told.stdout, told.stdout


def test_a_figure_stands_on_one_page_only(planted, tmp_path):
    (tmp_path / "lib/README.md").write_text(PAGE.replace("](lib/", "]("))
    told = planted(PAGE)
    assert told.returncode == 1 and "stands in README.md, too: ATE {2.4} mm" in told.stdout


def test_a_long_command_runs_when_all_are_asked_for(planted):
    page = PAGE.replace("check:", "check long:").replace("2.4", "2.3")
    told = planted(page)
    assert told.returncode == 0 and "skipped make bench (long" in told.stdout
    assert planted(page, "--all").returncode == 1


def test_what_needs_shared_data_is_left_out_where_there_are_none(planted):
    page = PAGE.replace("check: make bench", "check: make bench # $ALE_SHARED")
    told = planted(page, ALE_SHARED="")
    assert told.returncode == 0 and "skipped" in told.stdout
    assert planted(page.replace("2.4", "2.3"), ALE_SHARED="/").returncode == 1
