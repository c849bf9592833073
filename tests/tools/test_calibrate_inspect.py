"""ale-calibrate and ale-inspect as a user calls them."""
import math
import random
import re
import subprocess
import xml.etree.ElementTree as ElementTree

import pytest

from at_hand import BINARIES, shared

STEP = 2 * math.pi / 1024
KEYS = {"own_um", "own_ppm", "shared_um", "shared_ppm", "shared_beams", "surface_um", "bearing_nrad"}


def run(program, *words):
    return subprocess.run([BINARIES / program, *map(str, words)], check=False, capture_output=True, text=True)


def room(bearing):
    """A room with a chair leg in it."""
    if abs(bearing + 0.3) < 0.02:
        return 0.8
    return min(side / c for side, c in ((2.0, math.cos(bearing)), (1.5, math.sin(bearing)),
                                        (1.0, -math.sin(bearing))) if c > 1e-9)


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """40 scans at rest with 4 mm of noise of each beam's own."""
    path = tmp_path_factory.mktemp("log") / "rest.log"
    draw = random.Random(3)
    with path.open("w") as out:
        for scan in range(40):
            ranges = " ".join(f"{room((k - 340) * STEP) + draw.gauss(0, 0.004):.3f}" for k in range(682))
            out.write(f"ROBOTLASER1 2 {-340 * STEP:.9f} {681 * STEP:.9f} {STEP:.9f} 4.094 0.01 0 682 {ranges}"
                      f" 0 0 0 0 0 0 0 0 0 0 0 0 {scan / 10} test {scan / 10}\n")
    return path


def well_formed(text):
    return ElementTree.fromstring(text).tag.endswith("svg")


def test_the_fit_is_a_noise_section_on_standard_output(log):
    done = run("ale-calibrate", log)
    assert done.returncode == 0, done.stderr
    values = dict(re.findall(r"^(\w+) = (\d+)$", done.stdout, re.M))
    assert set(values) == KEYS
    assert "[noise]" in done.stdout
    at_two_metres = math.hypot(int(values["own_um"]), 2 * int(values["own_ppm"]))
    assert at_two_metres == pytest.approx(4000, rel=0.1)


def test_the_subject_may_be_named(log):
    assert run("ale-calibrate", "noise", log).stdout == run("ale-calibrate", log).stdout


def test_any_name_of_a_log_gives_a_configuration(log, tmp_path):
    named, config = tmp_path / ("at\nrest in a long room" * 10 + ".log"), tmp_path / "noise.ini"
    named.symlink_to(log)
    assert run("ale-calibrate", "noise", named, "--out", config).returncode == 0
    assert "fine" in run("ale-slamd", "--config", config, "--check-config").stdout


def with_noise(path, sigma_m, turn_rad_s=0):
    """As the log at rest, with another noise, and turning."""
    draw = random.Random(3)
    with path.open("w") as out:
        for scan in range(40):
            ranges = " ".join(f"{max(0, room((k - 340) * STEP + turn_rad_s * scan / 10) + draw.gauss(0, sigma_m)):.3f}" for k in range(682))
            out.write(f"ROBOTLASER1 2 {-340 * STEP:.9f} {681 * STEP:.9f} {STEP:.9f} 4.094 0.01 0 682 {ranges}"
                      f" 0 0 0 0 0 0 0 0 0 0 0 0 {scan / 10} test {scan / 10}\n")
    return path


def test_noise_that_ale_slamd_would_refuse_is_not_printed(tmp_path):
    done = run("ale-calibrate", "noise", with_noise(tmp_path / "wild.log", 0.25))
    assert (done.returncode, done.stdout) == (1, "")
    assert "wild.log: ale-slamd would refuse what was found: noise.own_" in done.stderr and done.stderr.count("\n") == 1


def test_without_any_noise_the_configuration_is_accepted(tmp_path):
    config = tmp_path / "noise.ini"
    assert run("ale-calibrate", "noise", with_noise(tmp_path / "still.log", 0), "--out", config).returncode == 0
    assert "fine" in run("ale-slamd", "--config", config, "--check-config").stdout


@pytest.mark.parametrize("turn_rad_s", [0.002, 0.3])
def test_a_moving_scanner_is_refused_with_how_much_and_when(tmp_path, turn_rad_s):
    done = run("ale-calibrate", "noise", with_noise(tmp_path / "turns.log", 0.004, turn_rad_s))
    assert (done.returncode, done.stdout) == (1, "")
    assert re.search(r"turns.log: the scanner moves: .*after [0-9.]+ s .*; a recording at rest is needed\n$", done.stderr), done.stderr


def test_a_recorded_drive_is_no_recording_at_rest():
    done = run("ale-calibrate", "noise", shared("data/urg04lx/exp1.dat"))
    assert done.returncode == 1 and "the scanner moves" in done.stderr


def test_the_fit_and_its_plot_go_to_files(log, tmp_path):
    done = run("ale-calibrate", log, "--out", tmp_path / "noise.ini", "--plot", tmp_path / "fit.svg")
    assert done.returncode == 0 and done.stdout == ""
    assert "own_um" in (tmp_path / "noise.ini").read_text()
    assert well_formed((tmp_path / "fit.svg").read_text())


def test_a_scan_is_drawn_with_its_lines_corners_and_search(log):
    done = run("ale-inspect", log, 7)
    assert done.returncode == 0, done.stderr
    assert well_formed(done.stdout)
    assert re.search(r"[34] lines", done.stdout)
    assert "2 corners" in done.stdout
    assert "binary search" in done.stdout
    assert done.stdout.count("#2ca02c") > 3 and done.stdout.count("#d62728") > 3


def test_the_sizes_of_what_a_caller_provides_are_a_table():
    done = run("ale-inspect", "--sizes")
    assert (done.returncode, done.stderr) == (0, "")
    sizes = {name: int(size) for name, size in re.findall(r"^\| `(ale_\w+_t)` \| (\d+) \| `.+` \| .+ \|$", done.stdout, re.M)}
    assert len(sizes) == len(done.stdout.splitlines()) - 2
    assert sizes["ale_extractor_t"] < sizes["ale_pipeline_t"], "the tracker holds an extractor"
    assert {"ale_scan_t", "ale_features_t", "ale_map_t", "ale_keyframe_t"} < set(sizes)


def test_a_configuration_changes_what_is_decided(log, tmp_path):
    config = tmp_path / "robot.ini"
    config.write_text("[extract]\nmin_points = 400\n")
    done = run("ale-inspect", log, 7, "--config", config)
    assert done.returncode == 0, done.stderr
    assert "0 lines" in done.stdout
    assert "too few points" in done.stdout


@pytest.mark.parametrize("words", [["ale-calibrate"], ["ale-calibrate", "a", "b"], ["ale-calibrate", "--colour"],
                                   ["ale-calibrate", "a", "--out"], ["ale-calibrate", "noise"], ["ale-calibrate", "noise", "a", "--config", "b"],
                                   ["ale-calibrate", "colour", "a"], ["ale-inspect", "a"], ["ale-inspect", "a", "x"],
                                   ["ale-inspect", "a", "-1"], ["ale-inspect", "a", "1", "--out", "a.png"], ["ale-calibrate", "a", "--plot", "a.png"],
                                   ["ale-inspect", "a", "1", "2"]])
def test_wrong_use_exits_2_with_one_line(words):
    done = run(*words)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_files_that_cannot_be_used_are_named(log, tmp_path):
    missing = run("ale-calibrate", tmp_path / "none.log")
    assert missing.returncode == 1 and "none.log" in missing.stderr
    beyond = run("ale-inspect", log, 40)
    assert beyond.returncode == 1 and "has 40 scans, there is no scan 40" in beyond.stderr
    unwritable = run("ale-inspect", log, 1, "--out", tmp_path / "no" / "where.svg")
    assert unwritable.returncode == 1 and "where.svg" in unwritable.stderr


def test_a_real_recording_at_rest_is_calibrated():
    path = shared("data/urg04lx/obstacle_demo_front.scan.gz")
    done = run("ale-calibrate", path)
    assert done.returncode == 0, done.stderr
    values = {key: int(value) for key, value in re.findall(r"^(\w+) = (\d+)$", done.stdout, re.M)}
    scatter_mm = math.hypot(values["own_um"], 3 * values["own_ppm"]) / 1000
    assert 3 <= scatter_mm <= 6  # what the recording's description states
    assert values["shared_um"] + 2 * values["shared_ppm"] > 4000  # straight walls are wavy
