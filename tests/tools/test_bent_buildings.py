"""The office, but not at right angles: what serves as a compass in other buildings must not straighten it."""
import math
import subprocess

import pytest

import slam_table
from at_hand import BINARIES, WORLDS

MIDDLE = (11.0, 8.25)


def sheared(x, y):
    return x + math.tan(math.radians(2)) * y, y


def with_a_wing(x, y):
    """The eastern half turned by 8 degrees."""
    if x < MIDDLE[0]:
        return x, y
    c, s = math.cos(math.radians(8)), math.sin(math.radians(8))
    ahead, left = x - MIDDLE[0], y - MIDDLE[1]
    return MIDDLE[0] + c * ahead - s * left, MIDDLE[1] + s * ahead + c * left


def bowed(x, y):
    """Along an arc of 8 degrees."""
    turn = math.radians(8) / (2 * MIDDLE[0])
    radius = 1 / turn - (y - MIDDLE[1])
    return radius * math.sin(turn * x), MIDDLE[1] + 1 / turn - radius * math.cos(turn * x)


def pieces(wall):
    """Of half a metre: walls bend."""
    x1, y1, x2, y2 = wall
    count = math.ceil(math.hypot(x2 - x1, y2 - y1) / 0.5)
    at = [(x1 + (x2 - x1) * k / count, y1 + (y2 - y1) * k / count) for k in range(count + 1)]
    return zip(at, at[1:])


def bent_office(bend):
    lines = []
    for line in (WORLDS / "office.world").read_text().splitlines():
        words = line.split()
        if words[1] in ("start", "via"):
            x, y = bend(*map(float, words[2:4]))
            lines.append(f"# {words[1]} {x:.4f} {y:.4f} {' '.join(words[4:])}")
        elif words[0] != "#":
            lines += [f"{a:.4f} {b:.4f} {c:.4f} {d:.4f}" for (a, b), (c, d) in
                      ((bend(*end), bend(*other)) for end, other in pieces(map(float, words[:4])))]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("bend", [sheared, with_a_wing, bowed])
def test_a_building_that_is_not_at_right_angles_keeps_its_shape(bend, tmp_path):
    world, log, truth, live, final = (tmp_path / name for name in ("world", "log", "truth", "live", "final"))
    world.write_text(bent_office(bend))
    subprocess.run([BINARIES / "ale-sim", "--world", world, "--seed", "5", "--write-log", log, "--truth", truth],
                   check=True, capture_output=True)
    subprocess.run([BINARIES / "ale-replay", log, "--trajectory-live", live, "--trajectory", final], check=True, capture_output=True)
    assert slam_table.trajectory_error(final, truth)[0] < 20  # mm
    assert slam_table.trajectory_error(live, truth)[0] < 30
