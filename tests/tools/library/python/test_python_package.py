"""Python's package: the same results as ale-replay, arrays where they lie, and errors in words."""
import gzip
import json
import math
import re
import subprocess
import sys

import numpy as np
import pytest

from at_hand import BINARIES, BUILD, ROOT

PYTHON = ROOT / "tools/library/python"
LOG = ROOT / "tests/digest/apartment.log.gz"


def carmen(path):
    """(ranges, odometry pose, stamp, laser pose) of every ROBOTLASER1 line: read from the text, not by drivers/log."""
    with gzip.open(path, "rt", encoding="ascii") as lines:
        for line in lines:
            words = line.split()
            if words[0] != "ROBOTLASER1":
                continue
            beams = int(words[8])
            ranges = np.array(words[9:9 + beams], float)
            laser_x, laser_y, laser_theta, x, y, theta = map(float, words[10 + beams:16 + beams])
            yield ranges, (x, y, theta), float(words[21 + beams]), (laser_x, laser_y, laser_theta)


def scanner_of_log(ale):
    return ale.Scanner(first_bearing=-2.086213872, step=2 * math.pi / 1024, range_min=0.02, range_max=5.6, beam_time=97.656e-6,
                       stamp_beam=340)


@pytest.fixture(scope="module")
def replayed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("replayed")
    subprocess.run([BINARIES / "ale-replay", LOG, "--poses", folder / "poses.jsonl", "--trajectory", folder / "trajectory.tum", "--save-map",
                    folder / "map", "--features", folder / "features.jsonl"], check=True, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def tracked(ale):
    """The same log through the package: tracker, estimates, features of every scan."""
    tracker, estimates, features = None, [], []
    for ranges, pose, stamp, laser in carmen(LOG):
        if tracker is None:
            tracker = ale.Tracker(scanner_of_log(ale), sensor=mounting(pose, laser))
        tracker.odometry(*pose, stamp)
        estimates.append(tracker.scan(ranges, stamp))
        features.append(tracker.features())
    tracker.finish()
    return tracker, estimates, features


def mounting(robot, laser):
    dx, dy = laser[0] - robot[0], laser[1] - robot[1]
    c, s = math.cos(robot[2]), math.sin(robot[2])
    return c * dx + s * dy, c * dy - s * dx, laser[2] - robot[2]


def rows(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def test_every_estimate_is_that_of_ale_replay_to_the_last_bit(replayed, tracked, ale):
    expected = rows(replayed / "poses.jsonl")
    assert len(tracked[1]) == len(expected) == 120
    for estimate, row in zip(tracked[1], expected):
        for name in ("scan", "t", "x", "y", "theta", "map_x", "map_y", "map_theta", "state", "predicted", "lag_us", "matched_lines",
                     "matched_corners", "map_id", "maps"):
            assert estimate[name] == row[name], (row["scan"], name)
        assert estimate.cov.ravel().tolist() == row["cov"]
        assert estimate.information.tolist() == row["information"]
        assert ale.WheelFault(estimate.wheel_fault).name.lower() == row["wheel_fault"]
        assert estimate.cpu_s > 0


def test_trajectory_and_map_are_the_same_files_byte_for_byte(replayed, tracked, tmp_path):
    tracked[0].save_trajectory(tmp_path / "trajectory.tum")
    tracked[0].save_map(tmp_path / "map")
    assert (tmp_path / "trajectory.tum").read_bytes() == (replayed / "trajectory.tum").read_bytes()
    assert (tmp_path / "map").read_bytes() == (replayed / "map").read_bytes()


def test_trajectory_and_map_as_arrays_are_what_the_files_say(replayed, tracked):
    tum = np.loadtxt(replayed / "trajectory.tum")
    poses = tracked[0].trajectory()
    assert np.array_equal(np.column_stack([poses["t"], poses["x"], poses["y"]]), tum[:, :3])
    assert np.allclose(np.sin(poses["theta"] / 2), tum[:, 6], atol=2e-9)
    walls = [list(map(int, line.split()[1:])) for line in (replayed / "map").read_text().splitlines() if line.startswith("wall ")]
    drawn = tracked[0].map()
    assert len(walls) > 10
    assert [[round(wall[name] * 1e6) for name in ("x1", "y1", "x2", "y2")] for wall in drawn.walls] == [wall[1:5] for wall in walls]
    assert [int(wall.seen) for wall in drawn.walls] == [wall[8] for wall in walls]


def test_lines_and_corners_are_those_of_ale_replay(replayed, tracked, ale):
    kinds = [kind.name.lower() for kind in ale.CornerKind], [kind.name.lower() for kind in ale.EndKind]
    for features, row in zip(tracked[2], rows(replayed / "features.jsonl")):
        assert (len(features.lines), len(features.corners), len(features.curves)) == tuple(
            len(row[name]) for name in ("lines", "corners", "curves"))
        assert features.refused == row["refused"] and features.outliers == row["outliers"]
        for line, expected in zip(features.lines, row["lines"]):
            assert all(line[name] == expected[name] for name in ("first", "last", "points", "x1", "y1", "x2", "y2", "alpha", "rho", "rmse"))
            assert line.cov.tolist() == expected["cov"]
            assert (kinds[1][line.first_end], kinds[1][line.last_end]) == (expected["first_end"], expected["last_end"])
        for corner, expected in zip(features.corners, row["corners"]):
            assert all(corner[name] == expected[name] for name in ("x", "y", "angle", "first_line", "second_line"))
            assert corner.cov.tolist() == expected["cov"] and kinds[0][corner.kind] == expected["kind"]


def test_the_extractor_alone_is_ale_replay_with_lines_only(ale, tmp_path):
    subprocess.run([BINARIES / "ale-replay", LOG, "--lines-only", "--features", tmp_path / "f"], check=True, capture_output=True)
    extractor = ale.Extractor(scanner_of_log(ale))
    for (ranges, *_), row in zip(carmen(LOG), rows(tmp_path / "f")):
        lines = extractor.extract(ranges).lines
        assert lines["rho"].tolist() == [line["rho"] for line in row["lines"]]
        assert lines["alpha"].tolist() == [line["alpha"] for line in row["lines"]]


def test_a_saved_map_is_started_in(ale, replayed):
    tracker = ale.Tracker(scanner_of_log(ale), map_file=replayed / "map")
    states = [tracker.scan(ranges, stamp).state for ranges, _, stamp, _ in carmen(LOG)]
    assert states[0] == ale.State.LOST
    assert ale.State.GOOD in states
    with pytest.raises(ale.AleError, match="no such file.*|No such file.*"):
        ale.Tracker(scanner_of_log(ale), map_file=replayed / "absent")


def test_arrays_are_read_where_they_lie(ale):
    checks = sys.modules["ale_package._checks"]
    for kind in (np.float32, np.float64):
        ranges = np.full(100, 2.0, kind)
        assert checks.beams_of(ranges, None) is ranges or np.shares_memory(checks.beams_of(ranges, None), ranges)
    assert not np.shares_memory(checks.beams_of(np.full(200, 2.0)[::2], None), ranges)
    features = ale.Extractor(ale.scanner("urg-04lx")).extract(np.full(682, 2.0))
    assert features.lines.base is not None, "a view of what the core wrote"


def test_float32_and_every_other_beam_of_an_array_give_the_same(ale):
    ranges = next(iter(carmen(LOG)))[0]
    extractor = ale.Extractor(scanner_of_log(ale))
    expected = extractor.extract(ranges).lines
    for same in (ranges.astype(np.float32), np.repeat(ranges, 2)[::2], list(ranges)):
        assert np.array_equal(extractor.extract(same).lines, expected)


def test_what_ros_says_of_a_beam_is_understood(ale):
    """REP 117: +inf nothing there, -inf too near, NaN no measurement."""
    scanner = ale.scanner("urg-04lx")
    bearings = scanner.first_bearing + scanner.step * np.arange(scanner.beams)
    with np.errstate(divide="ignore"):
        wall = np.where(np.abs(bearings) < 1, 2 / np.cos(bearings), np.inf)
    assert len(ale.Extractor(scanner).extract(wall).lines) == 1
    for nothing in (np.nan, np.inf, -np.inf):
        assert len(ale.Extractor(scanner).extract(np.full(682, nothing)).lines) == 0


@pytest.mark.parametrize("ranges, error, words", [
    (np.zeros((2, 341)), ValueError, r"shape \(2, 341\)"), (np.zeros(1082), ValueError, "1082 beams: at most 1081"),
    (np.zeros(681), ValueError, "681 beams: this scanner has 682"), (np.zeros(682, np.int16), TypeError, "millimetres: divide by 1000"),
    (["a"] * 682, TypeError, "metres as floats"), (3.0, ValueError, r"shape \(\)")])
def test_ranges_that_are_none_are_refused_in_words(ale, ranges, error, words):
    for call in (ale.Extractor(ale.scanner("urg-04lx")).extract, lambda r: ale.Tracker(ale.scanner("urg-04lx")).scan(r, 0.0)):
        with pytest.raises(error, match=words):
            call(ranges)


def test_numbers_that_are_none_are_refused_in_words(ale):
    tracker = ale.Tracker(ale.scanner("urg-04lx"))
    for pose, words in (((math.nan, 0, 0, 0), "x is nan"), ((0, math.inf, 0, 0), "y is inf"), ((0, 0, math.nan, 0), "theta is nan"),
                        ((0, 0, 0, math.nan), "stamp is nan"), ((3000, 0, 0, 0), "x is 3000: it must lie between -2000 and 2000")):
        with pytest.raises(ValueError, match=words):
            tracker.odometry(*pose)
    with pytest.raises(ValueError, match="stamp is inf"):
        tracker.scan(np.zeros(682), math.inf)
    with pytest.raises(RuntimeError, match="no scan yet"):
        tracker.features()
    tracker.finish()
    with pytest.raises(RuntimeError, match="nothing comes after finish"):
        tracker.scan(np.zeros(682), 0.0)
    with pytest.raises(ale.AleError, match="absent/file: No such file"):
        tracker.save_trajectory("absent/file")


def test_settings_and_scanners_that_are_none_are_refused_in_words(ale):
    scanner = ale.scanner("urg-04lx")
    for settings, words in (({"colour": 1}, "no setting is called colour; there are: sensor.x"),
                            ({"extract.smooth_span": 4}, "smooth_span is 4: an odd number"),
                            ({"noise.own_um": -1}, "noise.own_um is -1: it must lie between 0 and 100000")):
        with pytest.raises(ValueError, match=words):
            ale.Tracker(scanner, settings=settings)
        with pytest.raises(ValueError, match=words):
            ale.Extractor(scanner, settings=settings)
    with pytest.raises(ValueError, match="no preset is called lidar; there are: urg-04lx"):
        ale.scanner("lidar")
    with pytest.raises(ValueError, match="step is 0"):
        ale.Scanner(first_bearing=0, step=0)
    with pytest.raises(ValueError, match="9 blind sectors: at most 8"):
        ale.Extractor(scanner, blind=[(0.0, 0.1)] * 9)


def test_a_blind_sector_hides_what_lies_in_it(ale):
    scanner = ale.scanner("urg-04lx")
    ranges = next(iter(carmen(LOG)))[0]
    assert len(ale.Extractor(scanner).extract(ranges).lines) > 2
    assert len(ale.Extractor(scanner, blind=[(-3.0, 3.0)]).extract(ranges).lines) == 0


def test_settings_are_those_of_the_robot_s_configuration(ale, tmp_path):
    """Names, defaults and ranges as firmware/config has them; a file of the robot gives the same."""
    printed = subprocess.run([BINARIES / "ale-slamd", "--print-config"], check=True, capture_output=True, text=True).stdout
    path = tmp_path / "robot.ini"
    path.write_text(printed, encoding="utf-8")
    found = ale.settings_from(path)
    described = {name: default for name, default, _, _ in sys.modules["ale_package._core"].DESCRIPTION["settings"]}
    assert {**described, **found} == pytest.approx(described), "what is a remark there is the default"
    sections = {"sensor", "noise", "extract", "odometry"}
    keys = {(section, key) for section, key in re.findall(r'^    \{"(\w+)", "(\w+)",', (ROOT / "firmware/config/config_keys.c").read_text(), re.M)
            if section in sections or key in ("max_speed", "max_turn")}
    not_of_an_array = {("sensor", key) for key in ("type", "model", "port", "serial", "baud", "reversed", "blind", "first_step", "last_step")}
    assert {f"{section}.{key}" for section, key in keys - not_of_an_array} == set(described)
    path.write_text("[sensor]\nx = far\nblind = -120:-100, 90:100\n", encoding="utf-8")
    with pytest.raises(ValueError, match="robot.ini: sensor.x: 'far' is not a number"):
        ale.settings_from(path)
    assert ale.blind_from(path) == [pytest.approx((math.radians(a), math.radians(b))) for a, b in ((-120, -100), (90, 100))]


def test_the_presets_are_those_of_the_firmware(ale, tmp_path):
    described = {name: default for name, default, _, _ in sys.modules["ale_package._core"].DESCRIPTION["settings"]}
    for name, scanner in ale.SCANNERS.items():
        path = tmp_path / "robot.ini"
        path.write_text(f"[sensor]\nmodel = {name}\n", encoding="utf-8")
        printed = subprocess.run([BINARIES / "ale-slamd", "--config", path, "--print-config"], check=True, capture_output=True, text=True).stdout
        noise = {f"noise.{key}": float(value) for key, value in re.findall(r"^# (\w+) = (\d+)$", printed, re.M) if f"noise.{key}" in described}
        assert noise == {**{key: value for key, value in described.items() if key.startswith("noise.")}, **scanner.settings()}, name
        assert {key: value for key, value in ale.settings_from(path).items() if key.startswith("noise.")} == scanner.settings()


def test_presets_are_whole_turns_or_less(ale):
    for name, scanner in ale.SCANNERS.items():
        assert scanner.beams * abs(scanner.step) <= 2 * math.pi + 1e-9, name
        ale.Tracker(scanner).scan(np.full(scanner.beams, 1.0), 0.0)


def test_versions_agree(ale):
    version = re.search(r'ALE_VERSION "(.*)"', (ROOT / "lib/base/version.h").read_text())[1]
    assert ale.__version__ == version
    assert f'version = "{version}"' in (PYTHON / "pyproject.toml").read_text()


def test_lcm_types_that_lie_behind_are_there_beside_the_library(ale_package, tmp_path):
    types = BUILD / "python"
    if not (types / "ale").exists():
        pytest.skip("LCM's types are not built: make lcm-types")
    words = "import ale; ale.Extractor(ale.scanner('urg-04lx')); print(ale.pose_t.decode(ale.pose_t().encode()).utime)"
    done = subprocess.run([sys.executable, "-c", words], capture_output=True, text=True, check=False, cwd=tmp_path,
                          env={**ale_package, "PYTHONPATH": f"{ale_package['PYTHONPATH']}:{types}"})
    assert done.stdout == "0\n", done.stderr


def test_without_the_library_it_says_so(tmp_path, ale_package):
    done = subprocess.run([sys.executable, "-c", "import ale"], capture_output=True, text=True, check=False,
                          env={**ale_package, "ALE_CORE": str(tmp_path)})
    assert "ALE_CORE" in done.stderr and "ImportError" in done.stderr
