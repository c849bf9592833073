"""Event logs of LCM (lcm-logger), read and written.

    for event in lcm_log.events(path): event.utime, event.channel, event.data
    with lcm_log.Writer(path) as log: log.put(utime, "ALE_SCAN", message.encode())
    pipe.write(lcm_log.event(number, utime, "ALE_SCAN", message.encode()))
"""
import struct
import typing

SYNC = 0xEDA1DA01
HEADER = struct.Struct(">IqqII")  # sync, number, microseconds, lengths of channel and data
MOST_BYTES = 1 << 28


class Event(typing.NamedTuple):
    utime: int
    channel: str
    data: bytes


def is_log(path):
    with open(path, "rb") as file:
        return file.read(4) == struct.pack(">I", SYNC)


def events(path):
    """In their order; the rest of a log that is cut or damaged is left out."""
    with open(path, "rb") as file:
        while len(header := file.read(HEADER.size)) == HEADER.size:
            sync, _, utime, name_bytes, data_bytes = HEADER.unpack(header)
            if sync != SYNC or name_bytes > 1000 or data_bytes > MOST_BYTES:
                return
            name, data = file.read(name_bytes), file.read(data_bytes)
            if len(data) < data_bytes:
                return
            yield Event(utime, name.decode("ascii", "replace"), data)


def event(number, utime, channel, data):
    """Its bytes in a log."""
    name = channel.encode("ascii")
    return HEADER.pack(SYNC, number, utime, len(name), len(data)) + name + data


class Writer:
    def __init__(self, path):
        self.file = open(path, "wb")  # noqa: SIM115 (closed by close)
        self.number = 0

    def put(self, utime, channel, data):
        self.file.write(event(self.number, utime, channel, data))
        self.number += 1

    def close(self):
        self.file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
