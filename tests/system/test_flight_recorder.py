"""The flight recorder: what it leaves on disk replays to the very poses of the flight."""
import itertools
import signal
import struct
import subprocess
import zlib

import pytest

from at_hand import BINARIES
from waiting import TRIALS, wait_until

SPEED = 10
DECISION, CORRECTION, STAGES, CONFIG, ODOMETRY = 7, 5, 8, 6, 3


def config(folder, megabytes=8):
    return f"[recorder]\nfolder = {folder}\nmegabytes = {megabytes}\n"


def recordings(folder, why="*"):
    """Those written for a reason; on a busy machine a late answer may have left one of its own."""
    return sorted(folder.glob(f"flight-*-{why}.scip"))


def chunks(path):
    """(kind, stamp_us, payload) of every chunk, each held against its checksum."""
    data = path.read_bytes()
    assert data[:8] == b"ALESCIP1"
    at = 8
    while at < len(data):
        magic, kind, length, stamp = struct.unpack_from("<4sB3xIq", data, at)
        assert magic == b"CHNK"
        (crc,) = struct.unpack_from("<I", data, at + 20 + length)
        assert crc == zlib.crc32(data[at + 4:at + 20 + length])
        yield kind, stamp, data[at + 20:at + 20 + length]
        at += 24 + length


def decisions(path):
    return [dict(word.split("=") for word in payload.decode().split())
            for kind, _, payload in chunks(path) if kind == DECISION]


def replayed(path, folder):
    poses = folder / "replayed.tum"
    done = subprocess.run([BINARIES / "ale-replay", path, "--trajectory-live", poses], capture_output=True, text=True,
                          timeout=180, check=False)
    assert done.returncode == 0, done.stderr
    return [tuple(float(word) for word in line.split()[:3]) for line in poses.read_text().splitlines()]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "flights").mkdir()
    return tmp_path / "flights"


def fly(chain, folder, scans, words=(), **settings):
    simulator = chain.simulator("--world", "tools/lab/worlds/home.world", *words, speed=SPEED)
    firmware = chain.firmware(config(folder, **settings), speed=SPEED)
    wait_until(lambda: len(chain.listener.poses) >= scans, 180, f"{scans} poses")
    return simulator, firmware


def recorded_on_command(chain, firmware, folder):
    """What is written when told to, under the name of the late answer that was about to be recorded, if one was."""
    before = recordings(folder)
    firmware.process.send_signal(signal.SIGUSR1)
    wait_until(lambda: len(recordings(folder)) > len(before) and chain.listener.counters()["flight_recordings"] > 0, 180,
               "the recording")
    assert firmware.end() == 0
    return max(set(recordings(folder)) - set(before), key=lambda path: path.stat().st_mtime)


def test_a_recording_on_command_replays_to_the_same_poses(chain, folder):
    _, firmware = fly(chain, folder, 150)
    path = recorded_on_command(chain, firmware, folder)
    assert "flight recording written" in firmware.err()
    told = decisions(path)
    assert len(told) >= 150 and [int(one["scan"]) for one in told] == list(range(len(told)))
    poses = replayed(path, chain.folder)
    assert len(poses) >= len(told)
    # A busy machine may have set a scan aside for a newer one: the recording has it, the flight went on without it.
    flown = list(itertools.takewhile(lambda one: one["overloaded"] == "0", told))
    assert flown
    for one, (_, x, y) in zip(flown, poses):
        assert (int(one["map_x_um"]), int(one["map_y_um"])) == (round(x * 1e6), round(y * 1e6)), one["scan"]
    kinds = [kind for kind, _, _ in chunks(path)]
    assert kinds[0] == CONFIG and kinds.count(STAGES) == len(told) and kinds.count(ODOMETRY) > len(told)
    counters = chain.listener.counters()
    assert counters["flight_recordings"] >= 1 and counters["recorder_queue_full"] == 0


def test_the_oldest_makes_room_and_the_rest_still_replays(chain, folder):
    _, firmware = fly(chain, folder, 500, megabytes=1)
    assert not recordings(folder, "command")
    path = recorded_on_command(chain, firmware, folder)
    assert 0.9e6 < path.stat().st_size < 1.2e6
    told = decisions(path)
    assert int(told[0]["scan"]) > 50 and int(told[-1]["scan"]) >= 499
    poses = replayed(path, chain.folder)
    assert abs(len(poses) - len(told)) <= 2
    # From a later start: another origin, the same way.
    def length(points):
        return sum(((x2 - x1) ** 2 + (y2 - y1) ** 2) ** 0.5 for (x1, y1), (x2, y2) in zip(points[::10], points[10::10]))

    flown = length([(int(one["map_x_um"]) / 1e6, int(one["map_y_um"]) / 1e6) for one in told])
    assert length([pose[1:] for pose in poses]) == pytest.approx(flown, rel=0.05)


def recorded_when_the_scanner_goes(chain, folder):
    simulator, firmware = fly(chain, folder, 60)
    simulator.kill()
    wait_until(lambda: recordings(folder, "fault") or "scanner lost" in firmware.err() and recordings(folder, "deadline"), 180,
               "the recording")
    assert firmware.end() == 0
    return recordings(folder, "fault")


def test_a_scanner_that_goes_away_is_recorded_with_what_came_of_it(chain, folder):
    for _ in range(TRIALS):  # where a busy machine was late just before, that was recorded, and a minute is quiet then
        if recorded_when_the_scanner_goes(chain, folder):
            break
        chain.listener.forget()
        for late in recordings(folder):
            late.unlink()
    path = recordings(folder, "fault")[-1]
    assert len(decisions(path)) >= 60 and len(replayed(path, chain.folder)) >= 60


def test_a_folder_that_cannot_be_written_is_named_and_harms_nothing(chain, folder):
    _, firmware = fly(chain, folder / "absent", 20)
    firmware.process.send_signal(signal.SIGUSR1)
    wait_until(lambda: "not written" in firmware.err(), 180, "the complaint")
    assert str(folder / "absent") in firmware.err()
    seen = len(chain.listener.poses)
    wait_until(lambda: len(chain.listener.poses) > seen + 10, 180, "more poses")
    assert firmware.end() == 0
