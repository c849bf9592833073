"""Reads a simulated scanner by somebody else's client, run by the Python that has it:

    independent_client.py lds2d MODEL DEVICE SECONDS | pyrplidarsdk BAUD DEVICE SECONDS | hokuyolx PORT - SECONDS

prints a JSON object: the scans, each a list of points, degrees clockwise from straight ahead and millimetres.
"""
import json
import math
import sys
import time


def read_lds2d(model, device):
    from lds2d import Lidar

    with Lidar.open(model, device) as lidar:
        for scan in lidar.scans():
            yield [(point.angle_deg, point.dist_mm) for point in scan]


def read_pyrplidarsdk(baud, device):
    import pyrplidarsdk

    driver = pyrplidarsdk.RplidarDriver(port=device, baudrate=int(baud))
    assert driver.connect() and driver.get_health().status == 0
    assert driver.start_scan()
    while True:
        scan = driver.get_scan_data()
        if scan:
            yield [(math.degrees(angle), 1000 * metres) for angle, metres in zip(scan[0], scan[1])]


class OneReplyAtATime:
    """A socket for hokuyolx, which takes two scans that came together for one."""

    def __init__(self, connection):
        self.send = connection.send
        self._connection = connection
        self._waiting = b""
        self._last = b""

    def recv(self, count):
        self._waiting = self._waiting or self._connection.recv(65536)
        end = (self._last + self._waiting).find(b"\n\n")
        taken = self._waiting[:end + 2 - len(self._last)] if end >= 0 else self._waiting
        self._waiting = self._waiting[len(taken):]
        self._last = taken[-1:] if end < 0 else b""
        return taken


def read_hokuyolx(port, _):
    import hokuyolx

    laser = None
    for _ in range(100):
        try:
            laser = hokuyolx.HokuyoLX(addr=("127.0.0.1", int(port)), time_tolerance=1e9)
            break
        except ConnectionRefusedError:
            time.sleep(0.1)
    laser._sock = OneReplyAtATime(laser._sock)
    for distances, _, _ in laser.iter_dist():
        yield [(-(step - laser.aforw) * 360 / laser.ares, mm) for step, mm in enumerate(distances.tolist())]


def main():
    client, what, device, seconds = sys.argv[1:]
    read = {"lds2d": read_lds2d, "pyrplidarsdk": read_pyrplidarsdk, "hokuyolx": read_hokuyolx}[client]
    scans, times = [], []
    for scan in read(what, device):
        scans.append(scan)
        times.append(time.monotonic())
        if times[-1] - times[0] > float(seconds):
            break
    json.dump({"scans": scans, "seconds": times[-1] - times[0]}, sys.stdout)
    sys.stdout.flush()


if __name__ == "__main__":
    main()
