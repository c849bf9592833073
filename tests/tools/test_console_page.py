"""The console's page in headless Chromium: what an operator sees."""
import pytest

import browser
from console_page import (ALARM, LINK, STATE, chromium, cockpit, let_the_camera_glide, middle, number, page,  # noqa: F401 (fixtures)
                          pixels)
from waiting import Pulse, assert_in_time, seconds_of, wait_until
from watching import Console, alice, commands, console, lcm_url, pulse, robot  # noqa: F401 (fixtures)

pytestmark = pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")

BESIDE_THE_NUMBERS = """
const box = (selector) => document.querySelector(selector).getBoundingClientRect();
return box("#state-text").right <= box(".vitals").left && box("#state").height < 50;
"""


def test_before_the_robot_is_heard_it_waits(page):
    page.wait_for(f"{LINK} === 'waiting'")
    assert page.text("state-word") == "waiting"
    assert "ale-bridge --connect ROBOT:7700 --keys KEY" in page.text("advice"), "how it can be heard"
    assert page.run(f"return {ALARM}") is False


def test_the_map_appears_and_the_pose_moves(page, pulse):
    page.wait_for(f"{STATE} === 'good' && {LINK} === 'up'")
    assert "ale-bridge" not in page.text("advice")
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    first = page.text("x")
    page.wait_for(f"document.getElementById('x').textContent !== '{first}'")
    page.wait_for("document.getElementById('beams').textContent.endsWith('/ 682')")
    page.wait_for("Number(document.getElementById('scan').textContent) > 25")  # a trail longer than the robot
    for colour, least in (("wall", 1500), ("line", 1000), ("corner", 60), ("robot", 300), ("trail", 20)):
        assert pixels(page, colour, 40)["count"] > least, colour
    assert page.text("lines") == "5" and page.text("corners") == "3"


def test_the_numbers_are_those_that_were_sent(page, pulse):
    page.wait_for("document.getElementById('device').textContent.startsWith('URG-04LX')")
    page.wait_for("document.getElementById('codes').textContent.includes('1 beside a disturbed beam')")  # the scan comes last
    assert page.text("realtime") == "yes"
    assert page.text("latency-p99") == "2.30 ms"
    assert page.text("sigma-x") == "4.0 mm" and page.text("sigma-heading") == "0.17°"
    assert page.text("dropped") == "1"  # one scan lost; what else is counted was no scan
    assert "wrong checksums" in page.text("counters") and "streaming" in page.text("driver")
    wait_until(lambda: page.run("return parseFloat(document.getElementById('rate').textContent) || 0")
               == pytest.approx(pulse.rate(), rel=0.2), 180, "the rate of the scans")


@pytest.mark.parametrize("state, name", [(1, "weak"), (0, "lost")])
def test_weak_and_lost_cannot_be_missed(page, robot, pulse, state, name):
    def shown():
        robot.state = 2
        page.wait_for(f"{STATE} === 'good'")
        assert page.run(f"return {ALARM}") is False
        robot.state = state
        return seconds_of(lambda: page.wait_for(f"{ALARM} === '{name}'"))
    assert_in_time(shown, most=1)
    assert page.text("state-word") == name
    assert page.run("return getComputedStyle(document.querySelector('main'), '::after').borderTopWidth") != "0px"


CAUSE = "document.getElementById('alarm-cause').textContent"


def test_why_it_is_weak_or_lost_and_what_to_do_stands_beside_the_state(page, robot, pulse):
    """A sentence for each cause that the robot reports, and one that mostly helps where it reports none."""
    page.wait_for(f"{STATE} === 'good' && document.getElementById('device').textContent.startsWith('URG')")
    assert page.text("alarm-cause") == ""
    robot.state = 1
    page.wait_for(f"{ALARM} === 'weak' && {CAUSE}.includes('fits more than one place')")
    robot.wheels = "stalled"
    page.wait_for(f"{CAUSE}.includes('wheels contradict the scans')")
    robot.observability = [900.0, 0.0, 0.0, 1.0, 0.0, 50.0]
    page.wait_for(f"{CAUSE}.includes('as in a corridor')")
    robot.blind_beams = 650
    page.wait_for(f"/Only \\d+ of 682 beams see anything/.test({CAUSE})")
    robot.lost_scans += 5
    page.wait_for(f"{CAUSE}.startsWith('Scans get lost on the way from the scanner. Look at its cable')")
    alarm, advice = (page.run("const b = document.getElementById(arguments[0]).getBoundingClientRect(); return [b.top, b.bottom]", name)
                     for name in ("alarm", "advice"))
    assert alarm[1] < advice[0], "neither over the other"
    robot.state = 2
    page.wait_for(f"{STATE} === 'good' && {CAUSE} === ''")


def test_causes_are_put_in_words(page):
    words = page.run("""
        return import("/cause.js").then(({ Cause }) => {
          const fine = {type: "status", utime: 0, counters: [{name: "overloaded", value: 2}], exploration: ""};
          const scene = (state, more = {}) => ({pose: {state, observability: [0, 0, 0, 0, 0, 0]}, status: fine, ...more});
          const cause = new Cause();
          cause.take(fine);
          const said = {
            good: cause.words("up", scene("good"), true), weak: cause.words("up", scene("weak"), true), lost: cause.words("up", scene("lost"), true),
            apart: cause.words("up", scene("lost", {tracking: {map_id: 3, maps: 2, wheels: "fine"}}), true),
            looks: cause.words("up", scene("lost", {status: {exploration: "looks for its place: it turns"}}), true),
            silent: cause.words("lost", scene("good"), false), reports: cause.words("lost", scene("good"), true),
            gone: cause.words("gone", scene("good"), false), recorded: cause.words("recording", scene("lost"), false),
            room: cause.words("up", {...scene("weak"), pose: {state: "weak", observability: [900, 0, 0, 300, 0, 50]}}, true),
          };
          cause.take({...fine, utime: 5e6, counters: [{name: "overloaded", value: 3}]});
          said.busy = cause.words("up", scene("weak"), true);
          cause.take({...fine, utime: 16e6, counters: [{name: "overloaded", value: 3}]});
          said.later = cause.words("up", scene("weak"), true);
          return said;
        });""")
    assert words["good"] == "" and words["room"] == words["weak"] == words["later"] and "corners are in sight" in words["weak"]
    assert "was carried" in words["lost"] and words["recorded"] == words["lost"] and "goes on in a new one" in words["apart"]
    assert "by itself" in words["looks"] and "too busy" in words["busy"]
    assert "ale-bridge" in words["silent"] and "restart ale-slamd" in words["reports"] and "Start it again" in words["gone"]


def test_what_the_scanner_reports_stands_over_the_map_in_plain_words(page, robot, pulse):
    page.wait_for(f"{STATE} === 'good'")
    assert page.run("return document.getElementById('advice').hidden")
    robot.driver, robot.state = "asking who is there: hardware fault of the sensor: status 50", 0
    page.wait_for("document.getElementById('advice').textContent.includes('(status 50). Switch it off and on')")
    page.wait_for(f"{ALARM} === 'lost'")
    alarm, advice = (page.run("const b = document.getElementById(arguments[0]).getBoundingClientRect(); "
                              "return [b.left, b.top, b.right, b.bottom]", name) for name in ("alarm", "advice"))
    assert alarm[3] < advice[1] and advice[0] > 60, "neither over the other nor over the tools"
    robot.driver = "streaming"
    page.wait_for("document.getElementById('advice').hidden")


def test_a_map_that_is_not_joined_is_told_and_drawn_apart(page, robot, pulse):
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    page.wait_for("document.getElementById('maps').textContent === 'one'")
    assert page.run("return document.getElementById('apart').hasAttribute('data-empty')")
    before = pixels(page, "apart")["count"]
    robot.map_id, robot.maps = 1, 2
    robot.publish_pieces(range(5))  # the walls of the first room
    page.wait_for("document.getElementById('state-text').textContent === 'new map, not joined yet'")
    page.wait_for("document.getElementById('advice').textContent.includes('until the robot knows a place again (2 in all).')")
    assert page.text("maps") == "new map, not joined yet"
    page.wait_for("!document.getElementById('apart').hasAttribute('data-empty')")
    let_the_camera_glide(page)
    assert pixels(page, "apart")["count"] > before + 500, "the second room, in which no line of the scan lies over them"
    robot.map_id = 0  # it has found back, into the map of the other walls
    page.wait_for("document.getElementById('state-text').textContent === '2 maps, not joined'")
    let_the_camera_glide(page)
    assert pixels(page, "apart")["count"] < before + 100, "now the first room is apart, and the second is not"
    robot.publish_pieces([])
    robot.publish_map()
    robot.maps = 1
    page.wait_for("document.getElementById('advice').hidden && document.getElementById('apart').hasAttribute('data-empty')")


def test_wheels_that_are_not_believed_are_told_in_plain_words(page, robot, pulse):
    page.wait_for("document.getElementById('wheels').textContent === 'fine'")
    robot.wheels = "stalled"
    page.wait_for("document.getElementById('advice').textContent.includes("
                  "'Wheels not believed: they tell nothing while the robot moves.')")
    assert page.text("wheels") == "stalled: they tell nothing while the robot moves (once so far)"
    robot.driver = "silent"
    page.wait_for("document.querySelectorAll('#advice p').length === 2")
    robot.wheels, robot.driver = "fine", "streaming"
    page.wait_for("document.getElementById('advice').hidden")


def test_a_lost_link_shows_within_a_second(page, robot):
    def shown():
        pulse = Pulse(0.1, robot.step)
        try:
            page.wait_for(f"{LINK} === 'up'")
        finally:
            pulse.stop()
        return seconds_of(lambda: page.wait_for(f"{LINK} === 'lost'"))
    assert_in_time(shown, most=1)
    assert page.run(f"return {ALARM}") == "link lost"
    assert "ago" in page.text("alarm-text")


def test_a_robot_without_scans_says_why_in_the_place_of_its_state(page, robot):
    pulse = Pulse(0.1, robot.step)
    try:
        page.wait_for(f"{LINK} === 'up'")
    finally:
        pulse.stop()
    robot.driver = "no scanner: the port is gone (unplugged or hung up)"
    pulse = Pulse(0.5, robot.publish_status)
    try:
        page.wait_for(f"{LINK} === 'blind'")
        assert page.run(f"return {ALARM}") == "no scans"
        assert page.text("alarm-text").startswith(f"{robot.driver}; last pose ")
        assert page.text("state-word") == "no scans"
        robot.driver = "asking who is there: no answer from the sensor: what speaks there is NMEA, as of a GPS receiver: $GPGGA,1"
        page.wait_for("document.getElementById('advice').textContent.includes('on its port: NMEA, as of a GPS receiver: $GPGGA,1. Choose')")
        assert page.run(BESIDE_THE_NUMBERS), "a long cause runs into the numbers"
    finally:
        pulse.stop()
    page.wait_for(f"{LINK} === 'lost'")


def test_a_console_that_ends_shows_within_a_second_and_one_that_returns_is_found(chromium, lcm_url, robot, pulse, tmp_path):
    with_token = ("--token-file", tmp_path / "token")
    running = Console(lcm_url, "127.0.0.1:0", *with_token)
    chromium.open(running.url)

    def gone_and_found_again():
        nonlocal running
        chromium.wait_for(f"{LINK} === 'up'")
        assert running.end() == 0
        seconds = seconds_of(lambda: chromium.wait_for(f"{LINK} === 'gone'"))
        running = Console(lcm_url, running.origin.removeprefix("http://"), *with_token)
        chromium.wait_for(f"{LINK} === 'up'")
        return seconds
    try:
        assert_in_time(gone_and_found_again, most=1)
    finally:
        assert running.end() == 0
    chromium.errors()  # the browser's own notes about the connection that was refused meanwhile


def test_nothing_comes_from_elsewhere(page, console, pulse):
    page.wait_for(f"{LINK} === 'up'")
    urls = page.run("return performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert len(urls) >= 7
    assert all(url.startswith(console.address) for url in urls)


def test_following_keeps_the_robot_in_the_middle(page, pulse):
    page.wait_for(f"{STATE} === 'good'")
    page.click("follow")
    page.wait_for("document.getElementById('follow').ariaPressed === 'true'")
    let_the_camera_glide(page)
    where = pixels(page, "robot")
    assert where["x"] == pytest.approx(0.5, abs=0.03) and where["y"] == pytest.approx(0.5, abs=0.04)


def test_zoom_pan_and_back_to_the_whole(page, robot):
    for _ in range(3):
        robot.step()
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    let_the_camera_glide(page)
    before = pixels(page, "robot")
    scale = number(page.text("scale-text")) / page.run("return document.getElementById('scale-bar').offsetWidth")
    page.click("zoom-in")
    page.click("zoom-in")
    page.drag(500, 400, 600, 460)
    moved = pixels(page, "robot")
    assert (moved["x"], moved["y"]) != (before["x"], before["y"])
    assert page.run("return document.getElementById('whole').ariaPressed") == "false"
    page.click("whole")
    let_the_camera_glide(page)
    after = pixels(page, "robot")
    assert after["x"] == pytest.approx(before["x"], abs=0.01) and after["y"] == pytest.approx(before["y"], abs=0.01)
    assert number(page.text("scale-text")) / page.run(
        "return document.getElementById('scale-bar').offsetWidth") == pytest.approx(scale, rel=0.05)


def test_dark_and_light_by_one_button_and_remembered(page, robot):
    robot.step()
    ground = "getComputedStyle(document.body).backgroundColor"
    theme = page.run("return document.documentElement.dataset.theme")
    colour = page.run(f"return {ground}")
    page.click("theme")
    page.wait_for(f"document.documentElement.dataset.theme !== '{theme}'")
    assert page.run(f"return {ground}") != colour
    assert pixels(page, "ground")["count"] > 10000
    page.reload()
    page.wait_for(f"document.documentElement.dataset.theme !== '{theme}'")


@pytest.mark.parametrize("width, height", [(820, 1180), (1180, 820), (480, 900)])
def test_it_fits_a_tablet_either_way(page, pulse, width, height):
    try:
        page.resize(width, height)
        page.wait_for(f"{STATE} === 'good'")
        assert page.run("return document.documentElement.scrollWidth - innerWidth") <= 0
        area = page.run("const r = document.getElementById('map').getBoundingClientRect(); return [r.width, r.height]")
        assert min(area) > 250
        for name in ("state", "follow", "whole", "theme"):
            right = page.run("return document.getElementById(arguments[0]).getBoundingClientRect().right", name)
            assert 0 < right <= width
    finally:
        page.resize(1280, 800)


def test_poses_of_others_are_told_over_the_map(cockpit, robot):
    """While the robot vouches for its own: beside each of them one that is numbered ahead."""
    def forge():
        forged = robot.pose()
        forged.scan, forged.map_x = robot.scan + 6, 9.0
        robot.bus.publish("ALE_POSE", forged.encode())

    cockpit.wait_for("document.getElementById('advice').hidden")
    others = Pulse(0.1, forge)
    try:
        cockpit.wait_for("document.getElementById('advice').textContent.includes(\"are not the robot's own\")")
    finally:
        others.stop()
    cockpit.wait_for("document.getElementById('advice').hidden")


def test_without_a_key_it_says_so_and_shows_no_controls(page, pulse):
    page.wait_for("document.getElementById('control-note').textContent.includes('--keys')")
    assert page.run("return document.getElementById('stick').offsetParent") is None


def test_the_stick_drives_while_it_is_held_and_then_stands(cockpit, commands):
    x, y = middle(cockpit, "stick")
    cockpit.drag(x, y, x, y - 60, held_ms=600)
    def moved_and_stood(heard):
        return any(c.args[0] != "0.000" for c in heard) and heard[-1].args == ["0.000", "0.000"]
    sent = [[float(word) for word in c.args] for c in commands(moved_and_stood)]
    assert max(v for v, _ in sent) == pytest.approx(0.3, abs=0.05) and max(abs(w) for _, w in sent) < 0.05
    assert sent[-1] == [0, 0]


def test_the_keys_drive_and_space_stops(cockpit, commands):
    cockpit.hold("a", 0.6)
    cockpit.hold(" ", 0.05)
    heard = commands(lambda heard: any(c.verb == "stop" for c in heard))
    assert ["0.000", "0.800"] in [c.args for c in heard]
    assert "stop" in [c.verb for c in heard]


def test_buttons_ask_for_what_they_say_and_twice_where_something_is_lost(cockpit, commands):
    cockpit.click("explore")
    cockpit.click("save-map")
    cockpit.click("reset")
    assert cockpit.text("reset") == "sure?"
    cockpit.click("reset")
    assert cockpit.text("reset") == "reset"
    cockpit.click("freeze")
    assert [[c.verb, *c.args] for c in commands(4)] == [
        ["explore", "on"], ["save_map", "map"], ["reset"], ["set", "freeze_map", "yes"]]


def test_you_are_here_is_a_press_and_a_drag_on_the_map(cockpit, commands):
    cockpit.click("relocate")
    cockpit.drag(400, 400, 400, 300)
    one, = commands(1)
    assert one.verb == "relocate" and float(one.args[2]) == pytest.approx(1.5708, abs=0.01)
    cockpit.wait_for("document.getElementById('hint').hidden")


def test_what_came_of_a_command_and_who_drives_is_said(cockpit, commands, robot):
    cockpit.click("save-map")
    robot.who_drives = "bob"
    robot.answer = ("alice", commands(1)[0].counter, "saved map.map: 12 walls")
    cockpit.wait_for("document.getElementById('answer').textContent === 'saved map.map: 12 walls'")
    assert cockpit.text("who-drives") == "bob"


def test_measuring_tells_the_distance_between_two_points(page, pulse):
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    let_the_camera_glide(page)
    a_metre = page.run("return document.getElementById('scale-bar').offsetWidth") / number(page.text("scale-text"))
    page.click("measure")
    before = pixels(page, "pointed")["count"]
    page.drag(300, 400, 300 + round(a_metre), 400)
    assert pixels(page, "pointed")["count"] > before + 200
    where = page.run("return document.getElementById('map').dataset.measured")
    assert number(where) == pytest.approx(1, abs=0.02)
    page.click("measure")
    page.wait_for("document.getElementById('hint').hidden")
    page.run("return new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
    assert pixels(page, "pointed")["count"] == before


def test_a_scan_taken_while_turning_is_straightened(page, robot):
    """The beams of the double are cast from where the robot was at each beam's time: drawn rightly they lie on
    the walls."""
    robot.scan = 30
    robot.publish_map()
    robot.step()
    page.wait_for("document.getElementById('beams').textContent.endsWith('/ 682')")
    distances = page.run("""
        return import("/scene.js").then(({ Scene }) => new Promise((done) => {
          const scene = new Scene();
          const socket = new WebSocket(`ws://${location.host}/${location.search}`);
          socket.onmessage = (event) => {
            scene.take(JSON.parse(event.data));
            if (!scene.map || !scene.pose || !scene.scan || !scene.points.length) return;
            socket.close();
            const far = [];
            for (let k = 0; k < scene.points.length; k += 2) {
              const [x, y] = [scene.points[k], scene.points[k + 1]];
              far.push(Math.min(...scene.map.lines.map((l) => {
                const [ex, ey] = [l.x2 - l.x1, l.y2 - l.y1];
                const t = Math.max(0, Math.min(1, ((x - l.x1) * ex + (y - l.y1) * ey) / (ex * ex + ey * ey)));
                return Math.hypot(x - l.x1 - t * ex, y - l.y1 - t * ey);
              })));
            }
            done(far);
          };
        }));""")
    assert len(distances) > 300
    assert max(distances) < 0.004  # as sent in whole millimetres; bent, it would be centimetres


def test_numbers_and_codes_are_put_in_words(page):
    words = page.run("""
        return import("/words.js").then((w) => ({
          small: w.metres(-0.0001), nothing: w.metres(null), heading: [w.heading(-0.0001), w.heading(4), w.heading(-4)],
          times: [w.duration(12.4), w.duration(1234), w.duration(99949), w.duration(2.5e6), w.duration(null)],
          codes: [w.codesInWords([]), w.codesInWords([[0, 3], [0x81, 4], [2, 1]]), w.codesInWords([[18, 2], [11, 1]])],
          advice: [["streaming", null], ["streaming", [23, 0.7]], ["silent", null], ["no scanner: /dev/ttyACM0: No such file", null]]
            .map(([driver, stain]) => w.adviceOnScanner(driver, stain)),
          maps: [null, [0, 1], [0, 3], [4, 1]].map((t) => w.mapsInWords(t && {map_id: t[0], maps: t[1]})[0]),
          trouble: [["maps", 1], ["maps", 2], ["odometry", 9], ["wheel_faults", 1]].map(([name, value]) => w.isTrouble({name, value})),
          drops: w.countDrops([{name: "scans_lost", value: 2}, {name: "odometry", value: 90}, {name: "overloaded", value: 1}]),
        }));""")
    assert words["small"] == "0.000 m" and words["nothing"] == "–"
    assert words["heading"] == ["0.0°", "-130.8°", "130.8°"]
    assert words["times"] == ["12 µs", "1.23 ms", "99.9 ms", "2.5 s", "–"]
    assert words["codes"] == ["none", "7 nothing in reach, 1 too weak", "2 dazzled by something shiny, 1 disturbed"]
    assert words["advice"][0] is None
    assert words["advice"][1].startswith("The scanner's window may be dirty: 23 beams 40° to the left give no range")
    assert "cable" in words["advice"][2]
    assert words["advice"][3].startswith("No scanner (/dev/ttyACM0: No such file). Look at its cable")
    assert words["maps"] == ["", "", "3 maps, not joined", "new map, not joined yet"]
    assert words["trouble"] == [False, True, False, True]
    assert words["drops"] == 3


def test_a_press_on_the_map_sends_the_robot_there_and_its_path_is_drawn(cockpit, commands, robot):
    cockpit.wait_for("document.getElementById('map-lines').textContent === '12'")
    let_the_camera_glide(cockpit)
    cockpit.click("goal")
    assert cockpit.run("return document.getElementById('goal').ariaPressed") == "true"
    cockpit.drag(420, 300, 420, 300)
    cockpit.wait_for("document.getElementById('hint').hidden")
    one, = commands(1)
    x, y = (float(word) for word in one.args)
    cursor = cockpit.text("cursor").split()
    assert one.verb == "goto" and (x, y) == pytest.approx((float(cursor[1]), float(cursor[3])), abs=0.01)
    before = pixels(cockpit, "path")["count"]
    robot.who_drives, robot.exploration = "goal", "drives to 1.00 1.00: 2 m to go"
    robot.publish_plan(3, robot.exploration, (2, 1.5), [(-1.5, -1.0), (-1.5, 1.6), (2, 1.5)])
    cockpit.wait_for("document.getElementById('goal').textContent === 'leave goal'")
    let_the_camera_glide(cockpit)
    assert pixels(cockpit, "path")["count"] > before + 100
    cockpit.click("goal")
    assert commands(2)[1].verb == "stop"


def test_why_a_goal_was_given_up_stands_over_the_map(cockpit, commands, robot):
    why = "gave up 9.00 9.00: no way leads there that is wide enough"
    cockpit.run("document.getElementById('goal').focus()")
    cockpit.press("Enter", "ArrowUp", "Enter")
    one, = commands(1)
    assert one.verb == "goto"
    robot.exploration, robot.refused = why, True
    robot.answer = ("alice", one.counter, why)
    robot.publish_plan(5, why, (9, 9))
    cockpit.wait_for("document.getElementById('answer').className === 'bad'")
    assert cockpit.text("answer") == why
    cockpit.wait_for("document.getElementById('advice').textContent.includes('The robot gave up 9.00 9.00: no way leads there')")
    assert cockpit.text("goal") == "drive there"


def test_the_last_minutes_are_scrubbed_and_played(page, robot):
    robot.drive(40)
    page.wait_for("document.getElementById('scan').textContent === '39' && !document.getElementById('when').disabled")
    page.wait_for("Number(document.getElementById('when').max) - Number(document.getElementById('when').min) > 300")
    page.run("const when = document.getElementById('when'); when.value = (Number(when.min) + Number(when.max)) / 2;"
             "when.dispatchEvent(new Event('input'))")
    page.wait_for("document.body.dataset.time === 'past' && Number(document.getElementById('scan').textContent) < 39")
    scan = int(page.text("scan"))
    assert 0 < scan < 39
    assert not page.run("return document.getElementById('past').hidden") and page.text("past-text").endswith("ago")
    page.wait_for("document.getElementById('map-lines').textContent === '12'")  # what was to be seen then, all of it
    before = page.text("past-text")

    def later():  # of when the newest is, the page is told meanwhile, too
        robot.step()
        return page.text("past-text") != before
    wait_until(later, 180, "the time that has gone by since then")
    assert page.text("scan") == str(scan), "what comes now is not shown then"
    page.click("play")
    page.wait_for("document.body.dataset.time === 'now'")
    page.wait_for(f"document.getElementById('scan').textContent === '{robot.scan - 1}'")
    assert page.run("return document.getElementById('live').ariaPressed") == "true"


def test_while_the_past_is_looked_at_nothing_but_stop_is_sent(cockpit, commands, robot):
    cockpit.wait_for("Number(document.getElementById('when').max) - Number(document.getElementById('when').min) > 500")
    cockpit.run("const when = document.getElementById('when'); when.value = when.min; when.dispatchEvent(new Event('input'))")
    cockpit.wait_for("document.body.dataset.time === 'past' && document.body.dataset.control === 'off'")
    assert "past" in cockpit.text("control-note")
    cockpit.hold("w", 0.3)
    cockpit.click("stop")
    assert [c.verb for c in commands(1)] == ["stop"]
    cockpit.press("n")
    cockpit.wait_for("document.body.dataset.control === 'yes'")


def test_plots_show_any_signal_also_of_before_the_page_was_opened(page, robot):
    robot.drive(30)
    page.wait_for("document.getElementById('scan').textContent === '29'")
    page.reload()
    page.run("const choice = document.getElementById('signal-1'); choice.value = 'sigma x'; choice.dispatchEvent(new Event('change'))")
    page.wait_for("document.querySelector('#plots output').textContent === '4 mm (4 to 4)'")
    page.run("const choice = document.getElementById('signal-1'); choice.value = 'count of bad checksum'; choice.dispatchEvent(new Event('change'))")
    page.wait_for("document.querySelector('#plots output').textContent.startsWith('3 ')")
    assert page.run("return document.getElementById('signal-2').options.length") > 20


SIGNALS = {"lines seen": "5 ", "corners seen": "3 ", "maps that are not joined": "2 ", "faults of the wheels": "0 ", "deadline misses": "0 ",
           "beams without": r"\d+ ", "observability ahead": "900 /m²", "observability at its weakest": "100 /m²", "observability of the heading": "40 /rad²",
           "match p99": r"[\d.]+ ms", "all stages worst": r"[\d.]+ ms", "wheels: turn": r"[\d.]+ °/s", "wheels minus scans: speed": r"0.0\d+ m/s",
           "wheels minus scans: turn": r"-?[\d.e-]+ °/s", "count of bad checksum": "3 "}


def choose_each_signal(page):
    for name, said in SIGNALS.items():
        page.run("const choice = document.getElementById('signal-1'); choice.value = arguments[0]; choice.dispatchEvent(new Event('change'))", name)
        page.wait_for(f"/^{said.replace('/', chr(92) + '/')}/.test(document.querySelector('#plots output').textContent)", 30)


def test_plots_show_what_was_seen_counted_and_driven_live_and_of_before(page, robot):
    robot.wheel_scale, robot.observability, robot.maps = 1.2, [900.0, 0.0, 0.0, 100.0, 0.0, 40.0], 2
    pulse = Pulse(0.1, robot.step)
    try:
        page.wait_for("Number(document.getElementById('scan').textContent) > 12")
        choose_each_signal(page)
    finally:
        pulse.stop()
    page.wait_for(f"document.getElementById('scan').textContent === '{robot.scan - 1}'")
    page.reload()
    choose_each_signal(page)
    groups = page.run("return [...document.getElementById('signal-2').children].map((group) => group.label)")
    assert groups == ["pose", "wheels against scans", "maps", "seen", "health", "counts"]


def test_the_occupancy_of_what_was_scanned_is_a_layer(page, robot, pulse):
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    assert page.run("return document.querySelector('[data-layer=occupancy]').ariaPressed") == "false"
    page.wait_for("Number(document.getElementById('scan').textContent) > 20")
    found = page.run("""
        return import("/occupancy.js").then(({ Occupancy }) => {
          const cells = new Occupancy();
          for (const scan of [0, 1, 1, 2, 3]) cells.add(scan, [1.02, 0.02, 0.52, 0.52], [0.02, 0.02], 0, [0, 0, 0]);
          const at = (x, y) => cells.tiles.get(`${Math.floor(x / 3.2)},${Math.floor(y / 3.2)}`)
            ?.cells[(Math.floor(y / 0.05) % 64) * 64 + (Math.floor(x / 0.05) % 64)];
          const seen = [at(1.02, 0.02), at(0.5, 0.02), at(0.52, 0.52), at(0.9, 0.9)];
          cells.add(4, [2, 2], [1.5, 1.5], 0, [0, 0, 0.1]);
          seen.push(at(1.02, 0.02));
          cells.add(5, [2, 2], [1.5, 1.5], 0, [0, 0, 0.5]);
          return [...seen, cells.tiles.size, at(1.02, 0.02)];
        });""")
    assert found[0] == 20 and found[1] < 0 and found[2] > 6 and found[3] == 0
    assert found[4] == 20, "a robot that has driven on, its map turned a little"
    assert found[5] == 1 and found[6] == 0, "a map pose that jumps begins anew"
    page.run("document.querySelector('[data-layer=occupancy]').click()")


def test_keyframes_and_loops_are_a_layer_off_at_first(page, robot, pulse):
    entry = "document.getElementById('graph')"
    page.wait_for("document.getElementById('map-lines').textContent === '12'")
    assert page.run(f"return [{entry}.ariaPressed, {entry}.hasAttribute('data-empty')]") == ["false", True]
    robot.publish_graph(left_out=7)
    page.wait_for(f"!{entry}.hasAttribute('data-empty') && document.getElementById('keyframes').textContent === '22'")
    assert page.text("loops") == "2" and page.text("graph-left-out") == "7"
    let_the_camera_glide(page)
    assert pixels(page, "keyframe")["count"] < 10 and pixels(page, "loop")["count"] < 10, "off at first"
    page.click("graph")
    page.wait_for(f"{entry}.ariaPressed === 'true'")
    let_the_camera_glide(page)
    shown, apart = pixels(page, "keyframe", 25)["count"], pixels(page, "apart")["count"]
    assert shown > 500 and pixels(page, "loop", 40)["count"] > 50
    robot.publish_graph(apart=11, loops=((0, 10, 2),))
    page.wait_for("document.getElementById('loops').textContent === '1'")
    let_the_camera_glide(page)
    assert pixels(page, "apart")["count"] > apart + 150, "in the colour of another map"
    assert pixels(page, "keyframe", 25)["count"] < 0.7 * shown
    page.run(f"{entry}.focus()")
    page.press("Enter")
    page.wait_for(f"{entry}.ariaPressed === 'false'")
    let_the_camera_glide(page)
    assert pixels(page, "keyframe")["count"] < 10


def test_keyframes_of_then_are_shown_then(page, robot):
    robot.drive(10)
    robot.publish_graph(loops=((0, 20, 1),))
    robot.drive(30)
    robot.publish_graph()
    robot.drive(2)
    page.wait_for("document.getElementById('scan').textContent === '41' && document.getElementById('loops').textContent === '2'")
    page.wait_for("Number(document.getElementById('when').max) - Number(document.getElementById('when').min) > 300")
    page.run("const when = document.getElementById('when'); when.value = (Number(when.min) + Number(when.max)) / 2;"
             "when.dispatchEvent(new Event('input'))")
    page.wait_for("document.body.dataset.time === 'past' && document.getElementById('loops').textContent === '1'")
