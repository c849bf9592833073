"""Lines, corners and curves of one scan, as structured arrays in the sensor's frame."""
from __future__ import annotations

import enum
from typing import NamedTuple

import numpy as np

from . import _core


class EndKind(enum.IntEnum):
    """Why a line ends where it ends (first_end, last_end)."""

    EDGE = 0
    OCCLUDED = 1
    LIMIT = 2


class CornerKind(enum.IntEnum):
    CONVEX = 0
    CONCAVE = 1


REFUSALS = ("few_points", "short", "vague", "rough", "curved", "capacity")


class Features(NamedTuple):
    """Fields of lines: x1 y1 x2 y2 alpha rho cov[3] rmse var_start var_end first last points first_end last_end;
    of corners: x y cov[3] angle bisector first_line second_line kind; of curves: x y radius first last."""

    lines: _core.Records
    corners: _core.Records
    curves: _core.Records
    outliers: int
    refused: dict[str, int]


class FeatureRoom:
    """Where the core writes the features of one scan; what is handed out are views of it."""

    def __init__(self) -> None:
        capacity = _core.DESCRIPTION
        self._lines = _core.records("line", capacity["max_lines"])
        self._corners = _core.records("corner", capacity["max_corners"])
        self._curves = _core.records("curve", capacity["max_curves"])
        self._counts = np.zeros(4 + capacity["refusals"], np.uint32)
        self.target = _core.Features(*map(_core.address, (self._lines, self._corners, self._curves, self._counts)))

    def features(self) -> Features:
        lines, corners, curves, outliers, *refused = (int(count) for count in self._counts)
        return Features(self._lines[:lines], self._corners[:corners], self._curves[:curves], outliers,
                        dict(zip(REFUSALS, refused)))
