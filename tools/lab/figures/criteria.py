"""The least-squares criteria of III.C over range, view angle and surface, and the expected error (26)."""
import dataclasses

import numpy as np

STEP = 2 * np.pi / 1024  # of the URG-04LX
WALL = 0.20              # metres, as in the paper


@dataclasses.dataclass(frozen=True)
class Surface:
    name: str
    roughness: float  # metres, along the normal


SMOOTH = Surface("smooth", 0.0)
ROUGH = Surface("rough, 5 mm", 0.005)


def range_sigma(distance):
    return np.maximum(0.003, 0.007 * distance)


BEARING_SIGMA = np.radians(0.05)


def wall_scan(distance, view_angle, surface, random, turn=0.0):
    """Noisy points (x, y) of a 20 cm wall whose middle lies at `distance` on the y axis, turned by view_angle about
    its middle; `turn` then turns the whole about the sensor, which changes nothing but the axes."""
    half = WALL / 2
    along = np.array([np.cos(view_angle), np.sin(view_angle)])
    middle = np.array([0.0, distance])
    ends = [middle - half * along, middle + half * along]
    bearings = sorted(np.arctan2(end[1], end[0]) for end in ends)
    first, last = np.ceil(bearings[0] / STEP), np.floor(bearings[1] / STEP)
    true_bearing = np.arange(first, last + 1) * STEP
    normal = np.array([-along[1], along[0]])
    rho = normal @ middle + surface.roughness * random.standard_normal(true_bearing.size)
    measured_at = true_bearing + BEARING_SIGMA * random.standard_normal(true_bearing.size)
    exact = rho / (normal[0] * np.cos(measured_at) + normal[1] * np.sin(measured_at))
    measured = exact + range_sigma(exact) * random.standard_normal(exact.size)
    return measured * np.cos(true_bearing + turn), measured * np.sin(true_bearing + turn)


def residuals_along_y(x, y):
    """(11) to (16), by the hat matrix."""
    design = np.stack([x, np.ones_like(x)], axis=1)
    hat = design @ np.linalg.pinv(design)
    return y - hat @ y


def residuals_along_normal(x, y):
    """Total least squares in normal form."""
    centred = np.stack([x - x.mean(), y - y.mean()], axis=1)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    return centred @ axes[1]


def criteria(residuals, y):
    """(17) to (22), and what (20) should be."""
    n = residuals.size
    sse = float(residuals @ residuals)
    spread = float(((y - y.mean()) ** 2).sum())
    return {"SSE": sse, "RMSE": np.sqrt(sse / n), "RMSE, n - 2": np.sqrt(sse / (n - 2)), "(20)": np.sqrt(sse) / n,
            "MAE": float(np.abs(residuals).mean()), "R2": 1 - sse / spread}


def study(ranges, angles, surfaces, draws, seed=1):
    """Mean of every criterion: {(kind of residual, criterion): array over surfaces, ranges, angles}."""
    random = np.random.default_rng(seed)
    result = {}
    for s, surface in enumerate(surfaces):
        for i, distance in enumerate(ranges):
            for j, angle in enumerate(angles):
                for _ in range(draws):
                    x, y = wall_scan(distance, angle, surface, random)
                    if x.size < 4:
                        continue
                    for kind, of in (("y", residuals_along_y), ("normal", residuals_along_normal)):
                        for name, value in criteria(of(x, y), y).items():
                            store = result.setdefault((kind, name), np.full(
                                (len(surfaces), len(ranges), len(angles), draws), np.nan))
                            free = np.flatnonzero(np.isnan(store[s, i, j]))[0]
                            store[s, i, j, free] = value
    return {key: np.ma.masked_invalid(values).mean(axis=3).filled(np.nan) for key, values in result.items()}


def turned_study(distance, view_angle, turns, draws, seed=5):
    """Mean criteria of one wall as the whole scene is turned: {(kind of residual, criterion): array over turns}."""
    random = np.random.default_rng(seed)
    result = {}
    for turn in turns:
        sums = {}
        for _ in range(draws):
            x, y = wall_scan(distance, view_angle, SMOOTH, random, turn)
            for kind, of in (("y", residuals_along_y), ("normal", residuals_along_normal)):
                for name, value in criteria(of(x, y), y).items():
                    sums[kind, name] = sums.get((kind, name), 0.0) + value / draws
        for key, value in sums.items():
            result.setdefault(key, []).append(value)
    return {key: np.array(values) for key, values in result.items()}


def expected_mse_printed(slope, distance, bearing, sigma_d, sigma_phi):
    """(26) as printed, whose cross term is twice too big."""
    d, p = (distance * sigma_phi) ** 2, slope
    s = sigma_d**2
    return (d * np.cos(bearing) ** 2 + s * np.sin(bearing) ** 2
            + p**2 * (d * np.sin(bearing) ** 2 + s * np.cos(bearing) ** 2)
            + 2 * p * (d - s) * np.sin(2 * bearing))


def expected_mse(slope, distance, bearing, sigma_d, sigma_phi):
    """(26) with the cross term that follows from (7)."""
    d, s = (distance * sigma_phi) ** 2, sigma_d**2
    return expected_mse_printed(slope, distance, bearing, sigma_d, sigma_phi) - slope * (d - s) * np.sin(2 * bearing)


def expected_normal_mse(alpha, distance, bearing, sigma_d, sigma_phi):
    """The same along the normal of the line."""
    turned = bearing - alpha
    return (sigma_d * np.cos(turned)) ** 2 + (distance * sigma_phi * np.sin(turned)) ** 2


def simulated_mse(slope, distance, bearing, sigma_d, sigma_phi, random, draws=200000):
    """Monte Carlo of (25): the point (D, Phi) lies on the line, what is measured does not."""
    measured_d = distance + sigma_d * random.standard_normal(draws)
    measured_phi = bearing + sigma_phi * random.standard_normal(draws)
    intercept = distance * np.sin(bearing) - slope * distance * np.cos(bearing)
    error = measured_d * np.sin(measured_phi) - slope * measured_d * np.cos(measured_phi) - intercept
    return float((error**2).mean())
