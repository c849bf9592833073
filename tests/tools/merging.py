"""Drives of simulated robots on days of their own, and ale-merge over them."""
import os
import subprocess

from at_hand import BINARIES

DAY_S = 86400
# A room with a cupboard in it, a door, and a corridor on either side of it.
ROOM = """0 0 2 0
3 0 5 0
5 0 5 4
5 4 0 4
0 4 0 0
4.4 2.5 5 2.5
5 3.4 4.4 3.4
4.4 3.4 4.4 2.5
0 3.2 0.8 3.2
0.8 3.2 0.8 4
"""
IN_ROOM = [(1.2, 0.8), (3.5, 0.8), (3.5, 3.2), (1.4, 2.6), (1.2, 1.0), (2.5, 0.8), (2.5, -0.9)]


def drive(folder, name, world, seed, day):
    """Its log, of that day, and its truth."""
    log, truth = folder / f"{name}.log", folder / f"{name}.truth"
    subprocess.run([BINARIES / "ale-sim", "--world", world, "--seed", str(seed), "--write-log", log, "--truth", truth],
                   check=True, capture_output=True)
    os.utime(log, (1700000000 + DAY_S * day,) * 2)
    return log, truth


def merge(folder, *words, code=0):
    done = subprocess.run([BINARIES / "ale-merge", *map(str, words)], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stderr
    return done.stderr
