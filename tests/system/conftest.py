"""Fixtures of the system tests: an LCM port of their own, and the chain of programs, stopped whatever happens."""
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "python"))

from lcm_url import NoMulticast, ensure_multicast, free_lcm_url  # noqa: E402

from chain import Chain  # noqa: E402


@pytest.fixture(scope="session")
def multicast():
    try:
        ensure_multicast()
    except NoMulticast as error:
        pytest.skip(str(error))


@pytest.fixture
def chain(tmp_path, multicast):
    running = Chain(tmp_path, free_lcm_url())
    yield running
    running.stop()


@pytest.fixture(scope="module")
def long_chain(tmp_path_factory, multicast):
    """A chain that several tests look at."""
    running = Chain(tmp_path_factory.mktemp("chain"), free_lcm_url())
    yield running
    running.stop()
