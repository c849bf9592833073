"""What every program answers alike: --help, --version, an option that it does not have, a file that is not there."""
import re
import shutil
import subprocess

import pytest

from at_hand import BINARIES, ROOT

VERSION = re.search(r'ALE_VERSION "(.*)"', (ROOT / "lib/base/version.h").read_text())[1]
ABSENT = "absent/file"
# How each is told of a file that is not there, and its exit code: a configuration is wrong use. Empty: reads none.
MISSING_FILE = {
    "ale-bridge": ("", 0),
    "ale-calibrate": (ABSENT, 1),
    "ale-console": (f"--http 127.0.0.1:0 --keys {ABSENT}", 1),
    "ale-explore": (f"--world {ABSENT}", 1),
    "ale-fleet": (f"replay {ABSENT} --out table.csv --program ale-replay", 1),
    "ale-foxglove": (f"convert {ABSENT} out.mcap", 1),
    "ale-grid": ("", 0),
    "ale-inspect": (f"{ABSENT} 0", 1),
    "ale-keys": (f"--list {ABSENT}", 1),
    "ale-latency": (ABSENT, 1),
    "ale-merge": (ABSENT, 1),
    "ale-mounting": (ABSENT, 1),
    "ale-odometry": ("", 0),
    "ale-plot": (ABSENT, 1),
    "ale-record": (f"--port /dev/null --no-lcm --out {ABSENT}", 1),
    "ale-replay": (ABSENT, 1),
    "ale-ros2": (f"--local --domain 201 --keys {ABSENT}", 1),
    "ale-screen": ("", 0),
    "ale-send": (f"--keys {ABSENT} stop", 1),
    "ale-sim": (f"--pty urg --world {ABSENT}", 1),
    "ale-slamd": (f"--config {ABSENT}", 2),
    "ale-watch": ("", 0),
}
if not shutil.which("idlc"):  # the bridge to ROS 2 is built where Cyclone DDS is
    del MISSING_FILE["ale-ros2"]


def run(name, *words, cwd=None):
    return subprocess.run([BINARIES / name, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=180, cwd=cwd,
                          check=False)


def test_every_program_is_in_the_table():
    assert sorted(path.name for path in BINARIES.iterdir()) == sorted(MISSING_FILE)


@pytest.mark.parametrize("name", MISSING_FILE)
def test_it_tells_how_it_is_used_and_its_version_on_stdout(name):
    told = run(name, "--help")
    assert (told.returncode, told.stderr) == (0, "")
    assert told.stdout.startswith(f"usage: {name} ")
    assert "--help, --version" in told.stdout and re.search("[Ee]xit", told.stdout)
    told = run(name, "--version")
    assert (told.returncode, told.stdout, told.stderr) == (0, f"{name} {VERSION}\n", "")


@pytest.mark.parametrize("name", MISSING_FILE)
def test_words_that_nothing_takes_are_a_failure(name):
    with open("/dev/full", "w", encoding="utf-8") as full:
        failed = subprocess.run([BINARIES / name, "--help"], stdin=subprocess.DEVNULL, stdout=full, stderr=subprocess.PIPE, text=True,
                                timeout=180, check=False)
    assert (failed.returncode, failed.stderr) == (1, f"{name}: standard output: No space left on device\n")


@pytest.mark.parametrize("name", MISSING_FILE)
def test_an_option_that_it_does_not_have_is_named_in_one_line(name):
    refused = run(name, "--no-such-option")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "--no-such-option" in refused.stderr and refused.stderr.count("\n") == 1


@pytest.mark.parametrize("name", MISSING_FILE)
def test_every_option_of_its_help_is_one_of_its_own(name):
    told = run(name, "--help").stdout
    for option in re.findall(r"^  (--[a-z-]+)", told, re.M):
        refused = run(name, f"{option}=", "--no-such-option")
        assert refused.returncode == 2 and refused.stderr.count("\n") == 1
        assert not re.search(f"(unknown|unrecognized) option '?{option}", refused.stderr), refused.stderr


@pytest.mark.parametrize("words", ["ale-bridge --connect 127.0.0.1:7700 --keys KEY", "ale-console --http 127.0.0.1:0", "ale-latency",
                                   "ale-record --port urg --out file", "ale-screen --once", "ale-send --keys KEY stop",
                                   f"ale-sim --pty urg --world {ROOT}/tools/lab/worlds/home.world",
                                   f"ale-sim --pty urg --drive --world {ROOT}/tools/lab/worlds/home.world", "ale-slamd", "ale-watch"])
def test_an_lcm_that_cannot_be_joined_is_told_in_one_line(words, tmp_path):
    name, *arguments = words.split()
    run("ale-keys", "alice", "--secret", "KEY", "--robot", "robot.keys", cwd=tmp_path)
    for url, why in [("udpm://1.2.3.4:7667", "1.2.3.4 is not a multicast address"), ("udpm://239.255.76.67:99999", "99999 is not a port"),
                     ("pigeon://x", "pigeon://x is no URL that is known here")]:
        failed = run(name, "--lcm-url", url, *arguments, cwd=tmp_path)
        assert failed.returncode == 1
        assert failed.stderr.startswith(f"{name}: LCM: {why}") and failed.stderr.count("\n") == 1


@pytest.mark.parametrize("name", [name for name, (words, _) in MISSING_FILE.items() if words])
def test_a_file_that_is_not_there_is_named_in_one_line(name, tmp_path):
    words, code = MISSING_FILE[name]
    failed = run(name, *words.split(), cwd=tmp_path)
    assert (failed.returncode, failed.stdout) == (code, "")
    assert failed.stderr.startswith(f"{name}: ") and ABSENT in failed.stderr and failed.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == [], "nothing is left behind"


@pytest.mark.parametrize("words", ["ale-replay LOG --map FILE.svg", "ale-replay LOG --save-map FILE", "ale-replay LOG --features FILE",
                                   "ale-replay LOG --timing FILE", "ale-calibrate LOG --plot FILE", "ale-calibrate LOG --out FILE",
                                   "ale-mounting LOG --out FILE", "ale-inspect LOG 0 --out FILE", "ale-merge LOG --out FILE", "ale-merge LOG --into FILE", "ale-watch --csv FILE",
                                   "ale-watch --trajectory FILE", "ale-explore --world WORLD --map FILE.svg",
                                   "ale-sim --world WORLD --write-log FILE", "ale-sim --world WORLD --pty urg --truth FILE"])
def test_a_result_that_cannot_be_written_is_told_before_the_work(words, tmp_path):
    log = tmp_path / "some.log"
    log.write_text("no scan is in it: to have read it would be told")
    (tmp_path / "folder.svg").mkdir()
    (tmp_path / "folder").mkdir()
    before = sorted(tmp_path.iterdir())
    for there, why in [("absent/FILE", "No such file or directory"), ("some.log/FILE", "Not a directory"), ("folder", "Is a directory")]:
        name, *arguments = [word.replace("FILE", there.replace("FILE", "result")).replace("LOG", "some.log")
                            .replace("WORLD", f"{ROOT}/tools/lab/worlds/home.world") for word in words.split()]
        failed = run(name, *arguments, cwd=tmp_path)
        assert (failed.returncode, failed.stdout) == (1, "")
        assert failed.stderr.endswith(f": {why}\n") and failed.stderr.count("\n") == 1, failed.stderr
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("words", ["ale-replay LOG --trajectory LOG", "ale-replay LOG --features ./LOG", "ale-replay LOG --save-map LOG",
                                   "ale-replay LOG --poses one --trajectory one", "ale-replay a.log --load-map LOG --features LOG", "ale-calibrate LOG --out LOG",
                                   "ale-mounting LOG --out LOG", "ale-inspect LOG 0 --out LOG", "ale-merge LOG --out LOG", "ale-watch --csv one --trajectory ./one",
                                   "ale-sim --world LOG --write-log LOG", "ale-sim --log LOG --pty urg --truth LOG",
                                   "ale-sim --world LOG --write-log one --truth one"])
def test_no_result_takes_the_place_of_what_it_is_made_from_or_of_another(words, tmp_path):
    log = tmp_path / "some.log"
    log.write_text("precious")
    name, *arguments = [word.replace("LOG", "some.log") for word in words.split()]
    refused = run(name, *arguments, cwd=tmp_path)
    assert (refused.returncode, refused.stdout, refused.stderr.count("\n")) == (2, "", 1)
    assert log.read_text() == "precious" and list(tmp_path.iterdir()) == [log]


@pytest.mark.parametrize("words", ["--points", "--save-map -", "--load-map -"])
def test_what_replay_would_pass_over_is_refused(words, tmp_path):
    refused = run("ale-replay", "some.log", *words.split(), cwd=tmp_path)
    assert (refused.returncode, refused.stdout, refused.stderr.count("\n")) == (2, "", 1)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("there, what", [("file", "is an ordinary file and no serial device"), ("folder", "is a directory and no serial device"),
                                         ("/dev/null", "is no serial device"), ("absent", "no such serial device")])
def test_what_is_there_instead_of_a_scanner_is_said(there, what, tmp_path):
    (tmp_path / "file").write_text("a recording")
    (tmp_path / "folder").mkdir()
    failed = run("ale-record", "--port", there, "--no-lcm", "--seconds", "1", "--out", "drive.scip", cwd=tmp_path)
    assert failed.returncode == 1 and f"{there}: {what}" in failed.stderr
    assert (tmp_path / "file").read_text() == "a recording"


@pytest.mark.parametrize("words", ["ale-latency .", "ale-send --keys . stop", "ale-console --http 127.0.0.1:0 --keys ."])
def test_a_folder_in_place_of_a_file_is_called_one(words, tmp_path):
    name, *arguments = words.split()
    failed = run(name, *arguments, cwd=tmp_path)
    assert (failed.returncode, failed.stderr) == (1, f"{name}: .: is a directory\n")
