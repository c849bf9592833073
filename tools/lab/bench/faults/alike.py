"""A small world with two rooms furnished alike on one corridor: a robot that is carried from the corridor's end into one of them cannot
know which it is before it has left it.

    write_world("alike.world", room); first, last = cut(true_places, room)

The drive has seen both rooms; the cut takes away how it went from the corridor's east end into the middle of the room.
"""
import pathlib

ROOMS_AT = (1.0, 6.0)  # their west walls
DOOR = (1.5, 2.5)  # from and to, seen from there
CORRIDOR = (12.0, 1.5)
WALL_M = 0.1
ROOM = (4.0, 3.5)
EAST_END = (11.0, 0.75)
ROOM_MIDDLE = (2.0, 4.0)  # from the room's west wall, and up


def box(x1, y1, x2, y2):
    return [(x1, y1, x2, y1), (x2, y1, x2, y2), (x2, y2, x1, y2), (x1, y2, x1, y1)]


def room_walls(west):
    """A room north of the corridor, and the wall beside its door."""
    south, north = CORRIDOR[1] + WALL_M, CORRIDOR[1] + WALL_M + ROOM[1]
    east = west + ROOM[0]
    return [(west, south, west, north), (west, north, east, north), (east, north, east, south),
            *box(west, CORRIDOR[1], west + DOOR[0], south), *box(west + DOOR[1], CORRIDOR[1], east, south),
            *box(west, north - 0.6, west + 0.9, north), *box(east - 0.5, south + 0.8, east, south + 2.0)]


def corridor_walls():
    """Its ends differ, and a cabinet stands between the doors."""
    length, width = CORRIDOR
    north = [(0.0, ROOMS_AT[0]), (ROOMS_AT[0] + ROOM[0], ROOMS_AT[1]), (ROOMS_AT[1] + ROOM[0], length)]
    return [(0.0, 0.0, 0.0, width), (0.0, 0.0, length, 0.0), (length, 0.0, length, 0.9), (length, 0.9, length - 0.6, width),
            *((a, width, b, width) for a, b in north), *box(4.9, 0.0, 5.8, 0.35), *box(0.0, 0.0, 0.4, 0.3)]


def into(room):
    """From the corridor through the door to the middle of a room."""
    x = ROOMS_AT[room] + ROOM_MIDDLE[0]
    return [(x, 0.85), (x, 2.2), (x, ROOM_MIDDLE[1])]


def way(room):
    both = [point for number in (0, 1) for point in into(number) + into(number)[-2::-1]]
    return both + [EAST_END] + into(room) + into(room)[-2::-1] + [(3.0, 0.85), (0.8, 0.75)]


def write_world(path, room):
    walls = [wall for west in ROOMS_AT for wall in room_walls(west)] + corridor_walls()
    lines = ["# start 0.8 0.75 0"] + [f"# via {x} {y}" for x, y in way(room)] + [" ".join(f"{v:.3f}" for v in wall) for wall in walls]
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="ascii")


def cut(places, room):
    """The scans between the corridor's end and the middle of the room, of the true places (complex)."""
    at_the_end = abs(places - complex(*EAST_END)) < 0.5
    first = int(at_the_end.nonzero()[0][-1])
    in_the_room = abs(places - complex(ROOMS_AT[room] + ROOM_MIDDLE[0], ROOM_MIDDLE[1])) < 0.8
    return first, first + int(in_the_room[first:].nonzero()[0][0])
