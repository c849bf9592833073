"""A trajectory against a truth, and a run in numbers."""
import numpy as np

from .runs import LOST, WEAK

NEAREST_S = 0.1  # a pose of the truth is at most so far away in time, either side


class Error:
    """Of each pose that the truth knows: t, position error in metres."""

    def __init__(self, t, position):
        self.t, self.position = t, position

    @property
    def rmse(self):
        return float(np.sqrt(np.mean(self.position**2)))


def truth_at(truth, t):
    """Poses of the truth at these times, in between by a straight line, and which of them it knows."""
    after = np.clip(np.searchsorted(truth[:, 0], t), 1, len(truth) - 1)
    before = after - 1
    gap = np.minimum(np.abs(truth[before, 0] - t), np.abs(truth[after, 0] - t))
    inside = (t >= truth[0, 0] - NEAREST_S) & (t <= truth[-1, 0] + NEAREST_S)
    heading = np.unwrap(truth[:, 3])
    poses = np.column_stack([np.interp(t, truth[:, 0], column) for column in (truth[:, 1], truth[:, 2], heading)])
    return poses, inside & (gap <= NEAREST_S)


def rigid_fit(points, onto):
    """Rotation and translation that lay points onto others with least squares (Umeyama without scale)."""
    middle, middle_onto = points.mean(axis=0), onto.mean(axis=0)
    a, b = points - middle, onto - middle_onto
    turn = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    rotation = rotation_of(turn)
    return turn, middle_onto - rotation @ middle


def rotation_of(turn):
    return np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])


def aligned(trajectory, truth, how):
    """A trajectory in the truth's frame: how = "all" (least squares), "first" (first common pose), "none". None: they
    have no time in common."""
    poses, known = truth_at(truth, trajectory[:, 0])
    if not known.any():
        return None
    if how == "none":
        return trajectory
    if how == "first":
        first = int(np.argmax(known))
        turn = poses[first, 2] - trajectory[first, 3]
        shift = poses[first, :2] - rotation_of(turn) @ trajectory[first, 1:3]
    else:
        turn, shift = rigid_fit(trajectory[known, 1:3], poses[known, :2])
    moved = trajectory.copy()
    moved[:, 1:3] = trajectory[:, 1:3] @ rotation_of(turn).T + shift
    moved[:, 3] += turn
    return moved


def error_of(trajectory, truth):
    """Of a trajectory in the truth's frame; None of none."""
    if trajectory is None:
        return None
    poses, known = truth_at(truth, trajectory[:, 0])
    apart = trajectory[known, 1:3] - poses[known, :2]
    return Error(trajectory[known, 0], np.hypot(apart[:, 0], apart[:, 1]))


def ratio_to_stated(run, truth, how):
    """Position errors of the live poses in sigmas as they were stated; None: there are no poses, or no time in common."""
    live = None if run.live is None else aligned(run.live, truth, how)
    if live is None:
        return None
    _, known = truth_at(truth, live[:, 0])
    sigma = np.sqrt((run.poses["cov"][known, 0] + run.poses["cov"][known, 4]) / 2)
    return error_of(live, truth).position[sigma > 0] / sigma[sigma > 0]


def table(runs, errors):
    """Rows of text: what there is of each run in numbers."""
    rows = [("run", "scans", "weak", "lost", "predicted", "ATE rmse mm", "median mm", "95 % mm", "worst mm", "mean ms", "99 % ms")]
    for run, error in zip(runs, errors):
        count = len(run.trajectory) if run.trajectory is not None else len(run.timing["total"]) if run.timing else 0
        row = [run.name, str(count)]
        row += [str(int(n)) for n in troubles(run)] if run.poses else ["-"] * 3
        if error is None:
            row += ["-"] * 4
        else:
            millimetres = 1000 * error.position
            row += [f"{1000 * error.rmse:.1f}"] + [f"{value:.1f}" for value in np.percentile(millimetres, (50, 95, 100))]
        row += [f"{run.timing['total'].mean():.3f}", f"{np.percentile(run.timing['total'], 99):.3f}"] if run.timing else ["-"] * 2
        rows.append(tuple(row))
    return rows


def troubles(run):
    """Scans with a weak pose, lost ones, and those answered by prediction alone."""
    state = run.poses["state"]
    return (state == WEAK).sum(), (state == LOST).sum(), run.poses["predicted"].sum()
