"""ale-odometry on a pseudo terminal, and the senders of tools/library/odometry: ticks in, ALE_ODOMETRY out."""
import math
import os
import pty
import signal
import subprocess
import sys
import time
import tty

import ale
import pytest

from at_hand import BINARIES, BUILD, ROOT
from lcm_url import free_lcm_url
from waiting import Ear, wait_until

SENDERS = ROOT / "tools/library/odometry"
TRACK = 0.4
PER_METRE = 1000
# Metres of the left and the right wheel: ahead, a turn to the left, ahead.
WAY = [(0.02, 0.02)] * 25 + [(0.01, 0.03)] * 30 + [(0.02, 0.02)] * 10


def crc(text):
    total = 0xFFFF
    for byte in text.encode():
        total ^= byte << 8
        for _ in range(8):
            total = (total << 1) ^ 0x1021 if total & 0x8000 else total << 1
            total &= 0xFFFF
    return total


def line(left, right, micros):
    body = f"TICKS,{left},{right},{micros}"
    return f"${body}*{crc(body):04X}\r\n"


def lines_of(way, begin=(0, 0), micros=0):
    left, right = begin
    yield line(left, right, micros)
    for ahead_left, ahead_right in way:
        left, right, micros = left + round(ahead_left * PER_METRE), right + round(ahead_right * PER_METRE), micros + 20000
        yield line(left, right, micros)


def end_of(way):
    x = y = theta = 0.0
    for left, right in way:
        turn = (right - left) / TRACK
        x += (left + right) / 2 * math.cos(theta + turn / 2)
        y += (left + right) / 2 * math.sin(theta + turn / 2)
        theta += turn
    return x, y, math.remainder(theta, 2 * math.pi)


@pytest.fixture(name="url")
def a_bus():
    return free_lcm_url()


@pytest.fixture(name="heard")
def what_is_sent(url):
    heard = []
    ear = Ear(url, ["ALE_ODOMETRY"], lambda _, data: heard.append(ale.odometry_t.decode(data)))
    yield heard
    ear.stop()


def is_at(sample, place):
    return [sample.x, sample.y, math.remainder(sample.theta - place[2], 2 * math.pi)] == pytest.approx([*place[:2], 0], abs=2e-3)


class Board:
    """The far end of a serial line under a name, which may be pulled; there once the program has opened it."""

    def __init__(self, link, program):
        opened = program.said().count("open, waits")
        self.link = link
        self.near, self.far = pty.openpty()
        tty.setraw(self.near)
        tty.setraw(self.far)
        link.symlink_to(os.ttyname(self.far))
        wait_until(lambda: program.said().count("open, waits") > opened, 180, "the port is opened")

    def say(self, text):
        os.write(self.near, text if isinstance(text, bytes) else text.encode())

    def pull(self):
        self.link.unlink()
        os.close(self.near)
        os.close(self.far)


@pytest.fixture(name="program")
def a_program(tmp_path, url):
    process = subprocess.Popen([BINARIES / "ale-odometry", "--port", tmp_path / "board", "--left", str(PER_METRE), "--right", str(PER_METRE),
                                "--track", str(TRACK), "--lcm-url", url], stdout=subprocess.PIPE, stderr=(tmp_path / "said").open("w"), text=True)
    process.said = lambda: (tmp_path / "said").read_text()
    yield process
    process.kill()
    process.wait()


def test_ticks_become_odometry_and_noise_is_counted(program, tmp_path, heard):
    wait_until(lambda: "tried again every second" in program.said(), 180, "a word on the port")
    board = Board(tmp_path / "board", program)
    board.say(b"\xff\x00 boot noise\r\n")
    for text in lines_of(WAY, (-7, 2**31 - 100), 2**32 - 500000):
        board.say(text)
        time.sleep(0.002)
    wait_until(lambda: len(heard) == len(WAY) + 1, 180, "a message for each line")
    assert is_at(heard[-1], end_of(WAY))
    stamps = [sample.utime for sample in heard]
    assert stamps == sorted(set(stamps)) and abs(stamps[-1] / 1e6 - time.time()) < 600
    board.say("$TICKS,1,2\r\n")
    program.send_signal(signal.SIGTERM)
    told = program.communicate(timeout=180)[0]
    assert program.returncode == 0 and told.startswith(f"{len(WAY) + 1} lines, "), told


def test_a_board_that_is_pulled_and_put_back_goes_on(program, tmp_path, heard):
    board = Board(tmp_path / "board", program)
    for text in lines_of(WAY):
        board.say(text)
        time.sleep(0.002)
    wait_until(lambda: len(heard) == len(WAY) + 1, 180, "messages")
    board.pull()
    wait_until(lambda: "tried again every second" in program.said().split("ticks come")[-1], 180, "that it is gone")
    again = Board(tmp_path / "board", program)
    for text in lines_of([(0.02, 0.02)]):
        again.say(text)
    wait_until(lambda: len(heard) == len(WAY) + 3, 180, "messages again")
    x, y, theta = end_of(WAY)
    assert is_at(heard[-1], (x + 0.02 * math.cos(theta), y + 0.02 * math.sin(theta), theta))


def test_what_comes_in_place_of_ticks_is_said(program, tmp_path):
    board = Board(tmp_path / "board", program)

    def is_said():
        board.say("$GPGGA,123519,4807.038,N\r\n")
        return 'no ticks in what comes: "$GPGGA,123519' in program.said()

    wait_until(is_said, 180, "what comes")


@pytest.fixture(name="c_sender", scope="module")
def the_example_in_c(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sender")
    subprocess.run(["lcm-gen", "-c", "--c-cpath", folder, "--c-hpath", folder, ROOT / "lib/messages/ale.lcm"], check=True,
                   env={**os.environ, "PATH": "/usr/bin:/bin"})
    subprocess.run(["cc", "-w", "-c", folder / "ale_odometry_t.c", "-o", folder / "type.o"], check=True)
    subprocess.run(["cc", "-D_GNU_SOURCE", "-std=c11", "-Wall", "-Wextra", "-Werror", "-isystem", folder, SENDERS / "odometry.c", folder / "type.o",
                    "-llcm", "-lm", "-o", folder / "odometry"], check=True)
    return [folder / "odometry"]


@pytest.mark.parametrize("language", ["c", "python"])
def test_the_examples_send_what_the_wheels_did(language, c_sender, url, heard):
    command = c_sender if language == "c" else [sys.executable, SENDERS / "odometry.py"]
    wheels = "".join(f"{left} {right}\n" for left, right in WAY)
    subprocess.run([*command, str(TRACK)], check=True, input=wheels, text=True, timeout=180,
                   env={**os.environ, "LCM_DEFAULT_URL": url, "PYTHONPATH": str(BUILD / "python")})
    wait_until(lambda: len(heard) == len(WAY), 180, "a message for each line")
    assert is_at(heard[-1], end_of(WAY))


# What the sketch uses of Arduino's, and a robot that drives ahead: both encoders turn, the right one backwards.
ARDUINO = """
#include <cstdio>
#define INPUT_PULLUP 2
#define RISING 3
static unsigned long clock_us;
static void (*on_rise[2])();

static void pinMode(int, int) {}
static int digitalPinToInterrupt(int pin) { return pin - 2; }
static void attachInterrupt(int number, void (*handler)(), int) { on_rise[number] = handler; }
static int digitalRead(int pin) { return pin == 5; }
static void noInterrupts() {}
static void interrupts() {}
static unsigned long micros() { return clock_us; }
static struct { void begin(long) {} void print(const char *text) { fputs(text, stdout); } void print(char c) { putchar(c); } } Serial;
#include "SKETCH"
int main() { setup(); for (int k = 0; k < 1000; k++) { clock_us += 1000; on_rise[0](); on_rise[1](); loop(); } }
"""


def test_the_sketch_says_what_ale_odometry_reads(tmp_path):
    source = tmp_path / "board.cpp"
    source.write_text(ARDUINO.replace("SKETCH", str(SENDERS / "ale_odometry.ino")))
    subprocess.run(["g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", source, "-o", tmp_path / "sketch"], check=True)
    said = subprocess.run([tmp_path / "sketch"], check=True, capture_output=True, timeout=60).stdout.decode()
    lines = said.split("\r\n")
    assert len(lines) == 51 and lines[0] == line(20, -20, 20000).strip() and lines[49] == line(1000, -1000, 1000000).strip()
