"""ale-slamd as a daemon: signals, no device, wrong configuration, no rights, a restart."""
import os
import re
import shutil
import signal
import subprocess

import pytest

from chain import FIRMWARE
from waiting import assert_in_time, seconds_of, wait_until


def ask(*words, prefix=()):
    """Runs ale-slamd to its end: status, stdout, stderr."""
    done = subprocess.run([*prefix, FIRMWARE, *map(str, words)], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=180, check=False)
    return done.returncode, done.stdout, done.stderr


def assert_ends_quickly(chain, has_begun, number=signal.SIGTERM):
    def ended():
        chain.listener.forget()
        firmware = chain.firmware()
        wait_until(lambda: has_begun(firmware), 180, "what it begins with")
        seconds = seconds_of(lambda: firmware.end(number))
        assert firmware.wait(0) == 0
        return seconds
    assert_in_time(ended, most=2)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_cleanly_while_it_streams(chain, number):
    chain.simulator("--world", "tools/lab/worlds/home.world")
    assert_ends_quickly(chain, lambda firmware: len(chain.listener.poses) > 5 and "streaming" in firmware.err(), number)


def test_without_a_device_it_says_so_once_and_takes_it_when_it_comes(chain):
    firmware = chain.firmware()
    wait_until(lambda: len(chain.listener.statuses) >= 3, 180, "status messages")
    assert firmware.running()
    assert len(re.findall("no scanner", firmware.err())) == 1, firmware.err()
    assert str(chain.port)[:20] in firmware.err()
    assert chain.listener.statuses[-1].driver_state.startswith("no scanner: ")
    assert not chain.listener.poses
    chain.simulator("--world", "tools/lab/worlds/home.world")
    wait_until(lambda: len(chain.listener.poses) > 5, 180, "poses")
    wait_until(lambda: chain.listener.statuses[-1].driver_state == "streaming", 180, "the status")
    assert firmware.end() == 0


def test_a_signal_ends_it_quickly_without_a_device(chain):
    assert_ends_quickly(chain, lambda firmware: "no scanner" in firmware.err())


def test_it_starts_again_where_another_was_killed(chain):
    chain.simulator("--world", "tools/lab/worlds/home.world")
    first = chain.firmware()
    wait_until(lambda: len(chain.listener.poses) > 5, 180, "poses")
    first.kill()
    before = len(chain.listener.poses)
    boot = chain.listener.statuses[-1].boot if chain.listener.statuses else 0
    second = chain.firmware()
    wait_until(lambda: len(chain.listener.poses) > before + 10, 180, "poses again")
    wait_until(lambda: chain.listener.statuses and chain.listener.statuses[-1].boot != boot, 180, "a status")
    assert second.end() == 0


def test_a_hub_of_hostile_messages_does_not_disturb_it(chain):
    chain.simulator("--world", "tools/lab/worlds/home.world", "--no-odometry")
    firmware = chain.firmware()
    wait_until(lambda: len(chain.listener.poses) > 5, 180, "poses")
    for length in (0, 1, 8, 20, 28, 60000):
        chain.listener.bus.publish("ALE_ODOMETRY", b"\xff" * length)
    wait_until(lambda: chain.listener.statuses and chain.listener.counters()["odometry_refused"] >= 6, 180, "the count")
    before = len(chain.listener.poses)
    wait_until(lambda: len(chain.listener.poses) > before + 5, 180, "poses")
    assert firmware.end() == 0


@pytest.mark.parametrize("text, line, key", [
    ("[sensor]\ntheta = 9\n", 2, "sensor.theta"),
    ("[sensor]\n\nthetta = 1\n", 3, "sensor.thetta"),
    ("[extract]\nsmooth_span = 10\n", 2, "extract.smooth_span"),
    ("[robot]\nmax_speed\n", 2, ""),
    ("[sensor]\nbaud = 12345\n", 2, "sensor.baud: 12345 is no rate that a scanner has"),
    ("[lcm]\nurl = foo://\n", 2, "lcm.url: LCM: foo:// is no URL"),
    ("[lcm]\nurl = udpm://1.2.3.4\n", 2, "lcm.url: LCM: 1.2.3.4 is not a multicast address"),
    ("[lcm]\n\nprefix = two words\n", 3, "lcm.prefix: at most 16 letters"),
    ("\0" * 4096, 1, "holds control characters"),
    ("[sensor]\nx = 1\n" + "\0" * 500, 3, "holds control characters"),
    ("[sensor]\nx = 1\0\ny = 2\n", 2, "holds control characters"),
])
def test_a_bad_configuration_is_one_line_that_names_file_line_and_key(tmp_path, text, line, key):
    path = tmp_path / "robot.ini"
    path.write_text(text)
    status, out, err = ask("--config", path)
    assert status == 2
    assert out == ""
    assert err.count("\n") == 1
    assert f"{path}:{line}: {key}" in err
    assert ask("--config", path, "--check-config")[0] == 2


def test_the_printed_configuration_is_accepted_and_prints_the_same(tmp_path):
    status, text, _ = ask("--print-config")
    assert status == 0
    path = tmp_path / "robot.ini"
    path.write_text(text)
    assert ask("--config", path, "--check-config")[0] == 0
    assert ask("--config", path, "--print-config")[1] == text
    assert "ale-bridge --connect ROBOT:7700 --keys KEY" in text, "how a laptop hears it"


@pytest.mark.parametrize("words", [["--lcm-url", "carrier-pigeon://"], ["--lcm-url", "udpm://nowhere:1"]])
def test_an_lcm_that_cannot_be_opened_is_one_line(words):
    status, _, err = ask(*words)
    assert status == 1
    assert err.count("\n") == 1 and "LCM" in err


def test_a_map_that_cannot_be_read_is_one_line(tmp_path):
    status, _, err = ask("--map", tmp_path / "none.map", "--lcm-url", "memq://")
    assert status == 2
    assert err.count("\n") == 1 and "none.map" in err


def test_without_privileges_it_runs_and_says_what_is_missing(chain):
    prefix = []
    if os.geteuid() == 0:
        if not shutil.which("setpriv"):
            pytest.skip("no setpriv here to drop privileges with")
        prefix = ["setpriv", "--bounding-set=-all", "--inh-caps=-all", "--reuid=65534", "--clear-groups"]
        chain.folder.chmod(0o755)
    firmware = chain.start("ale-slamd", "--port", chain.port, "--lcm-url", chain.url, prefix=prefix)
    wait_until(lambda: chain.listener.statuses or not firmware.running(), 180, "a status")
    assert firmware.running(), firmware.err()
    assert "real time degraded" in firmware.err().splitlines()[0]
    assert "missing: " in firmware.err().splitlines()[0]
    assert not chain.listener.statuses[-1].realtime
    assert "missing: " in chain.listener.statuses[-1].realtime_detail
    assert firmware.end() == 0
