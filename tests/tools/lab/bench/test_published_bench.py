"""The published benchmark: errors of relations as they are defined, and the first minutes of ACES as everybody downloads them."""
import bz2
import math
import subprocess
import sys

import pytest

np = pytest.importorskip("numpy")

import published_table  # noqa: E402
from at_hand import BUILD, shared  # noqa: E402
from slam_table import Bench, read_tum, score  # noqa: E402

FIRST_SCANS = 1500
WORST_MEAN_M = 0.05  # of the first relations
OF_CORRIDOR_M = 2  # with noise on the ranges; gmapping's poses, over 1.9 km
OF_BELGIOIOSO_M = 0.2  # gmapping's poses; 0.45 to 0.50 with the scale that was learnt from noise


def trajectory(*poses):
    """A pose a second."""
    x, y, headings = np.array(poses, float).T
    return np.arange(len(poses), dtype=float), x + 1j * y, headings


QUARTER = math.pi / 2
ROUND_A_SQUARE = ((5, 5, 0), (6, 5, QUARTER), (6, 6, 2 * QUARTER), (5, 6, 3 * QUARTER))
AHEAD_AND_LEFT = (1, 0, QUARTER)


def test_a_relation_that_holds_has_no_error_wherever_the_map_begins():
    metres, turns = published_table.relation_errors(trajectory(*ROUND_A_SQUARE), np.array([(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)]),
                                                    np.array([AHEAD_AND_LEFT] * 3))
    assert metres == pytest.approx(0, abs=1e-9)
    assert turns == pytest.approx(0, abs=1e-9)


def test_the_error_of_a_relation_is_seen_from_its_first_end():
    metres, turns = published_table.relation_errors(trajectory(*ROUND_A_SQUARE), np.array([(1.0, 2.0)]), np.array([(1.3, 0.4, QUARTER - 0.2)]))
    assert metres == pytest.approx(0.5)
    assert turns == pytest.approx(0.2)


def test_stamps_between_scans_are_interpolated_and_those_beyond_are_left_out():
    metres, _ = published_table.relation_errors(trajectory((0, 0, 0), (2, 0, 0)), np.array([(0.25, 0.75), (0.5, 5.0)]), np.array([(1, 0, 0)] * 2))
    assert metres == pytest.approx([0])


def test_relations_by_number_count_scans_whatever_their_stamps():
    times, places, headings = trajectory(*ROUND_A_SQUARE)
    metres, _ = published_table.relation_errors((times[::-1], places, headings), np.array([(0, 1), (2, 9)]), np.array([AHEAD_AND_LEFT] * 2))
    assert metres == pytest.approx([0])


def test_of_scans_with_the_same_stamp_the_first_counts():
    _, places, headings = trajectory((0, 0, 0), (1, 0, 0), (7, 0, 0))
    metres, _ = published_table.relation_errors((np.array([0.0, 1.0, 1.0]), places, headings), np.array([(0.0, 1.0)]), np.array([(1, 0, 0)]))
    assert metres == pytest.approx([0])


@pytest.fixture(scope="module")
def beginning(tmp_path_factory):
    """The first scans of ACES as published, and the relations between them."""
    folder = tmp_path_factory.mktemp("aces")
    log, relations = folder / "aces.clf", folder / "aces.relations"
    scans = 0
    with bz2.open(shared("data/radish/aces.clf.bz2"), "rt", encoding="ascii") as lines, open(log, "w", encoding="ascii") as part:
        for line in lines:
            part.write(line)
            scans += line.startswith("FLASER")
            if scans == FIRST_SCANS:
                end_s = float(line.split()[-3])
                break
    with open(shared("data/radish/aces.relations"), encoding="ascii") as lines:
        relations.write_text("".join(line for line in lines if max(map(float, line.split()[:2])) <= end_s), encoding="ascii")
    return log, relations


def test_the_first_relations_of_aces_hold(beginning, tmp_path):
    log, relations = beginning
    _, final, _ = Bench(BUILD, tmp_path).replay(log, "--frame", "laser")
    ends, true = published_table.read_relations(relations)
    metres, turns = published_table.relation_errors(read_tum(final), ends, true)
    print(f"{len(metres)} relations of ACES, {metres.mean():.4f} m ({metres.std():.4f}), {math.degrees(turns.mean()):.2f} degrees")
    assert len(metres) == len(true) >= 100
    assert metres.mean() < WORST_MEAN_M
    assert math.degrees(turns.mean()) < 1


def test_the_table_of_an_own_recording_agrees_with_the_scorer_beside_the_project(beginning, tmp_path):
    log, relations = beginning
    scorer = shared("bench/slam/score.py")
    done = subprocess.run([sys.executable, published_table.__file__, "--build", BUILD, "--log", log, "--relations", relations],
                          check=True, capture_output=True, text=True)
    row = next(line for line in done.stdout.splitlines() if line.startswith("| aces.clf |"))
    _, final, _ = Bench(BUILD, tmp_path).replay(log, "--frame", "laser")
    told = subprocess.run([sys.executable, scorer, final, relations], check=True, capture_output=True, text=True).stdout
    figures = dict(line.split()[:2] for line in told.splitlines())
    assert f"| {figures['trans_mean']} ({float(figures['trans_std']):.3f}) |" in row
    assert f"| {figures['relations']} of {figures['relations']} |" in row


@pytest.mark.parametrize("words, status, part", [
    (["--log", "absent.clf"], 2, "go together"),
    (["--log", "absent.clf", "--relations", "absent.relations"], 1, "absent.clf: no such file"),
    (["--build", "absent"], 1, "no programs in absent/bin"),
])
def test_wrong_use_is_told_in_words(words, status, part):
    done = subprocess.run([sys.executable, published_table.__file__, "--build", BUILD, *words], check=False, capture_output=True, text=True)
    assert done.returncode == status
    assert part in done.stderr and "Traceback" not in done.stderr


def with_noise_m(data, name, seed, folder):
    """Error against gmapping's poses with noise of that seed on the ranges."""
    log, reference = shared(f"data/{data}/{name}.clf.gz"), shared(f"data/{data}/{name}.ref")
    if not (BUILD / "bin/ale-replay").exists():
        pytest.skip("ale-replay is not built")
    bench = Bench(BUILD, folder)
    _, final, _ = bench.replay(published_table.spoilt(bench, log, "jitter", seed), "--frame", "laser")
    return score(shared("bench/slam/score.py"), final, reference)["ate_rmse"]


@pytest.mark.parametrize("seed", ["2", "5"])
def test_a_corridor_that_looks_the_same_after_half_a_turn_is_not_driven_back(seed, tmp_path):
    assert with_noise_m("killian", "infinite-corridor", seed, tmp_path) < OF_CORRIDOR_M


@pytest.mark.parametrize("seed", ["2", "5"])
def test_of_a_robot_that_turns_on_the_spot_no_scale_of_the_wheels_is_learnt(seed, tmp_path):
    """Its first ways are some millimetres long: with this noise 16 % were learnt from them, and half a metre was lost in a corridor."""
    assert with_noise_m("corrected", "belgioioso", seed, tmp_path) < OF_BELGIOIOSO_M
