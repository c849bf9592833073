"""ale-sim over its pseudo terminal, as a client meets it: both protocols, pacing, faults, logs, errors."""
import math
import os
import signal
import subprocess
import time

import pytest

from at_hand import BINARIES, WORLDS, shared
from priority import as_hardware
from scip_client import Client, Gone
from waiting import assert_in_time, seconds_of, wait_until

SIM = BINARIES / "ale-sim"
ROOM = "-1 -2 3 -2\n3 -2 3 1\n3 1 -1 1\n-1 1 -1 -2\n"
STREAM = "MD0044072501000"


class Simulator:
    def __init__(self, folder, *words, world=ROOM, odometry=False):
        self.folder = folder
        self.link = folder / "urg"
        source = ()
        if world is not None:
            (folder / "room.world").write_text(world, encoding="utf-8")
            source = ("--world", folder / "room.world")
        words = (SIM, *source, "--pty", self.link, *([] if odometry else ["--no-odometry"]), *words)
        self.process = subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True, preexec_fn=as_hardware)
        self.wait_for_link()

    def wait_for_link(self):
        wait_until(lambda: self.link.exists() or self.process.poll() is not None, 180, "the pseudo terminal")
        assert self.process.poll() is None, self.process.stderr.read()

    def tally(self, seconds=180):
        """Waits for the end; what was counted."""
        out, err = self.process.communicate(timeout=seconds)
        assert self.process.returncode == 0, err
        return {name: int(value) for name, value in (line.split() for line in out.splitlines())}

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.tally()


@pytest.fixture
def start(tmp_path):
    started = []

    def begin(*words, **others):
        folder = tmp_path / str(len(started))
        folder.mkdir()
        started.append(Simulator(folder, *words, **others))
        return started[-1]

    yield begin
    for simulator in started:
        simulator.process.kill()
        simulator.process.communicate()


def streaming(simulator, command=STREAM):
    client = Client(simulator.link)
    assert client.ask(command) == command.encode() + b"\n00P"
    return client


def test_a_stream_brings_whole_scans_ten_times_a_second(start):
    client = streaming(start("--noise", "none"))
    scans = [client.scan() for _ in range(12)]
    assert all(scan.echo == STREAM and len(scan.values) == 682 for scan in scans)
    assert {scan.values[340] for scan in scans} == {3000}
    gaps = [b.stamp_ms - a.stamp_ms for a, b in zip(scans, scans[1:])]
    assert all(99 <= gap <= 101 for gap in gaps), gaps


def test_a_scan_leaves_when_its_turn_is_over(start):
    client = Client(start("--noise", "none").link)
    least, most = -math.inf, math.inf  # between these the zero of the device's clock lies
    client.ask("TM0")
    for _ in range(10):
        before = time.monotonic()
        stamp = client.ask("TM1").split(b"\n")[2]
        device = sum((c - 48) << 6 * (3 - k) for k, c in enumerate(stamp[:4])) / 1000
        least, most = max(least, before - device - 0.001), min(most, time.monotonic() - device)
    client.ask("TM2")
    client.ask(STREAM)
    shortest = math.inf
    for _ in range(50):
        scan = client.scan()
        shortest = min(shortest, time.monotonic() - scan.stamp_ms / 1000)
        assert shortest - least > 0.095
        if shortest - most < 0.125:
            return
    raise AssertionError(f"of fifty none came in time: {shortest - most} s at best")


def test_speed_scales_the_pace_and_the_device_clock_together(start):
    client = streaming(start("--speed", 5))

    def five_seconds():
        first = client.scan()
        begin = time.monotonic()
        scans = [client.scan() for _ in range(50)]
        assert scans[-1].stamp_ms - first.stamp_ms == pytest.approx(5000, abs=1)
        return time.monotonic() - begin
    assert_in_time(five_seconds, 0.9, 1.5)


def test_nothing_is_played_before_a_client_asks_for_ranges(start):
    simulator = start("--once", "--speed", 4, world=ROOM + "# via 0.3 0\n")
    client = Client(simulator.link)
    assert client.ask("VV").startswith(b"VV\n00P\nVEND:")
    time.sleep(0.3)
    assert client.ask("BM") == b"BM\n00P"
    client.ask(STREAM)
    received = 0
    with pytest.raises(Gone):
        while True:
            client.scan()
            received += 1
    tally = simulator.tally()
    assert tally["sent"] == received == tally["scans"]


def test_the_same_seed_gives_the_same_values_over_the_line(start):
    runs = []
    for seed in (7, 7, 8):
        client = streaming(start("--seed", seed, "--speed", 5))
        runs.append([client.scan().values for _ in range(5)])
    assert runs[0] == runs[1]
    assert runs[0] != runs[2]


def test_scip1_polls_and_switches(start):
    client = Client(start("--protocol", "scip1", "--noise", "none").link)
    assert client.ask("QT") == b"QT\nE"
    echo, status, *data = client.ask("G00076801").split(b"\n")
    assert (echo, status) == (b"G00076801", b"0")
    assert [len(line) for line in data] == [64] * 24 + [2]
    assert b"".join(data)[:88] == b"0C" * 44
    assert client.ask("G38438401") == b"G38438401\n0\n" + bytes([3000 // 64 + 48, 3000 % 64 + 48])
    assert client.ask("SCIP2.0") == b"SCIP2.0\n0"
    assert client.ask("QT") == b"QT\n00P"
    client.ask(STREAM)
    assert client.scan().values[340] == 3000


def test_old_firmware_cannot_be_switched(start):
    client = Client(start("--protocol", "scip1-only").link)
    assert client.ask("SCIP2.0") == b"SCIP2.0\nE"
    assert client.ask("V").startswith(b"V\n0\nVEND:")


def test_slow_firmware_answers_once_a_turn(start):
    client = Client(start("--command-interval", 100).link)
    client.ask("QT")
    assert_in_time(lambda: seconds_of(lambda: [client.ask("QT") for _ in range(5)]), 0.45, 0.9)


def test_the_rate_limit_is_kept_and_costs_scans(start):
    client = streaming(start("--baud-limit", 11520))

    def five_frames():
        first = client.scan()
        begin = time.monotonic()
        scans = [client.scan() for _ in range(5)]
        assert scans[-1].stamp_ms - first.stamp_ms >= 9 * 100, "a frame takes 186 ms: every second scan at most"
        return time.monotonic() - begin
    assert_in_time(five_frames, least=5 * 2137 / (11520 * 1.03))


def test_a_killed_client_leaves_it_streaming_and_the_next_one_starts_fresh(start):
    simulator = start("--speed", 5)
    client = streaming(simulator)
    last = [client.scan() for _ in range(3)][-1]
    client.close()
    time.sleep(0.5)
    client = Client(simulator.link)
    reply = client.reply()
    if not reply.startswith(STREAM.encode()):  # of this one a part came before the client had made its line raw
        reply = client.reply()
    stamp = reply.split(b"\n")[2][:4]
    assert reply.startswith(STREAM.encode())
    fresh = sum((c - 48) << 6 * (3 - k) for k, c in enumerate(stamp))
    assert fresh - last.stamp_ms > 2000, "what nobody listened to is gone"


def test_a_client_without_any_mode_of_its_own_gets_a_raw_line(start):
    client = Client(start().link, raw=False)
    os.write(client.fd, b"VV\nQT\n")
    assert client.reply().startswith(b"VV\n00P\nVEND:")
    assert client.reply() == b"QT\n00P"


def frames_around(start, fault, count=14):
    simulator = start("--speed", 4, "--noise", "none", "--faults", fault)
    client = streaming(simulator)
    data = b""
    while data.count(b"\n\n") < count:
        got = client.read_some(60)
        assert got
        data += got
    return data


def well_formed(frame):
    lines = frame.split(b"\n")
    return len(lines) == 35 and lines[0] == STREAM.encode() and all(
        chr((sum(line[:-1]) & 63) + 48).encode() == line[-1:] for line in lines[1:])


def test_a_flipped_bit_spoils_one_frame(start):
    frames = frames_around(start, "flip@#5").split(b"\n\n")[:12]
    assert 1 <= sum(not well_formed(frame) for frame in frames) <= 2


def test_a_cut_frame_runs_into_the_next(start):
    frames = frames_around(start, "cut@#5").split(b"\n\n")[:12]
    spoiled = [frame for frame in frames if not well_formed(frame)]
    assert 1 <= len(spoiled) <= 2, "on a busy machine another scan may be late and left out halfway"
    assert any(frame.count(STREAM.encode()) == 2 for frame in spoiled) and well_formed(frames[-1])


def test_garbage_comes_before_a_frame(start):
    data = frames_around(start, "garbage:300@#5")
    good = sum(well_formed(frame) for frame in data.split(b"\n\n"))
    assert good >= 11
    assert len(data) % 2137 == 300 or any(byte > 0x7E for byte in data)


def test_a_repeated_frame_is_the_same_again(start):
    frames = frames_around(start, "repeat@#5").split(b"\n\n")[:12]
    same = [a == b for a, b in zip(frames, frames[1:])]
    assert same.count(True) == 1


def test_silence_is_deaf_and_dumb_and_then_goes_on(start):
    client = streaming(start("--faults", "silence:2@0.5"))
    before = [client.scan() for _ in range(4)][-1]
    while client.read_some(1):  # more than a busy machine holds it up
        pass
    client.buffer = b""
    client.send("QT")
    after = client.scan()
    assert after.stamp_ms - before.stamp_ms >= 2000
    assert client.scan().stamp_ms > after.stamp_ms, "it has not heard QT"


def test_unplugged_it_hangs_up_and_returns_as_after_power_up(start):
    assert_in_time(lambda: unplugged_for(start), 0.9, 2)


def unplugged_for(start):
    """The seconds without a device, of which it was told to be without one for one."""
    simulator = start("--faults", "unplug:1@0.5", "--protocol", "scip1")
    client = Client(simulator.link)
    client.ask("SCIP2.0")
    client.ask(STREAM)
    with pytest.raises(Gone):
        while True:
            client.scan()
    begin = time.monotonic()
    assert not simulator.link.exists()
    old = os.ttyname(client.fd) if os.isatty(client.fd) else None
    simulator.wait_for_link()
    seconds = time.monotonic() - begin
    assert os.readlink(simulator.link) != old, "the old node is still held"
    client.close()
    assert Client(simulator.link).ask("QT") == b"QT\nE"
    return seconds


def test_a_reset_comes_back_in_scip1_with_a_silent_stream(start):
    client = streaming(start("--faults", "reset11@#4"))
    for _ in range(4):
        client.scan()
    assert client.read_some(0.5) == b""
    assert client.ask("QT") == b"QT\nE"
    assert client.ask("SCIP2.0") == b"SCIP2.0\n0"
    client.ask("TM0")
    assert client.ask("TM1").split(b"\n")[2][:1] == b"0", "its clock began anew"


def test_a_hardware_fault_is_a_status_in_the_stream(start):
    client = streaming(start("--faults", "hardware:50@#3"))
    for _ in range(3):
        client.scan()
    assert client.reply() == STREAM.encode() + b"\n50U"
    assert client.ask("II").find(b"LASR:OFF") > 0


def test_the_clock_passes_24_bits(start):
    client = streaming(start("--faults", "wrap@1"))
    stamps = [client.scan().stamp_ms for _ in range(20)]
    assert stamps[0] > 0xFFFFFF - 2000
    assert stamps[-1] < 2000
    assert all((b - a) % 0x1000000 in (99, 100, 101) for a, b in zip(stamps, stamps[1:]))


def test_a_slow_reader_gets_whole_frames_only(start):
    client = streaming(start("--speed", 20, "--noise", "none"))
    time.sleep(3)
    for _ in range(40):
        assert client.scan().values[340] == 3000


def test_the_truth_has_one_line_for_every_scan_sent(start, tmp_path):
    simulator = start("--once", "--speed", 5, "--truth", tmp_path / "truth.tum", world=ROOM + "# via 1 0\n")
    client = streaming(simulator)
    with pytest.raises(Gone):
        while True:
            client.scan()
    sent = simulator.tally()["sent"]
    lines = [[float(word) for word in line.split()] for line in (tmp_path / "truth.tum").read_text().splitlines()]
    assert len(lines) == sent > 20
    assert all(len(line) == 8 for line in lines)
    gaps = {round(b[0] - a[0], 3) for a, b in zip(lines, lines[1:])}
    assert gaps <= {0.099, 0.1, 0.101}
    assert lines[0][1:3] == pytest.approx([0, 0], abs=0.05)
    assert lines[-1][1] == pytest.approx(1, abs=0.05)


def test_a_written_log_is_deterministic_and_complete(tmp_path):
    def write(seed, name):
        words = [SIM, "--world", WORLDS / "home.world", "--write-log", tmp_path / name, "--truth",
                 tmp_path / (name + ".tum"), "--seed", seed]
        out = subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout
        return int(out.split()[1]), (tmp_path / name).read_text(), (tmp_path / (name + ".tum")).read_text()

    scans, log, truth = write(1, "a")
    assert (scans, log, truth) == write(1, "b")
    assert log != write(2, "c")[1]
    lines = log.splitlines()
    assert lines[0] == "# beam_time_us 97.65625 stamp_beam 340"
    assert len(lines) - 1 == len(truth.splitlines()) == scans
    assert 550 <= scans <= 650, "about a minute"
    words = lines[1].split()
    assert words[0] == "ROBOTLASER1" and int(words[8]) == 682
    assert float(words[-3]) == pytest.approx(0.0375)
    last = [float(word) for word in truth.splitlines()[-1].split()]
    assert math.hypot(last[1] - 1.5, last[2] - 1.5) < 0.1, "back at the start"


def test_a_log_is_played_as_it_was_recorded(start, tmp_path):
    log = tmp_path / "room.log"
    (tmp_path / "room.world").write_text(ROOM + "# via 0.3 0\n", encoding="utf-8")
    subprocess.run([SIM, "--world", tmp_path / "room.world", "--write-log", log], check=True, capture_output=True)
    recorded = [line.split() for line in log.read_text().splitlines() if line.startswith("ROBOTLASER1")]
    simulator = start("--log", log, "--once", "--speed", 4, world=None)
    client = streaming(simulator)
    played = []
    with pytest.raises(Gone):
        while True:
            played.append(client.scan())
    assert len(played) == len(recorded)
    for scan, words in zip(played, recorded):
        assert scan.values == [round(float(word) * 1000) for word in words[9:9 + 682]]
    assert simulator.tally()["sent"] == len(recorded)


def test_a_real_recording_is_played_with_its_error_codes(start):
    recording = shared("data/urg04lx/exp1.dat")
    rows = [[int(word) for word in line.split()[25:707]] for line in recording.read_text().splitlines()[:40]]
    client = streaming(start("--log", recording, "--speed", 8, world=None))
    for row in rows:
        assert client.scan().values == row


def test_the_description_is_a_configuration(tmp_path):
    (tmp_path / "room.world").write_text(ROOM + "# sensor 0.1 -0.05 0.2\n", encoding="utf-8")
    words = [SIM, "--world", tmp_path / "room.world", "--describe", "--odometry-lag", "0.15"]
    out = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    (tmp_path / "robot.ini").write_text(out, encoding="utf-8")
    printed = subprocess.run([SIM.parent / "ale-slamd", "--config", tmp_path / "robot.ini", "--print-config"],
                             check=True, capture_output=True, text=True).stdout
    values = [line for line in printed.splitlines() if line and not line.startswith(("#", ";"))]
    assert "x = 0.100000" in values or "x = 0.1" in values
    assert "lag_us = 150000" in values


@pytest.mark.parametrize("words, code, message", [
    ([], 2, "give either --log LOG or --world WORLD"),
    (["--world", "w", "--log", "l", "--pty", "p"], 2, "give either"),
    (["--world", "w"], 2, "give either --pty LINK or --tcp PORT"),
    (["--log", "l", "--pty", "p", "--drive"], 2, "--drive needs a --world"),
    (["--log", "l", "--pty", "p", "--truth", "t"], 2, "--truth"),
    (["--world", "w", "--pty", "p", "--speed", "0"], 2, "--speed 0"),
    (["--world", "w", "--pty", "p", "--protocol", "scip3"], 2, "scip3"),
    (["--world", "w", "--pty", "p", "--faults", "burn@3"], 2, "burn"),
    (["--world", "w", "--pty", "p", "--noise", "loud"], 2, "loud"),
    (["--world", "w", "--pty", "p", "--bogus"], 2, "bogus"),
    (["--world", "w", "--pty", "p", "more"], 2, "more"),
    (["--world", "no/such.world", "--pty", "p"], 1, "no/such.world"),
    (["--log", "no/such.log", "--pty", "p"], 1, "no/such.log"),
])
def test_wrong_use_is_one_line(tmp_path, words, code, message):
    done = subprocess.run([SIM, *words], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == code
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_a_file_in_the_place_of_the_link_is_left_alone(tmp_path):
    (tmp_path / "urg").write_text("mine", encoding="utf-8")
    done = subprocess.run([SIM, "--world", WORLDS / "home.world", "--no-odometry", "--pty", tmp_path / "urg"],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "no symbolic link" in done.stderr
    assert (tmp_path / "urg").read_text() == "mine"


def test_a_stale_link_is_replaced_and_the_own_one_removed(tmp_path, start):
    simulator = start()
    other = simulator.folder / "urg2"
    other.symlink_to("/dev/null")
    second = subprocess.Popen([SIM, "--world", simulator.folder / "room.world", "--no-odometry", "--pty", other])
    wait_until(lambda: os.readlink(other) != "/dev/null", 180, "the new link")
    second.terminate()
    assert second.wait(timeout=180) == 0
    assert not other.is_symlink()
    simulator.stop()
    assert not simulator.link.is_symlink()
