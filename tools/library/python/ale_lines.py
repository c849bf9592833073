"""Lines and corners of 2D laser scans: libale from Python, by ctypes.

    from ale_lines import Extractor
    features = Extractor("build/libale.so").extract(ranges, first_bearing=-2.09, step=0.00614)
    for line in features.lines:
        print(line.start, line.end, line.rho)

Metres and radians outside, the library's integers inside. `make library` builds libale.so; without a path it is
looked for in $ALE_LIBRARY, beside this file's tree in build/, then where the system has its libraries.
"""
import ctypes
import ctypes.util
import math
import os
import pathlib
from typing import NamedTuple

MAX_BEAMS = 1081
MAX_LINES = 136
MAX_CURVES = 32
MAX_CORNERS = MAX_LINES
REFUSALS = ("few_points", "short", "vague", "rough", "curved", "capacity")
END_KINDS = ("edge", "occluded", "limit")
CORNER_KINDS = ("convex", "concave")
BAM_PER_RADIAN = 2**32 / (2 * math.pi)


class _Point(ctypes.Structure):
    _fields_ = [("x_um", ctypes.c_int32), ("y_um", ctypes.c_int32)]


class _Scan(ctypes.Structure):
    _fields_ = [("stamp_us", ctypes.c_int64), ("stamp_beam", ctypes.c_int32), ("beam_time_ns", ctypes.c_int32),
                ("first_bearing_bam", ctypes.c_uint32), ("step_bam", ctypes.c_int32),
                ("range_min_um", ctypes.c_int32), ("range_max_um", ctypes.c_int32), ("beams", ctypes.c_uint16),
                ("range_um", ctypes.c_int32 * MAX_BEAMS), ("flag", ctypes.c_uint8 * MAX_BEAMS),
                ("code", ctypes.c_uint8 * MAX_BEAMS), ("own_bearings", ctypes.c_bool),
                ("bearing_bam", ctypes.c_uint32 * MAX_BEAMS)]


class _Noise(ctypes.Structure):
    _fields_ = [(name, ctypes.c_int32) for name in
                ("own_um", "own_ppm", "shared_um", "shared_ppm", "shared_beams", "surface_um", "bearing_nrad",
                 "own_ppm_per_m")]


class _Config(ctypes.Structure):
    _fields_ = [("noise", _Noise), ("min_points", ctypes.c_uint16), ("min_length_um", ctypes.c_int32),
                ("smooth_span", ctypes.c_uint16), ("robust_passes", ctypes.c_uint8)]


class _Line(ctypes.Structure):
    _fields_ = [("first", ctypes.c_uint16), ("last", ctypes.c_uint16), ("points", ctypes.c_uint16),
                ("first_end", ctypes.c_uint8), ("last_end", ctypes.c_uint8), ("alpha_bam", ctypes.c_uint32),
                ("rho_um", ctypes.c_int32), ("start", _Point), ("end", _Point),
                ("var_alpha_nrad2", ctypes.c_int64), ("cov_alpha_rho", ctypes.c_int64),
                ("var_rho_um2", ctypes.c_int64), ("var_start_um2", ctypes.c_int64), ("var_end_um2", ctypes.c_int64),
                ("rmse_um", ctypes.c_int32)]


class _Corner(ctypes.Structure):
    _fields_ = [("p", _Point), ("cov_um2", ctypes.c_int64 * 3), ("angle_bam", ctypes.c_uint32),
                ("bisector_bam", ctypes.c_uint32), ("first_line", ctypes.c_uint16), ("second_line", ctypes.c_uint16),
                ("kind", ctypes.c_uint8)]


class _Curve(ctypes.Structure):
    _fields_ = [("first", ctypes.c_uint16), ("last", ctypes.c_uint16), ("centre", _Point),
                ("radius_um", ctypes.c_int32)]


class _Features(ctypes.Structure):
    _fields_ = [("line_count", ctypes.c_uint16), ("corner_count", ctypes.c_uint16), ("curve_count", ctypes.c_uint16),
                ("outliers", ctypes.c_uint16), ("line", _Line * MAX_LINES), ("corner", _Corner * MAX_CORNERS),
                ("curve", _Curve * MAX_CURVES), ("refused", ctypes.c_uint16 * len(REFUSALS))]


# The C types by name, for whoever checks that both sides agree.
STRUCTURES = {"ale_point_t": _Point, "ale_scan_t": _Scan, "ale_noise_t": _Noise, "ale_extract_config_t": _Config,
              "ale_line_t": _Line, "ale_corner_t": _Corner, "ale_curve_t": _Curve, "ale_features_t": _Features}


class Line(NamedTuple):
    first: int
    last: int
    points: int
    start: tuple
    end: tuple
    alpha: float
    rho: float
    cov: tuple  # alpha alpha, alpha rho, rho rho; rad^2, m rad, m^2
    rmse: float
    first_end: str
    last_end: str


class Corner(NamedTuple):
    x: float
    y: float
    cov: tuple  # xx, xy, yy; m^2
    angle: float
    kind: str
    first_line: int
    second_line: int


class Curve(NamedTuple):
    first: int
    last: int
    centre: tuple
    radius: float  # 0: not a circle


class Features(NamedTuple):
    lines: list
    corners: list
    curves: list
    refused: dict
    outliers: int


def _metres(point):
    return point.x_um * 1e-6, point.y_um * 1e-6


def _radians(bam):
    return math.remainder(bam / BAM_PER_RADIAN, 2 * math.pi)


def _line(line):
    cov = (line.var_alpha_nrad2 * 1e-18, line.cov_alpha_rho * 1e-15, line.var_rho_um2 * 1e-12)
    return Line(line.first, line.last, line.points, _metres(line.start), _metres(line.end), _radians(line.alpha_bam),
                line.rho_um * 1e-6, cov, line.rmse_um * 1e-6, END_KINDS[line.first_end], END_KINDS[line.last_end])


def _corner(corner):
    return Corner(*_metres(corner.p), tuple(v * 1e-12 for v in corner.cov_um2), corner.angle_bam / BAM_PER_RADIAN,
                  CORNER_KINDS[corner.kind], corner.first_line, corner.second_line)


def _curve(curve):
    return Curve(curve.first, curve.last, _metres(curve.centre), curve.radius_um * 1e-6)


def _find_library():
    named = os.environ.get("ALE_LIBRARY")
    if named:
        return named
    beside = pathlib.Path(__file__).resolve().parents[3] / "build" / "libale.so"
    if beside.exists():
        return str(beside)
    found = ctypes.util.find_library("ale")
    if found is None:
        raise OSError("libale.so not found: build it with `make library`, or name it in ALE_LIBRARY")
    return found


class Extractor:
    """Holds the library and its working memory. Not for several threads at once."""

    def __init__(self, library=None, **settings):
        """settings: fields of the configuration (min_points, min_length_um, own_um, shared_ppm, ...)."""
        self._ale = ctypes.CDLL(library or _find_library())
        self._ale.ale_extractor_size.restype = ctypes.c_uint32
        self._ale.ale_extract_default_config.restype = _Config
        config = self._ale.ale_extract_default_config()
        for name, value in settings.items():
            owner = config.noise if hasattr(config.noise, name) else config
            if not hasattr(owner, name):
                raise ValueError(f"no setting is called {name}")
            setattr(owner, name, value)
        self._memory = ctypes.create_string_buffer(self._ale.ale_extractor_size())
        if self._ale.ale_extractor_init(self._memory, ctypes.byref(config)) < 0:
            raise ValueError(f"a setting is out of range: {settings}")

    def extract(self, ranges, first_bearing, step, range_min=0.02, range_max=30.0):
        """Features of one scan. ranges: metres in beam order, 0 or not finite where nothing was seen."""
        if len(ranges) > MAX_BEAMS:
            raise ValueError(f"{len(ranges)} beams, at most {MAX_BEAMS} fit")
        scan = _Scan(first_bearing_bam=round(first_bearing * BAM_PER_RADIAN) % 2**32,
                     step_bam=round(step * BAM_PER_RADIAN), range_min_um=round(range_min * 1e6),
                     range_max_um=round(range_max * 1e6), beams=len(ranges))
        for beam, distance in enumerate(ranges):
            seen = math.isfinite(distance) and 0 < distance < range_max
            self._ale.ale_scan_set_range(ctypes.byref(scan), beam, round(distance * 1e6) if seen else 0)
        found = _Features()
        self._ale.ale_extract_scan(self._memory, ctypes.byref(scan), None, ctypes.byref(found))
        return Features([_line(line) for line in found.line[:found.line_count]],
                        [_corner(corner) for corner in found.corner[:found.corner_count]],
                        [_curve(curve) for curve in found.curve[:found.curve_count]],
                        dict(zip(REFUSALS, found.refused)), found.outliers)
