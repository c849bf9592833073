"""Something else than a URG on the port: log and status name it by what comes from it, and a URG on the same port is found later."""
import contextlib
import os
import pty
import random
import threading
import tty

import pytest

from at_hand import WORLDS
from waiting import wait_until

GPS = b"$GPGGA,092750.000,5321.6802,N,00630.3372,W,1,8,1.03,61.7,M,55.2,M,,*76\r\n"
BEAMS = 360


def rplidar_nodes():
    """A turn, as its protocol describes measurements."""
    turn = bytearray()
    for beam in range(BEAMS):
        angle = beam * 64
        turn += bytes((60 << 2 | (1 if beam == 0 else 2), angle << 1 & 0xFE | 1, angle >> 7 & 0xFF, 0x40, 0x1F))
    return bytes(turn)


class Device:
    """A pseudo terminal from which the same bytes come again and again, whatever is sent to it."""

    def __init__(self, link, said):
        self.far, self.near = pty.openpty()
        tty.setraw(self.far)
        tty.setraw(self.near)
        os.symlink(os.ttyname(self.near), link)
        self.said, self.link = said, link
        os.set_blocking(self.far, False)
        self.over = threading.Event()
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def _run(self):
        while not self.over.wait(0.05):
            with contextlib.suppress(BlockingIOError):
                os.read(self.far, 4096)
            with contextlib.suppress(BlockingIOError):
                os.write(self.far, self.said)

    def unplug(self):
        self.over.set()
        self.thread.join()
        os.unlink(self.link)
        os.close(self.near)
        os.close(self.far)


@pytest.mark.parametrize("said, named", [
    (b"", "not a byte comes from it"),
    (GPS, "what speaks there is NMEA, as of a GPS receiver: $GPGGA,092750.000"),
    (random.Random(1).randbytes(400), "bytes come that are nothing known, or of another rate: "),
    (rplidar_nodes(), "what speaks there is an RPLIDAR, which is no URG"),
], ids=["silence", "nmea", "noise", "rplidar"])
def test_it_is_named_by_what_comes_from_it(chain, said, named):
    device = Device(chain.port, said)
    try:
        firmware = chain.firmware()
        words = f"no answer from the sensor: {named}"
        wait_until(lambda: words in firmware.err(), 180, "its name in the log")
        wait_until(lambda: any(words in status.driver_state for status in chain.listener.statuses), 180, "its name in the status")
        assert firmware.err().count("no answer from the sensor") == 1
    finally:
        device.unplug()
    chain.simulator("--world", WORLDS / "home.world")
    wait_until(lambda: len(chain.listener.poses) > 3, 180, "poses of a URG in its place")
    assert firmware.running()
