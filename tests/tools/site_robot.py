"""The robot that the site's commands speak of, simulated, on a computer of its own as far as networks go: it has the ports to itself.

    with SiteRobot(folder, host) as robot:
        robot.run("ale-record --port /dev/ale-scanner ...\n")     # a block of a page

Names of devices and hosts are replaced, minutes are played ten times as fast. A program that runs until Ctrl-C is ended so when
the block is over, and has said by then what shows that it works.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

from at_hand import BINARIES, BUILD, WORLDS

URL, LAPTOP, WHEELS = (f"udpm://239.255.76.67:{port}?ttl=0" for port in (7667, 7668, 7669))
FASTER = 10
LASTING = {"ale-watch": r"\bgood\b", "ale-bridge": r" at 127\.0\.0\.1:7700 ", "ale-console": r"http://\S+", "ale-foxglove": r"ws://\S+",
           "ale-ros2": r"on DDS domain", "ale-odometry": r"ticks come"}
TICKS, TRACK = 4096, 0.32  # of the page's board
SECONDS = 170
HERE = pathlib.Path(__file__).resolve().parent


class Running:
    """A program with what it says."""

    def __init__(self, words, folder, environment, prefix):
        self.words, self.said_path = words, folder / f"said.{time.monotonic_ns()}"
        with open(self.said_path, "wb") as said:
            self.process = subprocess.Popen([*prefix, *map(str, words)], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=said,
                                            stderr=subprocess.STDOUT)

    def said(self):
        return self.said_path.read_text(encoding="utf-8", errors="replace")

    def wait_for(self, condition, what):
        end = time.monotonic() + SECONDS
        while not condition():
            assert self.process.poll() is None and time.monotonic() < end, f"{self.words}: no {what}: {self.said()}"
            time.sleep(0.05)

    def end(self, number=signal.SIGINT):
        if self.process.poll() is None:
            self.process.send_signal(number)
        return self.process.wait(SECONDS)


class SiteRobot:
    def __init__(self, folder, host):
        """folder: where the commands run; host: a hosts.Host with nothing up yet."""
        self.folder, self.host = folder, host
        self.started, self.stands = [], False
        self.environment = {**os.environ, "PATH": f"{folder / 'as-root'}:{BINARIES}:{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}",
                            "HOME": str(folder), "LCM_DEFAULT_URL": URL, "ROS_LOCALHOST_ONLY": "1", "PYTHONPATH": str(BUILD / "python")}

    def __enter__(self):
        shim = self.folder / "as-root/sudo"
        shim.parent.mkdir()
        shim.write_text('#!/bin/sh\nexec "$@"\n', encoding="ascii")
        shim.chmod(0o755)
        return self

    def __exit__(self, *_):
        for each in reversed(self.started):
            each.end(signal.SIGKILL)

    def network(self):
        """As on a computer that has one: multicast has a way."""
        for words in (("link", "set", "lo", "up", "multicast", "on"), ("route", "replace", "224.0.0.0/4", "dev", "lo")):
            self.host.run("ip", *words)

    def start(self, *words, environment=None):
        self.started.append(Running(words, self.folder, environment or self.environment, self.host.prefix))
        return self.started[-1]

    def shell(self, line, environment):
        return subprocess.run([*self.host.prefix, "sh", "-ec", line], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=SECONDS, check=False)

    def keys(self):
        """Those of the page, or where it makes none some others."""
        if not (self.folder / "alice.key").exists():
            assert self.shell("ale-keys alice --secret alice.key --robot robot.keys", self.environment).returncode == 0

    def stand(self):
        """Scanner, wheels and firmware."""
        self.stands = True
        (self.folder / "robot.ini").write_text("[lcm]\npublish_scan = yes\n[recorder]\nfolder =\n", encoding="ascii")
        simulator = self.start("ale-sim", "--world", WORLDS / "home.world", "--pty", "urg", "--lcm-url", WHEELS)
        simulator.wait_for((self.folder / "urg").exists, "scanner")
        self.start(sys.executable, HERE / "tick_board.py", "board", WHEELS, TICKS, TRACK).wait_for((self.folder / "board").exists, "board")
        self.start("ale-slamd", "--config", "robot.ini", "--port", "urg", "--lcm-url", URL)

    def run(self, block):
        """Every line of it ends well."""
        lines = block.replace("\\\n", " ").splitlines()
        if "/dev/ale-scanner" in block:
            self.record(lines)
            return
        if not self.stands:
            self.stand()
        if "--keys" in block:
            self.keys()
        environment = self.environment
        if "--connect" in block:
            environment = {**environment, "LCM_DEFAULT_URL": LAPTOP}
            self.start("ale-bridge", "--listen", "7700", "--keys", "robot.keys", "--lcm-url", URL)
        lasting = []
        for line in lines:
            line = line.replace("robot.local", "127.0.0.1").replace("/dev/ttyUSB0", "board")
            program = line.split()[0]
            if program in LASTING:
                lasting.append(self.start(*line.split(), environment=environment))
                lasting[-1].wait_for(lambda: re.search(LASTING[program], lasting[-1].said()), LASTING[program])
            else:
                done = self.shell(line, environment)
                assert done.returncode == 0, f"{line}\n{done.stdout}"
        if "--connect" in block:
            done = self.shell("ale-watch --once", environment)
            assert done.returncode == 0, done.stdout
        for each in reversed(lasting):
            assert each.end() == 0, each.said()

    def record(self, lines):
        """With the scanner alone: at rest, or on a drive."""
        for line in lines:
            simulator = None
            if "/dev/ale-scanner" in line:
                world = self.world(moves="rest" not in line)
                simulator = self.start("ale-sim", "--world", world, "--pty", "scanner", "--lcm-url", URL, "--speed", FASTER)
                simulator.wait_for((self.folder / "scanner").exists, "scanner")
                line = line.replace("/dev/ale-scanner", "scanner") + f" --time-scale {FASTER}"
                line = re.sub(r"--seconds (\d+)", lambda found: f"--seconds {int(found[1]) // FASTER}", line)
            done = self.shell(line, self.environment)
            assert done.returncode == 0, f"{line}\n{done.stdout}"
            if simulator:
                simulator.end()

    def world(self, moves):
        text = (WORLDS / "home.world").read_text(encoding="ascii")
        path = self.folder / "here.world"
        path.write_text(text if moves else re.sub(r"^# via.*\n", "", text, flags=re.MULTILINE), encoding="ascii")
        return path
