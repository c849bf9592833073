"""What all tests share: the folders of modules that they import, Ctrl-C, and a way for multicast."""
import importlib.util
import os
import pathlib
import signal
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / folder) for folder in ("tests/tools", "tests/tree", "tools/library/python", "tools/lab/bench",
                                                   "tools/lab/bench/faults", "tools/lab/bench/fleet", "tools/lab/bench/scanners", "tools/lab/figures", "tools/lab/plot")]

from at_hand import BUILD  # noqa: E402
from lcm_url import NoMulticast, ensure_multicast  # noqa: E402


def pytest_configure(config):
    # What a shell starts in the background ignores Ctrl-C, and so would all that is started here.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    config.addinivalue_line("markers", "long: takes minutes; with ALE_LONG_TESTS=1 alone, as `make test-all` runs it")


def pytest_collection_modifyitems(items):
    if os.environ.get("ALE_LONG_TESTS"):
        return
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker(pytest.mark.skip(reason="long: ALE_LONG_TESTS=1, or make test-all"))


@pytest.fixture(scope="session")
def multicast():
    try:
        ensure_multicast()
    except NoMulticast as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def ale_package():
    """What a program of its own needs in its environment to import Python's package as it lies in the tree."""
    if not (BUILD / "python-package/ale_core.so").exists():
        pytest.skip("Python's package is not built: make python-package")
    return {"PYTHONPATH": str(ROOT / "tools/library/python/src"), "ALE_CORE": str(BUILD / "python-package")}


@pytest.fixture(scope="session")
def ale(ale_package):
    """The package itself, under a name of its own: in this process `ale` may be LCM's types."""
    os.environ["ALE_CORE"] = ale_package["ALE_CORE"]
    folder = ROOT / "tools/library/python/src/ale"
    spec = importlib.util.spec_from_file_location("ale_package", folder / "__init__.py", submodule_search_locations=[str(folder)])
    package = sys.modules["ale_package"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)
    return package
