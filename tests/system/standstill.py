"""How long the machine itself stands still: a program on every processor, above the firmware, that looks at the clock each millisecond.

What it sees, the firmware can do nothing about: the machine's host holds it, or a task that outranks all.
"""
import os
import signal
import subprocess
import sys
import time

from priority import as_hardware

LOOK_S = 0.001
LONG_S = 0.002


class Standstill:
    """Watches from its creation until it is stopped."""

    def __init__(self):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        self.watchers = [subprocess.Popen([sys.executable, __file__, str(cpu)], env=environment, preexec_fn=as_hardware, text=True,
                                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
                         for cpu in os.sched_getaffinity(0)]

    def stop(self):
        """How long each time, in seconds, of all processors; what is shorter than two milliseconds is left out."""
        for watcher in self.watchers:
            watcher.terminate()
        return [float(word) for watcher in self.watchers for word in watcher.communicate()[0].split()]


def watch(cpu):
    os.sched_setaffinity(0, {cpu})
    ended = []
    signal.signal(signal.SIGTERM, lambda *_: ended.append(True))
    last = time.monotonic()
    while not ended:
        time.sleep(LOOK_S)
        now = time.monotonic()
        if now - last - LOOK_S > LONG_S:
            print(now - last - LOOK_S)
        last = now


if __name__ == "__main__":
    watch(int(sys.argv[1]))
