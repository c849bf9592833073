"""Programs that run together: started, watched, and stopped in the opposite order, whatever happens."""
import ctypes
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "library/python"))
import lcm_url  # noqa: E402

START_SECONDS = 60  # a busy machine may take its time
ANSWER_SECONDS = 60
STOP_SECONDS = 60
STALL_SECONDS = 60  # without any new pose while the robot should have some
PR_SET_PDEATHSIG = 1


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


def private_lcm_url():
    """LCM for these programs alone. It needs a route for multicast; a container may have none: the loopback serves."""
    try:
        if lcm_url.ensure_multicast():
            say("no route for multicast here: using the loopback")
    except lcm_url.NoMulticast as reason:
        raise Failure(str(reason)) from reason
    return lcm_url.free_lcm_url()


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


def last_number(pattern, lines):
    """The number in the last line that has one, else None."""
    for line in reversed(lines):
        found = re.search(pattern, line)
        if found:
            return int(found[1])
    return None


class Tally:
    """Poses as ale-watch counts them, once a second."""

    def __init__(self, watch, pause_seconds=0):
        """pause_seconds: as long as it may be that no scan is due."""
        self.watch = watch
        self.stall_seconds = STALL_SECONDS + pause_seconds
        self.before = 0
        self.changed = time.monotonic()

    @property
    def poses(self):
        return last_number(r"poses +(\d+)", self.watch.lines) or 0

    def rests(self, seconds):
        """No new pose for so long."""
        self._look()
        return time.monotonic() - self.changed > seconds

    def _look(self):
        if self.poses != self.before:
            self.before, self.changed = self.poses, time.monotonic()

    def require_progress(self):
        if self.rests(self.stall_seconds):
            raise Failure(f"no new pose for {self.stall_seconds:.0f} s, after {self.before}; see {self.watch.log.parent}")


def positive(text):
    value = float(text)
    if not 0 < value < 1e6:
        raise ValueError
    return value


def common_options(parser):
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"), help="where the programs are")
    parser.add_argument("--speed", type=positive, default=1.0, help="faster than real time by this factor")


def conclude(name, work):
    """Does the work; the exit code. Ctrl-C and SIGTERM end it alike, also where a shell began it in the background."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        work()
    except Failure as failure:
        print(f"{name}: {failure}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"{name}: interrupted, all programs stopped", file=sys.stderr)
        return 130
    return 0
