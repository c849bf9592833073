"""ale-replay as its users meet it: files in, files out, exit codes."""
import gzip
import hashlib
import json
import math
import random
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import ale
import lcm
import pytest

from at_hand import BINARIES, ROOT, shared

MAP_SCORE = ROOT / "tools/lab/bench/map_score.py"
REPLAY = BINARIES / "ale-replay"
STEP = 2 * math.pi / 1024
BEAMS = 682
ROOM = (-2.0, -1.5, 2.5, 1.7)  # left, bottom, right, top


def replay(*arguments, code=0):
    done = subprocess.run([REPLAY, *map(str, arguments)], capture_output=True, text=True, timeout=180, check=False)
    assert done.returncode == code, done.stderr
    return done


def distance_to_wall(x, y, bearing):
    dx, dy = math.cos(bearing), math.sin(bearing)
    along = [((ROOM[2] if dx > 0 else ROOM[0]) - x) / dx if abs(dx) > 1e-12 else 1e9,
             ((ROOM[3] if dy > 0 else ROOM[1]) - y) / dy if abs(dy) > 1e-12 else 1e9]
    return min(along)


def scan_line(t, x, y, theta, ahead=0.0):
    """ROBOTLASER1 of a laser `ahead` of the robot's centre in the rectangular room."""
    laser_x, laser_y = x + ahead * math.cos(theta), y + ahead * math.sin(theta)
    ranges = [distance_to_wall(laser_x, laser_y, theta + (k - 340) * STEP) for k in range(BEAMS)]
    return (f"ROBOTLASER1 4 {-340 * STEP:.9f} {681 * STEP:.9f} {STEP:.9f} 5.6 0.01 0 {BEAMS} "
            + " ".join(f"{r:.3f}" for r in ranges)
            + f" 0 {laser_x:.6f} {laser_y:.6f} {theta:.6f} {x:.6f} {y:.6f} {theta:.6f} 0 0 0 0 0 {t:.6f} made {t:.6f}\n")


def way(k):
    """A slow arc: 0.02 m and 0.01 rad a scan."""
    theta = 0.01 * k
    return 2 * math.sin(theta), 2 * (1 - math.cos(theta)), theta


@pytest.fixture(scope="module")
def room_log(tmp_path_factory):
    path = tmp_path_factory.mktemp("room") / "room.log"
    path.write_text("".join(scan_line(10 + 0.1 * k, *way(k), ahead=0.1) for k in range(60)))
    return path


def read_json_lines(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def read_tum(path):
    return [[float(word) for word in line.split()] for line in path.read_text().splitlines()]


@pytest.mark.parametrize("arguments", [[], ["a.log", "b.log"], ["a.log", "--unknown"], ["a.log", "--frame", "sensor"],
                                       ["a.log", "--odometry", "maybe"], ["a.log", "--sensor", "1,2"],
                                       ["a.log", "--sensor", "1,2,7"], ["a.log", "--map", "map.jpeg"],
                                       ["a.log", "--lines-only", "--poses", "p.jsonl"], ["a.log", "--features", ""]])
def test_wrong_use_is_told_in_one_line_and_ends_with_2(arguments):
    done = replay(*arguments, code=2)
    assert len(done.stderr.strip().splitlines()) == 1 and done.stdout == ""


def test_what_cannot_be_read_is_told_in_one_line_and_ends_with_1(tmp_path):
    (tmp_path / "empty").touch()
    (tmp_path / "text").write_text("nothing of that kind\n")
    (tmp_path / "odometry").write_text("ODOM 0 0 0 0 0 0 1 h 1\n")
    for name, reason in (("absent", "No such file"), ("empty", "is empty"), ("text", "known format"),
                         ("odometry", "without a scan"), (".", "is a directory")):
        done = replay(tmp_path / name, code=1)
        assert reason in done.stderr and len(done.stderr.strip().splitlines()) == 1


def test_results_that_cannot_be_written_end_with_1(room_log, tmp_path):
    assert "No such file" in replay(room_log, "--trajectory", tmp_path / "no/such.tum", code=1).stderr
    assert "No space left" in replay(room_log, "--features", "/dev/full", code=1).stderr


def test_a_log_that_the_disk_did_not_take_whole_ends_with_1(room_log, tmp_path):
    """A limit on the size of files takes the place of a full disk."""
    out = tmp_path / "sent.lcm"
    done = subprocess.run(["sh", "-c", 'trap "" XFSZ; ulimit -f 20; exec "$@"', "sh", REPLAY, room_log, "--lcm", out], capture_output=True, text=True,
                          timeout=180, check=False)
    assert done.returncode == 1 and done.stderr == f"ale-replay: {out}: not all of it could be written; is the disk full?\n"


def test_a_bad_configuration_ends_with_2_and_names_file_and_key(room_log, tmp_path):
    config = tmp_path / "robot.ini"
    config.write_text("[sensor]\nnonsense = 1\n")
    stderr = replay(room_log, "--config", config, code=2).stderr
    assert "robot.ini" in stderr and "nonsense" in stderr


def test_features_lie_on_the_walls_of_the_room(room_log, tmp_path):
    out = tmp_path / "features.jsonl"
    replay(room_log, "--lines-only", "--features", out)
    scans = read_json_lines(out)
    assert [s["scan"] for s in scans] == list(range(60))
    assert [s["t"] for s in scans] == pytest.approx([10 + 0.1 * k for k in range(60)], abs=1e-6)
    for k, scan in enumerate(scans):
        x, y, theta = way(k)
        x, y = x + 0.1 * math.cos(theta), y + 0.1 * math.sin(theta)
        assert 2 <= len(scan["lines"]) <= 5
        assert set(scan) >= {"scan", "t", "lines", "corners", "curves", "refused"}
        for line in scan["lines"]:
            for end in ("1", "2"):
                ex, ey = line["x" + end], line["y" + end]
                wx, wy = x + ex * math.cos(theta) - ey * math.sin(theta), y + ex * math.sin(theta) + ey * math.cos(theta)
                off = min(abs(wx - ROOM[0]), abs(wx - ROOM[2]), abs(wy - ROOM[1]), abs(wy - ROOM[3]))
                assert off < 0.005, (k, line)
                normal = ex * math.cos(line["alpha"]) + ey * math.sin(line["alpha"])
                assert normal == pytest.approx(line["rho"], abs=2e-6)
            assert len(line["cov"]) == 3 and line["rmse"] < 0.002 and 0 <= line["first"] < line["last"] < BEAMS
        for corner in scan["corners"]:
            assert corner["kind"] == "concave" and corner["angle"] == pytest.approx(math.pi / 2, abs=0.01)
            assert 0 <= corner["first_line"] < len(scan["lines"])


def test_extraction_alone_and_in_the_pipeline_agree_on_whole_scans_at_rest(tmp_path):
    log = tmp_path / "rest.log"
    log.write_text("".join(scan_line(0.1 * k, 0, 0, 0) for k in range(5)))
    replay(log, "--lines-only", "--features", tmp_path / "a.jsonl")
    replay(log, "--features", tmp_path / "b.jsonl")
    first, second = read_json_lines(tmp_path / "a.jsonl")[0], read_json_lines(tmp_path / "b.jsonl")[0]
    assert first["lines"] == second["lines"]


@pytest.mark.parametrize("odometry", ["on", "off"])
def test_the_trajectory_is_the_way_driven(room_log, tmp_path, odometry):
    replay(room_log, "--odometry", odometry, "--trajectory", tmp_path / "t.tum", "--trajectory-live", tmp_path / "live.tum",
           "--poses", tmp_path / "p.jsonl")
    poses = read_tum(tmp_path / "t.tum")
    live = read_tum(tmp_path / "live.tum")
    assert len(poses) == len(live) == 60
    for k, (t, x, y, z, qx, qy, qz, qw) in enumerate(poses):
        expected = way(k)
        assert t == pytest.approx(10 + 0.1 * k, abs=1e-6) and z == qx == qy == 0
        assert math.hypot(x - expected[0], y - expected[1]) < 0.01
        assert 2 * math.atan2(qz, qw) == pytest.approx(expected[2], abs=0.005)
        assert math.hypot(qz, qw) == pytest.approx(1, abs=1e-8)
    for k, pose in enumerate(read_json_lines(tmp_path / "p.jsonl")):
        assert pose["scan"] == k and len(pose["cov"]) == 9 and len(pose["information"]) == 6
        assert pose["state"] in (0, 1, 2) and {"x", "y", "theta", "map_x", "map_y", "map_theta", "lag_us"} <= set(pose)
        assert pose["map_x"] == live[k][1]
        assert list(pose.items())[-3:] == [("map_id", 0), ("maps", 1), ("wheel_fault", "fine")]


def graphs_of(log, folder, *words):
    """[(time, message)] of ALE_GRAPH; trajectories as known then, and in the end."""
    replay(log, "--lcm", folder / "sent.lcm", "--trajectory-live", folder / "live.tum", "--trajectory", folder / "end.tum", *words)
    sent = lcm.EventLog(str(folder / "sent.lcm"), "r")
    graphs = [(event.timestamp, ale.graph_t.decode(event.data)) for event in sent if event.channel == "ALE_GRAPH"]
    return graphs, read_tum(folder / "live.tum"), read_tum(folder / "end.tum")


def furthest(graph, trajectory):
    return max(math.dist((x, y), trajectory[scan][1:3]) for scan, x, y in zip(graph.scan, graph.x, graph.y))


def test_keyframes_are_sent_where_they_lie_as_they_come_and_in_the_end(tmp_path):
    graphs, live, end = graphs_of(ROOT / "tests/digest/apartment.log.gz", tmp_path)
    *on_the_way, (last_us, last) = graphs
    assert len(on_the_way) > 8 and all(graph.utime == at for at, graph in graphs)
    assert all(b - a >= 1000000 for (a, _), (b, _) in zip(on_the_way, on_the_way[1:]))
    assert all(a.version < b.version for (_, a), (_, b) in zip(graphs, graphs[1:]))
    assert max(furthest(graph, live) for _, graph in on_the_way) < 1e-6, "no loop has moved them"
    assert last_us == round(end[-1][0] * 1e6) and furthest(last, end) < 0.01
    assert last.scan == tuple(sorted(last.scan)) and last.num_loops > 0 and {0} == set(last.map_id)
    assert graphs_of(ROOT / "tests/digest/apartment.log.gz", tmp_path, "--loops", "off")[0] == []


def test_a_loop_is_sent_when_it_is_closed(tmp_path):
    graphs, _, _ = graphs_of(shared("data/urg04lx/exp1.dat"), tmp_path)
    first = next(k for k, (_, graph) in enumerate(graphs) if graph.num_loops)
    assert 0 < first < len(graphs) - 2 and 1 in graphs[first][1].loop_kind


def test_a_graph_that_does_not_change_is_sent_again_every_ten_seconds(tmp_path):
    still = scan_line(10, 0, 0, 0)
    (tmp_path / "still.log").write_text("".join(still.replace(" 10.000000 made 10.000000", f" {10 + k / 10} made {10 + k / 10}") for k in range(250)))
    times = [at for at, _ in graphs_of(tmp_path / "still.log", tmp_path)[0]]
    assert [b - a for a, b in zip(times, times[1:])][:2] == [pytest.approx(10000000, abs=200000)] * 2


def with_echoes(log, told, has_echo):
    """The log told with beams that have no echo. FLASER n ranges.., ROBOTLASER1 with n behind eight words."""
    with gzip.open(log, "rt") as lines, open(told, "w") as out:
        for line in lines:
            words = line.split()
            if words[0] in ("FLASER", "ROBOTLASER1"):
                first = 2 if words[0] == "FLASER" else 9
                for k in range(int(words[first - 1])):
                    words[first + k] = words[first + k] if has_echo(k) else "0"
            out.write(" ".join(words) + "\n")


@pytest.mark.parametrize("name", ["tests/digest/apartment.log.gz", "corrected/freiburg-101.clf.gz"])
@pytest.mark.parametrize("pattern", ["every other", "half at random"])
def test_half_of_the_echoes_are_enough(name, pattern, tmp_path):
    log = ROOT / name if name.startswith("tests") else shared("data") / name
    chance = random.Random(7)
    with_echoes(log, tmp_path / "half.log", (lambda k: k % 2) if pattern == "every other" else lambda k: chance.random() < 0.5)
    replay(log, "--trajectory", tmp_path / "all.tum")
    replay(tmp_path / "half.log", "--trajectory", tmp_path / "half.tum", "--poses", tmp_path / "half.jsonl")
    apart = [math.dist(a[1:3], b[1:3]) for a, b in zip(read_tum(tmp_path / "all.tum"), read_tum(tmp_path / "half.tum"))]
    assert math.sqrt(sum(d * d for d in apart) / len(apart)) < 0.3
    assert all(pose["state"] > 0 for pose in read_json_lines(tmp_path / "half.jsonl"))


def test_the_frame_of_the_laser_is_ahead_of_the_robots(room_log, tmp_path):
    replay(room_log, "--trajectory", tmp_path / "robot.tum")
    replay(room_log, "--trajectory", tmp_path / "laser.tum", "--frame", "laser")
    for robot, laser in zip(read_tum(tmp_path / "robot.tum"), read_tum(tmp_path / "laser.tum")):
        theta = 2 * math.atan2(robot[6], robot[7])
        assert laser[1] == pytest.approx(robot[1] + 0.1 * math.cos(theta), abs=3e-6)
        assert laser[2] == pytest.approx(robot[2] + 0.1 * math.sin(theta), abs=3e-6)


def test_the_mounting_on_the_command_line_goes_before_the_logs(room_log, tmp_path):
    replay(room_log, "--trajectory", tmp_path / "laser.tum", "--frame", "laser", "--sensor", "0.5,-0.25,1.570796327")
    _, x, y, *_, qz, qw = read_tum(tmp_path / "laser.tum")[0]
    assert (x, y) == pytest.approx((0.5, -0.25), abs=1e-6) and 2 * math.atan2(qz, qw) == pytest.approx(math.pi / 2)


def test_timing_has_a_line_a_scan_and_its_parts_make_the_whole(room_log, tmp_path):
    replay(room_log, "--timing", tmp_path / "t.csv")
    header, *rows = (tmp_path / "t.csv").read_text().splitlines()
    assert header == "scan,deskew_ns,smooth_ns,extract_ns,match_ns,map_ns,total_ns" and len(rows) == 60
    for row in rows:
        _, *parts, total = map(int, row.split(","))
        assert 0 < sum(parts) <= total


def test_maps_of_every_kind_are_written_and_well_formed(room_log, tmp_path):
    names = [tmp_path / f"map.{kind}" for kind in ("png", "svg", "dxf", "pgm")]
    replay(room_log, "--points", *(word for name in names for word in ("--map", name)))
    assert names[0].read_bytes().startswith(b"\x89PNG")
    root = ElementTree.parse(names[1]).getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg" and len(root.get("viewBox").split()) == 4
    assert {g.get("id") for g in root} >= {"grid", "points", "walls", "trajectory", "start", "end"}
    assert names[2].read_text().endswith("EOF\n") and names[3].read_bytes().startswith(b"P5\n")
    assert "resolution: 0.05" in (tmp_path / "map.yaml").read_text()


def test_an_occupancy_grid_has_the_resolution_that_was_asked_for(room_log, tmp_path):
    sides = []
    for metres in ("0.1", "0.025"):
        replay(room_log, "--map", tmp_path / "map.pgm", "--map-resolution", metres)
        assert f"resolution: {metres}\n" in (tmp_path / "map.yaml").read_text()
        sides.append([int(word) - 20 for word in (tmp_path / "map.pgm").read_bytes().split(b"\n")[1].split()])
    assert [fine / coarse for fine, coarse in zip(*sides[::-1])] == [pytest.approx(4, rel=0.1)] * 2
    for words in (("--map-resolution", "0.1"), ("--map", tmp_path / "map.pgm", "--map-resolution", "0")):
        refused = replay(room_log, *words, code=2)
        assert "--map-resolution" in refused.stderr and refused.stderr.count("\n") == 1


def test_a_saved_map_can_be_started_from(room_log, tmp_path):
    replay(room_log, "--save-map", tmp_path / "a.map")
    text = (tmp_path / "a.map").read_text()
    assert text.startswith("ALE-SLAM map 1\n") and text.count("\nwall ") >= 3
    done = replay(room_log, "--load-map", tmp_path / "a.map", "--poses", tmp_path / "p.jsonl")
    states = [pose["state"] for pose in read_json_lines(tmp_path / "p.jsonl")]
    assert len(states) == 60 and 0 in states
    assert f"lost in {states.count(0)} scans, its pose weak in {states.count(1)}" in done.stderr
    (tmp_path / "a.map").write_text(text.replace("wall", "well", 1))
    assert "a.map: line" in replay(room_log, "--load-map", tmp_path / "a.map", code=1).stderr


def walls_in(path):
    return path.read_text().count("\nwall ")


def pairs_twice(drawn):
    score = subprocess.run([sys.executable, MAP_SCORE, drawn], capture_output=True, text=True, check=True).stdout
    return int(score.split("standing twice: ")[1].split()[0])


# The map of exp3 has its right wall in two parts, 35 cm apart where they overlap: a centimetre decides whether that is a pair.
@pytest.mark.parametrize("name, pairs", [("exp1.dat", 1), ("exp3.dat", 3)])
def test_a_map_that_is_driven_in_again_and_again_does_not_fill_up(name, pairs, tmp_path):
    log = shared(f"data/urg04lx/{name}")
    replay(log, "--save-map", tmp_path / "0.map")
    for k in range(3):
        replay(log, "--load-map", tmp_path / f"{k}.map", "--save-map", tmp_path / f"{k + 1}.map",
               "--map", tmp_path / "again.dxf")
    walls = walls_in(tmp_path / "0.map")
    assert abs(walls_in(tmp_path / "3.map") - walls) < 0.15 * walls
    assert pairs_twice(tmp_path / "again.dxf") <= pairs


NOT_FOUND = pytest.mark.xfail(strict=True, reason="of the drive through test_lab nine nodes agree on its place in the map of exp1, and twelve are asked for")


# One of exp3's pairs is its right wall, as above.
@pytest.mark.parametrize("name, pairs", [("exp3.dat", 2), pytest.param("test_lab.dat", 1, marks=NOT_FOUND)])
def test_the_map_of_one_drive_is_found_by_others_through_the_same_room(name, pairs, tmp_path):
    replay(shared("data/urg04lx/exp1.dat"), "--save-map", tmp_path / "exp1.map")
    done = replay(shared(f"data/urg04lx/{name}"), "--load-map", tmp_path / "exp1.map", "--map", tmp_path / "both.dxf")
    assert "a map that was begun anew was joined to an older one" in done.stderr
    assert pairs_twice(tmp_path / "both.dxf") <= pairs


def digest(log, folder, *arguments):
    folder.mkdir()
    names = {"--features": "f", "--poses": "p", "--trajectory": "t", "--trajectory-live": "l", "--save-map": "m",
             "--map": "map.png"}
    replay(log, *(str(x) for option, name in names.items() for x in (option, folder / name)), *arguments)
    return [hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in names.values()]


def test_the_same_log_gives_the_same_bytes_packed_or_not(room_log, tmp_path):
    packed = tmp_path / "room.gz"
    packed.write_bytes(gzip.compress(room_log.read_bytes()))
    assert digest(room_log, tmp_path / "a") == digest(room_log, tmp_path / "b") == digest(packed, tmp_path / "c")


def test_bad_lines_are_counted_and_the_last_is_named(room_log, tmp_path):
    log = tmp_path / "cut.log"
    log.write_text(room_log.read_text()[:-3000])
    done = replay(log, "--trajectory", "-")
    assert len(done.stdout.splitlines()) == 59
    assert "59 scans" in done.stderr and f"{log}: line 60" in done.stderr


def test_recordings_of_a_real_rover_have_a_pose_for_every_scan(tmp_path):
    replay(shared("data/urg04lx/exp1.dat"), "--trajectory", tmp_path / "t.tum")
    poses = read_tum(tmp_path / "t.tum")
    assert len(poses) == 756
    assert poses[0][:3] == [212.387282, 0, 0] and poses[-1][0] == 287.007421
    steps = [math.dist(a[1:3], b[1:3]) / max(b[0] - a[0], 0.05) for a, b in zip(poses, poses[1:])]
    assert max(steps) < 4, "no faster than the rover"
