"""ale-calibrate mounting and wheels as their users meet them: drives of the simulator with known mounting, and a real one."""
import re
import subprocess

import pytest

from at_hand import BINARIES, WORLDS, shared


def run(program, *words, code=0):
    done = subprocess.run([BINARIES / program, *map(str, words)], check=False, capture_output=True, text=True, timeout=180)
    assert done.returncode == code, done.stderr
    return done


def found(text):
    """Key: (value, one sigma), of what is determined."""
    return {key: (float(value), float(sigma))
            for sigma, key, value in re.findall(r"^# \+- ([\d.]+)  .*\n(\w+) = (\S+)$", text, re.M)}


@pytest.fixture(name="drive", scope="module")
def _drive(tmp_path_factory):
    log = tmp_path_factory.mktemp("drive") / "home.log"
    run("ale-sim", "--world", WORLDS / "home.world", "--write-log", log, "--sensor", "0.12,-0.05,0.2",
        "--wheels", "0.96,1.03,0.02", "--odometry-lag", "0.08")
    return log


@pytest.fixture(name="robot", scope="module")
def _robot(drive):
    """Configuration of the robot that drove: both sections."""
    config = drive.with_name("robot.ini")
    config.write_text(run("ale-calibrate", "mounting", drive).stdout + run("ale-calibrate", "wheels", drive).stdout)
    return config


def test_a_simulated_drive_shows_mounting_wheels_and_lag(robot):
    values = found(robot.read_text())
    truth = {"x": (0.12, 0.003), "y": (-0.05, 0.003), "theta": (0.2, 0.003), "lag_us": (80000, 5000),
             "distance_factor": (1 / 0.96, 0.002), "turn_factor": (1 / 1.03, 0.02), "turn_bias": (0.02, 0.02)}
    assert set(values) == set(truth)
    for key, (true, tolerance) in truth.items():
        value, sigma = values[key]
        assert abs(value - true) < min(tolerance, 3.5 * sigma), (key, value, sigma)
    assert "fine" in run("ale-slamd", "--config", robot, "--check-config").stdout


def test_the_older_name_writes_both_sections_at_once(drive, robot, tmp_path):
    config = tmp_path / "robot.ini"
    run("ale-mounting", drive, "--out", config)
    assert found(config.read_text()) == found(robot.read_text())
    assert "fine" in run("ale-slamd", "--config", config, "--check-config").stdout


def test_what_is_found_goes_into_the_tracker(drive, robot, tmp_path):
    """With wheels that are put right the lag and the factors that are learnt again are nothing."""
    second, poses = tmp_path / "second.ini", tmp_path / "poses.jsonl"
    run("ale-replay", drive, "--config", robot, "--poses", poses, "--loops", "off")
    lags = [int(lag) for lag in re.findall(r'"lag_us":(-?\d+)', poses.read_text())]
    assert abs(lags[0] - 80000) < 5000 and abs(lags[-1] - 80000) < 8000
    assert lags[0] == int(found(robot.read_text())["lag_us"][0])
    run("ale-calibrate", "mounting", drive, "--config", robot, "--out", second)
    assert found(second.read_text())["x"] == found(robot.read_text())["x"], "what is known already changes nothing"


def test_a_real_rover_is_found_near_what_its_makers_wrote():
    log = shared("data/urg04lx/exp1.dat")
    values = {subject: found(run("ale-calibrate", subject, log).stdout) for subject in ("mounting", "wheels")}
    values = {**values["mounting"], **values["wheels"]}
    assert 0.07 < values["x"][0] < 0.18  # 0.145
    assert abs(values["theta"][0]) < 0.05
    assert 140000 < values["lag_us"][0] < 170000  # 0.15 to 0.16 s
    assert abs(values["distance_factor"][0] - 1) < 0.05
    assert abs(values["turn_factor"][0] - 1.07) < 0.05


@pytest.mark.parametrize("words", ["ale-mounting", "ale-mounting a b", "ale-mounting a --out", "ale-mounting a --plot a.svg",
                                   "ale-calibrate mounting", "ale-calibrate wheels a b", "ale-calibrate wheels a --plot a.svg"])
def test_wrong_use_exits_2_with_one_line(words):
    assert run(*words.split(), code=2).stderr.count("\n") == 1


def test_logs_that_cannot_be_used_are_named(drive, tmp_path):
    still = tmp_path / "still.log"
    still.write_text("".join(drive.read_text().splitlines(keepends=True)[:60]))
    told = run("ale-calibrate", "wheels", still, code=1).stderr
    assert "still.log" in told and "too short" in told and told.count("\n") == 1
    config = tmp_path / "bad.ini"
    config.write_text("[odometry]\nturn_factor = 5\n")
    assert "bad.ini:2" in run("ale-calibrate", "wheels", drive, "--config", config, code=2).stderr



def test_what_ale_slamd_would_refuse_is_not_printed(tmp_path):
    log = tmp_path / "home.log"
    run("ale-sim", "--world", WORLDS / "home.world", "--write-log", log, "--wheels", "0.4,1,0")
    told = run("ale-calibrate", "wheels", log, code=1)
    assert "home.log: ale-slamd would refuse what was found: odometry.distance_factor" in told.stderr
    assert told.stdout == "" and told.stderr.count("\n") == 1


def test_any_name_of_a_log_gives_a_configuration(drive, tmp_path):
    log, config = tmp_path / ("of\na long way" * 15 + ".log"), tmp_path / "robot.ini"
    log.symlink_to(drive)
    run("ale-mounting", log, "--out", config)
    assert "fine" in run("ale-slamd", "--config", config, "--check-config").stdout
