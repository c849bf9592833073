"""A .scip recording of scans that came another way: the bytes that a scanner would have sent, as ale-sim sends a recording.

    scip_file.write(lcm_log.events(path), "drive.scip")

What SCIP has no word for (how the beams lie in bearing and time) is in line PLAY, as with every recording that is played
(drivers/scanner/urg/played.h). Ranges above 262 m, and what is not of ALE_SCAN or ALE_ODOMETRY, are not kept.
"""
import math
import struct
import zlib

import ale

MAGIC, CHUNK = b"ALESCIP1", b"CHNK"
RECEIVED, SENT, ODOMETRY = 1, 2, 3
TURN = 1 << 32
STAMPS = 1 << 24
MOST_MM, LEAST_MM = (1 << 18) - 1, 20
NO_RETURN, BLIND, TOO_NEAR = 0x81, 0x83, 0x85
LOST_CODE, NOT_A_STEP = 1, 19  # of the URG: no value; not part of the field of view
PERIOD_US = 100000  # of SCAN:600: the reader takes a scan's first byte to have come so long after its stamp
LINE = 64


def chunk(kind, stamp, payload):
    body = struct.pack("<B3xIq", kind, len(payload), stamp) + payload
    return CHUNK + body + struct.pack("<I", zlib.crc32(body))


def summed(text, end=b""):
    """A line with its sum, in which what ends it does not count."""
    return text + end + bytes([(sum(text) & 0x3F) + 0x30]) + b"\n"


def characters(value, count):
    return bytes(((value >> 6 * (count - 1 - k)) & 0x3F) + 0x30 for k in range(count))


def bam(radians):
    return round(radians / (2 * math.pi) * TURN)


def signed32(value):
    return (value + (1 << 31)) % TURN - (1 << 31)


class Geometry:
    """What a scanner says of itself, from one of its scans."""

    def __init__(self, scan, silence_ms):
        self.beams = scan.num_ranges
        self.least, self.most = max(round(scan.range_min * 1000), LEAST_MM + 1), min(round(scan.range_max * 1000), MOST_MM)
        self.request = b"MD%04d%04d00000" % (0, self.beams - 1)
        play = (silence_ms, 0, 1, scan.stamp_beam, round(scan.beam_time_us * 1000), signed32(bam(scan.first_bearing)),
                signed32(bam(scan.step)), 0, self.beams)
        lines = {"MODL": "recording", "DMIN": self.least, "DMAX": self.most, "ARES": max(self.beams, round(abs(2 * math.pi / scan.step))),
                 "AMIN": 0, "AMAX": self.beams - 1, "AFRT": 0, "SCAN": 600, "PLAY": ",".join(map(str, play))}
        self.reply = b"PP\n00P\n" + b"".join(summed(f"{key}:{value}".encode(), b";") for key, value in lines.items()) + b"\n"

    def fits(self, scan):
        return scan.num_ranges == self.beams

    def value(self, distance, unit, code):
        if code == 0:
            return min(max(distance * unit, LEAST_MM), self.most)
        return {NO_RETURN: self.most, BLIND: NOT_A_STEP, TOO_NEAR: LEAST_MM}.get(code, code if code < LEAST_MM else LOST_CODE)

    def frame(self, scan):
        unit = max(scan.range_unit_mm, 1)
        data = b"".join(characters(self.value(r, unit, code), 3) for r, code in zip(scan.range_mm, scan.codes))
        return (self.request + b"\n99b\n" + summed(characters(scan.utime % STAMPS, 4)) +
                b"".join(summed(data[at:at + LINE]) for at in range(0, len(data), LINE)) + b"\n")


def odometry(data):
    sample = ale.odometry_exact_t.decode(data)
    return sample.utime, struct.pack("<iiIq", sample.x_um, sample.y_um, sample.theta_bam % TURN, sample.utime)


def rounded_odometry(data):
    sample = ale.odometry_t.decode(data)
    return sample.utime, struct.pack("<iiIq", round(sample.x * 1e6), round(sample.y * 1e6), bam(sample.theta) % TURN, sample.utime)


def longest_gap_ms(events):
    times = [ale.scan_t.decode(event.data).utime for event in events if event.channel == "ALE_SCAN"]
    return min(max([(b - a) // 1000 for a, b in zip(times, times[1:])], default=0) + 3000, 10000000)


def write(events, path):
    events = list(events)
    exact = any(event.channel == "ALE_ODOMETRY_EXACT" for event in events)
    geometry, silence = None, longest_gap_ms(events)
    with open(path, "wb") as file:
        file.write(MAGIC)
        for event in events:
            if event.channel == "ALE_SCAN":
                scan = ale.scan_t.decode(event.data)
                if geometry is None:
                    geometry = Geometry(scan, silence)
                    file.write(chunk(SENT, scan.utime, b"PP\n") + chunk(RECEIVED, scan.utime, geometry.reply) +
                               chunk(SENT, scan.utime, geometry.request + b"\n") +
                               chunk(RECEIVED, scan.utime, geometry.request + b"\n00P\n\n"))
                if not geometry.fits(scan):
                    raise ValueError(f"scan {scan.scan} has {scan.num_ranges} beams, the first one has {geometry.beams}")
                file.write(chunk(RECEIVED, scan.utime + PERIOD_US, geometry.frame(scan)))
            elif event.channel == ("ALE_ODOMETRY_EXACT" if exact else "ALE_ODOMETRY"):
                stamp, payload = odometry(event.data) if exact else rounded_odometry(event.data)
                file.write(chunk(ODOMETRY, stamp, payload))
    if geometry is None:
        raise ValueError("no scan in it")
