"""Figures 8 and 10 of the paper: a corner of the scan and its candidates in the map; the map itself."""
import itertools
import json
import math
import subprocess

import matplotlib.pyplot as plt
import numpy as np

WALL, SCAN, PAIR, WAY, TRUTH, CORNER = "0.25", "#d62728", "#2ca02c", "#1f77b4", "0.8", "#d95f02"
LEAST_ENCLOSED = math.radians(30)


def placed(segments, pose):
    """Segments x1 y1 x2 y2 of a pose's frame in the frame that the pose is given in."""
    x, y, theta = pose
    ends = np.array(segments).reshape(-1, 2, 2)
    turn = np.array([[math.cos(theta), -math.sin(theta)], [math.sin(theta), math.cos(theta)]])
    return (ends @ turn.T + (x, y)).reshape(-1, 4)


def draw(axes, segments, colour, width):
    for x1, y1, x2, y2 in segments:
        axes.plot((x1, x2), (y1, y2), color=colour, linewidth=width, solid_capstyle="round")


def draw_robot(axes, pose):
    x, y, theta = pose
    axes.plot(x, y, "o", color=WAY, markersize=6)
    axes.plot((x, x + 0.5 * math.cos(theta)), (y, y + 0.5 * math.sin(theta)), color=WAY, linewidth=2)


def corner_in(segments):
    """The two lines that make the scan's corner: the longest that are far from parallel, as libale chooses them."""
    def length(s):
        return math.hypot(s[2] - s[0], s[3] - s[1])

    def encloses_enough(a, b):
        sine = abs((a[2] - a[0]) * (b[3] - b[1]) - (a[3] - a[1]) * (b[2] - b[0])) / (length(a) * length(b))
        return sine > math.sin(LEAST_ENCLOSED)
    pairs = [pair for pair in itertools.combinations(segments, 2) if encloses_enough(*pair)]
    return max(pairs, key=lambda pair: min(map(length, pair)))


def draw_scan(axes, lines, pose):
    draw(axes, placed(lines, pose), SCAN, 2)
    draw(axes, placed(corner_in(lines), pose), PAIR, 3)
    draw_robot(axes, pose)


def plan(axes, title):
    axes.set_aspect("equal")
    axes.set_title(title, fontsize=9)
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")


def corner_of(program, log, reference, last):
    done = subprocess.run([program, log, str(reference), str(last)], check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


def figure_8(folder, save, cases):
    """cases: title and what corner_data says. The scan, laid on the map by each of two candidates."""
    figure, grid = plt.subplots(len(cases), 3, figsize=(12, 4.2 * len(cases)), squeeze=False)
    for (scan_axes, second_axes, best_axes), (title, data) in zip(grid, cases):
        draw_scan(scan_axes, data["lines"], (0, 0, 0))
        plan(scan_axes, f"{title}: scan {data['scan']}, its corner in green")
        for axes, name, verdict in ((second_axes, "second", "a candidate"), (best_axes, "best", "adopted")):
            place = data[name]
            draw(axes, data["map"], WALL, 1)
            draw_scan(axes, data["lines"], place["pose"])
            plan(axes, f"{verdict}: {100 * place['part']:.0f} % of the scan lies on walls")
    figure.tight_layout()
    save(figure, folder, "figure_8")
    for title, data in cases:
        print(f"- Figure 8, {title}: scan {data['scan']} laid on the map by its corner; the place adopted explains "
              f"{100 * data['best']['part']:.0f} % of its lines, the next best {100 * data['second']['part']:.0f} %.")


def map_of(replay, log, folder, name):
    """Walls and corners of the map file, and the way."""
    file, way = folder / f"{name}.map", folder / f"{name}.tum"
    subprocess.run([replay, log, "--save-map", file, "--trajectory", way], check=True, stderr=subprocess.DEVNULL)
    words = [line.split() for line in file.read_text().splitlines()]
    walls = np.array([word[2:6] for word in words if word[0] == "wall"], float) * 1e-6
    corners = np.array([word[1:3] for word in words if word[0] == "corner"], float) * 1e-6
    return walls, corners.reshape(-1, 2), np.loadtxt(way)[:, 1:3]


def walls_of(world):
    """Walls of a world file in the frame of the robot's first pose."""
    start, walls = (0.0, 0.0, 0.0), []
    for words in (line.split() for line in world.read_text().splitlines()):
        if words[:2] == ["#", "start"]:
            start = tuple(map(float, words[2:5]))
        elif words and words[0] != "#":
            walls.append([float(word) for word in words[:4]])
    x, y, theta = start
    back = (-x * math.cos(theta) - y * math.sin(theta), x * math.sin(theta) - y * math.cos(theta), -theta)
    return placed(walls, back)


def distance_to_walls(points, walls):
    """Of each point to the nearest wall."""
    start, along = walls[:, :2], walls[:, 2:] - walls[:, :2]
    from_start = points[:, None, :] - start
    t = np.clip((from_start * along).sum(2) / (along ** 2).sum(1), 0, 1)
    return np.linalg.norm(from_start - t[..., None] * along, axis=2).min(1)


def every_five_centimetres(walls):
    points = [np.linspace(wall[:2], wall[2:], max(2, int(math.hypot(*(wall[2:] - wall[:2])) / 0.05))) for wall in walls]
    return np.concatenate(points)


def draw_map(axes, title, drawn):
    walls, corners, way = drawn
    draw(axes, walls, WALL, 1.6)
    axes.plot(*way.T, color=WAY, linewidth=0.8)
    axes.plot(*corners.T, "o", color=CORNER, fillstyle="none", markersize=5)
    plan(axes, f"{title}: {len(walls)} lines, {len(corners)} corners")


def figure_10(folder, save, replay, own, world, recorded):
    """The map of an own world, over its true walls, and of a recording where there is one."""
    figure, axes = plt.subplots(1, 2 if recorded else 1, figsize=(12 if recorded else 6, 6), squeeze=False)
    drawn = map_of(replay, own, folder, "own")
    true_walls = walls_of(world)
    draw(axes[0, 0], true_walls, TRUTH, 5)
    draw_map(axes[0, 0], "own world (grey: true walls)", drawn)
    if recorded:
        draw_map(axes[0, 1], f"recording {recorded.stem}", map_of(replay, recorded, folder, "recorded"))
    figure.tight_layout()
    save(figure, folder, "figure_10")
    off_mm = 1e3 * distance_to_walls(every_five_centimetres(drawn[0]), true_walls)
    print(f"- Figure 10: the lines of the own world's map lie {np.median(off_mm):.1f} mm off the true walls in the median, "
          f"{np.percentile(off_mm, 95):.1f} mm at 95 %.")
