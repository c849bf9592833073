"""What is drawn of runs: one function a panel, each into axes of its own."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from .runs import LOST, STAGES, WEAK  # noqa: E402


COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")  # told apart by everybody (Okabe, Ito)
STAGE_COLOURS = ("#56b4e9", "#009e73", "#0072b2", "#e69f00", "#cc79a7")
BINS = 25
STYLES = ("-", "--", ":", "-.")


def colour(number):
    return COLOURS[number % len(COLOURS)]


def trajectories(axes, runs, shown, truth):
    """shown: trajectories as they are drawn, in the truth's frame if there is one."""
    if truth is not None:
        axes.plot(truth[:, 1], truth[:, 2], color="0.6", linewidth=3, label="truth", zorder=1)
    for number, (run, trajectory) in enumerate(zip(runs, shown)):
        if trajectory is None:
            continue
        axes.plot(trajectory[:, 1], trajectory[:, 2], color=colour(number), linewidth=1.1, label=run.name, zorder=2)
        axes.plot(*trajectory[0, 1:3], "o", color=colour(number), markersize=6, zorder=3)
        axes.plot(*trajectory[-1, 1:3], "s", color=colour(number), markersize=6, zorder=3)
        if run.poses and len(run.poses["state"]) == len(trajectory):
            for state, mark, name in ((WEAK, "#f0c000", "weak"), (LOST, "red", "lost")):
                there = run.poses["state"] == state
                if there.any():
                    axes.plot(trajectory[there, 1], trajectory[there, 2], ".", color=mark, markersize=5, zorder=4,
                              label=f"{run.name}: {name}")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")
    axes.set_title("trajectory (circle: start, square: end)")
    axes.legend(loc="best", fontsize="small", framealpha=0.8)


def errors(axes, runs, of_runs):
    """Position error over time: median of each bin, bars from the 10th to the 90th per cent."""
    for number, (run, error) in enumerate(zip(runs, of_runs)):
        if error is None or len(error.t) == 0:
            continue
        t = error.t - run.start
        edges = np.linspace(t[0], t[-1] + 1e-9, min(BINS, len(t)) + 1)
        which = np.clip(np.digitize(t, edges) - 1, 0, len(edges) - 2)
        full = [k for k in range(len(edges) - 1) if (which == k).any()]
        low, middle, high = np.array([np.percentile(1000 * error.position[which == k], (10, 50, 90)) for k in full]).T
        centre = np.array([(edges[k] + edges[k + 1]) / 2 for k in full])
        axes.errorbar(centre + (number - (len(runs) - 1) / 2) * 0.15 * (edges[1] - edges[0]), middle, [middle - low, high - middle],
                      color=colour(number), marker="o", markersize=3, linewidth=1, capsize=2,
                      label=f"{run.name}: rmse {1000 * error.rmse:.1f} mm")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("time, s")
    axes.set_ylabel("position error, mm")
    axes.set_title("error against the truth (median, 10 to 90 %)")
    axes.legend(loc="best", fontsize="small", framealpha=0.8)


def honesty(axes, runs, ratios):
    """How often a live pose is within so many of the sigmas that it stated; the line is what a normal distribution has."""
    steps = np.linspace(0, 4, 81)
    axes.plot(steps, 100 * (1 - np.exp(-steps**2 / 2)), color="0.6", linewidth=3, label="as it should be")
    for number, (run, ratio) in enumerate(zip(runs, ratios)):
        if ratio is None or len(ratio) == 0:
            continue
        axes.plot(steps, [100 * np.mean(ratio <= step) for step in steps], color=colour(number), label=run.name)
    axes.set_xlabel("error, in sigmas stated")
    axes.set_ylabel("poses within, %")
    axes.set_ylim(0, 102)
    axes.set_title("is the stated covariance true? (poses as known live)")
    axes.legend(loc="lower right", fontsize="small", framealpha=0.8)


def covariance(axes, runs):
    """One sigma of the map pose: position solid in mm, heading dotted in mrad; on a logarithmic scale."""
    for number, run in enumerate(run for run in runs if run.poses):
        t = run.poses["t"] - run.start
        cov = run.poses["cov"]
        axes.plot(t, 1000 * np.sqrt(np.maximum(cov[:, 0] + cov[:, 4], 1e-12) / 2), color=colour(number), linewidth=1,
                  label=f"{run.name}: position, mm")
        axes.plot(t, 1000 * np.sqrt(np.maximum(cov[:, 8], 1e-12)), ":", color=colour(number), linewidth=1,
                  label=f"{run.name}: heading, mrad")
    axes.set_yscale("log")
    axes.set_ylim(bottom=max(axes.get_ylim()[0], 0.1))
    axes.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlabel("time, s")
    axes.set_ylabel("one sigma, mm or mrad")
    axes.set_title("stated uncertainty of the map pose")
    axes.legend(loc="best", fontsize="small", framealpha=0.8)


def stage_times(axes, runs):
    """Mean of each stage on top of the other, and the total's 99th per cent and worst scan beside it."""
    timed = [run for run in runs if run.timing]
    for k, run in enumerate(timed):
        below = 0.0
        for stage, shade in zip(STAGES, STAGE_COLOURS):
            mean = run.timing[stage].mean()
            axes.bar(k, mean, 0.55, bottom=below, color=shade, label=stage if k == 0 else None)
            below += mean
        for value, mark, name in ((np.percentile(run.timing["total"], 99), "_", "99 %"), (run.timing["total"].max(), "x", "worst")):
            axes.plot(k, value, mark, color="k", markersize=12 if mark == "_" else 7, markeredgewidth=2, label=name if k == 0 else None)
    axes.set_xticks(range(len(timed)), [run.name for run in timed])
    axes.set_xlim(-0.7, len(timed) - 0.3)
    axes.set_ylim(bottom=0)
    axes.set_ylabel("processor time of a scan, ms")
    axes.set_title("stage times (bars: mean)")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")


def dropped(axes, runs):
    """Scans that were not answered well, summed up over time."""
    posed = [run for run in runs if run.poses]
    for number, run in enumerate(posed):
        t = run.poses["t"] - run.start
        kinds = (("weak", run.poses["state"] == WEAK, "-"), ("lost", run.poses["state"] == LOST, "--"),
                 ("predicted", run.poses["predicted"], ":"), ("wheels contradict", run.poses["wheel_fault"] != "fine", "-."))
        for name, there, style in kinds:
            if there.any():
                axes.step(t, np.cumsum(there), style, where="post", color=colour(number), label=f"{run.name}: {name} ({int(there.sum())})")
    if not axes.lines:
        told = "\n".join(f"{run.name}: all {len(run.poses['t'])} scans answered, pose good" for run in posed)
        axes.text(0.5, 0.5, told, ha="center", va="center", transform=axes.transAxes)
        axes.set_yticks([])
    else:
        axes.legend(loc="upper left", fontsize="small", framealpha=0.8)
        axes.set_ylim(bottom=0)
    axes.set_xlabel("time, s")
    axes.set_ylabel("scans so far")
    axes.set_title("what was dropped or doubtful")


def counters(axes, runs):
    """What the robot itself counted as dropped, late or at fault (ALE_STATUS), summed up over time."""
    for number, run in enumerate(runs):
        grown = run.counted.grown if run.counted else {}
        for place, (name, growth) in enumerate(sorted(grown.items(), key=lambda each: -each[1][-1])):
            axes.step(run.counted.t - run.start, growth, STYLES[place % len(STYLES)], where="post", color=colour(number + place // len(STYLES)),
                      label=f"{run.name}: {name} ({growth[-1]})")
    if axes.lines:
        axes.legend(loc="upper left", fontsize="small", framealpha=0.8)
        axes.set_ylim(bottom=0)
    else:
        axes.text(0.5, 0.5, "nothing was dropped, late or at fault", ha="center", va="center", transform=axes.transAxes)
        axes.set_yticks([])
    axes.set_xlabel("time, s")
    axes.set_ylabel("so often")
    axes.set_title("what the robot counted (ALE_STATUS)")


def summary(axes, rows):
    """The table of numbers."""
    axes.axis("off")
    told = [k for k in range(len(rows[0])) if k < 2 or any(row[k] != "-" for row in rows[1:])]
    letters = [max(8, *(len(row[k]) for row in rows)) for k in told]
    drawn = axes.table([[row[k] for k in told] for row in rows[1:]], colLabels=[rows[0][k] for k in told], loc="center", cellLoc="right",
                       colWidths=[count / max(sum(letters), 90) for count in letters])
    drawn.auto_set_font_size(False)
    drawn.set_fontsize(9)
    drawn.scale(1, 1.5)


def panels_of(runs, shown, of_runs, truth, ratios, rows):
    """Those for which there is something to draw: its name, and the function."""
    chosen = []
    if any(trajectory is not None for trajectory in shown):
        chosen.append(("trajectory", lambda axes: trajectories(axes, runs, shown, truth)))
    if any(error is not None for error in of_runs):
        chosen.append(("error", lambda axes: errors(axes, runs, of_runs)))
        if any(ratio is not None for ratio in ratios):
            chosen.append(("honesty", lambda axes: honesty(axes, runs, ratios)))
    if any(run.poses for run in runs):
        chosen.append(("covariance", lambda axes: covariance(axes, runs)))
        chosen.append(("dropped", lambda axes: dropped(axes, runs)))
    if any(run.counted for run in runs):
        chosen.append(("counters", lambda axes: counters(axes, runs)))
    if any(run.timing for run in runs):
        chosen.append(("timing", lambda axes: stage_times(axes, runs)))
    chosen.append(("table", lambda axes: summary(axes, rows)))
    return chosen
