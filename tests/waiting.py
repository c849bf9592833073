"""Waiting for conditions; what goes on meanwhile in threads of its own; how long it took on a machine that others use too."""
import math
import pathlib
import re
import threading
import time

import lcm

from priority import threads_as_hardware


def wait_until(condition, seconds, what):
    """Waits for a condition; the time is only there to fail when it never comes."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"{what}: not within {seconds} s"
        time.sleep(0.01)


class Stopwatch:
    """Seconds since it was made. On a busy machine some of them went by because a program had to wait for a processor, by the
    kernel's account (pressure stall information); where the kernel keeps none, any of them may have."""

    PRESSURE = pathlib.Path("/proc/pressure/cpu")

    def __init__(self):
        self.begin = time.monotonic()
        self.waited = self._waited()

    def _waited(self):
        try:
            return int(re.search(r"some .*total=(\d+)", self.PRESSURE.read_text())[1]) * 1e-6
        except OSError:
            return -math.inf

    def seconds(self):
        return time.monotonic() - self.begin

    def waiting_seconds(self):
        """In which some program had to wait."""
        return self._waited() - self.waited if math.isfinite(self.waited) else math.inf

    def least(self):
        """What it would have taken an idle machine, at least: what is held against an upper bound."""
        return max(0.0, self.seconds() - self.waiting_seconds())

    def most(self):
        """What is held against a lower bound, where what came late at first is made up for later."""
        return self.seconds() + self.waiting_seconds()


class Ear:
    """Hands over what comes on LCM: take(channel, data), for each of the channels."""

    def __init__(self, url, channels, take):
        self.bus = lcm.LCM(url)
        with threads_as_hardware():  # LCM's own: it takes what comes off the socket, before the kernel drops it
            for channel in channels:
                self.bus.subscribe(channel, take).set_queue_capacity(0)
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._listen)
        self.thread.start()

    def _listen(self):
        while not self.stopping.is_set():
            self.bus.handle_timeout(50)

    def stop(self):
        self.stopping.set()
        self.thread.join()


class Pulse:
    """Does something again and again until it is stopped."""

    def __init__(self, period_s, beat):
        self.period_s = period_s
        self.beat = beat
        self.beats = []  # when they were
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._go_on)
        self.thread.start()

    def _go_on(self):
        while not self.stopping.wait(self.period_s):
            self.beat()
            self.beats.append(time.monotonic())

    def rate(self):
        """Beats a second lately: fewer than asked for on a busy machine."""
        lately = self.beats[-20:]
        return (len(lately) - 1) / (lately[-1] - lately[0]) if len(lately) > 1 else 0.0

    def stop(self):
        self.stopping.set()
        self.thread.join()
