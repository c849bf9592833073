"""Recordings of the scanner's bytes (flights) in ale-console: listed, replayed, shown, downloaded, and told in words where that fails; the
page in headless Chromium at the end."""
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import zipfile

import pytest

import browser
from at_hand import BINARIES, LONG
from console_page import cells, chromium, let_the_camera_glide, pixels, show_only  # noqa: F401 (fixtures)
from lcm_url import free_lcm_url
from recorded import FLIGHT, PERIOD_US, RECORDED, write_flight, write_recording
from waiting import wait_until
from watching import Console
from web_socket import WebSocket

SCANS = 40
LENGTH_MS = SCANS * PERIOD_US // 1000  # the last one comes a period after its stamp
WRITTEN_MS = 1_767_323_100_000  # as its name says
NEED_BROWSER = pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")
NOTE = "document.getElementById('recordings-note').textContent"
TIME = "document.body.dataset.time"


class Hangar:
    """A console with flights where a robot writes them, one beside the recordings, and no robot."""

    def __init__(self, place):
        self.recordings, self.flights = place / "recordings", place / "flights"
        write_recording(self.recordings / f"{RECORDED}.lcm")
        write_flight(self.flights / f"{FLIGHT}.scip", SCANS)
        shutil.copy(self.flights / f"{FLIGHT}.scip", self.recordings / "drive.scip")
        shutil.copy(self.flights / f"{FLIGHT}.scip", self.recordings / f"{FLIGHT}.scip")
        whole = (self.flights / f"{FLIGHT}.scip").read_bytes()
        (self.flights / "cut.scip").write_bytes(whole[:1000])
        middle = len(whole) // 2
        self.damaged = whole[:middle] + bytes(3000) + whole[middle + 3000:-100]  # in two places
        self.console = Console(free_lcm_url(), "127.0.0.1:0", "--recordings", self.recordings, "--flights", self.flights)


@pytest.fixture(scope="module")
def hangar(tmp_path_factory):
    one = Hangar(tmp_path_factory.mktemp("hangar"))
    yield one
    assert one.console.end() == 0


def ask(page, **message):
    page.send(json.dumps(message))
    return page.wait_for("shelf")


def opened(page, name):
    page.send(json.dumps({"type": "open", "name": name}))
    return page.wait_for("past")


def test_flights_of_both_folders_are_listed_once_with_length_time_and_reason(hangar):
    shelf = ask(WebSocket(hangar.console.url), type="shelf")
    assert [piece["name"] for piece in shelf["recordings"]["pieces"]] == [RECORDED]
    pieces = {piece["name"]: piece for piece in shelf["flights"]["pieces"]}
    assert sorted(pieces) == ["cut", "drive", FLIGHT] and len(shelf["flights"]["pieces"]) == 3
    flight = pieces[FLIGHT]
    assert (flight["reason"], flight["walls"], flight["length_ms"]) == ("fault", None, LENGTH_MS)
    assert flight["at"] == WRITTEN_MS - LENGTH_MS and pieces["drive"]["reason"] is None


def test_a_flight_is_replayed_and_looked_at_as_a_recording_is(hangar):
    page = WebSocket(hangar.console.url)
    past = opened(page, f"{FLIGHT}.scip")
    assert past["recording"] == f"{FLIGHT}.scip"
    assert past["kept"][1] - past["kept"][0] == (SCANS - 1) * PERIOD_US // 1000
    assert abs(past["kept"][1] - WRITTEN_MS) < 1000, "its clock knew no date, its name does"
    page.send(json.dumps({"type": "look", "at": past["kept"][1]}))
    assert page.wait_for("pose", lambda pose: pose["scan"] == SCANS - 1)["state"] == "good"
    assert len(page.wait_for("map")["lines"]) >= 4
    assert leftovers(hangar) == []


def test_what_of_a_recording_is_damaged_is_told(hangar):
    page = WebSocket(hangar.console.url)
    assert opened(page, f"{FLIGHT}.scip")["damage"] is None and opened(page, f"{RECORDED}.lcm")["damage"] is None
    flight, recording = hangar.flights / "damaged.scip", hangar.recordings / "damaged.lcm"
    flight.write_bytes(hangar.damaged)
    recording.write_bytes((hangar.recordings / f"{RECORDED}.lcm").read_bytes()[:-1000])
    try:
        assert opened(page, flight.name)["damage"] == "2 damaged places left out"
        assert re.fullmatch(r"1 damaged place, [\d.]+ (bytes|kB), left out", opened(page, recording.name)["damage"])
    finally:
        flight.unlink()
        recording.unlink()


def leftovers(hangar):
    """Programs that the console has started and that are still there."""
    return [child for tasks in pathlib.Path("/proc", str(hangar.console.process.pid), "task").glob("*/children")
            for child in tasks.read_text().split()]


def test_a_flight_and_its_map_are_downloaded_what_scans_left_free_in_it(hangar):
    with hangar.console.get(f"flights/{FLIGHT}.scip") as answer:
        assert answer.read() == (hangar.flights / f"{FLIGHT}.scip").read_bytes()
    with hangar.console.get("flights/drive.png") as answer:
        assert answer.read().startswith(b"\x89PNG")
    with hangar.console.get(f"flights/{FLIGHT}.zip") as answer, zipfile.ZipFile(io.BytesIO(answer.read())) as packed:
        cells_of = packed.read(f"{FLIGHT}.pgm")
    free, occupied = cells_of.count(254), cells_of.count(0)
    assert free > 3000 and 100 < occupied < free


@pytest.mark.parametrize("name, words", [("cut.scip", "cut.scip: .scip recording log without a scan"), ("none.scip", "no recording of that name"),
                                         ("../x.scip", "no recording of that name")])
def test_a_flight_that_cannot_be_replayed_is_refused_in_words(hangar, name, words):
    assert words in ask(WebSocket(hangar.console.url), type="open", name=name)["refusal"]


def test_who_asks_for_now_meanwhile_stays_there(hangar):
    page = WebSocket(hangar.console.url)
    page.send(json.dumps({"type": "open", "name": "drive.scip"}))
    page.send(json.dumps({"type": "look", "at": None}))
    assert page.wait_for("past")["recording"] is None
    assert opened(page, f"{RECORDED}.lcm")["recording"] == f"{RECORDED}.lcm", "it is the next one that is shown"


def test_lists_and_records_go_on_and_the_console_ends_while_a_flight_is_replayed(tmp_path):
    """By a stand-in for ale-replay that does not come to an end."""
    (tmp_path / "bin").mkdir()
    shutil.copy(BINARIES / "ale-console", tmp_path / "bin/ale-console")
    (tmp_path / "bin/ale-replay").write_text("#!/bin/sh\nexec sleep 1000\n")
    (tmp_path / "bin/ale-replay").chmod(0o755)
    write_flight(tmp_path / "flights/a.scip", 2)
    process = subprocess.Popen([tmp_path / "bin/ale-console", "--http", "127.0.0.1:0", "--lcm-url", free_lcm_url(), "--recordings",
                                tmp_path / "recordings", "--flights", tmp_path / "flights"], stdout=subprocess.PIPE, text=True,
                               env={**os.environ, "XDG_STATE_HOME": str(tmp_path)})
    try:
        page = WebSocket(process.stdout.readline().strip())
        page.send(json.dumps({"type": "open", "name": "a.scip"}))
        children = pathlib.Path("/proc", str(process.pid), "task")
        wait_until(lambda: any(tasks.read_text() for tasks in children.glob("*/children")), 60, "the replay")
        assert ask(page, type="record", on=True)["refusal"] is None
        assert page.wait_for("link", lambda link: link["recorder"]["name"])
    finally:
        process.terminate()
        assert process.wait(60) == 0


@LONG
@pytest.mark.skipif(os.geteuid() != 0 or shutil.which("unshare") is None, reason="needs root and unshare to have a small disk")
def test_without_room_for_it_a_flight_is_refused_in_words(tmp_path):
    """A disk of 33 MB, of which 32 are kept free, for a replay of two."""
    disk = tmp_path / "disk"
    disk.mkdir()
    write_flight(tmp_path / "flights/a.scip", 900)
    script = (f"mount -t tmpfs -o size=33m none {disk} && exec {BINARIES}/ale-console --http 127.0.0.1:0 --lcm-url '{free_lcm_url()}' "
              f"--flights {tmp_path}/flights")
    process = subprocess.Popen(["unshare", "-m", "sh", "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env={**os.environ, "XDG_STATE_HOME": str(tmp_path), "TMPDIR": str(disk)})
    url = process.stdout.readline().strip()
    if not url:
        pytest.skip(f"no small disk here: {process.stderr.read().strip()}")
    try:
        assert ask(WebSocket(url), type="open", name="a.scip")["refusal"] == f"there is no room in {disk} to replay a.scip"
    finally:
        process.terminate()
        process.communicate(timeout=180)


@NEED_BROWSER
@pytest.mark.parametrize("press", ["click", pytest.param("tap", marks=LONG), pytest.param("keys", marks=LONG)])
def test_a_press_on_a_flight_says_that_it_is_replayed_and_shows_it(hangar, chromium, press):
    chromium.open(hangar.console.url)
    chromium.run("localStorage.clear()")
    chromium.wait_for("document.querySelectorAll('#shelf li').length === 4 && document.getElementById('shelf-more').textContent === '1 more'")
    chromium.click("shelf-more")
    assert "flight, written at a fault" in chromium.run("return document.getElementById('shelf').textContent")
    chromium.run("window.said = []; new MutationObserver(() => said.push(document.getElementById('recordings-note').textContent))"
                 ".observe(document.getElementById('recordings-note'), {childList: true})")
    opener = f"open-{FLIGHT}.scip"
    if press == "keys":
        chromium.run("document.getElementById(arguments[0]).focus()", opener)
        chromium.press("Enter")
    else:
        getattr(chromium, press)(opener)
    chromium.wait_for(f"{TIME} === 'recording' && document.getElementById('scan').textContent === '0'")
    assert chromium.run("return said")[0] == f"replaying {FLIGHT}.scip: it is shown when that is done"
    assert not chromium.text("recordings-note").startswith("replaying")
    assert chromium.run("return document.getElementById(arguments[0]).ariaPressed", opener) == "true"
    assert chromium.text("past-text").endswith("0:00 of 0:04")
    show_only(chromium, "occupancy")
    chromium.click("play")
    chromium.wait_for(f"document.getElementById('scan').textContent === '{SCANS - 1}' && document.getElementById('play').ariaPressed === 'false'")
    assert cells(chromium)[1] > 3000
    show_only(chromium, "map")
    let_the_camera_glide(chromium)
    assert pixels(chromium, "wall", 40)["count"] > 500
    assert chromium.errors() == []


@NEED_BROWSER
def test_why_a_flight_cannot_be_shown_is_said_on_the_page(hangar, chromium):
    chromium.open(hangar.console.url)
    chromium.wait_for("document.getElementById('shelf-more').textContent === '1 more'")
    chromium.click("shelf-more")
    chromium.click("open-cut.scip")
    chromium.wait_for(f"{NOTE}.startsWith('It cannot be replayed: cut.scip: .scip recording log without a scan')")
    assert chromium.run(f"return {TIME}") == "now"


@NEED_BROWSER
def test_what_is_damaged_is_said_on_the_page_beside_the_time(hangar, chromium):
    flight = hangar.flights / "damaged.scip"
    flight.write_bytes(hangar.damaged)
    try:
        chromium.open(hangar.console.url)
        chromium.wait_for("document.getElementById('shelf-more').textContent === '2 more'")
        chromium.click("shelf-more")
        chromium.click("open-damaged.scip")
        chromium.wait_for(f"{TIME} === 'recording'")
        assert chromium.text("past-damage") == "2 damaged places left out"
        chromium.click(f"open-{FLIGHT}.scip")
        chromium.wait_for(f"document.getElementById('open-{FLIGHT}.scip').ariaPressed === 'true'")
        assert chromium.text("past-damage") == ""
    finally:
        flight.unlink()
