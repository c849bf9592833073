"""A console of several robots as its clients meet it: HTTP, the web socket, LCM; no browser (see
test_console_fleet_page.py)."""
import json
import urllib.error
import urllib.request

import lcm
import pytest

import ale
from recorded import RECORDED
from rovers import FIRST_SCAN, NAMES, rovers  # noqa: F401 (fixture)
from test_console import command, one_line, run_console, until
from waiting import wait_until
from watching import lcm_url  # noqa: F401 (fixture)
from web_socket import Refused, WebSocket


def states(message):
    return {robot["name"]: robot["state"] for robot in message["robots"]}


def ask(page, **message):
    page.send(json.dumps(message))


def test_each_page_is_of_its_robot_alone(rovers):
    pages = {"": WebSocket(rovers.console.url), "rover1": WebSocket(rovers.url_of("rover1")), "rover2": WebSocket(rovers.url_of("rover2"))}
    for name, page in pages.items():
        hello = page.wait_for("hello")
        assert hello["robot"] == (name or "rover1") and states(hello) == dict.fromkeys(NAMES, "waiting")
    for _ in range(12):
        rovers.step()
    for name, page in pages.items():
        first = FIRST_SCAN[name or "rover1"]
        taken = until(page, lambda message, last=first + 11: message["type"] == "scan" and message["scan"] == last, "its last scan")
        taken += until(page, lambda message: message["type"] == "link", "the link")
        scans = {message["scan"] for message in taken if "scan" in message}
        assert scans and scans <= set(range(first, first + 12))
        assert {message["robot"] for message in taken if message["type"] == "status"} == {name or "rover1"}
        assert (taken[-1]["poses"], taken[-1]["lost_poses"], taken[-1]["malformed"]) == (12, 0, 0)
        ask(page, type="series")
        assert {pose["scan"] for pose in page.wait_for("series")["poses"]} <= set(range(first, first + 12))


def test_how_the_others_are_is_told_when_it_changes(rovers):
    page = WebSocket(rovers.console.url)
    page.wait_for("hello")
    rovers.two.state = 1
    rovers.two.step()
    assert states(page.wait_for("robots")) == {"rover1": "waiting", "rover2": "weak", "rover3": "waiting"}
    assert states(page.wait_for("robots")) == {"rover1": "waiting", "rover2": "silent", "rover3": "waiting"}
    assert states(WebSocket(rovers.console.url).wait_for("hello"))["rover2"] == "silent"


def test_a_command_goes_to_the_robot_of_its_page_and_stop_to_all_that_are_heard(rovers):
    one, two = WebSocket(rovers.url_of("rover1")), WebSocket(rovers.url_of("rover2"))
    rovers.two.publish_status()
    two.wait_for("status")
    assert command(two, "drive", "0.1", "0")["refusal"] is None
    assert "no robot has been heard yet" in command(one, "stop")["refusal"]
    rovers.one.publish_status()
    one.wait_for("status")
    assert command(one, "drive", "0.1", "0")["refusal"] is None, "who drives one does not keep others from another"
    assert command(one, "stop")["refusal"] is None
    wait_until(lambda: rovers.verbs == [("rover2", "drive"), ("rover1", "drive"), ("rover1", "stop")], 60, f"commands: {rovers.verbs}")
    ask(two, type="stop_all")
    told = two.wait_for("sent")
    assert told["verb"] == "stop" and "rover3: no robot has been heard yet" == told["refusal"]
    wait_until(lambda: rovers.verbs[3:] == [("rover1", "stop"), ("rover2", "stop")], 60, f"commands: {rovers.verbs}")
    assert [one.robot for _, one in rovers.commands] == [name for name, _ in rovers.commands], "signed for it"


def test_recordings_maps_and_downloads_are_of_the_robot(rovers):
    one, two = WebSocket(rovers.url_of("rover1")), WebSocket(rovers.url_of("rover2"))
    for page, recordings, maps in ((one, [RECORDED], []), (two, [], ["flat"])):
        ask(page, type="shelf")
        shelf = page.wait_for("shelf")
        assert [piece["name"] for piece in shelf["recordings"]["pieces"]] == recordings
        assert [piece["name"] for piece in shelf["maps"]["pieces"]] == maps
    ask(two, type="record", on=True)
    name = two.wait_for("link", lambda link: link["recorder"]["name"])["recorder"]["name"]
    assert one.wait_for("link")["recorder"]["name"] is None
    rovers.step()
    two.wait_for("scan")
    ask(two, type="record", on=False)
    two.wait_for("link", lambda link: link["recorder"]["name"] is None)
    events = list(lcm.EventLog(str(rovers.folder / f"rover2/{name}"), "r"))
    assert {ale.pose_t.decode(event.data).scan for event in events if event.channel == "ALE_POSE"} == {1000}

    def status_of(path, robot):
        try:
            return urllib.request.urlopen(rovers.url_of(robot).replace("/?", f"/{path}?"), timeout=180).status
        except urllib.error.HTTPError as refused:
            return refused.code
    found = {robot: [status_of(path, robot) for path in (f"recordings/{name}", f"recordings/{RECORDED}.lcm", "maps/flat.svg", "live/map.svg")]
             for robot in NAMES}
    assert found == {"rover1": [404, 200, 404, 200], "rover2": [200, 404, 200, 200], "rover3": [404, 404, 404, 404]}


def test_a_robot_that_there_is_not_is_told_as_such_to_who_has_the_token(rovers):
    for name in ("rover4", "rover", "rover1.", "Rover1", "x" * 300):
        with pytest.raises(Refused, match="404"):
            WebSocket(rovers.url_of(name))
        for path in ("", "live/map.png", "recordings/a.lcm"):
            with pytest.raises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(rovers.url_of(name).replace("/?", f"/{path}?"), timeout=180)
            assert refused.value.code == 404 and "no robot of that name" in refused.value.read().decode()
    for url in (rovers.url_of("rover4").replace("token=", "token=x"), f"{rovers.console.address}?robot=rover1"):
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(url, timeout=180)
        assert refused.value.code == 403
        with pytest.raises(Refused, match="403"):
            WebSocket(url)


@pytest.mark.parametrize("arguments, words", [
    (["--lcm-url", "udpm://?prefix=a.", "--lcm-url", "udpm://239.255.76.67:7667?prefix=a."], "same channels"),
    (["--lcm-url", "udpm://?prefix=a.", "--lcm-url", "udpm://?prefix=a/"], "called a"),
    (["--lcm-url", "udpm://?prefix=a.", "--lcm-url", "udpm://?prefix=b.", "--recordings", "r"], "--recordings is wanted once for each"),
    (["--robot", "a", "--robot", "b"], "--robot is wanted once for each")], ids=["channels", "names", "one for two", "two for one"])
def test_robots_that_cannot_be_told_apart_are_wrong_use(arguments, words):
    done = run_console("--http", "127.0.0.1:0", *arguments)
    assert done.returncode == 2 and words in done.stderr and one_line(done.stderr) and done.stdout == ""
