"""Workers of an ale-fleet on this machine, to be killed while it is at work."""
import os
import pathlib
import signal
import time


def workers_of(pid):
    """Processes that it has started as workers."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = int((process / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()[1])
            words = (process / "cmdline").read_bytes()
        except OSError:
            continue  # it has ended
        if parent == pid and b"spawn_main" in words:
            found.append(int(process.name))
    return sorted(found)


def kill_workers(fleet, part, rows, count):
    """As soon as so many rows are done. False: all was done before."""
    while not (part.exists() and part.read_bytes().count(b"\n") >= rows):
        if fleet.poll() is not None:
            return False
        time.sleep(0.02)
    for worker in workers_of(fleet.pid)[:count]:
        os.kill(worker, signal.SIGKILL)
    return True
