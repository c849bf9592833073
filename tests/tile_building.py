"""A building as large as one likes: rooms side by side, no two alike; as a world for the simulator, and as a map, whole or by
tiles, written here from what the headers say of the formats (map_text.h, tile_file.h)."""
import math
import random
import zlib

WIDTH, DEPTH, DOOR = 8.0, 6.0, 1.0  # of a room; metres
SIDE_UM = 10_000_000
LEGENDS = ("# wall: id start_x start_y end_x end_y var_alpha_nrad2 cov_um_nrad var_rho_um2 seen\n"
           "# corner: x y var_xx var_xy var_yy angle_bam bisector_bam seen kind\n")


class Building:
    """columns x rows rooms from (0, 0) on. A room knows its walls by its own seed: of a large building a part is made alone."""

    def __init__(self, columns, rows):
        self.columns, self.rows = columns, rows

    def door_y(self, column, row):
        """Middle of the door to the room on the left."""
        return row * DEPTH + random.Random(f"left {column} {row}").uniform(2.6, 3.4)

    def panels_of(self, column, row):
        """Thin walls, by their ends: those to the left and below, and what stands in the room."""
        draw = random.Random(f"room {column} {row}")
        x, y = column * WIDTH, row * DEPTH
        door = self.door_y(column, row)
        gap = x + draw.uniform(1.5, WIDTH - 1.5)
        if column > 0:
            yield x, y, x, door - DOOR / 2
            yield x, door + DOOR / 2, x, y + DEPTH
        else:
            yield x, y, x, y + DEPTH
        if row > 0:
            yield x, y, gap - DOOR / 2, y
            yield gap + DOOR / 2, y, x + WIDTH, y
        else:
            yield x, y, x + WIDTH, y
        for floor, away in ((y, 1), (y + DEPTH, -1)):
            at = x + draw.uniform(0.8, WIDTH - 0.8)
            yield at, floor + 0.05 * away, at + draw.uniform(-0.4, 0.4), floor + away * draw.uniform(0.7, 1.6)

    def panels(self, columns=None, rows=None):
        for row in rows if rows is not None else range(self.rows):
            for column in columns if columns is not None else range(self.columns):
                yield from self.panels_of(column, row)
        if columns is None:
            yield self.columns * WIDTH, 0, self.columns * WIDTH, self.rows * DEPTH
            yield 0, self.rows * DEPTH, self.columns * WIDTH, self.rows * DEPTH

    def way(self, row, first, last):
        """Through the doors of a row of rooms: start, and places on the way."""
        places = []
        for column in range(first + 1, last + 1):
            y = self.door_y(column, row)
            places += [(column * WIDTH - 1, y), (column * WIDTH + 1, y)]
        places.append((last * WIDTH + WIDTH / 2, row * DEPTH + DEPTH / 2))
        return (first * WIDTH + WIDTH / 2, row * DEPTH + DEPTH / 2, 0.0), places


def write_world(path, building, row, first, last):
    """What a robot can see on its way, and the way."""
    start, places = building.way(row, first, last)
    around = building.panels(range(max(first - 2, 0), min(last + 3, building.columns)),
                             range(max(row - 2, 0), min(row + 3, building.rows)))
    lines = [f"# start {start[0]:.6f} {start[1]:.6f} {start[2]}"] + [f"# via {x:.6f} {y:.6f}" for x, y in places]
    path.write_text("\n".join(lines + [" ".join(f"{v:.6f}" for v in panel) for panel in around]) + "\n", encoding="utf-8")
    return start


def sides_of(panels):
    """Both sides of every panel, in um: each is seen from the left of its way from start to end."""
    for x1, y1, x2, y2 in panels:
        a, b = (round(x1 * 1e6), round(y1 * 1e6)), (round(x2 * 1e6), round(y2 * 1e6))
        yield a + b
        yield b + a


def wall_line(number, side):
    return f"wall {number} {side[0]} {side[1]} {side[2]} {side[3]} 4000000000000 0 9000000 20\n"


def map_text(walls, pose=None):
    """A map file of numbered walls."""
    text = "ALE-SLAM map 1\n" + LEGENDS + "".join(wall_line(number, side) for number, side in walls)
    if pose:
        bam = round(pose[2] * 2**31 / math.pi) % 2**32
        text += f"# pose: x y theta_bam\npose {round(pose[0] * 1e6)} {round(pose[1] * 1e6)} {bam}\n"
    return text + f"end {len(walls)} {zlib.crc32(text.encode()):08x}\n"


def tiles_of(side):
    """Panels are short: all tiles in the rectangle around one, but those on whose one side all of it lies."""
    x1, y1, x2, y2 = side
    for y in range(min(y1, y2) // SIDE_UM, max(y1, y2) // SIDE_UM + 1):
        for x in range(min(x1, x2) // SIDE_UM, max(x1, x2) // SIDE_UM + 1):
            corners = [((x2 - x1) * ((y + j) * SIDE_UM - y1) - (y2 - y1) * ((x + i) * SIDE_UM - x1))
                       for i in (0, 1) for j in (0, 1)]
            if min(corners) <= 0 <= max(corners):
                yield y, x


def write_tiles(path, panels):
    """How many walls there are."""
    tiles, count = {}, 0
    for count, side in enumerate(sides_of(panels), 1):
        for tile in tiles_of(side):
            tiles.setdefault(tile, []).append((count, side))
    index, bodies, written = f"ALE-SLAM tiles 1\nmap {SIDE_UM} {count} 0\n", [], 0
    for (y, x), walls in sorted(tiles.items()):
        bodies.append(map_text(walls))
        index += f"tile {x} {y} {len(walls)} 0 {written} {len(bodies[-1])}\n"
        written += len(bodies[-1])
    path.write_text(index + f"end {len(tiles)} {zlib.crc32(index.encode()):08x}\n" + "".join(bodies), encoding="utf-8")
    return count
