"""The panel of recordings and saved maps in headless Chromium: by mouse, by keys and by finger."""
import pathlib

import pytest

import browser
from at_hand import LONG
from console_page import STATE, cells, chromium, cockpit, page, pixels, show_only  # noqa: F401 (fixtures)
from recorded import FLIGHT, RECORDED, write_flight, write_recording
from waiting import Pulse, wait_until
from watching import Console, alice, commands, console, lcm_url, pulse, robot  # noqa: F401 (fixtures)

pytestmark = pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")

RECORDING = "document.getElementById('record').ariaPressed === 'true'"
ROWS = "document.querySelectorAll('#shelf li').length"
NOTE = "document.getElementById('recordings-note').textContent"


@pytest.mark.parametrize("press", ["click", pytest.param("tap", marks=LONG), pytest.param("keys", marks=LONG)])
def test_a_recording_is_made_by_mouse_finger_and_keys(cockpit, press, tmp_path):
    def act():
        if press == "keys":
            cockpit.run("document.getElementById('record').focus()")
            cockpit.press("Enter")
        else:
            getattr(cockpit, press)("record")
    cockpit.wait_for(f"{ROWS} === 3")  # the map of now, a recording, a saved map
    act()
    cockpit.wait_for(f"{RECORDING} && {NOTE}.startsWith('recording 20')")
    assert cockpit.text("record") == "stop recording"
    cockpit.wait_for(r"/^\d+:(0[1-9]|[1-5])/.test(document.getElementById('recorder-text').textContent)")
    act()
    cockpit.wait_for(f"!({RECORDING}) && {ROWS} === 4 && {NOTE}.endsWith('messages recorded')")
    newest, = [path.stem for path in (tmp_path / "recordings").iterdir() if path.stem != RECORDED]
    row = cockpit.run("return document.querySelectorAll('#shelf li')[1].textContent")
    assert "12 walls" in row and newest[:10] in row
    drawn = "const box = document.querySelectorAll('#shelf li')[1].querySelector('path').getBoundingClientRect(); return [box.width, box.height]"
    assert min(cockpit.run(drawn)) > 20, "the map is drawn"


def test_links_lead_to_the_files_and_a_press_brings_them(cockpit, tmp_path):
    cockpit.wait_for(f"{ROWS} === 3 && document.getElementById('live-map').href")
    cockpit.devtools("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path / "got"))
    cockpit.click(f"log-{RECORDED}.lcm")
    cockpit.run("const kind = document.getElementById('map-ending'); kind.value = 'zip'; kind.dispatchEvent(new Event('change'))")
    cockpit.click("map-maps-flat")
    cockpit.run("document.getElementById('live-map').focus()")
    cockpit.press("Enter")
    wanted = {f"{RECORDED}.lcm", "flat.zip", "map.zip"}
    wait_until(lambda: {path.name for path in pathlib.Path(tmp_path / "got").glob("*")} == wanted, 60, "the files")
    assert (tmp_path / f"got/{RECORDED}.lcm").read_bytes() == (tmp_path / f"recordings/{RECORDED}.lcm").read_bytes()


def test_why_nothing_can_be_recorded_is_said_on_the_page(page, pulse):
    page.wait_for(f"{NOTE}.includes('--recordings DIR')")
    assert page.run("return document.getElementById('record').disabled")
    assert page.run("return document.querySelectorAll('#shelf li').length") == 1
    page.wait_for("document.getElementById('live-map').href.includes('/live/map.png?token=')")


def test_what_the_disk_says_is_said_on_the_page(chromium, lcm_url, tmp_path, robot):
    folder = tmp_path / "rec"
    folder.mkdir()
    running = Console(lcm_url, "127.0.0.1:0", "--recordings", folder)
    try:
        chromium.open(running.url)
        chromium.wait_for(f"{NOTE} === 'nothing recorded yet'")
        folder.rmdir()
        folder.write_text("")
        chromium.click("record")
        chromium.wait_for(f"{NOTE}.endsWith('rec: Not a directory.')")
        assert chromium.run("return document.getElementById('recordings-note').className") == "bad"
        assert not chromium.run(f"return {RECORDING}")
    finally:
        assert running.end() == 0
    chromium.open("about:blank")
    chromium.errors()


def test_a_long_list_is_folded(alice, chromium, pulse, tmp_path):
    for day in range(3, 9):
        write_recording(tmp_path / f"recordings/2026-01-0{day}-000000.lcm", scans=1)
    chromium.open(alice.url)
    chromium.wait_for(f"{ROWS} === 4 && document.getElementById('shelf-more').textContent === '5 more'")
    chromium.click("shelf-more")
    chromium.wait_for(f"{ROWS} === 9 && document.getElementById('shelf-more').ariaExpanded === 'true'")
    chromium.click("shelf-more")
    chromium.wait_for(f"{ROWS} === 4")


def test_a_map_that_the_robot_saves_comes_into_the_list(cockpit, robot, tmp_path):
    cockpit.wait_for(f"{ROWS} === 3")
    (tmp_path / "maps/hall.map").write_bytes((tmp_path / "maps/flat.map").read_bytes())
    robot.answer = ("alice", 1, "saved hall: 12 walls, 0 corners")
    cockpit.wait_for(f"{ROWS} === 4 && document.getElementById('map-maps-hall') !== null")


def test_a_flight_that_the_robot_writes_comes_into_the_list(cockpit, robot, tmp_path):
    cockpit.wait_for(f"{ROWS} === 3")
    write_flight(tmp_path / f"recordings/{FLIGHT}.scip", scans=3)
    robot.flights += 1
    cockpit.wait_for(f"{ROWS} === 4 && document.getElementById('open-{FLIGHT}.scip') !== null")


def test_a_recording_is_opened_scrubbed_played_and_left(cockpit, commands):
    """By mouse and keys; marked as what it is, and nothing but STOP is sent meanwhile."""
    cockpit.wait_for(f"{ROWS} === 3")
    cockpit.click(f"open-{RECORDED}.lcm")
    cockpit.wait_for("document.body.dataset.time === 'recording' && document.getElementById('scan').textContent === '0'")
    assert cockpit.text("past-word") == "recording" and cockpit.text("past-text").endswith("0:00 of 0:03")
    assert cockpit.run(f"return document.getElementById('open-{RECORDED}.lcm').ariaPressed") == "true"
    cockpit.wait_for("document.getElementById('map-lines').textContent === '12' && document.body.dataset.control === 'off'")
    assert "a recording" in cockpit.text("control-note")
    cockpit.run("const when = document.getElementById('when'); when.value = Number(when.min) + 1500; when.dispatchEvent(new Event('input'))")
    cockpit.wait_for("document.getElementById('scan').textContent === '15'")
    cockpit.press("p")
    cockpit.wait_for("document.getElementById('scan').textContent === '29' && document.getElementById('play').ariaPressed === 'false'")
    assert cockpit.run("return document.body.dataset.time") == "recording", "its end is not now"
    assert pixels(cockpit, "robot")["count"] > 100
    cockpit.click("stop")
    assert [c.verb for c in commands(1)] == ["stop"]
    cockpit.press("n")
    cockpit.wait_for("document.body.dataset.time === 'now' && document.body.dataset.control === 'yes'")
    assert cockpit.run(f"return document.getElementById('open-{RECORDED}.lcm').ariaPressed") == "false"


def test_a_recording_is_looked_at_without_a_robot(alice, chromium):
    chromium.open(alice.url)
    chromium.wait_for(f"{ROWS} === 3 && document.body.dataset.link === 'waiting'")
    chromium.click(f"open-{RECORDED}.lcm")
    chromium.wait_for(f"document.body.dataset.link === 'recording' && {STATE} === 'good'")
    assert not chromium.run("return document.getElementById('when').disabled")
    show_only(chromium, "occupancy")
    chromium.click("play")
    chromium.wait_for("document.getElementById('scan').textContent === '29'")
    assert cells(chromium)[1] > 3000
    for name, value in (("lines seen", "5 "), ("wheels: speed", "nothing")):
        chromium.run("const choice = document.getElementById('signal-1'); choice.value = arguments[0]; choice.dispatchEvent(new Event('change'))", name)
        chromium.wait_for(f"document.querySelector('#plots output').textContent.startsWith('{value}')")
    chromium.click("live")
    chromium.wait_for("document.body.dataset.link === 'waiting' && document.body.dataset.time === 'now'")


def look_at(page, begin_ms):
    """So long after the beginning of what is kept."""
    page.run("const when = document.getElementById('when'); when.value = Number(when.min) + arguments[0]; when.dispatchEvent(new Event('input'))", begin_ms)


def test_cells_are_those_of_what_is_shown(cockpit, pulse):
    """Live, in the past, in a recording, back in it, and live again."""
    show_only(cockpit, "occupancy")
    cockpit.wait_for("Number(document.getElementById('scan').textContent) > 25")
    free, live = cells(cockpit)
    assert free > 10000 and live > 3000
    look_at(cockpit, 0)
    cockpit.wait_for("document.body.dataset.time === 'past' && document.getElementById('scan').textContent === '0'")
    past_free, past = cells(cockpit)
    assert 100 < past < 0.6 * live and 100 < past_free < 0.8 * free, "those of one scan"
    cockpit.press("n")
    cockpit.wait_for("document.body.dataset.time === 'now'")
    assert cells(cockpit)[1] > 0.8 * live
    cockpit.click(f"open-{RECORDED}.lcm")
    cockpit.wait_for("document.body.dataset.time === 'recording' && document.getElementById('scan').textContent === '0'")
    assert cells(cockpit) == pytest.approx([past_free, past], rel=0.1), "the same scan in the recording"
    cockpit.press("p")
    cockpit.wait_for("document.getElementById('scan').textContent === '29' && document.getElementById('play').ariaPressed === 'false'")
    assert cells(cockpit)[1] > 1.5 * past
    look_at(cockpit, 0)
    cockpit.wait_for("document.getElementById('scan').textContent === '0'")
    assert cells(cockpit) == pytest.approx([past_free, past], rel=0.1), "what was seen after that is not known then"
    cockpit.press("n")
    cockpit.wait_for("document.body.dataset.time === 'now'")
    assert cells(cockpit)[1] > 0.8 * live
