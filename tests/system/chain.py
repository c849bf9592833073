"""The real programs, started and stopped: simulator, firmware, and a listener that keeps all that is published."""
import bisect
import math
import os
import pathlib
import signal
import subprocess
import time

import ale

from at_hand import BINARIES, WORLDS
from priority import as_hardware
from waiting import Ear, wait_until

FIRMWARE = pathlib.Path(os.environ.get("ALE_SLAMD", BINARIES / "ale-slamd")).resolve()
IN_TIME_S = 0.015
TYPES = {"ALE_POSE": ale.pose_t, "ALE_FEATURES": ale.features_t, "ALE_SCAN": ale.scan_t, "ALE_MAP": ale.map_t,
         "ALE_STATUS": ale.status_t, "ALE_TRACKING": ale.tracking_t, "ALE_MAP_PIECES": ale.map_pieces_t,
         "ALE_PLAN": ale.plan_t, "ALE_GRAPH": ale.graph_t}


def program_path(name):
    """Of the build, or the firmware that is to be tested in its place (ALE_SLAMD)."""
    return FIRMWARE if name == "ale-slamd" else BINARIES / name


class Program:
    """One program with its output in files."""

    def __init__(self, folder, name, *words, prefix=(), prepare=None):
        self.name = name
        self.out_path = folder / f"{name}.{time.monotonic_ns()}.out"
        self.err_path = self.out_path.with_suffix(".err")
        with open(self.out_path, "w", encoding="utf-8") as out, open(self.err_path, "w", encoding="utf-8") as err:
            self.process = subprocess.Popen([*prefix, program_path(name), *map(str, words)], stdout=out, stderr=err,
                                            stdin=subprocess.DEVNULL, preexec_fn=prepare)

    def out(self):
        return self.out_path.read_text(encoding="utf-8", errors="replace")

    def err(self):
        return self.err_path.read_text(encoding="utf-8", errors="replace")

    def running(self):
        return self.process.poll() is None

    def wait(self, seconds):
        return self.process.wait(timeout=seconds)

    def wait_until(self, condition, what):
        """Fails at once, with its words, when the program has ended before the condition came."""
        wait_until(lambda: condition() or not self.running(), 180, what)
        assert self.running(), f"{self.name} ended with {self.process.returncode} before {what}: {self.err()}"

    def end(self, number=signal.SIGTERM, seconds=180):
        """Sends a signal; the exit status."""
        if self.running():
            self.process.send_signal(number)
        return self.wait(seconds)

    def kill(self):
        if self.running():
            self.process.kill()
        self.process.wait()


class Listener(Ear):
    """Keeps every message of the firmware on the channels that are asked for."""

    def __init__(self, url, channels):
        self.messages = {channel: [] for channel in TYPES}
        super().__init__(url, channels, self._take)

    def _take(self, channel, data):
        self.messages[channel].append(TYPES[channel].decode(data))

    def forget(self):
        self.messages.update({channel: [] for channel in self.messages})

    @property
    def poses(self):
        return self.messages["ALE_POSE"]

    @property
    def features(self):
        return self.messages["ALE_FEATURES"]

    @property
    def statuses(self):
        return self.messages["ALE_STATUS"]

    @property
    def map_parts(self):
        return self.messages["ALE_MAP"]

    def counters(self):
        status = self.statuses[-1]
        return dict(zip(status.counter_name, status.counter_value))


class Chain:
    """A folder, an LCM port, and the programs on them."""

    def __init__(self, folder, url, channels=tuple(TYPES)):
        self.folder = folder
        self.url = url
        self.port = folder / "urg"
        self.truth_path = folder / "truth.tum"
        self.programs = []
        self.listener = Listener(url, channels)

    def start(self, name, *words, **how):
        program = Program(self.folder, name, *words, **how)
        self.programs.append(program)
        return program

    def simulator(self, *words, speed=1):
        sim = self.start("ale-sim", "--pty", self.port, "--speed", speed, "--lcm-url", self.url, *words,
                         prepare=as_hardware)
        sim.wait_until(self.port.exists, "the simulated scanner")
        return sim

    def drive(self, world, *words, speed=1):
        """A simulated drive through a world that ends by itself and leaves its truth."""
        return self.simulator("--world", WORLDS / f"{world}.world", "--truth", self.truth_path, "--once", *words,
                              speed=speed)

    def firmware(self, config="", *words, speed=1, prefix=()):
        path = self.folder / "robot.ini"
        path.write_text(config, encoding="utf-8")
        return self.start("ale-slamd", "--config", path, "--port", self.port, "--lcm-url", self.url, "--time-scale",
                          speed, *words, prefix=prefix)

    def play_to_the_end(self, simulator, firmware):
        """Waits until all that was sent is answered, and ends the firmware; what the simulator counted."""
        assert simulator.wait(300) == 0, simulator.err()
        counted = tally(simulator)
        statuses = self.listener.statuses
        wait_until(lambda: statuses and (statuses[-1].poses >= counted["sent"] or
                                         statuses[-1].driver_state.startswith("no scanner")), 180, "the last pose")
        assert firmware.end() == 0
        return counted

    def all_went_well(self, counted):
        """Whether the machine was not too busy for every scan to be sent in time, used, and its pose to be heard."""
        return (counted["swallowed"] == 0 and len(self.listener.poses) == counted["sent"]
                and self.listener.counters()["overloaded"] == 0 and self.scans_came_in_time())

    def scans_came_in_time(self, poses=None):
        """Whether the stamps are right: the scanner's clock is found from when its scans come. A recording has no truth."""
        if not self.truth_path.exists():
            return True
        times = Truth(self.truth_path).times
        return all(abs(time - pose.utime * 1e-6) < IN_TIME_S for time, pose in zip(times, poses or self.listener.poses))

    def stop(self):
        for program in self.programs:
            program.kill()
        self.listener.stop()


def tally(simulator):
    """What the simulator counted: scans, sent, damaged, swallowed."""
    return {name: int(number) for name, number in (line.split() for line in simulator.out().splitlines())}


def wrap(angle):
    return math.remainder(angle, 2 * math.pi)


class Truth:
    """The robot's true poses, as seen from the first one: the firmware's frame."""

    def __init__(self, path):
        rows = [[float(word) for word in line.split()] for line in path.read_text(encoding="utf-8").splitlines()
                if not line.startswith("#")]
        self.times = [row[0] for row in rows]
        self.world = [(row[1], row[2], 2 * math.atan2(row[6], row[7])) for row in rows]

    def world_at(self, seconds):
        """The pose in the world, interpolated; None outside the drive."""
        k = bisect.bisect(self.times, seconds)
        if k == 0 or k == len(self.times):
            return None
        part = (seconds - self.times[k - 1]) / (self.times[k] - self.times[k - 1])
        a, b = self.world[k - 1], self.world[k]
        return (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * wrap(b[2] - a[2]))

    def at(self, seconds, origin):
        """The pose as seen from the origin, a pose in the world."""
        here = self.world_at(seconds)
        if here is None:
            return None
        dx, dy = here[0] - origin[0], here[1] - origin[1]
        c, s = math.cos(origin[2]), math.sin(origin[2])
        return (c * dx + s * dy, c * dy - s * dx, wrap(here[2] - origin[2]))


def trajectory_error(poses, truth):
    """Root mean square of position (m) and heading (rad) of the map poses, and how many were compared. The first
    pose is the origin: nothing is aligned."""
    origin = next(o for o in (truth.world_at(pose.utime * 1e-6) for pose in poses) if o)
    squares, turns, count = 0.0, 0.0, 0
    for pose in poses:
        true = truth.at(pose.utime * 1e-6, origin)
        if true:
            squares += (pose.map_x - true[0]) ** 2 + (pose.map_y - true[1]) ** 2
            turns += wrap(pose.map_theta - true[2]) ** 2
            count += 1
    return math.sqrt(squares / count), math.sqrt(turns / count), count


def walls_of(world):
    return [tuple(map(float, line.split())) for line in (WORLDS / f"{world}.world").read_text().splitlines()
            if line.strip() and not line.startswith("#")]


def distance_to_wall(wall, x, y):
    x1, y1, x2, y2 = wall
    dx, dy = x2 - x1, y2 - y1
    along = max(0.0, min(1.0, ((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy)))
    return math.hypot(x - x1 - along * dx, y - y1 - along * dy)
