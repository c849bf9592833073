#!/usr/bin/python3
"""Redraws the paper's figures from own data and prints what was measured for them, as Markdown.

    figures.py --build build --world tools/lab/worlds/home.world [--recorded exp1.dat] --out build/figures
"""
import argparse
import json
import pathlib
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import criteria  # noqa: E402
import mapping  # noqa: E402

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.color": "0.9", "axes.axisbelow": True,
                     "legend.frameon": False, "savefig.dpi": 80, "savefig.bbox": "tight"})
GREEN, RED, BLUE, GREY = "#2ca02c", "#d62728", "#1f77b4", "0.6"
NOISES = ("3mm", "10mm", "20mm", "urg", "real")
THRESHOLDS_MM = (1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40)
SWEPT_SCANS = 6


def save(figure, folder, name):
    figure.savefig(folder / f"{name}.png")
    plt.close(figure)


def figure_1(folder, data):
    """An outlier on a wall: libale's plain lowess, residuals against six median absolute deviations, robust lowess."""
    wall, measured, plain, robust = (np.array(data[key]) for key in ("wall", "measured", "plain", "robust"))
    degrees = np.arange(wall.size) * 360 / 1024
    residual = 1 / measured - 1 / plain
    deviation = np.median(np.abs(residual))
    figure, (a, b, c) = plt.subplots(1, 3, figsize=(11, 3.2))
    for axes, smooth, title in ((a, plain, "(a) lowess of 1/r"), (c, robust, "(c) robust lowess of 1/r")):
        axes.plot(degrees, measured, ".", color=GREY, label="measured")
        axes.plot(degrees, wall, color=GREEN, label="true wall")
        axes.plot(degrees, smooth, color=BLUE, label="smoothed by libale")
        axes.set(title=title, xlabel="bearing, degrees", ylabel="range, m")
        axes.legend(loc="lower left")
    b.plot(degrees, residual, ".", color=GREY)
    b.axhspan(-6 * deviation, 6 * deviation, color=BLUE, alpha=0.15, label="within 6 MAD")
    b.set(title="(b) residuals of (a)", xlabel="bearing, degrees", ylabel="1/m")
    b.legend()
    figure.tight_layout()
    save(figure, folder, "figure_1")
    near = slice(data["stray_beam"] - 5, data["stray_beam"] + 6)
    worst = [1e3 * np.abs(s[near] - wall[near]).max() for s in (plain, robust)]
    print(f"- Figure 1: one stray value of {1e3 * data['stray_by']:.0f} mm moves the smoothed wall by up to {worst[0]:.1f} mm "
          f"with plain lowess, {worst[1]:.1f} mm with robust lowess (span 11, noise 3 mm); it lies "
          f"{np.abs(residual).max() / deviation:.0f} MAD off.")


def draw_points(axes, data):
    points = np.array(data["points"])
    axes.plot(points[:, 1], points[:, 2], ".", color=GREY, markersize=2)
    axes.set_aspect("equal")
    axes.set(xlabel="x, m", ylabel="y, m")


def draw_lines(axes, lines):
    for k, line in enumerate(lines):
        (x1, y1), (x2, y2) = line["ends"]
        axes.plot((x1, x2), (y1, y2), color=(RED, BLUE)[k % 2], linewidth=1.8)
        axes.plot((x1, x2), (y1, y2), "|", color="k", markersize=7)


def figure_2(folder, data):
    """The binary search for the ends of the lines."""
    figure, (plan, search) = plt.subplots(1, 2, figsize=(11, 4), gridspec_kw={"width_ratios": (1, 2)})
    draw_points(plan, data)
    draw_lines(plan, data["lines"])
    plan.set_title("the scan and its lines")
    for row, step in enumerate(data["steps"]):
        search.plot((step["left"], step["right"]), (row, row), color="#9ab7d8", linewidth=4, solid_capstyle="butt")
        search.plot((step["first"], step["left"]), (row, row), color="0.85", linewidth=2)
        search.plot(step["guess"], row, "o", color=GREEN if step["accepted"] else RED, markersize=5)
    for beam in data["true_breaks"]:
        search.axvline(beam + 0.5, color="k", linewidth=0.8, linestyle=":")
    search.invert_yaxis()
    search.set(xlabel="beam", ylabel="step", title="span [L, R] and guess P: green accepted, red not; dotted: true breaks")
    save(figure, folder, "figure_2")
    print(f"- Figure 2: {len(data['steps'])} fits find the breaks of {len(data['points'])} points; "
          f"true breaks after beams {data['true_breaks']}, lines end at {[line['last'] for line in data['lines']]}.")


RANGES = (0.5, 1.0, 2.0, 3.0, 4.0)
ANGLES = np.radians(np.arange(0, 76, 5))


def figure_3(folder):
    """Raw data of a 20 cm wall from different ranges and views."""
    random = np.random.default_rng(2)
    figure, all_axes = plt.subplots(1, 3, figsize=(11, 4.5), sharey=True)
    for axes, angle in zip(all_axes, np.radians((0, 30, 60))):
        for distance in RANGES:
            x, y = criteria.wall_scan(distance, angle, criteria.SMOOTH, random)
            axes.plot(x, y, ".", markersize=3, label=f"{distance} m, {x.size} beams")
        axes.set(title=f"view angle {np.degrees(angle):.0f} degrees", xlabel="x, m", xlim=(-0.3, 0.3))
        axes.legend(loc="center left", bbox_to_anchor=(0, 0.55), fontsize=7)
    all_axes[0].set_ylabel("y, m")
    save(figure, folder, "figure_3")


def figure_4(folder):
    """The criteria over view angle and range, for residuals along y and along the normal."""
    surfaces = (criteria.SMOOTH, criteria.ROUGH)
    result = criteria.study(RANGES, ANGLES, surfaces, draws=40)
    names = ("SSE", "RMSE, n - 2", "(20)", "MAE", "R2")
    figure, all_axes = plt.subplots(2, len(names), figsize=(14, 5.4), sharex=True)
    for row, (kind, title) in zip(all_axes, (("y", "residual along y"), ("normal", "residual along the normal"))):
        for axes, name in zip(row, names):
            scale = {"SSE": 1e6, "R2": 1}.get(name, 1e3)
            for k, distance in enumerate(RANGES):
                axes.plot(np.degrees(ANGLES), scale * result[kind, name][0, k], label=f"{distance} m")
            unit = {"SSE": ", mm^2", "R2": ""}.get(name, ", mm")
            axes.set_title(f"{name.replace('R2', 'R^2')}{unit}")
            axes.set_yscale("linear" if name == "R2" else "log")
        row[0].set_ylabel(title)
    all_axes[0, 0].legend(fontsize=7)
    for axes in all_axes[1]:
        axes.set_xlabel("view angle, degrees")
    figure.tight_layout()
    save(figure, folder, "figure_4")
    print_criteria(result, surfaces)


def spread_over(values):
    return np.nanmax(values) / np.nanmin(values)


def figure_turned(folder):
    """The same wall, the same view, the axes turned: what y = p1 x + p2 makes of it."""
    turns = np.radians(np.arange(0, 181, 5))
    figure, (rmse, r2) = plt.subplots(1, 2, figsize=(8.5, 3.2))
    result = criteria.turned_study(2.0, 0.0, turns, draws=60)
    for kind, colour, title in (("y", RED, "residual along y"), ("normal", GREEN, "residual along the normal")):
        rmse.plot(np.degrees(turns), 1e3 * result[kind, "RMSE, n - 2"], color=colour, label=title)
    r2.plot(np.degrees(turns), result["y", "R2"], color=RED)
    rmse.set(title="RMSE of a wall seen from 2 m, mm", xlabel="scene turned by, degrees", yscale="log")
    r2.set(title="R^2 of the same fits along y", xlabel="scene turned by, degrees", ylim=(0, 1))
    rmse.legend(loc="upper right", fontsize=7)
    rmse.set_yticks((10, 20, 50, 100), labels=("10", "20", "50", "100"), minor=False)
    rmse.minorticks_off()
    figure.tight_layout()
    save(figure, folder, "figure_4_turned")
    print("- The same wall at 2 m, scene turned in steps of 5 degrees: RMSE along y changes by a factor of "
          f"{spread_over(result['y', 'RMSE, n - 2']):.1f}, along the normal by {spread_over(result['normal', 'RMSE, n - 2']):.2f}; "
          f"R^2 from {result['y', 'R2'].min():.2f} to {result['y', 'R2'].max():.2f}.")


def print_criteria(result, surfaces):
    """How much each criterion changes though the wall stays the same."""
    print("- Figure 4: largest over smallest value of each criterion, the same 20 cm wall, smooth, simulated URG-04LX:\n")
    print("| criterion | along y: over angle at 2 m | along y: over range at 0 degrees | along normal: over angle at 2 m "
          "| along normal: over range | rough (5 mm) over smooth, 1 m, 0 degrees |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    for name in ("SSE", "RMSE", "RMSE, n - 2", "(20)", "MAE"):
        y, normal = result["y", name], result["normal", name]
        print(f"| {name} | {spread_over(y[0, 2]):.1f} | {spread_over(y[0, :, 0]):.1f} | {spread_over(normal[0, 2]):.1f} "
              f"| {spread_over(normal[0, :, 0]):.1f} | {normal[1, 1, 0] / normal[0, 1, 0]:.1f} |")
    r2 = result["y", "R2"][0, 2]
    print(f"\n  R^2 at 2 m: {r2[0]:.2f} for the wall parallel to x, {r2[6]:.2f} at 30, {r2[12]:.2f} at 60 degrees.")
    by_range = 1e3 * result["normal", "RMSE, n - 2"][0, :, 0]
    print("  RMSE along the normal over range " + ", ".join(f"{d} m: {v:.1f} mm" for d, v in zip(RANGES, by_range)) + ".")


def figure_expected(folder):
    """(26) as printed and corrected against Monte Carlo."""
    random = np.random.default_rng(3)
    sigma_d, sigma_phi, distance = 0.010, np.radians(0.1), 3.0
    bearings = np.radians(np.arange(5, 176, 10))
    figure, all_axes = plt.subplots(1, 3, figsize=(11, 3.4), sharey=False)
    worst_printed = worst_corrected = 0.0
    for axes, slope in zip(all_axes, (0.3, 1.0, 3.0)):
        args = (slope, distance, bearings, sigma_d, sigma_phi)
        true = np.array([criteria.simulated_mse(slope, distance, b, sigma_d, sigma_phi, random) for b in bearings])
        printed, corrected = criteria.expected_mse_printed(*args), criteria.expected_mse(*args)
        axes.plot(np.degrees(bearings), 1e6 * true, "o", color="k", markersize=4, label="Monte Carlo")
        axes.plot(np.degrees(bearings), 1e6 * corrected, color=GREEN, label="corrected")
        axes.plot(np.degrees(bearings), 1e6 * printed, "--", color=RED, label="as printed")
        axes.set(title=f"slope p1 = {slope}", xlabel="bearing, degrees", ylabel="expected MSE, mm^2")
        worst_printed = max(worst_printed, np.abs(printed - true).max() / true.mean())
        worst_corrected = max(worst_corrected, np.abs(corrected / true - 1).max())
        along_normal = criteria.expected_normal_mse(np.arctan2(1, -slope), distance, bearings, sigma_d, sigma_phi)
        assert np.allclose(along_normal * (1 + slope**2), corrected)
    all_axes[0].legend()
    figure.tight_layout()
    save(figure, folder, "expected_mse")
    print(f"- (26): corrected within {100 * worst_corrected:.1f} % of Monte Carlo (200000 draws each); as printed wrong "
          f"by up to {100 * worst_printed:.0f} % of the mean, and negative at some bearings. Divided by 1 + p1^2 "
          "it is the normal-form expression to rounding.")


def figure_5(folder, data):
    """One static threshold too low, one too high."""
    figure, all_axes = plt.subplots(1, 2, figsize=(8, 4.5))
    for axes, key, letter in ((all_axes[0], "static_low", "a"), (all_axes[1], "static_high", "b")):
        threshold = 1e3 * data["low_threshold" if key == "static_low" else "high_threshold"]
        draw_points(axes, data)
        draw_lines(axes, data[key])
        axes.set_title(f"({letter}) static threshold {threshold:.1f} mm: {len(data[key])} lines")
    save(figure, folder, "figure_5")
    ends = [line["last"] for line in data["static_high"]]
    print(f"- Figure 5: with 3 mm of noise a static threshold of 2.5 mm makes {len(data['static_low'])} lines of 3 walls; "
          f"8 mm makes {len(data['static_high'])}, ending at beams {ends} where the walls end at {data['true_breaks']}.")


def figure_6(folder, data):
    """Growth of the RMSE with the points of the line, and the bounds of the threshold."""
    growth = data["growth"]
    beams = [g["beam"] for g in growth]
    figure, axes = plt.subplots(figsize=(7, 3.6))
    axes.plot(beams, [g["rmse_mm"] for g in growth], color="k", label="RMSE of the line up to the beam")
    axes.fill_between(beams, [g["low_mm"] for g in growth], [g["high_mm"] for g in growth], color=GREEN, alpha=0.4,
                      label="where libale's threshold floats")
    for value, style in ((1e3 * data["low_threshold"], ":"), (1e3 * data["high_threshold"], "--")):
        axes.axhline(value, color=RED, linestyle=style, linewidth=1, label=f"static {value:.1f} mm")
    axes.axvline(data["true_breaks"][0] + 0.5, color=BLUE, linewidth=1, label="true break")
    axes.set(xlabel="last beam of the line", ylabel="RMSE, mm", ylim=(0, 15), xlim=(beams[0], data["true_breaks"][1]))
    axes.legend(fontsize=8)
    save(figure, folder, "figure_6")
    crossing = {name: next(g["beam"] for g in growth if g["beam"] > beams[0] + 40 and g["rmse_mm"] > limit(g))
                for name, limit in (("2.5 mm", lambda g: 2.5), ("8 mm", lambda g: 8.0),
                                    ("the upper bound of the floating threshold", lambda g: g["high_mm"]))}
    print("- Figure 6: the RMSE crosses " + ", ".join(f"{name} at beam {beam}" for name, beam in crossing.items())
          + f"; the wall ends at {data['true_breaks'][0]}.")


def figure_7(folder, data):
    """What libale extracts."""
    figure, axes = plt.subplots(figsize=(4.2, 4.5))
    draw_points(axes, data)
    draw_lines(axes, data["lines"])
    for x, y in data["corners"]:
        axes.plot(x, y, "o", color="#d95f02", fillstyle="none", markersize=10)
    axes.set_title(f"libale: {len(data['lines'])} lines, {len(data['corners'])} corners")
    save(figure, folder, "figure_7")
    rmse = ", ".join(f"{line['rmse_mm']:.2f}" for line in data["lines"])
    print(f"- Figure 7: libale's lines end at beams {[line['last'] for line in data['lines']]}, RMSE {rmse} mm.")


def accuracy(bench, noise, extractor, *more):
    command = [bench, "accuracy", "--noise", noise, "--extractor", extractor, "--scans", str(SWEPT_SCANS), *more]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


def figure_thresholds(folder, bench):
    """Static against floating threshold: lines found and false lines over the static threshold."""
    figure, all_axes = plt.subplots(1, len(NOISES), figsize=(14, 3.2), sharey=True)
    print("- Static against floating threshold, found % / false % (no curved walls):\n")
    print("| noise | best static threshold | static, at it | static 3.7 mm (paper) | libale, one setting |")
    print("| --- | ---: | ---: | ---: | ---: |")
    pair = "{0[tp]:.1f} / {0[fp_straight]:.1f}".format
    for axes, noise in zip(all_axes, NOISES):
        rows = [accuracy(bench, noise, "static-ale-tuned", "--threshold", f"{e},0") for e in THRESHOLDS_MM]
        ale, paper = accuracy(bench, noise, "ale"), accuracy(bench, noise, "static-ale-3.7mm")
        axes.plot(THRESHOLDS_MM, [row["tp"] for row in rows], color=GREEN, label="found, static")
        axes.plot(THRESHOLDS_MM, [row["fp_straight"] for row in rows], color=RED, label="false, static")
        axes.axhline(ale["tp"], color=GREEN, linestyle="--", label="found, libale")
        axes.axhline(ale["fp_straight"], color=RED, linestyle="--", label="false, libale")
        axes.set(title=f"noise {noise}", xlabel="static threshold, mm", xscale="log", ylim=(0, 103))
        axes.set_xticks((2, 5, 10, 20, 40), labels=("2", "5", "10", "20", "40"))
        axes.minorticks_off()
        best = max(range(len(rows)), key=lambda k: rows[k]["tp"] - rows[k]["fp_straight"])
        print(f"| {noise} | {THRESHOLDS_MM[best]} mm | {pair(rows[best])} | {pair(paper)} | {pair(ale)} |")
    all_axes[0].set_ylabel("%")
    all_axes[0].legend(fontsize=7)
    figure.tight_layout()
    save(figure, folder, "static_and_floating")
    print()


# Scans after which the map is taken that a later scan is laid on: half of the house; the hall after a loop.
OWN_REFERENCE, RECORDED_REFERENCE, LAST = 300, 500, 700


def figures_8_and_10(options):
    """A drive through an own world, and a recording where one is given."""
    corner, own = options.build / "figures/corner_data", options.out / "own.log"
    subprocess.run([options.build / "bin/ale-sim", "--world", options.world, "--write-log", own], check=True,
                   stdout=subprocess.DEVNULL)
    cases = [("own world", mapping.corner_of(corner, own, OWN_REFERENCE, LAST))]
    if options.recorded:
        name = f"recording {options.recorded.stem}"
        cases.append((name, mapping.corner_of(corner, options.recorded, RECORDED_REFERENCE, LAST)))
    mapping.figure_8(options.out, save, cases)
    mapping.figure_10(options.out, save, options.build / "bin/ale-replay", own, options.world, options.recorded)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, type=pathlib.Path, help="where programs are")
    parser.add_argument("--world", required=True, type=pathlib.Path, help="own world of figures 8 and 10")
    parser.add_argument("--recorded", type=pathlib.Path, help="recording of figures 8 and 10")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    data = json.loads(subprocess.run([options.build / "figures/figure_data"], check=True, stdout=subprocess.PIPE, text=True).stdout)
    figure_1(options.out, data["smoothing"])
    figure_2(options.out, data)
    figure_3(options.out)
    figure_4(options.out)
    figure_turned(options.out)
    figure_expected(options.out)
    figure_5(options.out, data)
    figure_6(options.out, data)
    figure_7(options.out, data)
    figures_8_and_10(options)
    figure_thresholds(options.out, options.build / "bench/lines")
    print(f"Pictures: {options.out}/")


if __name__ == "__main__":
    main()
