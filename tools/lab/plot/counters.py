"""What a robot counted while its log was written: ALE_STATUS in event logs of LCM (lcm-logger, the console's recordings).

    counted = counters.read(path)          # None: no log of LCM, or no status in it
    counted.t; counted.grown["bad_checksum"]
"""
import bz2
import gzip
import struct
from typing import NamedTuple

import numpy as np

SYNC = struct.pack(">I", 0xEDA1DA01)
HEADER = struct.Struct(">4sqqII")  # sync, number, microseconds, lengths of channel and data
MOST_BYTES = 1 << 28
NO_TROUBLE = ("odometry", "flight_recordings")


class Counted(NamedTuple):
    """t: seconds, of each status. grown: by name, how often it was counted from the first status on; only what was. A robot that
    starts anew counts on."""
    t: np.ndarray
    grown: dict


def read(path):
    """Of the robot that is heard first."""
    times, rows = [], []
    for status in _statuses(path):
        times.append(status.utime * 1e-6)
        rows.append({**dict(zip(status.counter_name, status.counter_value)), "deadline_misses": status.deadline_misses})
    if not rows:
        return None
    grown = {name: _growth([row.get(name, 0) for row in rows]) for name in rows[-1] if name not in NO_TROUBLE}
    return Counted(np.array(times), {name: growth for name, growth in grown.items() if growth[-1] > 0})


def _growth(values):
    values = np.array(values, np.int64)
    steps = np.diff(values, prepend=values[0])
    return np.cumsum(np.where(steps < 0, values, steps))


def _statuses(path):
    import ale  # pylint: disable=import-outside-toplevel  (the types of LCM, which lie in the program)
    robot = None
    for data in _events(path, b"ALE_STATUS"):
        try:
            status = ale.status_t.decode(data)
        except (ValueError, IndexError, struct.error, UnicodeDecodeError):
            continue
        robot = robot or status.robot
        if status.robot == robot:
            yield status


def _opened(path):
    with open(path, "rb") as file:
        begin = file.read(3)
    return gzip.open(path) if begin[:2] == b"\x1f\x8b" else bz2.open(path) if begin == b"BZh" else open(path, "rb")


def _events(path, channel):
    """Data of each; the rest of a log that is cut or damaged is left out."""
    with _opened(path) as file:
        try:
            while len(header := file.read(HEADER.size)) == HEADER.size:
                sync, _, _, name_bytes, data_bytes = HEADER.unpack(header)
                if sync != SYNC or name_bytes > 1000 or data_bytes > MOST_BYTES:
                    return
                name, data = file.read(name_bytes), file.read(data_bytes)
                if name.endswith(channel) and len(data) == data_bytes:
                    yield data
        except (OSError, EOFError):
            return
