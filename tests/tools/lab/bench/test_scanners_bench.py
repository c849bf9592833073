"""Every scanner that ale-sim plays has a preset of its geometry, and drives seen by it are mapped as those of a URG are."""
import configparser
import re
import subprocess

import pytest

np = pytest.importorskip("numpy")

import scanners_table  # noqa: E402
from at_hand import BINARIES, ROOT  # noqa: E402

PRESETS = configparser.ConfigParser(inline_comment_prefixes=("#",))
PRESETS.read(ROOT / "firmware/config/scanners.ini")
# A room of 4 by 3 m with a box, driven once around.
ROOM = """# start -1.2 -0.8 0
# via 1.2 -0.8
# via 1.2 0.7
# via -1.2 0.7
-2 -1.5 2.2 -1.5
2.2 -1.5 2.2 1.6
2.2 1.6 -2 1.6
-2 1.6 -2 -1.5
-0.3 -0.2 0.4 -0.2
0.4 -0.2 0.4 0.1
0.4 0.1 -0.3 0.1
-0.3 0.1 -0.3 -0.2
"""
WORST_MM = 15


def sensors():
    done = subprocess.run([BINARIES / "ale-sim", "--sensor", "none"], capture_output=True, text=True, check=False)
    return re.search(r"there are (.*), or", done.stderr)[1].split(", ")


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    path = tmp_path_factory.mktemp("world") / "room.world"
    path.write_text(ROOM, encoding="utf-8")
    return path


def test_every_scanner_that_is_simulated_has_a_preset():
    assert set(sensors()) <= set(PRESETS.sections())
    assert set(scanners_table.SCANNERS) <= set(sensors())


@pytest.mark.parametrize("scanner", [name for name in PRESETS.sections() if name not in ("lms-200", "lds-01")])
def test_a_drive_is_mapped_by_its_preset(room, tmp_path, scanner):
    log, poses = tmp_path / "drive.log", tmp_path / "poses.jsonl"
    run = dict(check=True, capture_output=True, text=True, timeout=300)
    subprocess.run([BINARIES / "ale-sim", "--world", room, "--sensor", scanner, "--write-log", log, "--truth", tmp_path / "truth.tum"], **run)
    subprocess.run([BINARIES / "ale-replay", log, "--model", scanner, "--poses", poses, "--trajectory-live", tmp_path / "live.tum"], **run)
    assert scanners_table.trajectory_error(tmp_path / "live.tum", tmp_path / "truth.tum")[0] < WORST_MM
    assert scanners_table.scans_lost_and_wrong(poses, tmp_path / "truth.tum") == (0, 0)


def test_a_recording_of_a_whole_turn_cannot_be_played_by_scip_and_says_so(room, tmp_path):
    log = tmp_path / "drive.scip"
    subprocess.run([BINARIES / "ale-sim", "--world", room, "--sensor", "ld06", "--write-log", log], check=True, capture_output=True)
    done = subprocess.run([BINARIES / "ale-sim", "--log", log, "--pty", tmp_path / "urg"], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.strip() == (f"ale-sim: {log}: its points lie on no grid, as those of a scanner of a whole turn do, and SCIP cannot "
                                   "say that: ale-replay reads it")


def test_a_model_that_is_none_is_told_those_that_are(tmp_path):
    done = subprocess.run([BINARIES / "ale-replay", tmp_path / "log", "--model", "ld07"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.strip() == f"ale-replay: --model ld07: there are {', '.join(PRESETS.sections())} (see --help)"


def test_a_scan_is_wrong_when_the_state_is_good_and_the_pose_off(tmp_path):
    truth = tmp_path / "truth.tum"
    truth.write_text("".join(f"{k} {k / 10} 0 0 0 0 0 1\n" for k in range(5)))
    poses = tmp_path / "poses.jsonl"
    rows = ((0, 0, 0, 2), (0.1, 0, 0, 2), (0.4, 0, 0, 2), (0.5, 0, 0, 1), (0.4, 0, 0.2, 2))
    poses.write_text("".join(f'{{"t": {k}, "map_x": {x}, "map_y": {y}, "map_theta": {theta}, "state": {state}}}\n'
                             for k, (x, y, theta, state) in enumerate(rows)))
    assert scanners_table.scans_lost_and_wrong(poses, truth) == (0, 2)
