"""The console's page for everybody and everywhere: contrast, names for screen readers, keys for everything, phones held
upright and sideways, and nothing that moves under a finger."""
import pytest

import browser
from at_hand import LONG
from console_page import LINK, STATE, chromium, cockpit, let_the_camera_glide, middle, page, pixels  # noqa: F401 (fixtures)
from recorded import RECORDED
from waiting import Pulse, wait_until
from watching import alice, commands, console, lcm_url, pulse, robot  # noqa: F401 (fixtures)

pytestmark = pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")

PHONES = [(390, 844), (844, 390)]
# Of each law one case is in `make test`, the others in `make test-all`.
THEMES = ["dark", pytest.param("light", marks=LONG)]
LEAST_CONTRAST = 4.5  # WCAG 2.1, 1.4.3

CONTRASTS = """
const parse = (text) => {
  const [r, g, b, a = 1] = text.match(/[\\d.]+/g).map(Number);
  return text.startsWith("color(") ? [r * 255, g * 255, b * 255, a] : [r, g, b, a];
};
const over = (top, bottom) => [0, 1, 2].map((k) => top[k] * top[3] + bottom[k] * (1 - top[3])).concat(1);
const ground = parse(getComputedStyle(document.body).backgroundColor);
const behind = (element, under) => element && !element.matches("main") ? over(parse(getComputedStyle(element).backgroundColor), behind(element.parentElement, under)) : under;
// What may lie under a text: the page's ground, and over the map any colour that is drawn there.
const hex = (name) => [1, 3, 5].map((k) => parseInt(getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim().slice(k, k + 2), 16)).concat(1);
const drawn = ["wall", "line", "corner", "scan", "trail", "robot", "path", "apart", "keyframe", "loop"].map(hex);
const grounds = (element) => element.closest("main") ? [ground, ...drawn] : [ground];
const opacity = (element) => element ? Number(getComputedStyle(element).opacity) * opacity(element.parentElement) : 1;
const luminance = (colour) => [0.2126, 0.7152, 0.0722].reduce((sum, weight, k) => {
  const c = colour[k] / 255;
  return sum + weight * (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
}, 0);
const written = (element) => element.matches("input:not([type=range]), select") ||
  [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
return [...document.body.querySelectorAll("*")].filter((e) => !e.closest("svg") && e.checkVisibility() && written(e)).map((element) => {
  const contrasts = grounds(element).map((under) => {
    const back = behind(element, under);
    const own = parse(getComputedStyle(element).color);
    own[3] *= opacity(element);
    const [light, dark] = [luminance(over(own, back)), luminance(back)].sort((a, b) => b - a);
    return (light + 0.05) / (dark + 0.05);
  });
  return [Math.min(...contrasts), element.id || element.className || element.tagName, element.textContent.trim().slice(0, 30)];
});
"""
CONTROLS = "button:not([hidden]), input, select, a[href], [tabindex]"
# Each control in sight and what a finger on its middle meets; [name, left, top, right, bottom, met].
IN_SIGHT = f"""
return [...document.querySelectorAll("{CONTROLS}")].filter((e) => e.checkVisibility() && e.id !== "map").map((e) => {{
  const panel = e.closest("aside");
  if (panel) e.scrollIntoView({{block: "nearest"}});
  const r = e.getBoundingClientRect();
  const met = document.elementFromPoint(r.x + r.width / 2, r.y + r.height / 2);
  return [e.id || e.dataset.layer, r.left, r.top, r.right, r.bottom, met === e || e.contains(met)];
}});
"""
PLACES = f"""
document.querySelector("aside").scrollTop = 0;
return Object.fromEntries([...document.querySelectorAll("{CONTROLS}")].filter((e) => e.checkVisibility()).map((e) => {{
  const r = e.getBoundingClientRect();
  return [e.id || e.dataset.layer, [r.x, r.y, r.width, r.height].map(Math.round)];
}}));
"""
DISABLED = "return [...document.querySelectorAll('#control button, #stop, #record')].filter((e) => e.disabled).map((e) => e.id)"
ENABLED = "return [...document.querySelectorAll('#control button, #stop, #record')].filter((e) => !e.disabled).map((e) => e.id)"
LISTED = "document.querySelectorAll('#shelf a[href]').length === 4"  # the map of now, recording and map, a saved map
LINKS = "return [...document.querySelectorAll('#shelf a')].filter((e) => e.href).length"


def hold_still(page):
    """Colours are looked at when they have changed, not on their way."""
    page.run("const sheet = new CSSStyleSheet(); sheet.replaceSync('* { transition: none !important; animation: none !important }');"
             "document.adoptedStyleSheets.push(sheet)")


def assert_readable(page, when):
    measured = page.run(CONTRASTS)
    assert len(measured) > 60, "the texts of the page are looked at"
    poor = [(round(contrast, 2), name, text) for contrast, name, text in measured if contrast < LEAST_CONTRAST]
    assert poor == [], when


@pytest.mark.parametrize("theme", THEMES)
def test_every_text_can_be_read_in_every_state(cockpit, robot, theme):
    cockpit.run("localStorage.clear()")
    if cockpit.run("return document.documentElement.dataset.theme") != theme:
        cockpit.click("theme")
    hold_still(cockpit)
    cockpit.drag(600, 300, 600, 300)
    assert cockpit.text("cursor").startswith("x ") and cockpit.text("scale-text").endswith("m"), "they lie over the map without a panel"
    for state, name in ((2, "good"), (1, "weak"), (0, "lost")):
        robot.state = state
        cockpit.wait_for(f"{STATE} === '{name}'")
        assert_readable(cockpit, name)
    robot.state, robot.map_id, robot.maps, robot.wheels = 2, 1, 2, "stalled"
    cockpit.wait_for("document.querySelectorAll('#advice p').length === 2")
    for pressed in ("measure", "reset", "explore"):
        cockpit.click(pressed)
    cockpit.run("document.getElementById('answer').className = 'bad'; document.getElementById('answer').textContent = 'refused'")
    assert_readable(cockpit, "with advice, a hint, an answer")
    cockpit.wait_for(LISTED)
    cockpit.click("record")
    cockpit.wait_for("document.getElementById('recorder-text').textContent !== ''")
    assert_readable(cockpit, "while it records")
    cockpit.run("document.getElementById('recordings-note').className = 'bad'")
    assert_readable(cockpit, "with what the disk says")
    cockpit.click(f"open-{RECORDED}.lcm")
    cockpit.wait_for("document.body.dataset.time === 'recording'")
    assert_readable(cockpit, "in a recording")


@pytest.mark.parametrize("theme", THEMES)
def test_every_text_can_be_read_without_a_robot_and_without_a_link(page, console, theme):
    if page.run("return document.documentElement.dataset.theme") != theme:
        page.click("theme")
    hold_still(page)
    page.wait_for(f"{LINK} === 'waiting'")
    assert_readable(page, "waiting")
    console.end()
    page.wait_for(f"{LINK} === 'gone'")
    assert_readable(page, "gone")
    page.open("about:blank")
    page.errors()  # the browser's own notes about the connection that is refused


def test_every_control_has_a_name_that_a_screen_reader_says(cockpit):
    cockpit.be_a_phone(*PHONES[0])  # where every button is there to be seen
    try:
        cockpit.tap("layers")
        names = {element: cockpit.spoken_name(element) for element in cockpit.elements(f"{CONTROLS}, canvas, table")}
        buttons = [names[element] for element in cockpit.elements("button:not([hidden])")]
    finally:
        cockpit.be_a_window()
    assert len(names) > 40 and [name for name in names.values() if len(name) < 3] == []
    assert len(buttons) == len(set(buttons)), "no two buttons of one name"


def test_without_a_link_nothing_can_be_pressed(alice, chromium, robot):
    pulse = Pulse(0.1, robot.step)
    try:
        chromium.open(alice.url)
        chromium.wait_for("document.body.dataset.control === 'yes' && document.querySelectorAll('#shelf li').length === 3")
        assert chromium.run(DISABLED) == []
        assert chromium.run(LINKS) == 4
    finally:
        pulse.stop()
    chromium.wait_for(f"{LINK} === 'lost' && document.body.dataset.control === 'off'")
    assert chromium.run(ENABLED) == ["stop", "record"], "it may still be heard"
    assert "STOP" in chromium.text("control-note")
    alice.process.send_signal(15)
    chromium.wait_for(f"{LINK} === 'gone' && document.getElementById('stop').disabled")
    assert chromium.run(ENABLED) == [] and chromium.run(LINKS) == 0
    assert chromium.run("return document.getElementById('stick').ariaDisabled") == "true"
    chromium.open("about:blank")
    chromium.errors()


def test_before_a_robot_is_heard_nothing_can_be_pressed(alice, chromium):
    chromium.open(alice.url)
    chromium.wait_for("document.getElementById('control-note').textContent === 'no robot heard yet'")
    chromium.wait_for("!document.getElementById('record').disabled")
    assert chromium.run(ENABLED) == ["record"], "the console itself is there"


@pytest.fixture(params=[pytest.param(PHONES[0], id="upright"), pytest.param(PHONES[1], id="sideways", marks=LONG)])
def phone(request, chromium):
    chromium.be_a_phone(*request.param)
    yield request.param
    chromium.be_a_window()


def test_on_a_phone_each_control_is_in_reach_and_none_covers_another(phone, cockpit):
    width, height = phone
    assert cockpit.run("return [innerWidth, innerHeight]") == [width, height]
    cockpit.wait_for(f"{STATE} === 'good' && {LISTED}")
    assert cockpit.run("return document.documentElement.scrollWidth - innerWidth") <= 0
    assert cockpit.run("return document.documentElement.scrollHeight - innerHeight") <= 0
    in_sight = cockpit.run(IN_SIGHT)
    assert {"stop", "stick", "explore", "zoom-in", "layers", "theme", "set", "record", f"open-{RECORDED}.lcm", "live-map", "map-maps-flat"} <= {entry[0] for entry in in_sight}
    for name, left, top, right, bottom, met in in_sight:
        assert 0 <= left < right <= width + 0.5 and 0 <= top < bottom <= height + 0.5, name
        assert met, f"something lies over {name}"
        assert right - left >= 24 and bottom - top >= 24, f"{name} is too small for a finger"  # WCAG 2.2, 2.5.8
    area = cockpit.run("const r = document.getElementById('map').getBoundingClientRect(); return [r.width, r.height]")
    assert min(area) > 250


def test_on_a_phone_the_layers_open_at_a_button(phone, cockpit):
    cockpit.wait_for(f"{STATE} === 'good'")
    assert not cockpit.run("return document.getElementById('legend').checkVisibility()")
    cockpit.tap("layers")
    cockpit.wait_for("document.getElementById('legend').checkVisibility()")
    cockpit.tap("apart")
    assert cockpit.run("return document.getElementById('apart').ariaPressed") == "false"
    cockpit.tap("apart")
    cockpit.tap("graph")
    assert cockpit.run("return document.getElementById('graph').ariaPressed") == "true"
    cockpit.press("Escape")
    cockpit.wait_for("!document.getElementById('legend').checkVisibility()")


def test_a_finger_presses_and_holds(phone, cockpit, commands):
    cockpit.tap("freeze")
    assert [c.verb for c in commands(1)] == ["set"]


@pytest.mark.parametrize("size", [PHONES[0], *(pytest.param(size, marks=LONG) for size in ((1280, 800), PHONES[1]))])
def test_nothing_moves_under_a_finger(cockpit, robot, size):
    cockpit.be_a_phone(*size)
    try:
        cockpit.wait_for(f"{STATE} === 'good' && {LINK} === 'up' && {LISTED}")
        before = cockpit.run(PLACES)
        robot.state, robot.driver, robot.wheels = 0, "asking who is there: hardware fault of the sensor: status 50", "stalled"
        robot.who_drives, robot.exploration = "somebody with quite a long name", "looks for its place: the pose is lost, and so on"
        robot.map_id, robot.maps = 1, 3
        robot.publish_pieces(range(5))
        cockpit.wait_for("document.getElementById('exploration').textContent.startsWith('looks') && !document.getElementById('alarm').hidden"
                         " && document.querySelectorAll('#advice p').length === 3")
        cockpit.run("document.getElementById('answer').textContent = 'a long answer that says more than fits into one line of it, and more'")
        assert cockpit.run(PLACES) == before
        cockpit.click("reset")
        assert cockpit.text("reset") == "sure?"
        assert cockpit.run(PLACES) == before
        cockpit.click("record")
        cockpit.wait_for("document.getElementById('record').ariaPressed === 'true'")
        assert cockpit.run(PLACES) == before
        cockpit.click("measure")
        assert cockpit.run(PLACES) == before
        cockpit.click("measure")
    finally:
        cockpit.be_a_window()


def test_when_the_link_is_lost_everything_stays_in_its_place(alice, chromium, robot):
    pulse = Pulse(0.1, robot.step)
    try:
        chromium.open(alice.url)
        chromium.wait_for("document.body.dataset.control === 'yes'")
        before = chromium.run(PLACES)
    finally:
        pulse.stop()
    chromium.wait_for("document.body.dataset.control === 'off'")
    assert chromium.run(PLACES) == before


def test_every_control_is_reached_by_the_tabulator(cockpit):
    """Round and round: on a busy machine a link is lost for a moment, and what cannot be pressed then is passed by."""
    cockpit.run("document.activeElement.blur()")
    cockpit.wait_for(LISTED)
    missing = set(cockpit.run(f"return [...document.querySelectorAll('{CONTROLS}')].filter((e) => e.checkVisibility()).map((e) => e.id || e.dataset.layer)"))

    def tab():
        cockpit.press("Tab")
        missing.discard(cockpit.run("const e = document.activeElement; return e.id || e.dataset.layer"))
        return not missing
    wait_until(tab, 180, missing)


def test_the_stick_drives_by_arrow_keys_while_it_has_the_focus(cockpit, commands):
    where = cockpit.run("return document.getElementById('scale-text').textContent")
    cockpit.run("document.getElementById('stick').focus()")
    cockpit.hold("\ue013", 0.5)
    heard = commands(lambda heard: heard and heard[-1].args == ["0.000", "0.000"])
    assert ["0.300", "0.000"] in [c.args for c in heard]
    assert cockpit.run("return document.getElementById('whole').ariaPressed") == "true", "the map is not moved by them"
    assert where == cockpit.run("return document.getElementById('scale-text').textContent")


def test_a_place_and_a_heading_are_pointed_at_by_keys(cockpit, commands):
    cockpit.wait_for("document.getElementById('map-lines').textContent === '12'")
    cockpit.run("document.getElementById('relocate').focus()")
    cockpit.press("Enter", "ArrowLeft", "ArrowLeft", "Enter", "ArrowUp", "Enter")
    one, = commands(1)
    assert one.verb == "relocate" and float(one.args[2]) == pytest.approx(1.5708, abs=0.01)


def test_measuring_by_keys_and_the_place_under_the_cursor(page, pulse):
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    let_the_camera_glide(page)
    page.press("m", *["ArrowLeft"] * 4, "Enter")
    begin = page.text("cursor")
    page.press(*["ArrowRight"] * 8, "Enter")
    end = page.text("cursor")
    x = [float(text.split()[1]) for text in (begin, end)]
    measured = float(page.run("return document.getElementById('map').dataset.measured"))
    assert measured == pytest.approx(x[1] - x[0], abs=0.02) and measured > 0.5
    assert page.run("return document.getElementById('whole').ariaPressed") == "true"


def test_the_cursor_tells_its_place_in_the_map(page, pulse):
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    let_the_camera_glide(page)
    places = []
    for x in (400, 500):
        page.drag(x, 300, x, 300)
        places.append([float(word) for word in page.text("cursor").replace("x", "").replace("y", "").replace("m", "").split()])
    scale = page.run("return document.getElementById('scale-bar').offsetWidth") / float(page.text("scale-text").split()[0])
    assert places[1][0] - places[0][0] == pytest.approx(100 / scale, abs=0.03)
    assert places[0][1] == places[1][1]


@pytest.mark.parametrize("layer, colour, tolerance", [("map", "wall", 25), *(pytest.param(*case, marks=LONG) for case in (
    ("lines", "line", 25), ("corners", "corner", 25), ("scan", "scan", 25), ("trail", "trail", 40)))])
def test_a_layer_is_switched_off_and_on_and_stays_so(page, robot, layer, colour, tolerance):
    robot.drive(30)
    page.wait_for("document.getElementById('scan').textContent === '29' && document.getElementById('lines').textContent === '5'")
    let_the_camera_glide(page)

    def drawn():
        page.run("return new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
        return pixels(page, colour, tolerance)["count"]
    page.run("document.querySelectorAll('[data-layer][aria-pressed=true]').forEach((entry) => entry.dataset.layer === arguments[0] || entry.click())",
             layer)  # what lies over it
    press = f"document.querySelector('[data-layer={layer}]').click()"
    before = drawn()
    assert before > 20, "there is something of it"
    page.run(press)
    off = drawn()
    assert off < before / 2, layer
    page.reload()
    page.wait_for("document.getElementById('scan').textContent === '29'")
    assert page.run(f"return document.querySelector('[data-layer={layer}]').ariaPressed") == "false"
    page.run(press)
    let_the_camera_glide(page)
    assert drawn() > before / 2
