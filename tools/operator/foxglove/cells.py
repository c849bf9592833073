"""The map as cells, /occupancy: walls, and what scans left free, as ale-grid makes them of what the robot says.

    with Cells(context, names, every_seconds=2) as cells:
        cells.take("ALE_SCAN", data)          # every message of CHANNELS, as they come
    cells.failed                              # what ended ale-grid before its time, or ""
"""
import json
import subprocess
import sys
import threading

from foxglove import channels
from foxglove.messages import Grid, PackedElementField, PackedElementFieldNumericType, Pose, Quaternion, Timestamp, Vector2, Vector3

from . import lcm_log
from .near import program

CHANNELS = ("ALE_SCAN", "ALE_POSE", "ALE_TRACKING", "ALE_GRAPH", "ALE_MAP", "ALE_MAP_PIECES")
FREE, OCCUPIED, UNKNOWN = 0, 100, 255
COLOURS = {FREE: (110, 125, 140, 90), OCCUPIED: (235, 235, 235, 255), UNKNOWN: (0, 0, 0, 0)}  # red, green, blue, alpha
FIELDS = [PackedElementField(name=name, offset=offset, type=PackedElementFieldNumericType.Uint8)
          for offset, name in enumerate(("red", "green", "blue", "alpha"))]
FIELDS.append(PackedElementField(name="occupancy", offset=4, type=PackedElementFieldNumericType.Int8))  # -1: unknown, as ROS has it
TABLES = [bytes(COLOURS.get(cell, COLOURS[UNKNOWN])[part] for cell in range(256)) for part in range(4)]


def packed(cells):
    """Of each cell its colour and its occupancy, as FIELDS say."""
    out = bytearray(len(FIELDS) * len(cells))
    for part, table in enumerate(TABLES):
        out[part::len(FIELDS)] = cells.translate(table)
    out[4::len(FIELDS)] = cells
    return bytes(out)


def grid_message(head, cells, frame):
    stride = len(FIELDS)
    return Grid(timestamp=Timestamp(sec=head["utime"] // 1000000, nsec=head["utime"] % 1000000 * 1000), frame_id=frame,
                pose=Pose(position=Vector3(x=head["x"], y=head["y"], z=0.0), orientation=Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)),
                column_count=head["columns"], cell_size=Vector2(x=head["cell"], y=head["cell"]), cell_stride=stride,
                row_stride=stride * head["columns"], fields=FIELDS, data=packed(cells))


class Cells:
    def __init__(self, context, names, every_seconds):
        self.channel = channels.GridChannel(names.topic("/occupancy"), context=context)
        self.frame = names.frame("map")
        self.failed = ""
        # Not of the terminal's group: what ends this by Ctrl-C does not end that before its last grid.
        self.process = subprocess.Popen([program("ale-grid"), "--every", str(every_seconds)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        start_new_session=True)
        self.thread = threading.Thread(target=self._listen, daemon=True)
        self.thread.start()

    def take(self, channel, data):
        if channel not in CHANNELS or self.failed:
            return
        try:
            self.process.stdin.write(lcm_log.event(0, 0, channel, data))
            self.process.stdin.flush()
        except OSError as error:
            self.failed = f"ale-grid has ended ({error.strerror}): no /occupancy any more"
            print(f"ale-foxglove: {self.failed}", file=sys.stderr, flush=True)

    def _listen(self):
        grids = self.process.stdout
        while line := grids.readline():
            head = json.loads(line)
            cells = grids.read(head["columns"] * head["rows"])
            self.channel.log(grid_message(head, cells, self.frame), log_time=head["utime"] * 1000)

    def close(self):
        """When its last grid has been shown."""
        try:
            self.process.stdin.close()
        except OSError:
            pass  # it has ended, which its exit status tells
        self.thread.join()
        if self.process.wait() != 0 and not self.failed:
            self.failed = f"ale-grid failed with status {self.process.returncode}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
