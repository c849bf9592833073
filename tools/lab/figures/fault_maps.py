#!/usr/bin/python3
"""A page of maps of one drive as recorded and with each kind of fault of spoil.py.

    fault_maps.py --build build --out build/fault-maps [--world home] [--longer office] [--kinds KIND,..]

Writes a picture a family of kinds and README.md. Each picture begins with the drive as recorded; grey are the true walls, black those of
the map, violet those of maps that were begun anew and not joined with it; blue is the final way. A kind that wants a longer drive gets it
through the world --longer. Figures are those of faults_table.py.

Stands twice: how many metres of wall run beside themselves (map_score.py). Astray: metres of the map's lines that are more than 0.15 m
from every true wall, seen from the first scan. A map is in pieces where another was not joined with it. The map itself is called single when
neither figure is more than 0.2 m beyond the drive as recorded, and torn when more than a tenth of it is astray.
"""
import argparse
import dataclasses
import pathlib
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools/lab/bench"), str(ROOT / "tools/lab/bench/faults")]
import mapping  # noqa: E402
import spoil  # noqa: E402
from drives import Course  # noqa: E402
from faults_table import limit_m, run_clean, told_with  # noqa: E402
from judge import judged, replayed  # noqa: E402
from map_score import directions, in_plan, read_numbers, read_pieces, standing_twice  # noqa: E402
from slam_table import WORLDS, read_tum  # noqa: E402

CLEAN = "as recorded"
SHEETS = {"wheels": ("Wheels that are wrong for a time, or by a share", spoil.PASSING),
          "lying": ("Wheels that lie for the whole drive", spoil.LYING),
          "scans": ("Scans that are covered or away; carried", spoil.SCANS + ("carried",)),
          "outages": ("The scanner away for 4 to 12 s", spoil.OUTAGES),
          "otherwise": ("The drive told otherwise", spoil.TOLD_OTHERWISE)}
SEED = 1
ASTRAY_M = 0.15
WORSE_M = 0.2
TORN_SHARE = 0.1
NO_CORNERS = np.empty((0, 2))
APART = "#9467bd"
MIRRORED = (1, -1, 1, -1)
COLUMNS, TILE_INCHES, COLOURS = 3, 4.4, 64


@dataclasses.dataclass
class Drawn:
    """A drive, its map as it lies in the plan of its world, and its figures."""
    world: str
    kind: str
    walls: np.ndarray
    apart: np.ndarray  # which of them are in maps that are not joined with the first
    way: np.ndarray
    plan: np.ndarray
    figures: dict
    limit_m: float

    def first_map(self):
        return dataclasses.replace(self, walls=self.walls[~self.apart], apart=self.apart[~self.apart])

    def length_m(self):
        return float(directions(self.walls)[1].sum())

    def twice_m(self):
        return float(standing_twice(self.walls)[1])

    def astray_m(self):
        """Metres of lines that are at no true wall."""
        if not len(self.walls):
            return 0.0
        far = mapping.distance_to_walls(mapping.every_five_centimetres(self.walls), self.plan) > ASTRAY_M
        return float(far.mean()) * self.length_m()


def drawn(build, drive, kind, folder):
    """A drive with this fault, or none; nothing where the kind does not fit."""
    file = folder / "drive.dxf"
    if kind == CLEAN:
        _, places, headings = read_tum(drive.truth)
        done = replayed(build, drive.log, places, headings, "on", "--map", file), 0
    else:
        done = told_with(build, drive, kind, SEED, "on", folder, "--map", file)
    if not done:
        return None
    told = done[0]
    first, heading = told.true_places[0], told.true_headings[0]
    way = first + told.final * np.exp(1j * heading)
    walls, apart = read_pieces(file)
    plan = read_numbers(ROOT / f"tools/lab/worlds/{drive.name}.world", 4)
    return Drawn(drive.name, kind, in_plan(walls, (first.real, first.imag, heading)), apart, np.c_[way.real, way.imag],
                 plan * MIRRORED if kind == "mirror" else plan, {**judged(*done), "live": told.ate_m(live=True)}, limit_m(drive, kind))


def all_drawn(build, worlds, kinds):
    """Of each kind the drive with it, by the first world that it fits; of each world the drive as recorded before the first of them."""
    with tempfile.TemporaryDirectory() as folder:
        folder, left = pathlib.Path(folder), kinds
        for world in dict.fromkeys(worlds):
            drive = next(Course(build, folder, (SEED,), left).of_world(world)) if left else None
            if drive:
                limits_m, _ = run_clean((build, drive, "on"))
                drive = dataclasses.replace(drive, limits_m=limits_m)
                done = [found for kind in (CLEAN,) + left if (found := drawn(build, drive, kind, folder))]
                left = tuple(kind for kind in left if kind not in [found.kind for found in done])
                yield from done if len(done) > 1 else ()


def verdict(one, clean):
    """In words, whether the map is in one piece, and the first map as single as that of the drive as recorded."""
    own = one.first_map()
    twice, astray = own.twice_m() > clean.twice_m() + WORSE_M, own.astray_m() > clean.astray_m() + WORSE_M
    torn = own.astray_m() > TORN_SHARE * own.length_m()
    words = ["in pieces" if one.apart.any() else "", "torn" if torn else "lines astray" if astray else "", "a wall twice" if twice else ""]
    return ", ".join(filter(None, words)) or "single"


def errors_mm(one):
    return f"{1e3 * one.figures['ate']:.0f} / {1e3 * one.figures['live']:.0f}"


def caption(one):
    figures = one.figures
    words = [f"{one.kind}: {errors_mm(one)} mm", "" if figures["ate"] <= one.limit_m else "not within",
             f"{figures['silent']} silent wrong" if figures["silent"] else "", f"{figures['lost']} lost" if figures["lost"] else ""]
    return ", ".join(filter(None, words))


def draw_sheet(path, tiles):
    """Small: few colours."""
    high, wide = np.ptp(tiles[0].plan.reshape(-1, 2), axis=0)[::-1]
    rows = -(-len(tiles) // COLUMNS)
    figure, grid = plt.subplots(rows, COLUMNS, figsize=(COLUMNS * TILE_INCHES, rows * (TILE_INCHES * high / wide + 0.3)), squeeze=False)
    for axes in grid.flat:
        axes.set_axis_off()
    for axes, one in zip(grid.flat, tiles):
        mapping.draw(axes, one.plan, mapping.TRUTH, 3)
        mapping.draw_map(axes, "", (one.walls[~one.apart], NO_CORNERS, one.way))
        mapping.draw(axes, one.walls[one.apart], APART, 1.6)
        axes.set_title(caption(one), fontsize=9)
    figure.tight_layout(pad=0.4)
    figure.savefig(path, dpi=80)
    plt.close(figure)
    with Image.open(path) as picture:
        small = picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    small.save(path, optimize=True)


def row_of(one, clean):
    figures = one.figures
    within = "-" if one.kind == CLEAN else "yes" if figures["ate"] <= one.limit_m else "**no**"
    cells = [one.kind, errors_mm(one), within, str(figures["silent"]), str(figures["lost"]),
             str(figures["other_map"]), f"{one.twice_m():.1f}", f"{one.astray_m():.1f}", verdict(one, clean)]
    return "| " + " | ".join(cells) + " |"


def section(name, title, tiles):
    return ["", f"## {title}", "", f"![{title}]({name}.png)", "",
            "| kind | ATE final / live, mm | within | silent wrong | lost | in another map | twice, m | astray, m | map |",
            "| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | --- |", *(row_of(one, tiles[0]) for one in tiles)]


def page(out, worlds, found):
    """Pictures and text."""
    lines = ["# Maps of a drive with each kind of fault", "",
             f"Made by `make fault-maps`: the drive of seed {SEED} through `{worlds[0]}`, as recorded and with each kind of `spoil.py`. Grey: true",
             "walls. Black: those of the map at the end. Violet: those of maps begun anew and never joined with it; where they lie the wheels alone",
             "say. Blue: the final way. What the robot did not see is not there. Captions: errors of the final and the live trajectory, and what",
             "`faults_table.py` counts: not within its limit, scans silently wrong, scans lost. In another map: scans whose live pose stood in",
             "another map than the first; the live error takes it for one of the first.",
             "",
             f"Twice: metres of wall beside themselves (`map_score.py`). Astray: metres of lines more than {ASTRAY_M} m from every true wall, seen",
             "from the first scan. Both are of all that is drawn. The words: in pieces where something is violet; of the black map, single when",
             f"neither is more than {WORSE_M} m beyond the drive as recorded, torn when more than a tenth of it is astray."]
    for world in dict.fromkeys(one.world for one in found):
        of_world = [one for one in found if one.world == world]
        for name, (title, kinds) in SHEETS.items():
            tiles = [one for one in of_world if one.kind in kinds]
            if tiles:
                name, title = (name, title) if world == worlds[0] else (f"{name}-{world}", f"{title}: what wants a longer drive, through {world}")
                tiles = [of_world[0], *tiles]
                draw_sheet(out / f"{name}.png", tiles)
                lines += section(name, title, tiles)
    (out / "README.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--world", choices=WORLDS, default="home")
    parser.add_argument("--longer", choices=WORLDS, default="office", help="for kinds that do not fit that drive")
    parser.add_argument("--kinds", default=",".join(spoil.KINDS), metavar="KIND,..")
    options = parser.parse_args()
    kinds = tuple(options.kinds.split(","))
    unknown = [kind for kind in kinds if kind not in spoil.KINDS]
    if unknown:
        parser.error(f"--kinds {unknown[0]}: not one of {' '.join(spoil.KINDS)}")
    if not (options.build / "bin/ale-replay").exists():
        sys.exit(f"fault_maps.py: no programs in {options.build}/bin (make builds them)")
    options.out.mkdir(parents=True, exist_ok=True)
    worlds = (options.world, options.longer)
    found = []
    for one in all_drawn(options.build, worlds, kinds):
        print(f"{one.world:10} {caption(one)}; twice {one.twice_m():.1f} m, astray {one.astray_m():.1f} m", flush=True)
        found.append(one)
    page(options.out, worlds, found)


if __name__ == "__main__":
    main()
