"""Waiting for conditions; what goes on meanwhile in threads of its own; what must be done in time."""
import math
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


TRIALS = 8


def assert_in_time(trial, least=0, most=math.inf):
    """The seconds that trial() tells lie between the bounds, in one of a few trials: on a machine that others use too some
    trials are held up, and those of a program that is too slow all are."""
    seconds = []
    for _ in range(TRIALS):
        seconds.append(trial())
        if least < seconds[-1] < most:
            return
    raise AssertionError(f"never between {least} and {most} s: {seconds}")


def seconds_of(action):
    begin = time.monotonic()
    action()
    return time.monotonic() - begin


class Ear:
    """Hands over what comes on LCM: take(channel, data), for each of the channels. bus: another way than liblcm's."""

    def __init__(self, url, channels, take, bus=None):
        self.bus = bus or lcm.LCM(url)
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
