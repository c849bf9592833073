"""ale-watch --screen as its user meets it: one screen as text, or a live one on a terminal."""
import os
import pty
import select
import subprocess
import time

import pytest

from at_hand import BINARIES
from watching import lcm_url, pulse, robot  # noqa: F401 (fixtures)


LIVE = [["ale-watch", "--screen"], ["ale-screen"]]  # the latter is its older name


def run(*arguments, **more):
    return subprocess.run([BINARIES / arguments[0], *arguments[1:]], capture_output=True, text=True, timeout=180, check=False, **more)


@pytest.mark.parametrize("words", LIVE)
def test_without_a_terminal_it_says_so(lcm_url, words):
    done = run(*words, "--lcm-url", lcm_url, stdin=subprocess.DEVNULL)
    assert done.returncode == 1 and "no terminal" in done.stderr


@pytest.mark.parametrize("name", ["ale-watch", "ale-screen"])
def test_one_screen_has_the_state_the_map_and_the_numbers(lcm_url, robot, pulse, name):
    # The double sends its map with its first scan only.
    with subprocess.Popen([BINARIES / name, "--lcm-url", lcm_url, "--once"], stdout=subprocess.PIPE, text=True) as one:
        while one.poll() is None:
            robot.publish_map()
            time.sleep(0.1)
        picture = one.stdout.read()
    assert one.returncode == 0
    assert picture.startswith(" GOOD") and "double" in picture.splitlines()[0]
    assert "12 walls" in picture and "URG" not in picture.splitlines()[0]
    assert sum(picture.count(chr(code)) for code in range(0x2801, 0x2900)) > 100
    assert "streaming" in picture and "3 bad_checksum" in picture


class Terminal:
    """The program on a pseudo terminal of its own."""

    def __init__(self, *arguments):
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.execve(BINARIES / arguments[0], arguments,
                      {**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8", "COLUMNS": "100", "LINES": "30"})
        self.seen = b""

    def wait_for(self, text, seconds=180):
        end = time.monotonic() + seconds
        while text not in self.seen and time.monotonic() < end:
            if select.select([self.fd], [], [], 0.1)[0]:
                self.seen += os.read(self.fd, 65536)
        assert text in self.seen

    def end(self, key):
        os.write(self.fd, key)
        while True:
            try:
                if not os.read(self.fd, 65536):
                    break
            except OSError:
                break
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])


@pytest.mark.parametrize("words", LIVE)
@pytest.mark.parametrize("key", [b"q", b"\x03"])
def test_a_live_screen_shows_the_state_and_ends_by_key_or_ctrl_c(lcm_url, pulse, words, key):
    terminal = Terminal(*words, "--lcm-url", lcm_url)
    terminal.wait_for(b"GOOD")
    terminal.wait_for(b"heading")
    pulse.stop()
    terminal.wait_for(b"LINK LOST")
    assert terminal.end(key) == 0


def test_the_screen_leaves_files_too(lcm_url, robot, tmp_path):
    path = tmp_path / "t.tum"
    terminal = Terminal("ale-watch", "--screen", "--lcm-url", lcm_url, "--trajectory", str(path))
    terminal.wait_for(b"WAITING")
    robot.drive(3)
    terminal.wait_for(b"GOOD")
    assert terminal.end(b"q") == 0
    assert len(path.read_text().splitlines()) == 3
