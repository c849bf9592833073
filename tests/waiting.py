"""Waiting for conditions; what goes on meanwhile in threads of its own."""
import threading
import time

import lcm


def wait_until(condition, seconds, what):
    """Waits for a condition; the time is only there to fail when it never comes."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"{what}: not within {seconds} s"
        time.sleep(0.01)


class Ear:
    """Hands over what comes on LCM: take(channel, data), for each of the channels."""

    def __init__(self, url, channels, take):
        self.bus = lcm.LCM(url)
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
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._go_on)
        self.thread.start()

    def _go_on(self):
        while not self.stopping.wait(self.period_s):
            self.beat()

    def stop(self):
        self.stopping.set()
        self.thread.join()
