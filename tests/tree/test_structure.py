"""The tree keeps its order: what includes what, how many units a folder holds, how complicated a function is."""
import pathlib
import re
import shutil

import lizard
import pytest

from at_hand import ROOT
from includes import SOURCES, TOP, Tree

MOST_PATHS = 12  # cyclomatic complexity of a function
MOST_ARGUMENTS = 6


@pytest.fixture(scope="module")
def tree():
    return Tree(ROOT)


@pytest.fixture
def copy(tmp_path):
    """The sources of lib and drivers, to plant faults in."""
    for top in ("lib", "drivers"):
        shutil.copytree(ROOT / top, tmp_path / top, ignore=lambda _, names: [
            name for name in names if "." in name and pathlib.PurePath(name).suffix not in SOURCES])
    return tmp_path


def plant(path, include):
    path.write_text(f'#include "{include}"\n' + path.read_text(encoding="utf-8"), encoding="utf-8")


def test_the_sources_are_found(tree):
    assert len(tree.units) > 300
    assert {unit.split("/")[0] for unit in tree.units} == set(TOP)
    assert sum(map(len, tree.includes.values())) > 1000


def test_no_floor_or_room_includes_one_above_it(tree):
    assert tree.upward() == []
    assert tree.unplaced() == []


def test_no_units_include_each_other_in_a_circle(tree):
    assert tree.circles() == []


def test_no_folder_holds_more_units_than_one_can_look_over(tree):
    assert tree.crowded() == []


def test_an_upward_include_is_found(copy):
    plant(copy / "lib/map/wall.c", "track/pipeline.h")
    assert ("lib/map/wall", "lib/track/pipeline") in Tree(copy).upward()


def test_an_include_of_drivers_in_lib_is_found(copy):
    plant(copy / "lib/base/pose.h", "lcm/bus.h")
    assert ("lib/base/pose", "drivers/lcm/bus") in Tree(copy).upward()


def test_a_circle_is_found(copy):
    plant(copy / "lib/base/pose.h", "base/noise.h")
    plant(copy / "lib/base/noise.h", "base/pose.h")
    assert any({"lib/base/pose", "lib/base/noise"} <= set(circle) for circle in Tree(copy).circles())


def test_a_folder_without_a_place_in_the_order_is_found(copy):
    (copy / "lib/attic").mkdir()
    (copy / "lib/attic/old.c").write_text("int old;\n", encoding="utf-8")
    assert Tree(copy).unplaced() == ["lib/attic"]


def functions(paths):
    return [function for file in lizard.analyze_files([str(path) for path in paths]) for function in file.function_list]


def complicated(found):
    return [f"{f.filename}:{f.start_line} {f.name}: {f.cyclomatic_complexity} paths, {f.parameter_count} arguments"
            for f in found if f.cyclomatic_complexity > MOST_PATHS or f.parameter_count > MOST_ARGUMENTS]


def test_no_function_is_complicated():
    found = functions(sorted(path for top in TOP for path in (ROOT / top).rglob("*") if path.suffix in SOURCES))
    assert len(found) > 3000
    assert complicated(found) == []


def test_a_complicated_function_is_found(tmp_path):
    planted = tmp_path / "planted.c"
    planted.write_text("int f(int a)\n{\n" + "".join(f"    if (a == {k}) {{ return {k}; }}\n" for k in range(12)) +
                       "    return a;\n}\nint g(int a, int b, int c, int d, int e, int f, int h);\n"
                       "int g(int a, int b, int c, int d, int e, int f, int h) { return a; }\n", encoding="utf-8")
    assert [line.split()[1] for line in complicated(functions([planted]))] == ["f:", "g:"]


def long_tests():
    """Files with tests that run with ALE_LONG_TESTS alone, as far as pytest selects them by name."""
    found = [path for path in sorted((ROOT / "tests").rglob("test_*.py")) if path != pathlib.Path(__file__).resolve()]
    return [path for path in found if re.search(r"@LONG|marks=LONG|\[LONG|ALE_LONG_TESTS", path.read_text(encoding="utf-8"))]


def without_a_command(paths):
    """Those that no command with ALE_LONG_TESTS names, neither the file nor a test of it."""
    recipes = (ROOT / "tools/make/tests.mk").read_text(encoding="utf-8")
    variables = dict(re.findall(r"^(\w+) = (.*)$", recipes, re.MULTILINE))
    chosen = re.findall(r'ALE_LONG_TESTS=1 .*?\bT=(?:"([^"]*)"|(\S+))', recipes)
    text = " or ".join(re.sub(r"\$\((\w+)\)", lambda name: variables[name[1]], quoted or bare) for quoted, bare in chosen)
    words = text.split(" or ")
    return [path.name for path in paths if not any(word in path.stem or re.search(rf"def test_\w*{word}", path.read_text(encoding="utf-8")) for word in words)]


def test_make_test_all_runs_every_long_test():
    assert len(long_tests()) > 8
    assert without_a_command(long_tests()) == []


def test_a_long_test_that_nothing_runs_is_found(tmp_path):
    planted = tmp_path / "test_planted.py"
    planted.write_text("@LONG\ndef test_it(): pass\n", encoding="utf-8")
    assert without_a_command([planted]) == ["test_planted.py"]
