"""Lines and corners of single scans."""
from __future__ import annotations

import ctypes
import weakref
from collections.abc import Mapping, Sequence

from numpy.typing import ArrayLike

from . import _checks, _core
from .features import FeatureRoom, Features
from .scanner import Scanner


class Settings:
    """What is set of the core, held as long as it is read."""

    def __init__(self, asked: Mapping[str, float], blind: Sequence[tuple[float, float]], loops: bool, rebuilds_map: bool):
        self._values = _checks.settings_of(dict(asked))
        self._blind = _checks.blind_of(list(blind))
        self.config = _core.Config(_core.address(self._values), _core.address(self._blind), len(self._blind), loops, rebuilds_map)


class ScanArgument:
    """One scan as the core reads it, from the caller's own memory."""

    def __init__(self, scanner: Scanner) -> None:
        self._scanner = scanner
        self._record = scanner.record()

    def of(self, ranges: ArrayLike, stamp: float) -> tuple[_core.Scan, object]:
        """The scan, and what must be held while it is read."""
        array = _checks.beams_of(ranges, self._scanner.beams)
        return _core.Scan(_core.address(self._record), _core.address(array), array.size, array.itemsize == 4,
                          _checks.stamp(stamp)), array


class Extractor:
    """Lines, corners and curves of scans, one after the other; nothing is kept from scan to scan.

        features = ale.Extractor(ale.scanner("urg-04lx")).extract(ranges)
        features.lines["rho"], features.corners[0].x

    settings: by the names of ale-slamd's configuration, as {"extract.min_points": 8}. blind: sectors of bearings
    (from, to, radians, counter-clockwise) that see the robot itself. For one thread at a time."""

    def __init__(self, scanner: Scanner, *, settings: Mapping[str, float] | None = None,
                 blind: Sequence[tuple[float, float]] = ()) -> None:
        self.scanner = scanner
        self._scan = ScanArgument(scanner)
        held = Settings({**scanner.settings(), **(settings or {})}, blind, False, False)
        handle = _core.library.ale_binding_extractor_new(ctypes.byref(held.config))
        if not handle:
            raise ValueError(_core.reason())
        self._handle = ctypes.c_void_p(handle)
        weakref.finalize(self, _core.library.ale_binding_extractor_free, self._handle)

    def extract(self, ranges: ArrayLike) -> Features:
        """ranges: metres in beam order, read where they lie if they are contiguous floats. +inf, 0 and what is
        beyond range_max met nothing, -inf something too near, NaN is a beam that says nothing (REP 117)."""
        scan, held = self._scan.of(ranges, 0.0)
        room = FeatureRoom()
        _core.check(_core.library.ale_binding_extract(self._handle, ctypes.byref(scan), ctypes.byref(room.target)))
        del held
        return room.features()
