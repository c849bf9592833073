"""A robot that starts at an unknown place of a saved map says lost until it has found itself, and is right then."""
import os
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "bench"))

import relocalise  # noqa: E402

BUILD = pathlib.Path(os.environ.get("ALE_BUILD", "build")).resolve()


@pytest.mark.parametrize("world", ["home", "arena"])
def test_finds_itself_from_random_places_and_is_never_wrong_while_good(world):
    times, right, wrong = relocalise.try_world(BUILD, ROOT / "tools" / "worlds" / f"{world}.world", 2, 60, 11)
    assert wrong == 0
    assert right == 2
    assert len(times) == 2
