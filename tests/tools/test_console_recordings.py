"""Recordings and saved maps of ale-console as its clients meet them: made, listed, downloaded; no browser (see
test_console_recordings_page.py)."""
import io
import json
import os
import pathlib
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request
import zipfile

import lcm
import pytest

from at_hand import BINARIES, LONG
from lcm_url import free_lcm_url
from recorded import RECORDED, write_map, write_recording
from robot_double import WALLS, RobotDouble
from waiting import Ear, Pulse, wait_until
from watching import Console, alice, console, lcm_url, robot  # noqa: F401 (fixtures)
from web_socket import WebSocket


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "recordings"


class Library:
    """A console with a recording, a saved map, and a robot that has told its map."""

    def __init__(self, place):
        url = free_lcm_url()
        self.folder = place / "recordings"
        write_recording(self.folder / f"{RECORDED}.lcm")
        write_map(place / "maps/flat.map")
        self.console = Console(url, "127.0.0.1:0", "--recordings", self.folder, "--maps", place / "maps")
        self.robot = RobotDouble(url)
        page = WebSocket(self.console.url)
        self.robot.publish_map()
        page.wait_for("map")
        page.close()


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """For tests that leave it as it is."""
    one = Library(tmp_path_factory.mktemp("library"))
    yield one
    assert one.console.end() == 0


def ask(page, **message):
    page.send(json.dumps(message))
    return page.wait_for("shelf")


def status_of(url):
    try:
        with urllib.request.urlopen(url, timeout=180) as answer:
            return answer.status
    except urllib.error.HTTPError as refused:
        return refused.code


def record(page, robot, scans):
    """The name of what was recorded."""
    assert ask(page, type="record", on=True)["refusal"] is None
    name = page.wait_for("link", lambda link: link["recorder"]["name"])["recorder"]["name"]
    robot.drive(scans)
    page.wait_for("pose", lambda pose: pose["scan"] == robot.scan - 1)
    ask(page, type="record", on=False)
    return name.removesuffix(".lcm")


def channels_of(path):
    return [event.channel for event in lcm.EventLog(str(path), "r")]


def test_what_is_recorded_is_read_by_lcm_and_replayed(alice, robot, folder):
    page = WebSocket(alice.url)
    robot.publish_status()
    robot.publish_map()
    page.wait_for("map")
    name = record(page, robot, 25)
    heard = channels_of(folder / f"{name}.lcm")
    assert heard.count("ALE_POSE") == heard.count("ALE_SCAN") == heard.count("ALE_FEATURES") == 25
    assert heard[:2] == ["ALE_MAP", "ALE_MAP"], "it begins with the map that was known"
    recorder = page.wait_for("link", lambda link: not link["recorder"]["name"])["recorder"]
    assert (recorder["messages"], recorder["dropped"]) == (len(heard), 0)
    trajectory = folder / "replayed.tum"
    done = subprocess.run([BINARIES / "ale-replay", folder / f"{name}.lcm", "--trajectory", trajectory], capture_output=True, text=True,
                          timeout=180, check=False)
    assert done.returncode == 0, done.stderr
    assert len(trajectory.read_text().splitlines()) == 25


def test_commands_and_set_points_are_not_recorded(alice, robot, folder):
    """Who plays a recording on a robot's bus must not move it."""
    page = WebSocket(alice.url)
    robot.publish_status()
    page.wait_for("status", lambda status: status["vouched"])
    ask(page, type="record", on=True)
    page.send(json.dumps({"type": "command", "words": ["drive", "0.1", "0"]}))
    assert page.wait_for("sent")["refusal"] is None
    robot.bus.publish("ALE_DRIVE", b"\0" * 32)
    robot.bus.publish("ALE_ODOMETRY", b"\0" * 28)
    robot.drive(3)
    page.wait_for("pose", lambda pose: pose["scan"] == 2)
    ask(page, type="record", on=False)
    recording, = [path for path in folder.iterdir() if path.stem != RECORDED]
    assert not {"ALE_DRIVE", "ALE_COMMAND"} & set(channels_of(recording))
    assert "ALE_ODOMETRY" in channels_of(recording)


@LONG
@pytest.mark.skipif(shutil.which("lcm-logplayer") is None, reason="no lcm-logplayer")
def test_lcm_logplayer_plays_it(alice, robot, folder, lcm_url):
    name = record(WebSocket(alice.url), robot, 10)
    poses = []
    ear = Ear(lcm_url, ["ALE_POSE"], lambda _, data: poses.append(data))
    try:
        subprocess.run(["lcm-logplayer", f"--lcm-url={lcm_url}", "--speed=5", folder / f"{name}.lcm"], capture_output=True, timeout=180, check=True)
        wait_until(lambda: len(poses) == 10, 60, "all poses")
    finally:
        ear.stop()


def test_the_list_tells_what_lies_there(library):
    shelf = ask(WebSocket(library.console.url), type="shelf")
    recording, = shelf["recordings"]["pieces"]
    assert recording["name"] == RECORDED and recording["length_ms"] == 2900 and recording["scans"] is True
    assert recording["bytes"] == (library.folder / f"{RECORDED}.lcm").stat().st_size
    saved, = shelf["maps"]["pieces"]
    assert saved["name"] == "flat" and saved["walls"] == recording["walls"] == len(WALLS)
    assert sorted(saved["drawing"]) == sorted(recording["drawing"]) and max(saved["drawing"]) == 1000


def fetch(console, path):
    with console.get(path) as answer:
        assert answer.headers["content-disposition"] == f'attachment; filename="{path.rpartition("/")[2]}"'
        assert answer.headers["x-content-type-options"] == "nosniff" and "default-src 'none'" in answer.headers["content-security-policy"]
        data = answer.read()
        assert len(data) == int(answer.headers["content-length"])
        return data


def test_recordings_and_every_map_in_every_format_are_downloaded(library):
    alice = library.console
    assert fetch(alice, f"recordings/{RECORDED}.lcm") == (library.folder / f"{RECORDED}.lcm").read_bytes()
    for stem in (f"recordings/{RECORDED}", "maps/flat", "live/map"):
        assert fetch(alice, f"{stem}.png").startswith(b"\x89PNG")
        assert b"<svg" in fetch(alice, f"{stem}.svg")
        assert fetch(alice, f"{stem}.dxf").count(b"\nWALLS") >= len(WALLS)
        walls = [feature for feature in json.loads(fetch(alice, f"{stem}.geojson"))["features"] if feature["properties"].get("kind") == "wall"]
        assert len(walls) == len(WALLS), stem
        with zipfile.ZipFile(io.BytesIO(fetch(alice, f"{stem}.zip"))) as packed:
            name = stem.rpartition("/")[2]
            assert packed.testzip() is None and packed.namelist() == [f"{name}.pgm", f"{name}.yaml"]
            assert packed.read(f"{name}.pgm").startswith(b"P5") and f"image: {name}.pgm" in packed.read(f"{name}.yaml").decode()


def test_a_pgm_has_what_scans_left_free_where_there_are_any(library):
    page = WebSocket(library.console.url)
    library.robot.drive(12)
    page.wait_for("scan", lambda scan: scan["scan"] == library.robot.scan - 1)
    free = {}
    for stem in ("live/map", f"recordings/{RECORDED}", "maps/flat"):
        with zipfile.ZipFile(io.BytesIO(fetch(library.console, f"{stem}.zip"))) as packed:
            cells = packed.read(f"{stem.rpartition('/')[2]}.pgm").split(b"\n255\n", 1)[1]
            free[stem], walls = cells.count(254), cells.count(0)
            assert 200 < walls < 2000, stem
    room = 5 * 3.6 / 0.05 ** 2
    assert 0.5 * room < free["live/map"] < 1.2 * room and 0.5 * room < free[f"recordings/{RECORDED}"] < 1.2 * room
    assert free["maps/flat"] == 0, "its file has no scans"


PATHS = [f"recordings/{RECORDED}.lcm", f"recordings/{RECORDED}.png", "maps/flat.png", "live/map.png"]


def test_nothing_of_it_is_had_without_the_token(library):
    alice = library.console
    for path in PATHS:
        for token in ("", "?token=", "?token=" + "x" * len(alice.token)):
            assert status_of(alice.address + path + token) == 403, path


def raw(console, request):
    """The first line that comes back; a path as no client would send it."""
    host, _, port = console.address.split("/")[2].partition(":")
    with socket.create_connection((host, int(port)), timeout=180) as wire:
        wire.sendall(f"{request}\r\nHost: {host}:{port}\r\nConnection: close\r\n\r\n".encode("latin-1"))
        return wire.recv(4096).decode("latin-1").splitlines()[:1]


ELSEWHERE = ["recordings/../x.lcm", "recordings/..%2fx.lcm", "recordings/%2e%2e/x.lcm", "recordings//etc/x.lcm", "recordings/link.lcm",
             "recordings/folder.lcm", "recordings/.hidden.lcm", "maps/../recordings/x.png", "maps/%00.png", "recordings/x%00.lcm",
             "recordings/" + "x" * 300 + ".lcm", "maps/none.png", "live/other.png", "recordings/..\\\\x.lcm"]


def test_no_name_leads_out_of_the_folder(alice, folder):
    for name in (folder.parent / "x.lcm", folder / ".hidden.lcm"):
        name.write_text("secret")
    (folder / "link.lcm").symlink_to(folder.parent / "x.lcm")
    (folder / "folder.lcm").mkdir()
    for path in ELSEWHERE:
        answer = raw(alice, f"GET /{path}?token={alice.token} HTTP/1.1")
        assert not answer or answer[0].split()[1] in ("400", "403", "404"), (path, answer)
    assert raw(alice, f"DELETE /{PATHS[0]}?token={alice.token} HTTP/1.1") != ["HTTP/1.1 200 OK"]
    assert status_of(f"{alice.address}{PATHS[0]}?token={alice.token}") == 200


def test_without_a_folder_it_says_so_and_records_nothing(console):
    page = WebSocket(console.url)
    shelf = ask(page, type="record", on=True)
    assert "--recordings DIR" in shelf["refusal"] and shelf["recordings"]["folder"] is None and shelf["maps"]["folder"] is None
    assert page.wait_for("link")["recorder"]["name"] is None


def test_a_folder_that_cannot_be_written_is_told_in_words(lcm_url, tmp_path):
    (tmp_path / "file").write_text("")
    running = Console(lcm_url, "127.0.0.1:0", "--recordings", tmp_path / "file")
    refusal = ask(WebSocket(running.url), type="record", on=True)["refusal"]
    assert refusal == f"{tmp_path}/file: Not a directory"
    assert running.end() == 0


@LONG
@pytest.mark.skipif(os.geteuid() != 0 or shutil.which("unshare") is None, reason="needs root and unshare to have a small disk")
def test_a_full_disk_ends_the_recording_with_words_and_keeps_what_came_before(lcm_url, robot, tmp_path):
    """A disk of 33 MB, of which 32 are kept free; the console and its disk are in a room of their own."""
    disk = tmp_path / "disk"
    disk.mkdir()
    script = f"mount -t tmpfs -o size=33m none {disk} && exec {BINARIES}/ale-console --http 127.0.0.1:0 --lcm-url '{lcm_url}' --recordings {disk}"
    process = subprocess.Popen(["unshare", "-m", "sh", "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env={**os.environ, "XDG_STATE_HOME": str(tmp_path)})
    url = process.stdout.readline().strip()
    if not url:
        pytest.skip(f"no small disk here: {process.stderr.read().strip()}")
    try:
        page = WebSocket(url)
        assert ask(page, type="record", on=True)["refusal"] is None
        flood = Pulse(0.005, lambda: robot.bus.publish("ALE_ODOMETRY", b"x" * 30000))
        try:
            recorder = page.wait_for("link", lambda link: link["recorder"]["trouble"], 60)["recorder"]
        finally:
            flood.stop()
        assert "is full" in recorder["trouble"] and "what came before is in it" in recorder["trouble"]
        assert 1_000_000 < recorder["bytes"] <= 1 << 20 and recorder["name"] is None
        piece, = ask(page, type="shelf")["recordings"]["pieces"]
        assert piece["bytes"] == recorder["bytes"]
        assert "is full" in ask(page, type="record", on=True)["refusal"]
    finally:
        process.terminate()
        process.communicate(timeout=180)


def test_a_download_that_nobody_takes_holds_up_nobody(alice, robot, folder):
    """More of them than there may be, of a file that no socket's buffer holds."""
    with open(folder / "large.lcm", "wb") as large:
        large.truncate(64 << 20)
    host, _, port = alice.address.split("/")[2].partition(":")
    held = []
    for _ in range(20):
        wire = socket.create_connection((host, int(port)), timeout=180)
        wire.sendall(f"GET /recordings/large.lcm?token={alice.token} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
        held.append(wire)
    page = WebSocket(alice.url)
    beat = Pulse(0.05, robot.step)
    try:
        for _ in range(20):
            page.wait_for("pose")
        begin = time.monotonic()
        assert ask(page, type="record", on=True)["refusal"] is None
        assert time.monotonic() - begin < 10
    finally:
        beat.stop()
    assert status_of(f"{alice.address}recordings/large.lcm?token={alice.token}") == 503
    for wire in held:
        wire.close()
    wait_until(lambda: status_of(f"{alice.address}live/map.png?token={alice.token}") == 200, 60, "room for another one")


def test_a_recording_is_looked_at_by_one_page_and_others_go_on(library):
    here, other = WebSocket(library.console.url), WebSocket(library.console.url)
    here.send(json.dumps({"type": "open", "name": f"{RECORDED}.lcm"}))
    past = here.wait_for("past")
    assert past["recording"] == f"{RECORDED}.lcm" and past["kept"][1] - past["kept"][0] == 2900 and past["at"] == past["kept"][0]
    assert here.wait_for("map")["lines"] and here.wait_for("link")["kept"] == past["kept"]
    here.send(json.dumps({"type": "look", "at": past["kept"][1]}))
    assert here.wait_for("pose")["scan"] == 29
    library.robot.scan += 100
    library.robot.publish_pose()
    other.wait_for("pose", lambda pose: pose["scan"] == library.robot.scan)
    here.send(json.dumps({"type": "look", "at": None}))
    assert here.wait_for("past")["recording"] is None
    here.wait_for("pose", lambda pose: pose["scan"] == library.robot.scan)


def test_a_recording_that_is_none_is_refused_in_words(library):
    page = WebSocket(library.console.url)
    (library.folder / "none.lcm").write_bytes(b"nothing " * 100)
    for name, words in (("absent.lcm", "no recording of that name"), ("../x.lcm", "no recording of that name"), ("none.lcm", "no message of a robot")):
        assert words in ask(page, type="open", name=name)["refusal"]
    (library.folder / "none.lcm").unlink()


NONSENSE = ['{"type":"open"}', '{"type":"open","name":7}', '{"type":"record"}', '{"type":"record","on":1}', '{"type":"record","on":null}', '{"type":["shelf"]}']


def test_a_request_that_is_none_ends_the_connection(library):
    for text in NONSENSE:
        rude = WebSocket(library.console.url)
        rude.send(text)
        with pytest.raises(OSError):
            while True:
                rude.next()


def test_a_flood_of_requests_ends_its_connection_and_nobody_elses(library):
    robot = library.robot
    rude, other = WebSocket(library.console.url), WebSocket(library.console.url)
    with pytest.raises(OSError):
        for _ in range(100000):
            rude.send('{"type":"shelf"}')
        while True:
            rude.next()
    robot.publish_pose()
    other.wait_for("pose", lambda pose: pose["scan"] == robot.scan)
    assert ask(other, type="shelf")["refusal"] is None


def test_a_console_that_ends_while_it_records_has_all_of_it(lcm_url, robot, tmp_path):
    running = Console(lcm_url, "127.0.0.1:0", "--recordings", tmp_path / "rec")
    page = WebSocket(running.url)
    ask(page, type="record", on=True)
    robot.drive(5)
    page.wait_for("pose", lambda pose: pose["scan"] == 4)
    page.wait_for("scan", lambda scan: scan["scan"] == 4)
    assert running.end() == 0
    recording, = pathlib.Path(tmp_path / "rec").iterdir()
    assert channels_of(recording).count("ALE_SCAN") == 5
