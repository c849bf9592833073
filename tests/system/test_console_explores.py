"""A click on "explore" in the browser, and the robot maps the arena: every program is the real one.

It takes minutes and wants the processor for itself: with ALE_LONG_TESTS=1, as `make test-all` runs it."""
import math
import os
import subprocess

import pytest

import browser
from at_hand import BINARIES, WORLDS
from chain import Truth, distance_to_wall, tally, walls_of
from waiting import wait_until

pytestmark = [
    pytest.mark.skipif(not os.environ.get("ALE_LONG_TESTS"), reason="takes minutes: ALE_LONG_TESTS=1 runs it"),
    pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")]

SPEED = 4
LONGEST_S = 900  # of the robot's time
WORD = "document.getElementById('exploration').textContent"
WALLS = "Number(document.getElementById('map-lines').textContent)"


@pytest.fixture
def page(chain):
    secret, listed = chain.folder / "operator.key", chain.folder / "robot.keys"
    subprocess.run([BINARIES / "ale-keys", "operator", "--secret", secret, "--robot", listed], check=True, timeout=180)
    chain.sim = chain.simulator("--world", WORLDS / "arena.world", "--drive", "--truth", chain.truth_path, speed=SPEED)
    chain.firmware("[lcm]\npublish_scan = yes\n[recorder]\nfolder =\n", "--keys", listed, speed=SPEED)
    console = chain.start("ale-console", "--lcm-url", chain.url, "--http", "127.0.0.1:0", "--keys", secret)
    wait_until(console.out, 180, "the console's address")
    watching = browser.Browser()
    try:
        watching.open(console.out().strip())
        yield watching
        assert watching.errors() == []
    finally:
        watching.close()


def seen_part(world, lines):
    """Part of the world's walls, by length, that has a line of the map beside it."""
    seen = total = 0.0
    for x1, y1, x2, y2 in walls_of(world):
        length = math.hypot(x2 - x1, y2 - y1)
        steps = max(1, round(length / 0.1))
        near = sum(any(distance_to_wall(line, x1 + (x2 - x1) * (k + 0.5) / steps, y1 + (y2 - y1) * (k + 0.5) / steps) < 0.1
                       for line in lines) for k in range(steps))
        seen += length * near / steps
        total += length
    return seen / total


def to_world(origin, line):
    c, s = math.cos(origin[2]), math.sin(origin[2])
    return tuple(v for x, y in ((line["x1"], line["y1"]), (line["x2"], line["y2"]))
                 for v in (origin[0] + c * x - s * y, origin[1] + s * x + c * y))


def test_a_click_on_explore_makes_the_robot_map_the_arena(page, chain):
    page.wait_for("document.body.dataset.control === 'yes'")
    page.click("explore")
    page.wait_for(f"{WORD} !== 'off'")
    page.wait_for(f"{WALLS} > 10")
    page.wait_for(f"{WORD}.startsWith('finished')", LONGEST_S / SPEED)
    page.screenshot(chain.folder / "explored.png")
    lines = page.run("""
        return import("/scene.js").then(({ Scene }) => new Promise((done) => {
          const scene = new Scene();
          const socket = new WebSocket(`ws://${location.host}/${location.search}`);
          socket.onmessage = (event) => {
            scene.take(JSON.parse(event.data));
            if (scene.map) { socket.close(); done(scene.map.lines); }
          };
        }));""")
    assert chain.sim.end() == 0
    assert tally(chain.sim)["collisions"] == 0
    truth = Truth(chain.truth_path)
    start, end = truth.world[0], truth.world[-1]
    assert math.dist(start[:2], end[:2]) < 0.10
    part = seen_part("arena", [to_world(start, line) for line in lines])
    print(f"{100 * part:.1f} % of the walls in the map")
    assert part > 0.9
