"""--record: what is shown, as MCAP; what was heard goes into an LCM log beside it, which is attached when it ends, so that the
MCAP turned back is what the robot said.

    with Recording("live.mcap", context) as recording:
        recording.take("ALE_SCAN", data)

Who is killed before leaves the log where it is, F.mcap.lcm. The log is in memory once while it is attached.
"""
import mmap
import pathlib
import time

import foxglove

from . import lcm_log
from .convert import ATTACHED, MEDIA


class Recording:
    def __init__(self, path, context):
        self.mcap = foxglove.open_mcap(str(path), context=context)
        self.path = pathlib.Path(f"{path}.lcm")
        self.log = lcm_log.Writer(self.path)

    def take(self, channel, data):
        self.log.put(time.time_ns() // 1000, channel, data)

    def close(self):
        self.log.close()
        if self.path.stat().st_size > 0:
            now = time.time_ns()
            with open(self.path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data, memoryview(data) as view:
                self.mcap.attach(log_time=now, create_time=now, name=f"{ATTACHED}.lcm", media_type=MEDIA[".lcm"], data=view)
        self.mcap.close()
        self.path.unlink()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
