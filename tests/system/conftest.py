"""Fixtures of the system tests: an LCM port of their own, and the chain of programs, stopped whatever happens."""
import pytest

from chain import Chain
from lcm_url import free_lcm_url


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
