"""Files that a console lists: a recording of the robot double, a flight of it, and a map that a robot has saved."""
import importlib.util
import types
import zlib

import ale
import lcm

from at_hand import ROOT
from robot_double import WALLS, RobotDouble

RECORDED = "2026-01-02-030405"
BEGIN_US = 1_767_323_045_000_000  # of the recording
PERIOD_US = 100_000
FLIGHT = "flight-00000003-20260102T030500.000Z-fault"  # when it was written
SWITCHED_ON_US = 50_000_000  # before the flight begins: its clock knows no date


class LogBus:
    """Takes the place of LCM: what is published is in a file, at times of our own."""

    def __init__(self, path):
        path.parent.mkdir(exist_ok=True)
        self.log = lcm.EventLog(str(path), "w", overwrite=True)
        self.now_us = BEGIN_US

    def publish(self, channel, data):
        self.log.write_event(self.now_us, channel, data)


def write_recording(path, scans=30, change=lambda robot: None):
    """Ten scans a second; change: what is done to the robot before each."""
    robot = RobotDouble("memq://")
    robot.bus = LogBus(path)
    for _ in range(scans):
        change(robot)
        robot.step()
        robot.bus.now_us += PERIOD_US
    robot.bus.log.close()


class ScanBus:
    """Keeps the scans that are published, at times of a robot's own clock."""

    def __init__(self):
        self.events = []

    def publish(self, channel, data):
        scan = ale.scan_t.decode(data)
        scan.utime = SWITCHED_ON_US + len(self.events) * PERIOD_US
        self.events.append(types.SimpleNamespace(channel=channel, data=scan.encode()))


def write_flight(path, scans=40):
    """The bytes of the robot double's scanner, ten scans a second."""
    spec = importlib.util.spec_from_file_location("scip_file", ROOT / "tools/operator/foxglove/scip_file.py")
    scip_file = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(scip_file)
    robot = RobotDouble("memq://")
    robot.bus = ScanBus()
    for robot.scan in range(scans):
        robot.publish_scan()
    path.parent.mkdir(exist_ok=True)
    scip_file.write(robot.bus.events, path)


def write_map(path):
    """The walls of the robot double, as ale-slamd keeps them."""
    def um(metres):
        return round(metres * 1e6)
    path.parent.mkdir(exist_ok=True)
    walls = [f"wall {k} {um(x1)} {um(y1)} {um(x2)} {um(y2)} 1200 -35 410 96\n" for k, (x1, y1, x2, y2) in enumerate(WALLS)]
    text = "ALE-SLAM map 1\n" + "".join(walls)
    path.write_text(f"{text}end {len(walls)} {zlib.crc32(text.encode()):08x}\n", encoding="ascii")
