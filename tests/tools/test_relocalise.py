"""A robot that starts at an unknown place of a saved map says lost until it has found itself, and is right then."""
import subprocess
import sys

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


@pytest.mark.parametrize("words, status, part", [
    (["absent.world"], 1, "absent.world: No such file"),
    (["--poses", "0"], 2, "--poses"),
    (["--build", "absent"], 1, "no programs in absent/bin"),
])
def test_wrong_use_is_told_in_words(words, status, part):
    done = subprocess.run([sys.executable, relocalise.__file__, "--build", BUILD, *words], check=False, capture_output=True, text=True)
    assert done.returncode == status
    assert part in done.stderr and "Traceback" not in done.stderr
