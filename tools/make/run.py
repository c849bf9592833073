#!/usr/bin/env python3
"""Plays a recording through the whole chain, in real time: ale-sim -> pseudo terminal -> ale-slamd -> LCM ->
ale-console and ale-watch.

    run.py [--build build] [--log LOG | --world WORLD] [--speed X]

Needs neither screen nor root. Leaves map.png, map.svg, trajectory.tum and the programs' messages in
BUILD/run. Exit 0 only when every program ended well and every scan that was sent has its pose.
"""
import argparse
import ctypes
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))
import lcm_url  # noqa: E402

START_SECONDS = 10
ANSWER_SECONDS = 10
STOP_SECONDS = 10
STALL_SECONDS = 60  # without any new pose while the recording plays
PR_SET_PDEATHSIG = 1
PROGRAMS = ("ale-sim", "ale-slamd", "ale-console", "ale-watch")
DEFAULT_WORLD = pathlib.Path("tools/worlds/home.world")


class Failure(Exception):
    """What went wrong, in one line."""


def say(text):
    print(text, flush=True)


class Program:
    """One program of the chain; what it says goes to a file, and its lines to whoever listens."""

    def __init__(self, folder, command, on_line=None):
        self.name = pathlib.Path(command[0]).name
        self.log = folder / f"{self.name}.log"
        self.lines = []
        self.on_line = on_line
        libc = ctypes.CDLL(None)
        with self.log.open("wb") as messages:
            self.process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=messages, start_new_session=True,
                preexec_fn=lambda: libc.prctl(PR_SET_PDEATHSIG, signal.SIGTERM), text=True, errors="replace")
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip("\n"))
            if self.on_line:
                self.on_line(self.lines[-1])

    def said(self):
        """All it wrote: results and messages."""
        return "\n".join([*self.lines, self.log.read_text(encoding="utf-8", errors="replace")])

    def running(self):
        return self.process.poll() is None

    def stop(self):
        if self.running():
            self.process.send_signal(signal.SIGTERM)

    def end(self, seconds=STOP_SECONDS):
        """Waits for its end; the exit code."""
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise Failure(f"{self.name} did not end within {seconds} s, see {self.log}") from None
        self.reader.join(1)
        return self.process.returncode

    def require_success(self, seconds=STOP_SECONDS):
        code = self.end(seconds)
        if code != 0:
            raise Failure(f"{self.name} ended with {code}: {self.last_words()}")

    def last_words(self):
        words = self.log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return words[-1] if words else f"without a word, see {self.log}"


class Chain:
    """The programs that run, stopped in the opposite order of their start."""

    def __init__(self, folder, binaries):
        self.folder = folder
        self.binaries = binaries
        self.programs = []

    def start(self, name, *arguments, on_line=None):
        program = Program(self.folder, [str(self.binaries / name), *map(str, arguments)], on_line)
        self.programs.append(program)
        return program

    def wait_until(self, condition, what, seconds):
        """Waits for a condition; fails when a program dies before, or the time is over."""
        deadline = time.monotonic() + seconds
        while not condition():
            for program in self.programs:
                if not program.running() and program.process.returncode != 0:
                    raise Failure(f"{program.name} ended with {program.process.returncode}: {program.last_words()}")
            if time.monotonic() > deadline:
                raise Failure(f"{what} did not happen within {seconds} s, see {self.folder}")
            time.sleep(0.02)

    def stop_all(self):
        for program in reversed(self.programs):
            program.stop()
        for program in reversed(self.programs):
            try:
                program.end()
            except Failure as failure:
                say(str(failure))


def prepare_multicast():
    """LCM needs a route for multicast; a container may have none. The loopback serves."""
    try:
        if lcm_url.ensure_multicast():
            say("no route for multicast here: using the loopback")
    except lcm_url.NoMulticast as reason:
        raise Failure(str(reason)) from reason


def ask(command):
    """Runs a program to its end; what it printed."""
    done = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, errors="replace", check=False)
    if done.returncode != 0:
        words = done.stderr.strip().splitlines() or ["without a word"]
        raise Failure(f"{pathlib.Path(command[0]).name} ended with {done.returncode}: {words[-1]}")
    return done.stdout


def require_programs(binaries, names):
    for name in names:
        if not (binaries / name).exists():
            raise Failure(f"{binaries / name} is missing: run make first")


def recording_of(world, folder, binaries):
    """The recording of a drive through a world, made once by the simulator."""
    recording = folder / f"{world.stem}.log"
    simulator = binaries / "ale-sim"
    made_from = max(path.stat().st_mtime for path in (world, simulator))
    if not recording.exists() or recording.stat().st_mtime < made_from:
        ask([simulator, "--world", world, "--write-log", recording, "--truth", recording.with_suffix(".truth.tum")])
    return recording


def write_config(recording, folder, binaries):
    """What the recording says about mounting and wheels, plus the scans for the console."""
    config = folder / "ale-slamd.ini"
    described = ask([binaries / "ale-sim", "--log", recording, "--describe"])
    config.write_text(described + "\n[lcm]\npublish_scan = true\n", encoding="utf-8")
    return config


def last_number(pattern, lines):
    """The number in the last line that has one, else None."""
    for line in reversed(lines):
        found = re.search(pattern, line)
        if found:
            return int(found[1])
    return None


class Tally:
    """Poses as ale-watch counts them, once a second."""

    def __init__(self, watch):
        self.watch = watch
        self.before = 0
        self.changed = time.monotonic()

    @property
    def poses(self):
        return last_number(r"poses +(\d+)", self.watch.lines) or 0

    def require_progress(self):
        now = time.monotonic()
        if self.poses != self.before:
            self.before, self.changed = self.poses, now
        elif now - self.changed > STALL_SECONDS:
            raise Failure(f"no new pose for {STALL_SECONDS} s, after {self.before}; see {self.watch.log.parent}")


def play(chain, recording, speed):
    """The run itself. How many scans the scanner took, how many of them it sent, and how many poses came."""
    url = lcm_url.free_lcm_url()
    folder = chain.folder
    port = folder / "urg"
    config = write_config(recording, folder, chain.binaries)

    console = chain.start("ale-console", "--lcm-url", url, "--http", "127.0.0.1:0")
    watch = chain.start("ale-watch", "--lcm-url", url, "--map", folder / "map.png", "--map", folder / "map.svg",
                        "--trajectory", folder / "trajectory.tum", on_line=say)
    chain.wait_until(lambda: console.lines and "listening" in watch.said(), "start of console and watch", START_SECONDS)
    say(f"playing {recording}; watch it at {console.lines[0]}")

    sim = chain.start("ale-sim", "--log", recording, "--pty", port, "--once", "--speed", speed, "--lcm-url", url)
    chain.wait_until(port.exists, "the simulated scanner", START_SECONDS)
    slamd = chain.start("ale-slamd", "--config", config, "--port", port, "--lcm-url", url, "--time-scale", speed)

    tally = Tally(watch)
    chain.wait_until(lambda: tally.require_progress() or not sim.running(), "the end of the recording", float("inf"))
    sim.require_success()
    scans, sent = (last_number(rf"^{word} (\d+)", sim.lines) for word in ("scans", "sent"))
    if sent is None:
        raise Failure(f"ale-sim did not say how many scans it sent, see {sim.log}")
    chain.wait_until(lambda: tally.poses >= sent, "the last pose", ANSWER_SECONDS)
    for program in (slamd, watch, console):
        program.stop()
        program.require_success()
    return scans, sent, last_number(r"^(\d+) poses", watch.lines)


def results(folder):
    return [folder / name for name in ("map.png", "map.svg", "trajectory.tum")]


def run(arguments):
    binaries = arguments.build / "bin"
    folder = arguments.build / "run"
    folder.mkdir(parents=True, exist_ok=True)
    require_programs(binaries, PROGRAMS)
    for old in [*results(folder), folder / "urg"]:
        old.unlink(missing_ok=True)
    prepare_multicast()
    recording = arguments.log or recording_of(arguments.world, folder, binaries)
    chain = Chain(folder, binaries)
    try:
        scans, sent, answered = play(chain, recording, arguments.speed)
    finally:
        chain.stop_all()
    for result in results(folder):
        if not result.exists() or result.stat().st_size == 0:
            raise Failure(f"{result} was not written")
    # A scan that never left the scanner may be noticed by the gap in the stamps, and answered too.
    if not sent <= answered <= scans:
        raise Failure(f"{sent} of {scans} scans sent, but {answered} poses came")
    say(f"{sent} scans sent, {answered} poses came; results in {', '.join(map(str, results(folder)))}")


def positive(text):
    value = float(text)
    if not 0 < value < 1e6:
        raise ValueError
    return value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"), help="where the programs are")
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--log", type=pathlib.Path, help="recording to play (default: made from the world)")
    source.add_argument("--world", type=pathlib.Path, default=DEFAULT_WORLD, help=f"world to drive through (default {DEFAULT_WORLD})")
    parser.add_argument("--speed", type=positive, default=1.0, help="faster than real time by this factor")
    arguments = parser.parse_args()

    def interrupted(*_):
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, interrupted)
    try:
        run(arguments)
    except Failure as failure:
        print(f"run: {failure}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("run: interrupted, all programs stopped", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
