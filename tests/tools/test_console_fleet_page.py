"""The page of a console of several robots in headless Chromium: another one is chosen by mouse, keys and finger, and then
nothing of the one before is left."""
import pytest

import browser
from at_hand import LONG
from console_page import LINK, STATE, chromium, page, pixels  # noqa: F401 (fixtures)
from rovers import NAMES, rovers  # noqa: F401 (fixture)
from test_console_access import CONTROLS, IN_SIGHT, PHONES, assert_readable, hold_still
from waiting import Pulse, wait_until
from watching import Console, console, lcm_url, pulse, robot  # noqa: F401 (fixtures)

pytestmark = pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")

SHOWN = "document.getElementById('robot').value"
LISTED = "[...document.getElementById('robot').options].map((option) => option.text).join()"
# All that the page says, but for the list of robots, names of signals, and what the link counts.
SAID = """
const ofTheLink = ["malformed", "skipped"], lists = "#robot, #plots select";
return [...document.body.querySelectorAll("*")].filter((e) => e.childElementCount === 0 && !e.closest(lists) && !ofTheLink.includes(e.id))
  .map((e) => [e.id, e.textContent, e.className.baseVal ?? e.className, e.getAttribute("href") ?? ""].join("|"));
"""


@pytest.fixture
def beating(rovers):
    """Both robots send ten scans a second."""
    pulse_of_both = Pulse(0.1, rovers.step)
    yield pulse_of_both
    pulse_of_both.stop()


@pytest.fixture
def fleet_page(chromium, rovers, beating):
    chromium.open(rovers.console.url)
    chromium.run("localStorage.clear()")
    chromium.wait_for(f"document.body.dataset.control === 'yes' && {STATE} === 'good'")
    chromium.errors()
    yield chromium
    assert chromium.errors() == []


def choose(page, name, way="mouse"):
    """From rover1, which is shown."""
    if way == "keys":
        page.run("document.getElementById('robot').focus()")
        page.press(*["ArrowDown"] * NAMES.index(name))
    else:
        if way == "finger":
            page.tap("robot")
            assert page.run("return document.activeElement.id") == "robot"
        page.select(page.elements(f"#robot option[value='{name}']")[0])
    page.wait_for(f"{SHOWN} === '{name}' && {LINK} !== 'connecting'")


def test_one_robot_is_no_choice(page, pulse):
    page.wait_for(f"{STATE} === 'good'")
    assert page.run("return document.getElementById('robot')") is None
    assert not page.run("return document.getElementById('stop-all').checkVisibility()")


@pytest.mark.parametrize("way", ["mouse", *(pytest.param(way, marks=LONG) for way in ("keys", "finger"))])
def test_another_robot_is_chosen_and_its_state_is_seen_before(fleet_page, rovers, way):
    fleet_page.wait_for(f"{LISTED} === 'rover1: good,rover2: good,rover3: not heard yet'")
    rovers.two.state = 1
    fleet_page.wait_for(f"{LISTED} === 'rover1: good,rover2: weak,rover3: not heard yet'")
    assert fleet_page.run(f"return {STATE}") == "good"
    assert fleet_page.spoken_name(fleet_page.elements("#robot")[0]) == "robot that is shown; rover2: weak"
    assert fleet_page.run("return document.getElementById('robot').hasAttribute('data-trouble')")
    choose(fleet_page, "rover2", way)
    fleet_page.wait_for(f"{STATE} === 'weak' && Number(document.getElementById('scan').textContent) >= 1000")
    fleet_page.wait_for("document.getElementById('shelf').textContent.includes('flat')")
    assert "recording" not in fleet_page.run("return document.getElementById('shelf').textContent"), "rover1 has one"
    fleet_page.reload()
    fleet_page.wait_for(f"document.getElementById('robot') && {SHOWN} === 'rover2' && {STATE} === 'weak'")
    assert "robot=rover2" in fleet_page.run("return document.getElementById('live-map').href")


def test_nothing_of_the_robot_before_is_left(fleet_page, rovers):
    """As on a page that has never shown another one."""
    rovers.one.wheels, rovers.one.exploration, rovers.one.who_drives = "stalled", "explores", "bob"
    rovers.one.publish_pieces(range(5))
    rovers.one.publish_graph()
    fleet_page.click("save-map")
    wait_until(lambda: rovers.commands, 60, "the command")
    rovers.one.answer = ("alice", rovers.commands[-1][1].counter, "saved map.map: 12 walls")
    fleet_page.wait_for("document.getElementById('answer').textContent.startsWith('saved')")
    fleet_page.wait_for("document.getElementById('wheels').textContent.startsWith('stalled') && document.querySelectorAll('#shelf li').length === 2")
    fleet_page.wait_for("Number(document.getElementById('scan').textContent) > 15 && document.getElementById('keyframes').textContent === '22'")
    fleet_page.click("zoom-in")
    assert pixels(fleet_page, "wall", 40)["count"] > 500
    choose(fleet_page, "rover3")

    def said():
        fleet_page.wait_for("document.getElementById('recordings-note').textContent !== '' && document.getElementById('rate').textContent === '0.0 /s'"
                            f" && {LINK} === 'waiting' && document.getElementById('advice').textContent !== ''"
                            " && [...document.querySelectorAll('#plots output')].every((said) => said.textContent === 'nothing yet')")
        fleet_page.run("return new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
        drawn = {colour: pixels(fleet_page, colour, 12)["count"] for colour in ("wall", "apart", "trail", "line", "corner", "scan", "keyframe")}
        return fleet_page.run(SAID), drawn
    after, drawn_after = said()
    fleet_page.reload()
    fresh, drawn = said()
    assert [pair for pair in zip(after, fresh, strict=True) if pair[0] != pair[1]] == []
    assert drawn_after == drawn


def test_what_was_begun_with_one_robot_reaches_no_other(fleet_page, rovers):
    fleet_page.click("reset")
    assert fleet_page.text("reset") == "sure?"
    fleet_page.click("goal")
    assert not fleet_page.run("return document.getElementById('hint').hidden")
    fleet_page.run("document.getElementById('robot').focus()")
    fleet_page.run("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: 'w', bubbles: true}))")
    wait_until(lambda: ("rover1", "drive") in rovers.verbs, 60, "a set point")
    choose(fleet_page, "rover2", "keys")
    fleet_page.wait_for("document.body.dataset.control === 'yes' && Number(document.getElementById('scan').textContent) >= 1000")
    assert fleet_page.text("reset") == "reset"
    assert fleet_page.run("return document.getElementById('hint').hidden")
    fleet_page.press(" ")  # in the list of robots, too
    wait_until(lambda: ("rover2", "stop") in rovers.verbs, 60, "STOP")
    assert [verb for name, verb in rovers.verbs if name == "rover2"] == ["stop"]
    before = len(rovers.verbs)
    fleet_page.click("stop-all")
    wait_until(lambda: rovers.verbs[before:] == [("rover1", "stop"), ("rover2", "stop")], 60, f"STOP for all: {rovers.verbs[before:]}")
    fleet_page.wait_for("document.getElementById('answer').textContent === 'rover3: no robot has been heard yet'")


@LONG
def test_a_console_that_returns_without_the_robot_says_so(chromium, lcm_url, tmp_path):
    with_token = ("--token-file", tmp_path / "token")
    running = Console(f"{lcm_url}&prefix=rover1.", "127.0.0.1:0", *with_token, "--lcm-url", f"{lcm_url}&prefix=rover2.")
    chromium.open(f"{running.url}&robot=rover2")
    chromium.wait_for(f"{LINK} === 'waiting'")
    assert running.end() == 0
    chromium.wait_for(f"{LINK} === 'gone'")
    running = Console(f"{lcm_url}&prefix=rover1.", running.origin.removeprefix("http://"), *with_token)
    chromium.wait_for("document.body.textContent.includes('This console has no robot of that name')")
    assert running.end() == 0
    chromium.errors()  # the browser's own notes about what was refused


@pytest.mark.parametrize("size", [PHONES[0], *(pytest.param(size, marks=LONG) for size in ((1280, 800), PHONES[1]))])
def test_the_choice_and_stop_for_all_are_in_reach_and_can_be_read(fleet_page, size):
    fleet_page.be_a_phone(*size)
    try:
        hold_still(fleet_page)
        assert_readable(fleet_page, "several robots")
        in_sight = {entry[0]: entry[1:] for entry in fleet_page.run(IN_SIGHT)}
        for name in ("robot", "stop-all", "stop", "stick", "theme", "zoom-in"):
            left, top, right, bottom, met = in_sight[name]
            assert 0 <= left < right <= size[0] and 0 <= top < bottom <= size[1], name
            assert met and right - left >= 24 and bottom - top >= 24, name
        spoken = [fleet_page.spoken_name(element) for element in fleet_page.elements("#robot, #stop-all, #stop")]
        assert spoken[0].startswith("robot that is shown") and spoken[1:] == ["STOP all", "STOP"]
    finally:
        fleet_page.be_a_window()
