#!/usr/bin/env python3
"""Who includes whom: units (x.c with x.h), the floors and rooms that they lie in, what points upward, what goes in a circle.

    includes.py [ROOT]     prints the counts and what is wrong; exit 1 when anything is
"""
import pathlib
import re
import sys

SOURCES = (".c", ".h", ".cpp", ".hpp")
TOP = ("lib", "drivers", "firmware", "tools")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
MOST_UNITS = 20

# Of each folder, what may be included by what stands after it. A folder that is not listed is named as such.
ORDER = {
    "": ("lib", "drivers", "firmware", "tools"),
    "lib": ("base", "extract", "motion", "observe", "map", "match", "relocate", "track", "graph", "plan", "messages"),
    "lib/graph": ("optimise", "walls", "fields", "loops"),
    "lib/track": ("evidence",),
    "drivers": ("file", "serial", "scanner", "command", "motor", "store", "lcm", "log"),
    "drivers/scanner": ("urg", "rotary", "ldrobot", "rplidar"),
    "firmware": ("realtime", "config", "exchange", "system", "recorder", "acquire", "estimate", "mapping", "operator", "telemetry",
                 "deploy"),
}
# Files of a folder itself stand above its rooms, but these, which the rooms share.
BELOW_THE_ROOMS = {"drivers/scanner"}


class Tree:
    """Units and their includes, as paths below a root without their endings."""

    def __init__(self, root):
        root = pathlib.Path(root)
        self.files = {path.relative_to(root).as_posix() for top in TOP for path in sorted((root / top).rglob("*"))
                      if path.suffix in SOURCES}
        self.units = {unit(file) for file in self.files}
        self.includes = {name: set() for name in self.units}
        for file in self.files:
            for named in INCLUDE.findall((root / file).read_text(encoding="utf-8")):
                found = self._resolve(file, named)
                if found and unit(found) != unit(file):
                    self.includes[unit(file)].add(unit(found))

    def _resolve(self, file, named):
        beside = (pathlib.PurePosixPath(file).parent / named).as_posix()
        return next((path for path in (beside, *(f"{top}/{named}" for top in TOP)) if path in self.files), None)

    def upward(self):
        """(unit, what it includes) where the latter stands above."""
        return sorted((a, b) for a, named in self.includes.items() for b in named if is_above(b, a))

    def circles(self):
        """Units that include each other, directly or by others: each circle once."""
        return sorted(sorted(circle) for circle in strongly_connected(self.includes) if len(circle) > 1)

    def unplaced(self):
        """Folders of a listed one whose place in its order nobody has said."""
        folders = {unit_.rpartition("/")[0] for unit_ in self.units}
        parents = {folder.rpartition("/") for folder in folders}
        return sorted(f"{parent}/{name}" for parent, _, name in parents if parent in ORDER and name not in ORDER[parent])

    def crowded(self):
        """(folder, its units) of folders with too many."""
        count = {}
        for name in self.units:
            folder = name.rpartition("/")[0]
            count[folder] = count.get(folder, 0) + 1
        return sorted((folder, units) for folder, units in count.items() if units > MOST_UNITS)


def unit(file):
    return file.rpartition(".")[0]


def is_above(a, b):
    """Whether unit a stands above unit b: in the first folder in which their ways part."""
    ways = [name.split("/") for name in (a, b)]
    depth = next(i for i, (x, y) in enumerate(zip(*ways)) if x != y)
    parent = "/".join(ways[0][:depth])
    order = ORDER.get(parent, ())
    rank = [order.index(way[depth]) if way[depth] in order and len(way) > depth + 1 else
            (-1 if parent in BELOW_THE_ROOMS else len(order)) for way in ways]
    return rank[0] > rank[1]


def strongly_connected(graph):
    """Tarjan's components of a graph that is given as successors of each node."""
    number, low, stack, components = {}, {}, [], []

    def visit(node):
        number[node] = low[node] = len(number)
        stack.append(node)
        for successor in sorted(graph[node]):
            if successor not in number:
                visit(successor)
                low[node] = min(low[node], low[successor])
            elif successor in stack:
                low[node] = min(low[node], number[successor])
        if low[node] == number[node]:
            at = stack.index(node)
            components.append(stack[at:])
            del stack[at:]

    for node in sorted(graph):
        if node not in number:
            visit(node)
    return components


def main():
    tree = Tree(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2])
    upward, circles, unplaced, crowded = tree.upward(), tree.circles(), tree.unplaced(), tree.crowded()
    for a, b in upward:
        print(f"upward: {a} includes {b}")
    for circle in circles:
        print("circle: " + ", ".join(circle))
    for folder in unplaced:
        print(f"no place in the order: {folder}")
    for folder, units in crowded:
        print(f"more than {MOST_UNITS} units: {folder} ({units})")
    print(f"{len(tree.units)} units, {len(upward)} upward includes, {len(circles)} circles")
    return 1 if upward or circles or unplaced or crowded else 0


if __name__ == "__main__":
    sys.exit(main())
