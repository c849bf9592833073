#!/usr/bin/env python3
"""Lost in a saved map: a robot is put at random places of a world and drives on from there. Does it find itself?

    relocalise.py [--build build] [--poses 100] [--seconds 60] [--seed 7] [WORLD]...

For each world: a drive through it is mapped and the map saved; then every place (near the world's way, any heading)
is the start of a drive along the next points of the way, which ale-replay sees from a loaded map and an unknown
pose. Right: at the end the pose is known within 10 cm and 0.1 rad. Wrong: at any scan the state was good and the
pose was not. The truth is where a true place lies in the saved map, as the scans have it that the mapping drive took
within half a metre of it: the map of a long corridor is itself some centimetres off, which is told apart. Exit 1 when
more than one in a hundred was not right, or any was wrong.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

GOOD = 2
NEAR_M, NEAR_RAD = 0.10, 0.10
PLACE_NEAR_M, PLACE_STEP = 0.5, 4  # scans of the mapping drive that say where a place lies in the map
POINTS = 12  # of the way that are driven to
ROBOT_M = 0.25  # room that a place leaves around the robot


class World:
    def __init__(self, path):
        self.walls, self.start, self.via = [], (0.0, 0.0, 0.0), []
        try:
            lines = pathlib.Path(path).read_text(encoding="utf-8").splitlines()
        except OSError as error:
            raise SystemExit(f"relocalise.py: {path}: {error.strerror}") from error
        for line in lines:
            words = line.split()
            if words[:2] == ["#", "start"]:
                self.start = tuple(map(float, words[2:5]))
            elif words[:2] == ["#", "via"]:
                self.via.append(tuple(map(float, words[2:4])))
            elif words and words[0] != "#":
                self.walls.append(tuple(map(float, words[:4])))
        if not self.via:
            raise SystemExit(f"relocalise.py: {path}: no way through it (\"# via x y\"), near which places are taken")

    def room(self, x, y):
        """Distance to the nearest wall."""
        def distance(wall):
            ax, ay, bx, by = wall
            dx, dy = bx - ax, by - ay
            u = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)
            u = min(max(u, 0.0), 1.0)
            return math.hypot(ax + u * dx - x, ay + u * dy - y)
        return min(map(distance, self.walls))

    def is_clear(self, a, b, room_m):
        steps = max(2, int(math.dist(a, b) / 0.05))
        return all(self.room(a[0] + (b[0] - a[0]) * k / steps, a[1] + (b[1] - a[1]) * k / steps) > room_m
                   for k in range(steps + 1))

    def place(self, chance):
        """A random pose within a metre of the way, and the points to drive to from there."""
        points = [self.start[:2], *self.via]
        pieces = [(k, a, b) for k, (a, b) in enumerate(zip(points, points[1:])) if math.dist(a, b) > 0.05]
        while True:
            k, a, b = chance.choices(pieces, [math.dist(a, b) for _, a, b in pieces])[0]
            u = chance.random()
            on = (a[0] + (b[0] - a[0]) * u, a[1] + (b[1] - a[1]) * u)
            p = (on[0] + chance.uniform(-1, 1), on[1] + chance.uniform(-1, 1))
            if self.room(*p) > ROBOT_M and self.is_clear(p, on, ROBOT_M - 0.05):
                return (*p, chance.uniform(-math.pi, math.pi)), [on, *self.onward(k)]

    def onward(self, k):
        """The next points of the way from its k-th piece; at its end it is driven back."""
        return (self.via + self.via[-2::-1])[k:k + POINTS]

    def write(self, path, start, via):
        lines = [f"# start {start[0]:.3f} {start[1]:.3f} {start[2]:.4f}"]
        lines += [f"# via {x:.3f} {y:.3f}" for x, y in via]
        lines += [" ".join(f"{v:.3f}" for v in wall) for wall in self.walls]
        path.write_text("\n".join(lines) + "\n")


def seen_from(base, pose):
    """A pose (x, y, theta) in the frame of another."""
    x, y = pose[0] - base[0], pose[1] - base[1]
    c, s = math.cos(base[2]), math.sin(base[2])
    return c * x + s * y, c * y - s * x, pose[2] - base[2]


def compose(base, pose):
    c, s = math.cos(base[2]), math.sin(base[2])
    return base[0] + c * pose[0] - s * pose[1], base[1] + s * pose[0] + c * pose[1], base[2] + pose[2]


def read_trajectory(path):
    """(time, pose) of each line of a TUM file."""
    rows = (list(map(float, line.split())) for line in path.read_text().splitlines() if not line.startswith("#"))
    return [(t, (x, y, 2 * math.atan2(qz, qw))) for t, x, y, _, _, _, qz, qw in rows]


class SavedMap:
    """The map of a drive, and where in it the true places of that drive are."""
    def __init__(self, build, world_file, folder):
        log, truth, track, self.path = (folder / name for name in ("mapping.log", "mapping.truth", "mapping.tum", "saved.map"))
        run(build / "bin/ale-sim", "--world", world_file, "--write-log", log, "--truth", truth)
        run(build / "bin/ale-replay", log, "--save-map", self.path, "--trajectory", track)
        self.places = [(true, found) for (_, true), (_, found) in zip(read_trajectory(truth), read_trajectory(track))]

    def places_of(self, pose):
        """A true pose as it lies in the map: one for each scan of the drive that was taken near it."""
        near = [place for place in self.places[::PLACE_STEP] if math.dist(place[0][:2], pose[:2]) < PLACE_NEAR_M]
        near = near or [min(self.places, key=lambda place: math.dist(place[0][:2], pose[:2]))]
        return [compose(found, seen_from(true, pose)) for true, found in near]

    def worst_error_m(self):
        """How far the map itself is off, seen from where it begins."""
        start, origin = self.places[0]
        return max(math.dist(compose(origin, seen_from(start, true))[:2], found[:2]) for true, found in self.places)


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{command[0]}: {done.stderr.strip()}")


def is_near(pose, truth):
    turn = abs((pose["map_theta"] - truth[2] + math.pi) % (2 * math.pi) - math.pi)
    return math.hypot(pose["map_x"] - truth[0], pose["map_y"] - truth[1]) < NEAR_M and turn < NEAR_RAD


def relocate(build, world, saved, start, via, seed, seconds, folder):
    """Seconds until the pose was right for the first time (None: never), right at the end, scans wrong while good."""
    plan, log, truth, poses = (folder / name for name in ("lost.world", "lost.log", "lost.truth", "lost.jsonl"))
    world.write(plan, start, via)
    run(build / "bin/ale-sim", "--world", plan, "--write-log", log, "--truth", truth, "--seed", seed)
    run(build / "bin/ale-replay", log, "--load-map", saved.path, "--poses", poses)
    first, right, wrong, begin = None, False, 0, None
    for (t, true), found in zip(read_trajectory(truth), poses.read_text().splitlines()):
        begin = t if begin is None else begin
        if t - begin > seconds:
            break
        pose = json.loads(found)
        near = any(is_near(pose, place) for place in saved.places_of(true))
        right = near and pose["state"] > 0
        first = t - begin if right and first is None else first
        wrong += pose["state"] == GOOD and not near
    return first, right, wrong


def try_world(build, world_file, poses, seconds, seed):
    """(times until found, number right at the end, number ever wrong while good, how far the map is off)"""
    world, chance = World(world_file), random.Random(seed)
    times, right, wrong = [], 0, 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        saved = SavedMap(build, world_file, folder)
        for k in range(poses):
            start, via = world.place(chance)
            first, last_right, scans_wrong = relocate(build, world, saved, start, via, 100 + k, seconds, folder)
            times += [first] if first is not None else []
            right += last_right
            wrong += scans_wrong > 0
    return sorted(times), right, wrong, saved.worst_error_m()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--poses", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("worlds", nargs="*", default=sorted(map(str, pathlib.Path("tools/lab/worlds").glob("*.world"))))
    options = parser.parse_args()
    if options.poses < 1 or options.seconds <= 0:
        parser.error("--poses and --seconds want more than 0")
    if not (options.build / "bin/ale-replay").exists():
        sys.exit(f"relocalise.py: no programs in {options.build}/bin (make builds them)")
    fine = True
    for world_file in options.worlds:
        times, right, wrong, off_m = try_world(options.build, world_file, options.poses, options.seconds, options.seed)
        spread = f"found after {times[len(times) // 2]:.1f} s in the median, {times[-1]:.1f} s at the latest" if times else "never"
        print(f"{pathlib.Path(world_file).stem:10} {right} of {options.poses} right, {wrong} wrong while good; {spread}; "
              f"the map is up to {off_m * 100:.1f} cm off")
        fine = fine and wrong == 0 and right * 100 >= options.poses * 99
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
