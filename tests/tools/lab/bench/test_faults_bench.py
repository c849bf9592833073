"""Faults put into drives: each kind does what it says and nothing else, scans are judged by their definition, and those kinds that the
robot survives today it survives."""
import importlib.util
import math
import subprocess
import sys

import pytest

np = pytest.importorskip("numpy")

import alike  # noqa: E402
import faults_table  # noqa: E402
import spoil  # noqa: E402
from at_hand import BUILD, shared  # noqa: E402
from carmen import CarmenLog, wrapped  # noqa: E402
from judge import Told, judged  # noqa: E402

SCANS, STEP_S, BEAMS = 1500, 0.1, 9
AHEAD, ASIDE, TURN = 0.05, 0.002, 0.02
HEAD = "# beam_time_us 97.656 stamp_beam 3\n"
# What is survived today. The rest is in the table of the benchmark.
SURVIVED = ("stall", "swallow", "jump", "reset", "slip", "track", "noise", "blind", "gap", "half", "frozen", "gap-4", "gap-8", "mirror", "backward",
            "every-other", "near", "tail")


def laser_line(kind, k, pose):
    ranges = " ".join(f"{1 + beam + k % 7 / 10:.3f}" for beam in range(BEAMS))
    place = " ".join(f"{value:.6f}" for value in pose)
    stamp = f"{STEP_S * k:.6f}"
    if kind == "FLASER":
        return f"FLASER {BEAMS} {ranges} {place} {place} {stamp} robot {stamp}\n"
    return f"ROBOTLASER1 4 -2.0 4.0 0.5 5.6 0.01 0 {BEAMS} {ranges} 0 {place} {place} 0 0 0 0 0 {stamp} robot {stamp}\n"


def poses():
    place, heading = 1 + 2j, 0.5
    for _ in range(SCANS):
        yield place.real, place.imag, math.remainder(heading, 2 * math.pi)
        place += complex(AHEAD, ASIDE) * complex(math.cos(heading), math.sin(heading))
        heading += TURN


@pytest.fixture(scope="module", params=["FLASER", "ROBOTLASER1"])
def path(request, tmp_path_factory):
    """A drive along an arc, 150 s at 0.5 m/s."""
    file = tmp_path_factory.mktemp("drive") / "drive.log"
    file.write_text(HEAD + "".join(laser_line(request.param, k, pose) for k, pose in enumerate(poses())), encoding="ascii")
    return file


@pytest.fixture
def log(path):
    return CarmenLog(path)


@pytest.fixture
def clean(path):
    return CarmenLog(path)


def all_ranges(log):
    return np.array([log.ranges(k) for k in range(len(log.scans))])


def changed(log, clean):
    """Numbers of the steps of the wheels that are others now."""
    return np.flatnonzero(np.abs(log.steps() - clean.steps()).max(axis=1) > 1e-4)


def test_a_log_that_nothing_is_done_to_goes_out_as_it_was(log, path, tmp_path):
    log.write(tmp_path / "same.log")
    assert (tmp_path / "same.log").read_text() == path.read_text()


@pytest.mark.parametrize("kind", spoil.KINDS)
def test_the_same_seed_spoils_the_same_way_and_touches_wheels_or_scans_alone(kind, log, clean, path):
    left = spoil.spoil(log, kind, 3)
    again = CarmenLog(path)
    assert np.array_equal(spoil.spoil(again, kind, 3).index, left.index)
    assert np.array_equal(log.odometry, again.odometry) and log.scans == again.scans
    assert len(left.index) == len(log.scans) == len(log.stamps) == len(log.odometry)
    if kind in spoil.WHEELS:
        assert log.scans == clean.scans and len(left.index) == SCANS
        assert not np.allclose(log.odometry, clean.odometry)
    elif kind in ("blind", "half", "every-other", "near", "crop", "rough", "jitter"):
        assert np.array_equal(log.odometry, clean.odometry)
        assert log.scans != clean.scans


def test_stalled_wheels_catch_up_at_once(log, clean):
    spoil.spoil(log, "stall", 1)
    held = np.flatnonzero(np.abs(log.odometry - clean.odometry).max(axis=1) > 1e-4)
    assert 10 <= len(held) <= 21 and np.ptp(held) == len(held) - 1
    assert np.allclose(log.odometry[held], clean.odometry[held[0] - 1])


def test_what_is_swallowed_is_never_told(log, clean):
    spoil.spoil(log, "swallow", 1)
    steps = changed(log, clean)
    assert 10 <= len(steps) <= 21 and np.ptp(steps) == len(steps) - 1
    assert np.allclose(log.steps()[steps], 0, atol=1e-4)


@pytest.mark.parametrize("seed", range(5))
def test_one_step_jumps(seed, log, clean):
    spoil.spoil(log, "jump", seed)
    steps = changed(log, clean)
    assert len(steps) == 1
    off = (log.steps() - clean.steps())[steps[0]]
    assert 0.3 <= math.hypot(*off[:2]) <= 1.5
    assert 0.35 <= abs(wrapped(off[2])) <= 2.1


def test_a_reset_begins_at_0_and_goes_on_rightly(log, clean):
    spoil.spoil(log, "reset", 1)
    first = np.flatnonzero(np.abs(log.odometry - clean.odometry).max(axis=1) > 1e-4)[0]
    assert np.allclose(log.odometry[first], 0, atol=1e-6)
    assert list(changed(log, clean)) == [first - 1]


def test_the_sign_of_ahead_is_wrong_for_three_seconds(log, clean):
    spoil.spoil(log, "sign", 1)
    steps = changed(log, clean)
    assert len(steps) == pytest.approx(30, abs=1)
    assert np.allclose(log.steps()[steps], (-AHEAD, ASIDE, TURN), atol=1e-4)


def test_wheels_go_wrong_again_and_again(log, clean):
    left = spoil.spoil(log, "often", 1)
    wrong = changed(log, clean)
    assert len(wrong) and left.after >= wrong[-1]
    apart = np.flatnonzero(np.diff(wrong) * STEP_S > spoil.OFTEN_S[0] - 5) + 1
    assert 1 <= len(apart) <= 4, "in 150 s, 30 to 90 s apart"


def test_one_wheel_slips(log, clean):
    spoil.spoil(log, "slip", 1)
    steps = changed(log, clean)
    assert len(steps) == pytest.approx(20, abs=1)
    half = spoil.TRACK_M / 2
    now, was = log.steps()[steps], clean.steps()[steps]
    wheels = [sorted((now[:, 0] + side * now[:, 2] * half) / (was[:, 0] + side * was[:, 2] * half)) for side in (-1, 1)]
    assert sorted(round(np.mean(shares), 2) for shares in wheels) == [1, 3]


def test_a_scan_after_so_much_of_a_way(log, clean):
    left = spoil.spoil(log, "by-way", 1)
    apart = np.diff(clean.odometry[left.index], axis=0)
    ways, turns = np.hypot(apart[:, 0], apart[:, 1]), np.abs(wrapped(apart[:, 2]))
    reached = (ways >= spoil.BY_WAY_M) | (turns >= spoil.BY_WAY_RAD)
    assert left.index[0] == 0 and reached.all()
    assert ways.max() <= spoil.BY_WAY_M + 2 * AHEAD and turns.max() <= spoil.BY_WAY_RAD + TURN + 1e-9


@pytest.mark.parametrize("kind, late_s", [("late", 0.4), ("stale", 100)])
def test_poses_are_old(kind, late_s, log, clean):
    spoil.spoil(log, kind, 1)
    scans = round(late_s / STEP_S)
    assert np.allclose(wrapped(log.odometry[scans:] - clean.odometry[:-scans]), 0, atol=1e-4)
    assert np.allclose(log.odometry[:scans], clean.odometry[0])


def test_the_whole_way_is_told_too_short_and_every_turn_too_large(log):
    spoil.spoil(log, "track", 1)
    assert np.allclose(log.steps(), (0.85 * AHEAD, ASIDE, 1.25 * TURN), atol=1e-4)


def test_every_step_is_noisy(log, clean):
    spoil.spoil(log, "noise", 1)
    off = log.steps() - clean.steps()
    assert np.std(off[:, 0] / AHEAD) == pytest.approx(0.3, rel=0.1)
    assert np.std(off[:, 2]) == pytest.approx(0.03, rel=0.1)


@pytest.mark.parametrize("kind, told", [
    ("frozen", lambda x, y, heading: (0, 0, 0)),
    ("mirrored", lambda x, y, heading: (x, -y, -heading)),
    ("degrees", lambda x, y, heading: (x, y, math.degrees(heading))),
    ("millimetres", lambda x, y, heading: (1000 * x, 1000 * y, heading)),
])
def test_wheels_lie_for_the_whole_drive(kind, told, log, clean, tmp_path):
    spoil.spoil(log, kind, 1)
    log.write(tmp_path / "spoilt.log")
    assert np.allclose(CarmenLog(tmp_path / "spoilt.log").odometry, [told(*pose) for pose in clean.odometry], atol=1e-5)


def test_a_short_drive_has_no_wheels_that_are_100_s_old(log):
    log.keep(np.arange(1000))
    assert not spoil.fits(log, "stale") and spoil.fits(log, "late")


def test_blind_has_no_echo_and_half_something_near_on_the_left(log, clean, path):
    spoil.spoil(log, "blind", 1)
    blind = np.flatnonzero(np.isnan(all_ranges(log)).any(axis=1))
    assert 10 <= len(blind) <= 21 and np.isnan(all_ranges(log)[blind]).all()
    half = CarmenLog(path)
    spoil.spoil(half, "half", 1)
    hung = np.flatnonzero((all_ranges(half) != all_ranges(clean)).any(axis=1))
    assert len(hung) == pytest.approx(40, abs=1)
    assert np.allclose(all_ranges(half)[hung, BEAMS // 2:], 0.3, atol=0.03)
    assert np.array_equal(all_ranges(half)[:, :BEAMS // 2], all_ranges(clean)[:, :BEAMS // 2])


@pytest.mark.parametrize("kind, least_s, most_s", [("gap", 1, 2), ("dark", 1, 2), ("carried", 10, 40)]
                         + [(kind, float(kind[kind.index("-") + 1:]), float(kind[kind.index("-") + 1:])) for kind in spoil.OUTAGES])
def test_scans_are_away_and_wheels_know_of_it_or_not(kind, least_s, most_s, log, clean):
    left = spoil.spoil(log, kind, 1)
    away_s = np.diff(log.stamps).max()
    assert least_s - STEP_S < away_s < most_s + 2 * STEP_S
    assert np.diff(log.stamps).argmax() == left.after - 1
    assert np.array_equal(log.stamps, clean.stamps[left.index])
    told_m = np.hypot(*log.steps()[left.after - 1, :2])
    driven_m = np.abs(complex(*(clean.odometry[left.index[left.after], :2] - clean.odometry[left.after - 1, :2])))
    if kind.startswith("gap"):
        assert told_m == pytest.approx(driven_m, abs=1e-4)
    else:
        assert told_m <= AHEAD * 1.01  # the step before, at most


def test_a_drive_told_otherwise_twice_is_as_it_was(path, clean):
    for kind in ("mirror", "backward"):
        log = CarmenLog(path)
        for _ in range(2):
            spoil.spoil(log, kind, 1)
        assert log.scans == clean.scans and np.allclose(log.odometry, clean.odometry) and np.allclose(log.stamps, clean.stamps)


def test_a_swept_scan_told_otherwise_was_swept_the_other_way_round(log, path):
    spoil.spoil(log, "mirror", 1)
    assert log.comments == [f"# beam_time_us -97.656 stamp_beam {BEAMS - 1 - 3}\n"]
    backward = CarmenLog(path)
    spoil.spoil(backward, "backward", 1)
    assert backward.comments == ["# beam_time_us -97.656 stamp_beam 3\n"]
    assert (np.diff(backward.stamps) > 0).all()


def test_one_drive_follows_another_and_the_wheels_know_nothing_of_the_way_between(path, clean, tmp_path):
    other = CarmenLog(path)
    other.keep(np.arange(700, 900))
    other.write(tmp_path / "other.log")
    both = CarmenLog(path)
    both.then(CarmenLog(tmp_path / "other.log"), 25)
    left = spoil.carry(both, SCANS, SCANS)
    assert left.after == SCANS and len(left.index) == len(both.scans) == SCANS + 200
    assert both.stamps[SCANS] - both.stamps[SCANS - 1] == pytest.approx(25)
    assert np.allclose(both.steps()[SCANS - 1], 0, atol=1e-5)
    assert np.allclose(np.delete(both.steps(), SCANS - 1, axis=0), (AHEAD, ASIDE, TURN), atol=1e-5)


def test_the_truth_is_told_as_the_drive(log):
    left = spoil.spoil(log, "mirror", 1)
    places, headings = left.told(np.arange(SCANS) * (1 + 2j), np.full(SCANS, 0.5))
    assert places[3] == 3 - 6j and headings[3] == -0.5
    assert np.array_equal(spoil.Spoilt(np.array([4, 2])).told(np.arange(5) + 0j, np.zeros(5))[0], [4, 2])


def test_a_queue_holds_scans_up_and_lets_many_go_at_once(log, clean):
    left = spoil.spoil(log, "queued", 1)
    late = log.stamps - clean.stamps
    assert np.array_equal(left.index, np.arange(SCANS)) and np.array_equal(log.odometry, clean.odometry) and log.scans == clean.scans
    assert late.min() >= 0 and 0.5 < late.max() <= 1.5
    assert np.mean(np.diff(log.stamps) == 0) > 0.5 and np.any(np.diff(log.stamps) < 0)


def test_fewer_and_rougher_ranges(path, clean):
    was = all_ranges(clean)
    now = {}
    for kind in ("every-other", "near", "crop", "rough", "jitter"):
        log = CarmenLog(path)
        spoil.spoil(log, kind, 1)
        now[kind] = all_ranges(log)
        left = ~np.isnan(now[kind])
        assert kind in ("rough", "jitter") or np.array_equal(now[kind][left], was[left])
    assert np.array_equal(np.isnan(now["every-other"]), np.broadcast_to(np.arange(BEAMS) % 2 == 1, was.shape))
    assert np.array_equal(np.isnan(now["near"]), was > 8)
    assert np.array_equal(np.isnan(now["crop"]), np.broadcast_to(np.abs(clean.bearings()) > math.radians(60), was.shape))
    assert np.std((now["rough"] - was) / (0.01 + 0.01 * was)) == pytest.approx(1, rel=0.05)
    assert np.std(now["jitter"] - was) == pytest.approx(0.004, rel=0.05)


def test_faults_are_those_of_the_script_beside_the_project(tmp_path):
    """Kind by kind and seed by seed the same drive, to a micrometre."""
    script = shared("bench/slam/faults.py")
    spec = importlib.util.spec_from_file_location("the_definition", script)
    definition = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(definition)
    path = shared("data/corrected/freiburg-101.clf.gz")
    for kind in definition.KINDS[1:]:
        theirs, ours = definition.Log(str(path)), CarmenLog(path)
        index = definition.spoil(theirs, kind, 2)
        assert np.array_equal(spoil.spoil(ours, kind, 2).index, index), kind
        theirs.write(tmp_path / "theirs.log")
        ours.write(tmp_path / "ours.log")
        theirs, ours = CarmenLog(tmp_path / "theirs.log"), CarmenLog(tmp_path / "ours.log")
        assert np.allclose(ours.odometry, theirs.odometry, atol=3e-6), kind
        assert np.array_equal(all_ranges(ours), all_ranges(theirs), equal_nan=True), kind


def told(off_m=0.0, turn=0.0, state=2, predicted=False, sigma=0.01, map_id=None):
    """Twenty scans of a straight drive, of which the last ten are so."""
    true = np.arange(20) * 0.1 + 0j
    late = np.arange(20) >= 10
    rows = [{"state": state if bad else 2, "predicted": predicted and bool(bad), "cov": np.diag([sigma ** 2] * 3).ravel().tolist(),
             **({"map_id": map_id if bad else 0} if map_id is not None else {})} for bad in late]
    turned = np.exp(0.7j)  # the map begins elsewhere
    return Told((true + 1j * off_m * late) * turned + 5, (true + 1j * off_m * late) * turned + 5, turn * late + 0.7, rows, true, np.zeros(20),
                np.arange(20) * 0.1)


@pytest.mark.parametrize("how, wrong, silent", [
    ({}, 0, 0),
    ({"off_m": 0.29}, 0, 0),
    ({"off_m": 0.31}, 10, 10),
    ({"off_m": -0.31}, 10, 10),
    ({"off_m": 0.31, "sigma": 0.05}, 10, 0),
    ({"off_m": 0.31, "state": 1}, 0, 0),
    ({"off_m": 0.31, "predicted": True}, 0, 0),
    ({"turn": math.radians(9.9)}, 0, 0),
    ({"turn": math.radians(-10.1)}, 10, 10),
    ({"turn": math.radians(10.1), "sigma": 0.04}, 10, 0),
])
def test_a_scan_is_wrong_and_silent_by_definition(how, wrong, silent):
    row = judged(told(**how), 0)
    assert (row["wrong"], row["silent"]) == (wrong, silent)


def test_drives_end_lost_or_far_off():
    assert not judged(told(off_m=0.2), 0)["end"]
    assert judged(told(off_m=0.4, state=1), 0)["end"]
    assert judged(told(state=0), 0)["end"] and judged(told(state=0), 0)["lost"] == 10


def test_good_scans_a_little_off_and_scans_in_another_map_are_counted():
    assert judged(told(off_m=0.16), 0)["good_off"] == 10
    assert judged(told(off_m=0.16, state=1), 0)["good_off"] == 0
    row = judged(told(map_id=1), 0)
    assert (row["other_map"], row["ends_in_other"]) == (10, True)
    assert judged(told(), 0)["other_map"] == 0


def test_a_drive_has_joined_when_it_is_good_and_right_after_a_known_place():
    assert judged(told(), 10)["joined_s"] == 0
    assert judged(told(state=1), 10)["joined_s"] == math.inf
    assert judged(told(state=1), 5)["joined_s"] == 0
    elsewhere = told()
    elsewhere.true_places = elsewhere.true_places + 50 * (np.arange(20) >= 10)
    assert judged(elsewhere, 10)["joined_s"] is None


def test_rooms_alike_are_furnished_alike():
    first, second = ({tuple(round(v - (west if k % 2 == 0 else 0), 6) for k, v in enumerate(wall)) for wall in alike.room_walls(west)}
                     for west in alike.ROOMS_AT)
    assert first == second and len(first) > 10


@pytest.mark.parametrize("room", [0, 1])
def test_the_robot_is_carried_from_the_end_of_the_corridor_into_a_room_that_it_has_seen(room):
    corners = np.array([complex(*point) for point in alike.way(room)])
    places = np.concatenate([np.linspace(a, b, 50) for a, b in zip(corners, corners[1:])])
    first, last = alike.cut(places, room)
    middle = complex(alike.ROOMS_AT[room] + alike.ROOM_MIDDLE[0], alike.ROOM_MIDDLE[1])
    assert abs(places[first] - complex(*alike.EAST_END)) < 0.5 and abs(places[last] - middle) < 0.8
    for west in alike.ROOMS_AT:
        assert np.abs(places[:first] - complex(west + alike.ROOM_MIDDLE[0], alike.ROOM_MIDDLE[1])).min() < 0.1


def bench(*words):
    return subprocess.run([sys.executable, faults_table.__file__, "--build", BUILD, "--shared", "", "--jobs", "1", *words], check=False,
                          capture_output=True, text=True)


def cells_of(done):
    assert done.returncode == 0, done.stderr
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines() if line.startswith("|")]


def rows_of(done):
    return {row[0]: row[1:] for row in reversed(cells_of(done))}  # of a kind in both tables the first


def rows_after(done):
    return {row[0]: row[1:] for row in cells_of(done)}  # the second


def test_the_home_is_survived_and_no_scan_is_silently_wrong():
    done = bench("--only", "home", "--seeds", "1", "--kinds", ",".join(SURVIVED))
    print(done.stdout)
    rows = rows_of(done)
    assert set(SURVIVED) < set(rows)
    runs, _, _, within, _, silent, lost, ends = rows["all"]
    assert int(runs) == len(SURVIVED)
    assert (within, silent, ends) == (runs, "0", "0")


def test_in_darkness_driven_on_unseen_by_dead_wheels_the_robot_is_never_wrong_while_good():
    """Where the scans begin again, half of what they show lies on the map at the old place, too."""
    for seed in ("5", "9"):
        rows = rows_of(bench("--only", "office", "--seeds", seed, "--kinds", "dark-4"))
        assert rows["dark-4"][0] == "1" and rows["dark-4"][4] == "0"


def test_where_nobody_watched_a_place_that_looks_alike_is_not_taken_unless_the_last_scan_confirms_it():
    rows = rows_of(bench("--only", "arena", "--seeds", "14", "--kinds", "dark-4"))
    assert rows["dark-4"][0] == "1" and rows["dark-4"][5] == "0", rows


def test_wheels_that_tell_of_long_ago_and_now_and_then_rightly_do_not_lead_the_robot_astray():
    rows = rows_of(bench("--shared", str(shared("bench").parent), "--only", "maze-real", "--seeds", "22", "--kinds", "stale"))
    assert rows["stale"][0] == "1" and rows["stale"][5] == "0", rows


def test_a_map_of_a_place_that_only_looks_alike_is_not_joined_where_the_way_would_have_led_through_walls():
    done = bench("--shared", str(shared("bench").parent), "--only", "maze", "--seeds", "6", "--kinds", "dark-8")
    rows = rows_of(done)
    assert int(rows["dark-8"][0]) >= 1 and rows["dark-8"][4] == "0"


@pytest.mark.parametrize("run, seed, kind", [("maze-bent", 10, "dark-10"), ("maze", 12, "dark")])
def test_where_nobody_watched_a_few_walls_alike_nearby_prove_no_place(run, seed, kind):
    rows = rows_of(bench("--shared", str(shared("bench").parent), "--only", run, "--seeds", str(seed), "--kinds", kind))
    assert int(rows[kind][0]) >= 1 and rows[kind][5] == "0", rows


@pytest.mark.parametrize("seed, kind", [(9, "gap-10"), (10, "gap-12")])
def test_wheels_that_have_told_of_the_way_tell_equal_rooms_apart(seed, kind):
    rows = rows_of(bench("--only", "office", "--seeds", str(seed), "--kinds", kind))
    assert rows[kind][0] == "1" and rows[kind][3] == "1" and rows[kind][5] == "0", rows


def test_carried_into_a_room_like_another_the_robot_is_never_wrong_while_good():
    rows = rows_of(bench("--only", "alike", "--seeds", "1,2"))
    runs, _, _, _, wrong, silent, _, ends = rows["alike"]
    assert (runs, wrong, silent, ends) == ("2", "0", "0", "0")


@pytest.mark.parametrize("seed", [202, 204])
def test_a_robot_that_was_carried_is_put_in_its_place_after_the_drive_by_what_nothing_else_resembles(seed):
    """It comes back to what it knows for the last three metres."""
    rows = rows_of(bench("--only", "home", "--seeds", str(seed), "--kinds", "carried"))
    assert rows["carried"][0] == "1" and rows["carried"][3] == "1", rows


def test_ground_that_resembles_the_other_side_of_the_building_for_seventeen_metres_is_not_taken_for_it():
    """The office is nearly the same after half a turn: recesses are, but not where they are."""
    rows = rows_after(bench("--only", "office", "--seeds", "206", "--kinds", "carried"))
    assert rows["carried"][0] == "1" and rows["carried"][-1] == "1", rows


def test_carried_elsewhere_in_the_home_the_robot_is_never_wrong_while_good():
    rows = rows_of(bench("--only", "home", "--seeds", "1", "--kinds", "elsewhere,unknown", "--carried", "1"))
    assert rows["all"][0] == "2" and rows["all"][4] == "0"


@pytest.mark.parametrize("words, status, part", [
    (["--seeds", "one"], 2, "--seeds one"),
    (["--kinds", "gap,fire"], 2, "--kinds fire"),
    (["--carried", "-1"], 2, "--carried"),
    (["--only", "palace"], 1, "no drive here for palace"),
    (["--build", "absent"], 1, "no programs in absent/bin"),
])
def test_wrong_use_is_told_in_words(words, status, part):
    done = bench(*words)
    assert done.returncode == status
    assert part in done.stderr and "Traceback" not in done.stderr
