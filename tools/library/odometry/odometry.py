#!/usr/bin/env python3
"""Sends odometry: reads metres of the left and the right wheel since the line before, a line each time.

    your-wheels | PYTHONPATH=/usr/share/ale-slam/python python3 odometry.py TRACK_METRES
"""
import math
import sys
import time

import ale
import lcm


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    track = float(sys.argv[1])
    bus = lcm.LCM()  # LCM_DEFAULT_URL, else LCM's own default
    message = ale.odometry_t()
    heading = 0.0
    for line in sys.stdin:
        left, right = map(float, line.split())
        turn = (right - left) / track
        message.x += (left + right) / 2 * math.cos(heading + turn / 2)
        message.y += (left + right) / 2 * math.sin(heading + turn / 2)
        heading += turn
        message.theta = math.remainder(heading, 2 * math.pi)
        message.utime = time.time_ns() // 1000
        bus.publish("ALE_ODOMETRY", message.encode())
    return 0


if __name__ == "__main__":
    sys.exit(main())
