"""Robust lowess as the paper prints it, (8) to (10), in double precision: for figure 1."""
import numpy as np


def local_weights(positions, at, span):
    """Indices of the `span` nearest neighbours and their tri-cube weights (8); the farthest has weight 0."""
    distance = np.abs(positions - positions[at])
    nearest = np.argsort(distance, kind="stable")[:span]
    reach = distance[nearest].max()
    return nearest, (1 - (distance[nearest] / reach) ** 3) ** 3


def lowess(positions, values, span, robust=None):
    """First-degree local fit at every position; robust: a further weight of each value."""
    smooth = np.empty_like(values)
    for at in range(len(values)):
        nearest, weights = local_weights(positions, at, span)
        if robust is not None:
            weights = weights * robust[nearest]
        if weights.sum() < 1e-12:
            smooth[at] = values[at]
            continue
        offset = positions[nearest] - positions[at]
        design = np.stack([np.ones_like(offset), offset], axis=1) * np.sqrt(weights)[:, None]
        smooth[at] = np.linalg.lstsq(design, values[nearest] * np.sqrt(weights), rcond=None)[0][0]
    return smooth


def bisquare(residuals, least_deviation):
    """Robust weights (9). M has a floor: a third of a real scanner's neighbouring values are equal."""
    deviation = max(np.median(np.abs(residuals)), least_deviation)
    scaled = residuals / (6 * deviation)
    return np.where(np.abs(scaled) < 1, (1 - scaled**2) ** 2, 0.0), deviation


def robust_lowess(positions, values, span, passes, least_deviation):
    smooth = lowess(positions, values, span)
    for _ in range(passes):
        weights, _ = bisquare(values - smooth, least_deviation)
        smooth = lowess(positions, values, span, weights)
    return smooth
