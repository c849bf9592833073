"""Pictures of scans, maps and drives by Matplotlib. Each function draws into `axes`, or a new figure, and returns the axes."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .features import CornerKind, Features
from .scanner import Scanner
from .tracker import Map, State

try:
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.collections import LineCollection
except ImportError as error:
    raise ImportError("ale.plot needs matplotlib: pip install 'ale-slam[plot]'") from error

STATE_COLOURS = {State.LOST: "tab:red", State.WEAK: "tab:orange", State.GOOD: "tab:green"}


def _axes(axes: Axes | None) -> Axes:
    if axes is None:
        axes = plt.subplots(figsize=(7, 7), layout="constrained")[1]
    axes.set_aspect("equal")
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")
    return axes


def _segments(lines: _core.Records) -> Any:
    ends = np.stack([lines["x1"], lines["y1"], lines["x2"], lines["y2"]], axis=-1)
    return ends.reshape(-1, 2, 2)


def scan(scanner: Scanner, ranges: ArrayLike, features: Features | None = None, axes: Axes | None = None) -> Axes:
    """A scan as points in the sensor's frame; its lines and corners, convex ones filled."""
    axes = _axes(axes)
    distances = np.asarray(ranges, float)
    bearings = scanner.first_bearing + scanner.step * np.arange(distances.size)
    met = np.isfinite(distances) & (distances > 0) & (distances < scanner.range_max)
    axes.plot((distances * np.cos(bearings))[met], (distances * np.sin(bearings))[met], ".", color="0.6", markersize=3)
    axes.plot(0, 0, "k+", markersize=10)
    if features is not None:
        axes.add_collection(LineCollection(_segments(features.lines), colors="k", linewidths=1.5))
        for kind in CornerKind:
            of_kind = features.corners[features.corners["kind"] == kind]
            axes.plot(of_kind["x"], of_kind["y"], "o", color="C1", fillstyle="full" if kind == CornerKind.CONVEX else "none")
        axes.set_title(f"{len(features.lines)} lines, {len(features.corners)} corners")
    return axes


def map(drawn: Map, trajectory: _core.Records | None = None, axes: Axes | None = None) -> Axes:  # pylint: disable=redefined-builtin
    """Walls black, those of maps that were not joined violet; the way of the robot with start and end."""
    axes = _axes(axes)
    apart = drawn.walls["map_id"] != 0
    axes.add_collection(LineCollection(_segments(drawn.walls[~apart]), colors="k", linewidths=1.2))
    axes.add_collection(LineCollection(_segments(drawn.walls[apart]), colors="tab:purple", linewidths=1.2))
    if trajectory is not None and len(trajectory):
        axes.plot(trajectory["x"], trajectory["y"], color="tab:red", linewidth=0.8)
        axes.plot(trajectory["x"][0], trajectory["y"][0], "o", color="tab:green", label="start")
        axes.plot(trajectory["x"][-1], trajectory["y"][-1], "s", color="tab:red", label="end")
        axes.legend(loc="best")
    axes.autoscale_view()
    return axes


def deviation(estimates: _core.Records, axes: Axes | None = None) -> Axes:
    """One sigma of the map pose over time, and the state of each scan as a band of colour below."""
    if axes is None:
        axes = plt.subplots(figsize=(9, 3.5), layout="constrained")[1]
    t = estimates["t"] - estimates["t"][0]
    for k, name in enumerate(("x", "y")):
        axes.plot(t, 1000 * np.sqrt(estimates["cov"][:, k, k]), label=f"{name}, mm")
    axes.plot(t, 1000 * np.sqrt(estimates["cov"][:, 2, 2]), label="theta, mrad")
    for state, colour in STATE_COLOURS.items():
        of_state = estimates["state"] == state
        if of_state.any():
            axes.plot(t[of_state], np.zeros(of_state.sum()), "|", color=colour, label=state.name.lower())
    axes.set_xlabel("time, s")
    axes.set_ylabel("one sigma")
    axes.set_ylim(bottom=0)
    axes.legend(loc="best")
    return axes
