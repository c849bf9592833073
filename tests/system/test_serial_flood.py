"""Whoever writes on the scanner's line makes no more scans than a scanner: a relay between the simulator and the firmware puts
beginnings of frames on it, as fast as it takes them."""
import os
import pty
import select
import threading
import time
import tty

from at_hand import WORLDS
from waiting import wait_until

HEADER = b"MD0044072501000\n99b\n"
FLOOD_S = 6
PERIOD_S = 0.1
AT_ONCE = 34


class Relay:
    """A pseudo terminal in front of another one."""

    def __init__(self, device, link):
        self.inner = os.open(device, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.inner)
        self.outer, name = pty.openpty()
        tty.setraw(self.outer)
        tty.setraw(name)
        os.symlink(os.ttyname(name), link)
        self.slave = name
        self.flooding = False
        self.sent = 0
        self.stopping = False
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def _run(self):
        while not self.stopping:
            writable = [self.outer] if self.flooding else []
            ready, free, _ = select.select([self.inner, self.outer], writable, [], 0.05)
            for end, other in ((self.inner, self.outer), (self.outer, self.inner)):
                if end in ready:
                    os.write(other, os.read(end, 4096))
            if free:
                os.write(self.outer, HEADER * 20)
                self.sent += 20

    def stop(self):
        self.stopping = True
        self.thread.join()
        for end in (self.inner, self.outer, self.slave):
            os.close(end)


def test_headers_at_full_speed_make_no_more_poses_than_a_scanner(chain):
    inner = chain.folder / "inner"
    chain.start("ale-sim", "--pty", inner, "--lcm-url", chain.url, "--world", WORLDS / "home.world")
    wait_until(inner.exists, 180, "the simulated scanner")
    relay = Relay(inner, chain.port)
    try:
        chain.firmware()
        wait_until(lambda: len(chain.listener.poses) > 20, 180, "poses")
        before, begun = len(chain.listener.poses), time.monotonic()
        relay.flooding = True
        wait_until(lambda: time.monotonic() - begun > FLOOD_S and relay.sent > 2000, 180, "the flood")
        relay.flooding = False
        seconds = time.monotonic() - begun
        poses = len(chain.listener.poses) - before
        print(f"{relay.sent} headers in {seconds:.1f} s made {poses} poses")
        assert poses <= 2 * seconds / PERIOD_S + AT_ONCE
        wait_until(lambda: not chain.listener.poses[-1].predicted, 180, "scans again")
        wait_until(lambda: chain.listener.counters()["losses_too_fast"] > 0, 180, "the count of them")
    finally:
        relay.stop()
