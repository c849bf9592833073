"""A robot that starts at an unknown place of a saved map says lost until it has found itself, and is right then."""
import pytest

import relocalise
from at_hand import BUILD, WORLDS


@pytest.mark.parametrize("world", ["home", "arena"])
def test_finds_itself_from_random_places_and_is_never_wrong_while_good(world):
    times, right, wrong, off_m = relocalise.try_world(BUILD, WORLDS / f"{world}.world", 2, 60, 11)
    assert wrong == 0
    assert right == 2
    assert len(times) == 2
    assert off_m < 0.03
