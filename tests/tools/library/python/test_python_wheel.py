"""The wheel as a user has it: built from the sdist away from the tree, installed into an empty virtual environment; a bag becomes a
map there by the notebook. Long: with ALE_LONG_TESTS alone, and where PyPI can be had."""
import json
import os
import resource
import sys
import tarfile
import time

import pytest

from at_hand import ROOT
from empty_environment import alone, environment, run

PYTHON = ROOT / "tools/library/python"
LOG = ROOT / "tests/digest/apartment.log.gz"
WRITER = ROOT / "tests/tools/library/python/bag_of_log.py"
MOST_S = 60  # of processor time, once the wheel is there; what a clock says hangs on the network and on who else computes


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Folder with wheel and sdist."""
    if not os.environ.get("ALE_LONG_TESTS"):
        pytest.skip("compiles the core: ALE_LONG_TESTS=1")
    folder = tmp_path_factory.mktemp("built")
    python = environment(folder / "venv", "build")
    run(python, "-m", "build", "--outdir", folder, PYTHON)
    return folder


def test_the_sdist_carries_what_it_builds_from(built):
    with tarfile.open(next(built.glob("*.tar.gz"))) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {"pyproject.toml", "CMakeLists.txt", "src/ale/tracker.py", "src/ale/py.typed", "sources/firmware/config/scanners.ini", "binding/binding.cpp",
            "sources/lib/ale.h", "sources/lib/graph/mapper.cpp", "sources/drivers/store/map_file.c", "sources/LICENSE"} <= names
    assert not (PYTHON / "sources").exists(), "nothing is left in the tree"


def processor_s():
    """Of all that this process has run and waited for."""
    return sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])


def test_the_notebook_makes_a_map_of_a_bag_in_an_empty_environment(built, tmp_path):
    wheel = next(built.glob("*.whl"))
    started, worked = time.monotonic(), processor_s()
    python = environment(tmp_path / "venv", f"{wheel}[bags,plot]")
    for bag in ("drive", "drive.bag"):
        run(python, WRITER, LOG, tmp_path / bag)
    notebook = json.loads((PYTHON / "bag_to_map.ipynb").read_text(encoding="utf-8"))
    code = "\n".join("".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code")
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    maps = []
    for bag in ("drive", "drive.bag"):
        run(python, "-c", code.replace('"drive"', f'"{bag}"'), cwd=tmp_path, env=alone(tmp_path))
        maps.append((tmp_path / "drive.map").read_bytes())
    assert maps[0] == maps[1] and maps[0].count(b"\nwall ") > 10
    assert (tmp_path / "map.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert len((tmp_path / "drive.tum").read_text().splitlines()) == 120
    worked = processor_s() - worked
    print(f"wheel, notebook and plot in an empty environment: {time.monotonic() - started:.0f} s, {worked:.0f} s of a processor")
    assert worked < MOST_S


def test_a_bag_that_is_none_is_refused_in_words(built, tmp_path):
    python = environment(tmp_path / "venv", f"{next(built.glob('*.whl'))}[bags]")
    run(python, WRITER, LOG, tmp_path / "drive")
    (tmp_path / "letter.bag").write_text("no bag\n")
    code = ("import ale.bags, sys\n"
            "for path, words in (('absent', 'absent: no bag'), ('letter.bag', 'letter.bag: no bag'), ('drive', 'no topic /lidar')):\n"
            "    try:\n        list(ale.bags.read(path, '/lidar'))\n"
            "    except ValueError as error:\n        assert words in str(error), error\n"
            "    else:\n        sys.exit('taken')\n")
    run(python, "-c", code, cwd=tmp_path, env=alone(tmp_path))
