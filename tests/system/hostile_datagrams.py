"""Datagrams as anybody can send them to LCM's group: of every kind that has ended or blinded a program, and noise."""
import struct

CHANNELS = ("ALE_COMMAND", "ALE_ODOMETRY", "ALE_ODOMETRY_EXACT", "ALE_DRIVE", "ALE_POSE", "ALE_STATUS", "ALE_MAP", "ALE_MAP_PIECES",
            "ALE_FEATURES", "ALE_SCAN", "ALE_TRACKING", "ALE_PLAN", "ALE_GRAPH")
EDGES = (0, 1, 19, 32, 1000, 65535, 65536, 2**28, 2**28 + 1, 2**31 - 1, 2**31, 2**32 - 16, 2**32 - 1)


def part(sequence, size, offset, number, of, rest):
    return b"LC03" + struct.pack(">IIIHH", sequence, size, offset, number, of) + rest


def whole(channel, message):
    return b"LC02" + struct.pack(">I", 1) + channel.encode() + b"\0" + message


def wrapping(channel):
    """Offset and length add up to 16."""
    return part(1, 1000, 2**32 - 16, 0, 2, channel.encode() + b"\0" + bytes(32))


def announcing(sequence, channel):
    """45 bytes or so that announce 256 MiB."""
    return part(sequence, 2**28, 0, 0, 4000, channel.encode() + b"\0" + b"x")


def hostile(rng, genuine=()):
    """One of all kinds. genuine: messages as (channel, bytes) that were heard, to be changed."""
    channel = rng.choice(CHANNELS)
    name = channel.encode() + b"\0"
    kind = rng.randrange(8)
    if kind == 0:
        return wrapping(channel)
    if kind == 1:
        return announcing(rng.randrange(100), channel)
    if kind == 2:
        return part(rng.randrange(3), rng.choice(EDGES), rng.choice(EDGES), rng.randrange(3), rng.randrange(4),
                    (name if rng.randrange(2) else b"") + rng.randbytes(rng.randrange(100)))
    if kind == 3:
        return whole(channel, b"")[:rng.randrange(30)]
    if kind == 4:
        return whole("C" * rng.randrange(200), rng.randbytes(rng.randrange(50)))
    if kind == 5:
        return rng.choice((b"LC02", b"LC03", b"")) + rng.randbytes(rng.randrange(400))
    if kind == 6 or not genuine:
        return whole(channel, rng.randbytes(rng.randrange(3000)))
    return changed(rng, *rng.choice(genuine))


def changed(rng, channel, message):
    """A message of the right type, of which a number of elements, or anything else, is another."""
    data = bytearray(message)
    at = rng.randrange(8, max(9, len(data) - 4))
    data[at:at + 4] = struct.pack(">I", rng.choice(EDGES))
    return whole(channel, bytes(data[:rng.randrange(len(data))] if rng.randrange(4) == 0 else data))
