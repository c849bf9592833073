"""Pose, features and map from scans and odometry: the firmware's own tracker and mapper, as ale-replay runs them."""
from __future__ import annotations

import ctypes
import enum
import os
import weakref
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _checks, _core
from .extractor import ScanArgument, Settings
from .features import FeatureRoom, Features
from .scanner import Scanner


class State(enum.IntEnum):
    """What a pose is worth. GOOD: right, to the covariance stated."""

    LOST = 0
    WEAK = 1
    GOOD = 2


class WheelFault(enum.IntEnum):
    """What wheels do that scans contradict."""

    FINE = 0
    CONTRADICT = 1
    STALLED = 2
    REVERSED = 3
    LATE = 4
    SCALE = 5


class Map(NamedTuple):
    """Fields of walls: x1 y1 x2 y2 cov[3] id seen map_id; of corners: x y cov[3] angle bisector seen kind. Walls of
    which map_id is not 0 are in a map that was never joined with the first one. refused: what found no room."""

    walls: _core.Records
    corners: _core.Records
    refused: int


class Tracker:
    """Scans and odometry in, in the order of their stamps; pose, state, covariance, features and map out.

        tracker = ale.Tracker(ale.scanner("urg-04lx"))
        for stamp, ranges in scans:
            estimate = tracker.scan(ranges, stamp)
        tracker.finish()
        trajectory, map = tracker.trajectory(), tracker.map()

    sensor: x, y, theta of the scanner in the robot's frame. loops: the mapper closes loops as ale-replay does. settings and
    blind as for ale.Extractor. map_file: a saved map to start in, lost until found. For one thread at a time.

    An estimate has the fields t, x, y, theta (smooth pose), map_x, map_y, map_theta (map pose), cov (3 x 3, of the map
    pose), information[6], velocity[3], state (ale.State), predicted, scan, map_id, maps, wheel_fault (ale.WheelFault),
    lag_us, matched_lines, matched_corners, cpu_s: estimate.x or estimate["x"]. np.array(list, dtype=ale.ESTIMATE) puts many together."""

    def __init__(self, scanner: Scanner, *, sensor: tuple[float, float, float] | None = None, loops: bool = True,
                 settings: Mapping[str, float] | None = None, blind: Sequence[tuple[float, float]] = (),
                 map_file: str | os.PathLike[str] | None = None) -> None:
        self.scanner = scanner
        self._scan = ScanArgument(scanner)
        mounting = {} if sensor is None else dict(zip(("sensor.x", "sensor.y", "sensor.theta"), sensor))
        held = Settings({**scanner.settings(), **mounting, **(settings or {})}, blind, loops, True)
        handle = _core.library.ale_binding_tracker_new(ctypes.byref(held.config))
        if not handle:
            raise ValueError(_core.reason())
        self._handle = ctypes.c_void_p(handle)
        self._finished = False
        self._scans = 0
        weakref.finalize(self, _core.library.ale_binding_tracker_free, self._handle)
        if map_file is not None:
            _core.check(_core.library.ale_binding_load_map(self._handle, os.fsencode(map_file)))

    def odometry(self, x: float, y: float, theta: float, stamp: float) -> None:
        """Pose of the robot's centre as its wheels count it, in a frame of its own: metres, radians, seconds."""
        self._go_on()
        pose = (ctypes.c_double * 3)(_checks.finite("x", x, -_checks.FARTHEST_M, _checks.FARTHEST_M),
                                     _checks.finite("y", y, -_checks.FARTHEST_M, _checks.FARTHEST_M),
                                     _checks.finite("theta", theta))
        _core.check(_core.library.ale_binding_odometry(self._handle, ctypes.c_double(_checks.stamp(stamp)), pose))

    def scan(self, ranges: ArrayLike, stamp: float, scanner: Scanner | None = None) -> np.record:
        """The estimate after this scan. ranges as for ale.Extractor.extract; stamp in seconds. scanner: from now on the
        beams lie like this (scanners whose turns differ in their number of beams)."""
        self._go_on()
        if scanner is not None and scanner != self.scanner:
            self.scanner, self._scan = scanner, ScanArgument(scanner)
        scan, held = self._scan.of(ranges, stamp)
        out = _core.records("estimate", 1)
        _core.check(_core.library.ale_binding_scan(self._handle, ctypes.byref(scan), _core.address(out)))
        del held
        self._scans += 1
        return _only(out)

    def dropped(self, stamp: float) -> np.record:
        """The estimate for a scan that was lost on its way: a prediction."""
        self._go_on()
        out = _core.records("estimate", 1)
        _core.check(_core.library.ale_binding_dropped(self._handle, ctypes.c_double(_checks.stamp(stamp)), _core.address(out)))
        self._scans += 1
        return _only(out)

    def features(self) -> Features:
        """Lines, corners and curves of the last scan, sensor frame at its stamp."""
        if self._scans == 0:
            raise RuntimeError("there was no scan yet")
        room = FeatureRoom()
        _core.library.ale_binding_features(self._handle, ctypes.byref(room.target))
        return room.features()

    def finish(self) -> None:
        """After the last scan: loops correct the whole trajectory, and the map is built anew from all scans."""
        if not self._finished:
            _core.check(_core.library.ale_binding_finish(self._handle))
            self._finished = True

    def trajectory(self) -> _core.Records:
        """Map pose at every scan, corrected after finish(): fields t, x, y, theta, measured (False: predicted)."""
        poses = _core.records("pose", _core.library.ale_binding_trajectory(self._handle, None))
        _core.library.ale_binding_trajectory(self._handle, _core.address(poses))
        return poses

    def map(self) -> Map:
        """The map as it stands; after finish() as all scans show it."""
        walls = _core.records("wall", _core.DESCRIPTION["max_walls"])
        corners = _core.records("map_corner", _core.DESCRIPTION["max_map_corners"])
        counts = np.zeros(3, np.uint32)
        _core.check(_core.library.ale_binding_map(self._handle, *map(_core.address, (walls, corners, counts))))
        return Map(walls[:counts[0]], corners[:counts[1]], int(counts[2]))

    def save_map(self, path: str | os.PathLike[str]) -> None:
        """As ale-replay --save-map: ale-slamd starts in it."""
        _core.check(_core.library.ale_binding_save_map(self._handle, os.fsencode(path)))

    def save_trajectory(self, path: str | os.PathLike[str]) -> None:
        """TUM, as ale-replay --trajectory."""
        _core.check(_core.library.ale_binding_save_trajectory(self._handle, os.fsencode(path)))

    def _go_on(self) -> None:
        if self._finished:
            raise RuntimeError("the drive is finished: nothing comes after finish()")


def _only(one: _core.Records) -> np.record:
    record: np.record = one[0]
    return record


ESTIMATE = _core.DTYPES["estimate"]
