"""Each fault of tests/planted/run_time must turn the proof red, and be named by it; so must a harness that proves one run alone."""
import pathlib
import re
import shutil
import subprocess

import pytest

from prove import HERE, ROOT, Harness, argued, prove

PLANTED = sorted((ROOT / "tests" / "planted" / "run_time").glob("*.patch"))


def head(patch, key):
    """What stands before the patch itself."""
    return re.search(rf"^{key}: (.*)$", patch.read_text(encoding="utf-8"), re.MULTILINE).group(1)


@pytest.mark.parametrize("patch", PLANTED, ids=lambda patch: patch.stem)
def test_a_planted_fault_is_named(patch, tmp_path):
    tree = tmp_path / "tree"
    for folder in ("lib", "drivers", "tests/proofs/eva"):
        shutil.copytree(ROOT / folder, tree / folder)
    subprocess.run(["patch", "-s", "-p1", "-i", patch], cwd=tree, check=True)
    chosen = [Harness(path) for path in sorted(HERE.glob(f"{head(patch, 'harness')}*.c"))]
    total = prove(chosen, tree, tmp_path / "reports", 1)
    named = [str(alarm) for alarm in total.open if alarm.entry() not in argued()] + sorted(total.endless)
    assert any(head(patch, "says") in line for line in named), named + total.broken


def test_a_harness_in_which_nothing_is_unknown_is_refused(tmp_path):
    constant = pathlib.Path(tmp_path) / "base_constant.c"
    constant.write_text('/* One angle.\n *\n * proves: lib/base/trig.c\n * with: lib/base/fixed.c */\n#include "base/trig.h"\n'
                        "void main(void)\n{\n    ale_cos_q30(0);\n}\n", encoding="utf-8")
    total = prove([Harness(constant)], ROOT, tmp_path / "reports", 1)
    assert [line for line in total.broken if "nothing in it is unknown" in line]
