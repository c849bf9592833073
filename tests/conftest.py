"""What all tests share: the folders of modules that they import, and a way for multicast."""
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / folder) for folder in ("tests/tools", "tests/tree", "tools/library/python", "tools/lab/bench",
                                                   "tools/lab/bench/faults", "tools/lab/figures")]

from lcm_url import NoMulticast, ensure_multicast  # noqa: E402


@pytest.fixture(scope="session")
def multicast():
    try:
        ensure_multicast()
    except NoMulticast as error:
        pytest.skip(str(error))
