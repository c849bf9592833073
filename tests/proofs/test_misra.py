"""The page of MISRA's rules is read as it is written, and what it does not say is found."""
import shutil

import pytest

from misra import ADDON_FOLDER, PAGE, counts, differences, findings, in_order, table

PLANTED = """int planted(int a)
{
    if (a > 0) {
        goto out;
    }
out:
    return a;
}
"""


def test_the_page_has_a_row_for_each_rule_in_which_something_is_said():
    rows = [line.strip("| ").split(" | ") for line in PAGE.read_text(encoding="utf-8").splitlines() if line[:3].strip("| ").isdigit()]
    assert len(rows) == len(table(PAGE.read_text(encoding="utf-8"))) > 20
    assert all(len(row) >= 4 and all(row) for row in rows)


def test_a_row_that_is_missing_and_one_too_many_are_told():
    found = {("10.4", "lib/a.c", line, 1) for line in range(120)} | {("15.1", "lib/a.c", 1, 1)}
    assert counts(found) == {"10.4": 120, "15.1": 1}
    assert not differences(found, "| 10.4 | up to 200 | w | r |\n| 15.1 | 1 | w | r |\n")
    told = differences(found, "| 10.4 | up to 100 | w | r |\n| 7.2 | 3 | w | r |\n")
    assert [line.split()[2] for line in told] == ["7.2", "10.4", "15.1"]
    assert sorted(["10.4", "2.5", "10.10"], key=in_order) == ["2.5", "10.4", "10.10"]


@pytest.mark.skipif(not shutil.which("cppcheck") or not ADDON_FOLDER, reason="cppcheck with its addons is not there")
def test_what_breaks_a_rule_is_found(tmp_path):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib/planted.c").write_text(PLANTED, encoding="utf-8")
    found = findings(tmp_path, tmp_path / "work", 1)
    assert ("15.1", "lib/planted.c", 4) in {finding[:3] for finding in found}
