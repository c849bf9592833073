"""What a caller hands over, checked before the core sees it: ValueError or TypeError with the words for it."""
from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

MAX_BEAMS: int = _core.DESCRIPTION["max_beams"]
FARTHEST_M = 2000.0
LATEST_S = 2.0**61 / 1e6


def finite(name: str, value: float, least: float = -math.inf, most: float = math.inf) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{name} is {number}: a finite number is needed")
    if not least <= number <= most:
        raise ValueError(f"{name} is {number:g}: it must lie between {least:g} and {most:g}")
    return number


def stamp(value: float) -> float:
    return finite("stamp", value, -LATEST_S, LATEST_S)


def beams_of(ranges: ArrayLike, expected: int | None) -> NDArray[Any]:
    """As a contiguous array of 32 or 64 bit floats; the caller's own memory where it is one already."""
    array = np.asarray(ranges)
    if array.ndim != 1:
        raise ValueError(f"ranges have the shape {array.shape}: one number a beam is needed, shape (beams,)")
    if array.dtype.kind in "iu" and array.size:
        raise TypeError(f"ranges are {array.dtype}: metres as floats are needed (millimetres: divide by 1000)")
    if array.dtype.kind != "f" and array.size:
        raise TypeError(f"ranges are {array.dtype}: metres as floats are needed")
    if array.size > MAX_BEAMS:
        raise ValueError(f"{array.size} beams: at most {MAX_BEAMS} fit; leave out every other beam, or use a narrower sector")
    if expected is not None and array.size != expected:
        raise ValueError(f"{array.size} beams: this scanner has {expected}")
    kept = array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)
    return np.ascontiguousarray(kept)


def settings_of(asked: dict[str, float]) -> NDArray[np.float64]:
    """Defaults with what is asked for, in the order of the core."""
    known = {name: number for number, (name, *_) in enumerate(_core.DESCRIPTION["settings"])}
    values = np.array([default for _, default, _, _ in _core.DESCRIPTION["settings"]], np.float64)
    for name, value in asked.items():
        if name not in known:
            raise ValueError(f"no setting is called {name}; there are: {', '.join(known)}")
        _, _, least, most = _core.DESCRIPTION["settings"][known[name]]
        values[known[name]] = finite(name, value, least, most)
    span = values[known["extract.smooth_span"]]
    if span % 2 != 1:
        raise ValueError(f"extract.smooth_span is {span:g}: an odd number of beams is needed")
    return values


def blind_of(sectors: list[tuple[float, float]]) -> NDArray[np.float64]:
    most = _core.DESCRIPTION["max_blind"]
    if len(sectors) > most:
        raise ValueError(f"{len(sectors)} blind sectors: at most {most} fit")
    array = np.array(sectors, np.float64).reshape(len(sectors), 2)
    if not np.isfinite(array).all():
        raise ValueError("a blind sector is not finite: pairs of bearings in radians are needed")
    return array
