"""A click on "explore" in the browser, and the robot maps the arena; a press on the map, and it drives there: every program is the
real one.

It takes minutes and wants the processor for itself: with ALE_LONG_TESTS=1, as `make test-all` runs it."""
import math
import subprocess

import pytest

import browser
from at_hand import BINARIES, LONG, WORLDS
from chain import Truth, distance_to_wall, tally, walls_of
from console_page import let_the_camera_glide
from waiting import wait_until

pytestmark = [LONG, pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")]

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


BEHIND_TWO_CORNERS, START = (3.2, 1.1), (0.0, 0.0)  # map frame
PEEK = """
    const canvas = document.getElementById("map");
    canvas.dispatchEvent(new PointerEvent("pointermove", { clientX: arguments[0], clientY: arguments[1], bubbles: true }));
    return document.getElementById("cursor").textContent;"""


def place_under(page, x_px, y_px):
    words = page.run(PEEK, x_px, y_px).split()
    return float(words[1]), float(words[3])


def pixel_of(page, place):
    """Where on the screen a place of the map is, while the camera rests."""
    left, right = place_under(page, 300, 300), place_under(page, 700, 300)
    px_m = 400 / (right[0] - left[0])
    return round(300 + px_m * (place[0] - left[0])), round(300 - px_m * (place[1] - left[1]))


def press_goal(page, place):
    page.click("goal")
    let_the_camera_glide(page)
    x_px, y_px = pixel_of(page, place)
    page.drag(x_px, y_px, x_px, y_px)


def test_a_press_on_the_map_makes_the_robot_drive_there(page, chain):
    page.wait_for("document.body.dataset.control === 'yes'")
    page.wait_for(f"{WALLS} > 3")
    for place in (BEHIND_TWO_CORNERS, START):
        press_goal(page, place)
        page.wait_for(f"{WORD}.startsWith('drives to')")
        page.wait_for(f"{WORD}.startsWith('is at')", LONGEST_S / SPEED)
    press_goal(page, BEHIND_TWO_CORNERS)
    page.wait_for(f"{WORD}.startsWith('drives to')")
    page.click("stop")
    page.wait_for(f"!{WORD}.startsWith('drives to')")
    assert chain.sim.end() == 0
    assert tally(chain.sim)["collisions"] == 0
    way = Truth(chain.truth_path).world
    there = to_world(way[0], {"x1": BEHIND_TWO_CORNERS[0], "y1": BEHIND_TWO_CORNERS[1], "x2": 0, "y2": 0})[:2]
    assert min(math.dist(pose[:2], there) for pose in way) < 0.15
    assert math.dist(way[-1][:2], there) > 0.5, "stopped on the way"
