"""The drives of the faults' table: simulated through the worlds of the tree, and, where the shared data are, recorded ones.

    for drive in Course("build", "folder", seeds=(1, 2), kinds=KINDS).drives(shared, chosen, carried=0): ...
"""
import dataclasses
import pathlib
import random
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import alike  # noqa: E402
import relocalise  # noqa: E402
import spoil  # noqa: E402
from carmen import CarmenLog  # noqa: E402
from slam_table import PEERS_MM, ROOT, WORLDS, Bench, read_tum  # noqa: E402

RECORDINGS = {"intel_every5th": "intel/intel_every5th.clf.gz", "freiburg-101": "corrected/freiburg-101.clf.gz"}
CARRIED_THERE = ("alike", "elsewhere", "unknown")
KINDS = spoil.KINDS + CARRIED_THERE
PAUSE_S = (10, 40)  # in which the robot is carried elsewhere
UNKNOWN_M = 2.0  # so far from every place of before
UNKNOWN_TRIES = 500


@dataclasses.dataclass
class Drive:
    """A drive without a fault, where its truth is, and what faults it gets."""
    name: str
    group: str
    log: pathlib.Path
    truth: pathlib.Path
    kinds: tuple
    seeds: tuple
    recorded: bool = False  # its truth is made of itself
    cut: tuple = ()  # alike: scans between which the robot is carried
    onward: pathlib.Path = None  # elsewhere, unknown: the world in which it drives on, and when
    pause_s: float = 0
    limits_m: tuple = ()  # with odometry, without

    def spoilt(self, build, kind, seed, folder):
        """Its log with a fault, the first scan after that, and the truth beside it; nothing where the kind does not fit."""
        log = CarmenLog(self.log)
        _, places, headings = read_tum(self.truth)
        if self.onward:
            first = len(log.scans)
            onward, truth = Bench(build, folder).drive(self.onward, str(100 + seed))
            log.then(CarmenLog(onward), self.pause_s)
            _, more_places, more_headings = read_tum(truth)
            places, headings = np.r_[places, more_places], np.r_[headings, more_headings]
            left = spoil.carry(log, first, first)
        elif self.cut:
            left = spoil.carry(log, *self.cut)
        elif spoil.fits(log, kind):
            left = spoil.spoil(log, kind, seed)
        else:
            return None
        return log, left.after, *left.told(places, headings)


def unseen_place(plan, chance, seen):
    """A place near the way that is far from every place seen; the way from there."""
    for _ in range(UNKNOWN_TRIES):
        start, via = plan.place(chance)
        if np.abs(seen - complex(*start[:2])).min() > UNKNOWN_M:
            return start, via
    raise SystemExit("faults: half of the way sees the whole world")


class Course:
    """Makes the drives of a table in a folder."""

    def __init__(self, build, folder, seeds, kinds):
        self.build, self.folder, self.seeds, self.kinds = build, pathlib.Path(folder), seeds, kinds

    def simulated(self, world, name, seed):
        """Log and truth of a drive through a world."""
        made = self.folder / name
        made.mkdir()
        return Bench(self.build, made).drive(world, str(seed))

    def of_world(self, world):
        """A drive of each seed, with the faults of that seed."""
        usual = tuple(kind for kind in self.kinds if kind not in CARRIED_THERE)
        for seed in self.seeds if usual else ():
            log, truth = self.simulated(world, f"{world}-{seed}", seed)
            yield Drive(world, "Worlds of the tree", log, truth, usual, (seed,))

    def alike(self):
        """Carried into the one room, or into the other."""
        for seed in self.seeds if "alike" in self.kinds else ():
            plan = self.folder / f"alike-{seed}.world"
            alike.write_world(plan, seed % 2)
            log, truth = self.simulated(plan, f"alike-{seed}", seed)
            yield Drive("alike", "Worlds of the tree", log, truth, ("alike",), (seed,), cut=alike.cut(read_tum(truth)[1], seed % 2))

    def carried(self, world, kind, count):
        """After the whole drive, or half of it, the robot is carried to a random place near the way, and drives on from there."""
        if not count or kind not in self.kinds:
            return
        plan = relocalise.World(ROOT / f"tools/lab/worlds/{world}.world")
        chance = random.Random(f"{kind} {world}")
        before = self.folder / f"{world}-before-{kind}.world"
        plan.write(before, plan.start, plan.via if kind == "elsewhere" else plan.via[:len(plan.via) // 2])
        log, truth = self.simulated(before, before.stem, self.seeds[0])
        seen = read_tum(truth)[1]
        for number in range(1, count + 1):
            onward = self.folder / f"{world}-{kind}-{number}.world"
            plan.write(onward, *(plan.place(chance) if kind == "elsewhere" else unseen_place(plan, chance, seen)))
            yield Drive(world, "Worlds of the tree", log, truth, (kind,), (number,), onward=onward, pause_s=chance.uniform(*PAUSE_S))

    def recorded(self, shared, chosen):
        """Development runs, whose truth is known, and recordings."""
        usual = tuple(kind for kind in self.kinds if kind not in CARRIED_THERE)
        runs = pathlib.Path(shared) / "bench/slam"
        for name in filter(chosen, PEERS_MM):
            if usual and (runs / name).is_dir():
                yield Drive(name, "Development runs", runs / name / "scans.log.gz", runs / name / "truth.tum", usual, self.seeds)
        for name, file in RECORDINGS.items():
            path = pathlib.Path(shared) / "data" / file
            if usual and chosen(name) and path.exists():
                (self.folder / name).mkdir()
                yield Drive(name, "Recordings, against their own drive without a fault", path, self.folder / name / "clean.tum", usual, self.seeds,
                            recorded=True)

    def drives(self, shared, chosen, carried):
        for world in filter(chosen, WORLDS):
            yield from self.of_world(world)
            for kind in ("elsewhere", "unknown"):
                yield from self.carried(world, kind, carried)
        if chosen("alike"):
            yield from self.alike()
        if shared:
            yield from self.recorded(shared, chosen)
