"""A building that no map in work can hold, by tiles: the robot localises in it while it drives, in the memory of one room."""
import math
import re

import pytest

from at_hand import LONG
from chain import Truth, wrap
from commanded import Commanded
from tile_building import Building, map_text, sides_of, write_tiles, write_world
from waiting import wait_until

SPEEDS = (10, 5, 2)  # slower where the machine is too busy to send or to hear all of it
GOOD = 2
CAPACITY = 2048  # ALE_MAP_MAX_LINES
MORE_KIB = 4096  # that a robot may take for its tiles (a thread, what it reads, the index), whatever the size of the building
ROOMS = 5  # that the way leads on


def resident_kib(program):
    with open(f"/proc/{program.process.pid}/status", encoding="utf-8") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:"))


def drive(chain, building, row, first, map_path):
    """Through ROOMS rooms, on from the first one and a pose in it that were kept; resident memory at the end, and what was said."""
    start = write_world(chain.folder / "way.world", building, row, first, first + ROOMS)
    for speed in SPEEDS:
        (chain.folder / "kept.map").write_text(map_text(one_room(building, row, first), start), encoding="utf-8")
        config = f"[map]\nfile = {map_path}\nkeep = {chain.folder / 'kept.map'}\n"
        chain.listener.forget()
        firmware = chain.firmware(config, speed=speed)
        simulator = chain.simulator("--world", chain.folder / "way.world", "--truth", chain.truth_path, "--once", speed=speed)
        assert simulator.wait(300) == 0
        wait_until(lambda: chain.listener.statuses and chain.listener.statuses[-1].driver_state.startswith("no scanner"), 180,
                   "the end of the drive")
        memory = resident_kib(firmware)
        assert firmware.end() == 0
        said = firmware.err()
        if chain.scans_came_in_time() and "late" not in said and chain.listener.counters()["overloaded"] == 0:
            break
    return memory, said


def one_room(building, row, column):
    return list(enumerate(sides_of(building.panels(range(column - 1, column + 2), range(row - 1, row + 2))), 1))


def errors_in_the_building(poses, truth):
    """(metres, radians) of every pose of a good state, in the building's own frame."""
    for pose in poses:
        true = truth.world_at(pose.utime * 1e-6)
        if true and pose.state == GOOD:
            yield math.hypot(pose.map_x - true[0], pose.map_y - true[1]), abs(wrap(pose.map_theta - true[2]))


def localises_in(chain, columns, rows):
    """In the middle of a building of so many rooms; what it printed."""
    building = Building(columns, rows)
    tiles = chain.folder / "building.tiles"
    walls = write_tiles(tiles, building.panels())
    assert walls > 4 * CAPACITY
    row, first = rows // 2, columns // 2
    memory, said = drive(chain, building, row, first, tiles)
    assert f"{walls} walls" in said and "could not be read" not in said
    poses = chain.listener.poses
    errors = list(errors_in_the_building(poses, Truth(chain.truth_path)))
    assert len(errors) > 0.9 * len(poses), "lost until it has found itself, and good from then on"
    metres = [error[0] for error in errors]
    mean = math.sqrt(sum(m * m for m in metres) / len(metres))
    assert mean < 0.01 and max(metres) < 0.05
    assert max(error[1] for error in errors) < 0.02
    drawn = max(part.parts for part in chain.listener.map_parts)
    assert drawn > 1, "walls of tiles are shown"
    of_one_room, _ = drive(chain, building, row, first, "")
    print(f"{walls} walls, {len(poses)} poses, error {1000 * mean:.1f} mm (most {1000 * max(metres):.1f}), resident "
          f"{memory / 1024:.1f} MiB, with the map of one room {of_one_room / 1024:.1f} MiB")
    assert memory < of_one_room + MORE_KIB


def test_a_building_larger_than_any_map_in_work_takes_the_memory_of_a_room(chain):
    localises_in(chain, 30, 40)


@LONG
def test_a_square_kilometre_takes_the_memory_of_a_room(chain):
    localises_in(chain, 125, 167)


def test_told_where_it_is_the_robot_finds_itself_there_though_nothing_of_that_was_loaded(chain):
    building = Building(30, 40)
    write_tiles(chain.folder / "building.tiles", building.panels())
    x, y, _ = write_world(chain.folder / "far.world", building, 30, 20, 21)
    chain.simulator("--world", chain.folder / "far.world", "--drive")
    robot = Commanded(chain, f"[map]\nfile = {chain.folder / 'building.tiles'}\n", simulator=False)
    poses = chain.listener.poses
    wait_until(lambda: len(poses) > 60, 180, "poses")
    assert all(pose.state != GOOD for pose in poses), "the tiles around the origin hold no such place"
    obeyed, said = robot.send("relocate", x + 0.1, y - 0.1, 0.03)
    assert obeyed, said
    wait_until(lambda: poses[-1].state == GOOD, 180, "the robot to find itself")
    assert math.hypot(poses[-1].map_x - x, poses[-1].map_y - y) < 0.05
    assert re.search(r"where the robot is must be said", robot.firmware.err())


def test_a_damaged_tile_is_said_and_the_robot_starts(chain):
    building = Building(30, 40)
    path = chain.folder / "building.tiles"
    write_tiles(path, building.panels())
    data = bytearray(path.read_bytes())
    data[data.index(b"\nend ", data.index(b"tile 0 0 ")) + 200] ^= 1  # in the first tile, which lies around the origin
    path.write_bytes(data)
    write_world(chain.folder / "near.world", building, 0, 0, 1)
    chain.simulator("--world", chain.folder / "near.world")
    firmware = chain.firmware(f"[map]\nfile = {path}\n")
    wait_until(lambda: "1 tiles could not be read" in firmware.err(), 180, "the damage to be said")
    wait_until(lambda: len(chain.listener.poses) > 30, 180, "poses all the same")
    assert "tile 0 0: " in firmware.err()


@pytest.mark.parametrize("spoil", (lambda data: data[:200], lambda data: data.replace(b"tile 1 0", b"tile 2 0", 1)))
def test_a_damaged_index_ends_the_start(chain, spoil):
    path = chain.folder / "building.tiles"
    write_tiles(path, Building(4, 3).panels())
    path.write_bytes(spoil(path.read_bytes()))
    firmware = chain.firmware(f"[map]\nfile = {path}\n")
    assert firmware.wait(180) == 2
    assert f"{path}: line " in firmware.err()
