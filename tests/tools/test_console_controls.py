"""Every control of the console's page, by mouse, by finger and by keys, each with what it does. Which controls there are is asked of the page
itself: one that has no entry here fails."""
import functools
import re

import pytest

import browser
from at_hand import LONG
from console_page import STATE, chromium, let_the_camera_glide, number  # noqa: F401 (fixtures)
from recorded import FLIGHT, RECORDED, write_flight, write_recording
from rovers import rovers  # noqa: F401 (fixture)
from waiting import Pulse, wait_until
from watching import alice, commands, lcm_url, pulse, robot  # noqa: F401 (fixtures)

pytestmark = pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")

WAYS = ["mouse", pytest.param("finger", marks=LONG), pytest.param("keys", marks=LONG)]
SIZES = {"finger": (390, 844), "keys": (844, 390)}  # a phone held upright and sideways; else a screen on a desk
OLDER = "2026-01-01-000000"  # a recording that is not among the first of the list
# Whatever may be pressed, moved, written into or chosen, also while it is hidden.
NAMES = """
return [...document.querySelectorAll("button, input, select, textarea, a, summary, [tabindex], [contenteditable], [onclick]")]
  .map((e) => (e.dataset.layer && `layer ${e.dataset.layer}`) || e.id || e.outerHTML);
"""
FIND = "const e = document.querySelector(`[data-layer='${arguments[0].split('layer ')[1]}']`) ?? document.getElementById(arguments[0]);"
TIME = "document.body.dataset.time"
RESTS_MS = 100  # before it is lifted: else a flick, after which the browser may make no click of the next tap
MOST_FAILED = 3  # then the page is in no state for the rest, each of which would be waited for


class Hand:
    """A person with a mouse, with fingers, or with keys alone."""

    def __init__(self, page, way, commands, got):
        self.page, self.way, self.heard, self.got = page, way, commands, got

    def of(self, name, what):
        return self.page.run(f"{FIND} return {what}", name)

    def wait(self, name, what):
        self.page.wait_for(f"(() => {{ {FIND} return {what} }})()", 25, name)

    def attribute(self, name, attribute):
        return self.of(name, f"e.getAttribute('{attribute}')")

    def focus(self, name):
        """As the tabulator does, which test_console_access.py looks at."""
        assert self.of(name, "(e.focus(), document.activeElement === e)"), f"{name} takes no keys"

    def box(self, name):
        return self.of(name, "(e.scrollIntoView({block: 'nearest'}), (({x, y, width, height}) => [x, y, width, height])(e.getBoundingClientRect()))")

    def at(self, name, right=0.5, down=0.5):
        x, y, width, height = self.box(name)
        place = round(x + right * width), round(y + down * height)
        self.page.wait_for(f"(() => {{ {FIND} const met = document.elementFromPoint(...arguments[1]); return met === e || e.contains(met); }})()", 25, name, place)
        return place

    def point(self, x, y, to=None):
        """A press there, or from there to another place."""
        to = to or (x, y)
        if self.way == "finger":
            self.page.fingers([(x, y), to], held_ms=RESTS_MS)
        else:
            self.page.drag(x, y, *to)

    def press(self, name):
        self.wait(name, "!e.disabled")  # a busy machine loses the link for moments
        if self.way == "keys":
            self.focus(name)
            self.page.press("Enter")
        else:
            self.point(*self.at(name))

    def write(self, name, text):
        if self.way == "keys":
            self.focus(name)
        else:
            self.point(*self.at(name))
            assert self.of(name, "document.activeElement === e")
        self.page.press("End", *["Backspace"] * 12, *text)

    def slide(self, name, begin):
        """To one of its ends, from the middle."""
        if self.way == "keys":
            self.focus(name)
            self.page.press("Home" if begin else "End")
        else:
            self.point(*self.at(name), self.at(name, 0.02 if begin else 0.98))

    def choose(self, name, value):
        options = self.of(name, "[...e.options].map((option) => option.value)")
        if self.way == "keys":
            self.focus(name)
            way = options.index(value) - options.index(self.of(name, "e.value"))
            self.page.press(*["ArrowDown" if way > 0 else "ArrowUp"] * abs(way))
        else:
            self.point(*self.at(name))  # opens the list, which is none of the page's
            assert self.of(name, "document.activeElement === e")
            self.page.press("Escape")
            self.page.select(self.page.elements(f"#{name} option")[options.index(value)])

    def point_at_map(self, right, down, to=None):
        """A place of the map, in parts of its width and height; to: and a heading."""
        if self.way == "keys":
            self.page.press("ArrowLeft", "Enter", *(["ArrowUp", "Enter"] if to else []))
        else:
            self.point(*self.at("map", right, down), to and self.at("map", *to))

    def sent(self):
        """Commands on the bus so far."""
        return [" ".join([command.verb, *command.args]) for command in self.heard(lambda _: False, 0.05)]

    def commands(self, *wanted):
        """What is done now sends these, whatever else is sent."""
        return Sending(self, wanted)

    def scale(self):
        return self.page.run("return document.getElementById('scale-bar').offsetWidth") / number(self.page.text("scale-text"))


class Sending:
    def __init__(self, hand, wanted):
        self.hand, self.wanted = hand, wanted

    def __enter__(self):
        self.before = len(self.hand.sent())

    def __exit__(self, failed, *_):
        if not failed:
            wait_until(self.all_sent, 25, f"{self.wanted} among {self.hand.sent()[self.before:]}")

    def all_sent(self):
        """In their order."""
        left = list(self.wanted)
        for command in self.hand.sent()[self.before:]:
            if left and re.fullmatch(left[0], command):
                left.pop(0)
        return not left


def toggles(hand, name, attribute="aria-pressed"):
    """And back again."""
    before = hand.attribute(name, attribute)
    for wanted in (("true" if before == "false" else "false"), before):
        hand.press(name)
        hand.wait(name, f"e.getAttribute('{attribute}') === '{wanted}'")


def sends(*words, sure=False):
    def act(hand, name):
        with hand.commands(*words):
            hand.press(name)
            if sure:
                hand.wait(name, "e.textContent === 'sure?'")
                hand.press(name)
    return act


def zooms(factor):
    def act(hand, name):
        let_the_camera_glide(hand.page)
        before = hand.scale()
        hand.press(name)
        wait_until(lambda: (hand.scale() / before - 1) * (factor - 1) > 0.01, 25, name)
    return act


def whole(hand, name):
    hand.page.run("document.getElementById('zoom-in').click()")
    hand.wait(name, "e.ariaPressed === 'false'")
    hand.press(name)
    hand.wait(name, "e.ariaPressed === 'true'")


def changes_theme(hand, name):
    before = hand.page.run("return document.documentElement.dataset.theme")
    hand.press(name)
    hand.page.wait_for(f"document.documentElement.dataset.theme !== '{before}'")
    hand.press(name)


def measures(hand, name):
    hand.press(name)
    hand.wait(name, "e.ariaPressed === 'true'")
    if hand.way == "keys":
        hand.page.press("Enter", *["ArrowLeft"] * 5, "Enter")
    else:
        hand.point_at_map(0.4, 0.4, (0.6, 0.5))
    hand.page.wait_for("Number(document.getElementById('map').dataset.measured) > 0.2")
    hand.page.press("Escape") if hand.way == "keys" else hand.press(name)
    hand.wait(name, "e.ariaPressed === 'false'")


def moves_the_map(hand, name):
    """Dragged, and zoomed into: by wheel, by two fingers, by keys."""
    hand.page.press("Escape")  # the legend of a phone
    hand.page.run("document.getElementById('whole').click()")
    let_the_camera_glide(hand.page)
    before = hand.scale()

    def pans():
        if hand.way == "keys":
            hand.focus(name)
            hand.page.press("ArrowLeft")
        else:
            hand.point(*hand.at(name, 0.5, 0.45), hand.at(name, 0.6, 0.5))
        return hand.of("whole", "e.ariaPressed === 'false'")
    wait_until(pans, 25, "a map that was moved")
    assert hand.scale() == pytest.approx(before, rel=0.1)
    if hand.way == "mouse":
        hand.page.turn_wheel(*hand.at(name), -300)
    elif hand.way == "keys":
        hand.page.press("+", "+")
    else:
        x, y = hand.at(name)
        hand.page.fingers([(x - 30, y), (x - 60, y - 20), (x - 90, y - 40)], [(x + 30, y), (x + 60, y + 20), (x + 90, y + 40)])
    wait_until(lambda: hand.scale() > 1.3 * before, 25, "a map that is nearer")
    hand.page.run("document.getElementById('whole').click()")


def drives(hand, name):
    """While it is held, and no longer."""
    with hand.commands(r"drive 0\.[1-9]\d* .*", r"drive 0\.000 0\.000"):
        if hand.way == "keys":
            hand.focus(name)
            hand.page.hold("\ue013", 0.5)
        elif hand.way == "mouse":
            hand.page.drag(*hand.at(name), *hand.at(name, 0.5, 0.1), held_ms=500)
        else:
            hand.page.fingers([hand.at(name), hand.at(name, 0.5, 0.1)], held_ms=500)


def stops(hand, name):
    """The space bar, too, wherever the focus is."""
    sends("stop")(hand, name)
    with hand.commands("stop"):
        hand.page.press(" ")


def sends_a_goal(hand, name):
    with hand.commands(r"goto -?\d+\.\d+ -?\d+\.\d+"):
        hand.press(name)
        hand.wait(name, "e.ariaPressed === 'true'")
        hand.point_at_map(0.45, 0.4)
    hand.wait(name, "e.ariaPressed === 'false'")


def tells_where_it_is(hand, name):
    with hand.commands(r"relocate -?\d+\.\d+ -?\d+\.\d+ 1\.57.*"):
        hand.press(name)
        hand.page.wait_for("!document.getElementById('hint').hidden")
        hand.point_at_map(0.45, 0.5, (0.45, 0.35))


def names_a_map(hand, name):
    hand.write(name, "hall")
    with hand.commands("save_map hall"):
        hand.press("save-map")


def limits(verb):
    """A slider: how fast the stick drives at most."""
    def act(hand, name):
        hand.slide(name, begin=True)
        hand.wait(name, "e.value === e.min")
        if verb:
            with hand.commands(verb):
                hand.focus("stick")
                hand.page.hold("\ue013", 0.3)
        hand.slide(name, begin=False)
        hand.wait(name, "e.value === e.max")
    return act


def sets_a_parameter(hand, name):
    hand.choose("parameter", "drive_turn")
    hand.write("value", "0.7")
    with hand.commands(r"set drive_turn 0\.7"):
        hand.press(name)


def looks_back(hand, name):
    hand.slide(name, begin=True)
    hand.page.wait_for(f"{TIME} === 'past'")
    back_to_now(hand, "live")


def plays(hand, name):
    hand.press(name)
    hand.page.wait_for(f"{TIME} === 'past' && document.getElementById('play').ariaPressed === 'true'")
    hand.press(name)
    hand.wait(name, "e.ariaPressed === 'false'")
    hand.press("live")
    hand.page.wait_for(f"{TIME} === 'now'")


def back_to_now(hand, name):
    if hand.page.run(f"return {TIME}") == "now":
        hand.slide("when", begin=True)
        hand.page.wait_for(f"{TIME} === 'past'")
    hand.press(name)
    hand.page.wait_for(f"{TIME} === 'now' && document.body.dataset.control === 'yes'")


def shows_a_recording(hand, name):
    hand.press(name)
    hand.page.wait_for(f"{TIME} === 'recording'")
    hand.wait(name, "e.ariaPressed === 'true'")
    back_to_now(hand, "live")


def downloads(file):
    def act(hand, name):
        hand.press(name)
        wait_until(lambda: (hand.got / file).exists(), 25, file)
        (hand.got / file).unlink()
    return act


def chooses_the_kind_of_map(hand, name):
    hand.choose(name, "svg")
    hand.wait("live-map", "e.href.includes('/live/map.svg?')")
    hand.choose(name, "png")


def unfolds_the_list(hand, name):
    toggles(hand, name, "aria-expanded")
    hand.press(name)


def chooses_what_is_plotted(value, starts):
    def act(hand, name):
        hand.choose(name, value)
        hand.wait(name, f"/{starts}/.test(e.parentElement.querySelector('output').textContent)")
    return act


def chooses_the_span(hand, name):
    hand.choose(name, "600")
    hand.wait(name, "e.value === '600'")


def opens_the_legend(hand, name):
    """Of a phone; a large screen has room for it."""
    if hand.way in SIZES:
        toggles(hand, name, "aria-expanded")
        hand.press(name)


LAYERS = ("map", "apart", "lines", "corners", "scan", "trail", "occupancy", "graph", "path", "uncertainty")
# What each of them does, in the order in which they are tried. `None`: it is there with several robots alone, and tried below.
CONTROLS = {
    "theme": changes_theme, "shelf-more": unfolds_the_list, "layers": opens_the_legend,
    **{f"layer {layer}": toggles for layer in LAYERS},
    "map": moves_the_map, "zoom-in": zooms(1.4), "zoom-out": zooms(1 / 1.4), "follow": toggles, "whole": whole, "measure": measures,
    "stop": stops, "stick": drives, "explore": sends("explore on"), "goal": sends_a_goal, "relocate": tells_where_it_is,
    "freeze": sends("set freeze_map yes"), "reset": sends("reset", sure=True), "map-name": names_a_map, "save-map": sends("save_map hall"),
    "load-map": sends("load_map hall", sure=True), "speed-limit": limits(r"drive 0\.050 .*"), "turn-limit": limits(None),
    "parameter": lambda hand, name: hand.choose(name, "publish_scan"), "value": functools.partial(Hand.write, text="yes"), "set": sets_a_parameter,
    "when": looks_back, "play": plays, "live": back_to_now, "record": toggles, "map-ending": chooses_the_kind_of_map,
    f"open-{RECORDED}.lcm": shows_a_recording, f"open-{OLDER}.lcm": shows_a_recording, f"open-{FLIGHT}.scip": shows_a_recording,
    f"log-{RECORDED}.lcm": downloads(f"{RECORDED}.lcm"), f"log-{OLDER}.lcm": downloads(f"{OLDER}.lcm"), f"log-{FLIGHT}.scip": downloads(f"{FLIGHT}.scip"),
    f"map-recordings-{RECORDED}": downloads(f"{RECORDED}.png"), f"map-recordings-{OLDER}": downloads(f"{OLDER}.png"),
    f"map-flights-{FLIGHT}": downloads(f"{FLIGHT}.png"), "map-maps-flat": downloads("flat.png"), "live-map": downloads("map.png"),
    "plot-span": chooses_the_span, "signal-1": chooses_what_is_plotted("lines seen", "^5 "), "signal-2": chooses_what_is_plotted("lines seen", "^5 "),
    "robot": None, "stop-all": None,
}


@pytest.fixture
def desk(chromium, alice, robot, tmp_path):
    """The page of a console that may command a robot, with all kinds of files, and a list that is longer than what is shown of it."""
    write_recording(tmp_path / f"recordings/{OLDER}.lcm", scans=5)
    write_flight(tmp_path / f"recordings/{FLIGHT}.scip")
    beat = Pulse(0.1, robot.step)
    chromium.devtools("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path / "got"))
    chromium.open(alice.url)
    chromium.run("localStorage.clear()")
    chromium.wait_for(f"document.body.dataset.control === 'yes' && {STATE} === 'good' && Number(document.getElementById('scan').textContent) > 20")
    chromium.wait_for("document.getElementById('shelf-more').textContent === '1 more' && document.getElementById('map-lines').textContent === '12'")
    chromium.errors()
    yield chromium
    beat.stop()
    assert chromium.errors() == []


def lay_out_for(way, page):
    """What is pressed at once stands where it was seen."""
    if way in SIZES:
        page.be_a_phone(*SIZES[way])
        page.wait_for(f"innerWidth === {SIZES[way][0]}")


@pytest.mark.parametrize("flicked, from_to, button, sent", [
    ("map", ((0.4, 0.4), (0.6, 0.5)), "explore", "explore on"), ("stick", ((0.5, 0.9), (0.5, 0.1)), "explore", "explore on"),
    ("speed-limit", ((0.5, 0.5), (0.9, 0.5)), "stop", "stop")])
def test_a_button_right_after_a_flick_is_obeyed(desk, commands, tmp_path, flicked, from_to, button, sent):
    """The browser makes no click of a tap that ends a fling: map and stick leave none, and STOP waits for no click."""
    hand = Hand(desk, "finger", commands, tmp_path)
    lay_out_for("finger", desk)
    try:
        for _ in range(3):
            desk.fingers([hand.at(flicked, *place) for place in from_to])
            with hand.commands(sent):
                desk.fingers([hand.at(button)])
    finally:
        desk.be_a_window()


def all_of_the_list(page):
    page.run("document.getElementById('shelf-more').click()")
    return set(page.run(NAMES))


def test_every_control_has_an_entry(desk):
    there = all_of_the_list(desk)
    assert there == set(CONTROLS) - {"robot"}


def what_fails(act, hand, name):
    """One that fails hides no other."""
    try:
        act(hand, name)
    except (AssertionError, RuntimeError) as error:
        return error
    return None


@pytest.mark.parametrize("way", WAYS)
def test_every_control_does_what_it_is_for(desk, commands, way, tmp_path):
    hand = Hand(desk, way, commands, tmp_path / "got")
    lay_out_for(way, desk)
    failed = []
    try:
        for name, act in CONTROLS.items():
            if act and len(failed) < MOST_FAILED and (error := what_fails(act, hand, name)):
                failed.append(f"{name}: {str(error)[:300]}")
    finally:
        desk.be_a_window()
    assert not failed, "\n".join(failed)


@pytest.mark.parametrize("way", WAYS)
def test_those_of_several_robots_too(chromium, rovers, way):
    beat = Pulse(0.1, rovers.step)
    try:
        chromium.open(rovers.console.url)
        chromium.wait_for("document.body.dataset.control === 'yes'")
        hand = Hand(chromium, way, lambda *_: [command for _, command in rovers.commands], None)
        lay_out_for(way, chromium)
        assert {"robot", "stop-all"} <= set(chromium.run(NAMES))
        with hand.commands("stop", "stop"):
            hand.press("stop-all")
        assert sorted(rover for rover, _ in rovers.commands) == ["rover1", "rover2"]
        hand.choose("robot", "rover2")
        chromium.wait_for("Number(document.getElementById('scan').textContent) >= 1000")
    finally:
        chromium.be_a_window()
        beat.stop()
