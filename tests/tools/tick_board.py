#!/usr/bin/env python3
"""The board of a simulated robot: wheels that turn as the odometry on one LCM says, told on a pseudo terminal as ale-odometry reads it.

    tick_board.py LINK URL TICKS_A_METRE TRACK
"""
import binascii
import math
import os
import pty
import sys
import time
import tty

import ale
import lcm


class Board:
    def __init__(self, descriptor, ticks, track):
        self.descriptor, self.ticks, self.track = descriptor, ticks, track
        self.left = self.right = 0.0
        self.before = None

    def take(self, _, data):
        now = ale.odometry_t.decode(data)
        if self.before:
            dx, dy = now.x - self.before.x, now.y - self.before.y
            turn = math.remainder(now.theta - self.before.theta, 2 * math.pi)
            middle = self.before.theta + turn / 2
            ahead = dx * math.cos(middle) + dy * math.sin(middle)
            self.left += ahead - turn * self.track / 2
            self.right += ahead + turn * self.track / 2
        self.before = now
        body = f"TICKS,{round(self.left * self.ticks)},{round(self.right * self.ticks)},{time.monotonic_ns() // 1000 % 2**32}"
        checksum = binascii.crc_hqx(body.encode(), 0xFFFF)
        os.write(self.descriptor, f"${body}*{checksum:04X}\r\n".encode())


def main():
    link, url, ticks, track = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
    near, far = pty.openpty()
    tty.setraw(near)
    tty.setraw(far)
    os.symlink(os.ttyname(far), link)
    board, bus = Board(near, ticks, track), lcm.LCM(url)
    bus.subscribe("ALE_ODOMETRY", board.take)
    while True:
        bus.handle()


if __name__ == "__main__":
    main()
