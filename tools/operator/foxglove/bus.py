"""LCM in, by a socket of its own: one datagram of a stranger ends liblcm, and with it PyPI's `lcm` (drivers/lcm).

    bus = Bus("udpm://239.255.76.67:7667?ttl=0&prefix=rover1.", ["ALE_POSE", ...])
    for channel, data in bus.receive(seconds): ...

With ttl=0 only this computer is heard. A message of more than one datagram is put together; of those that are not whole yet
the newest few are kept.
"""
import os
import re
import select
import socket
import struct
import urllib.parse

DEFAULT = "udpm://239.255.76.67:7667?ttl=0"
WHOLE, PART = b"LC02", b"LC03"
PART_HEADER = struct.Struct(">IIIHH")  # sequence, bytes of all, offset, number, count
MOST_BYTES = 1 << 16
MOST_BEGUN = 4


class BadUrl(ValueError):
    """No such LCM; the text says why."""


def parse(url):
    """(group, port, ttl, prefix)"""
    found = re.fullmatch(r"udpm://([0-9.]*):?(\d*)(?:\?(.*))?", url or os.environ.get("LCM_DEFAULT_URL") or DEFAULT)
    if not found:
        raise BadUrl(f"{url}: only udpm:// is heard")
    options = dict(urllib.parse.parse_qsl(found[3] or ""))
    return found[1] or "239.255.76.67", int(found[2] or 7667), int(options.get("ttl", 0)), options.get("prefix", "")


class Bus:
    def __init__(self, url, channels):
        group, port, ttl, self.prefix = parse(url)
        self.only_here = ttl == 0
        self.channels = {(self.prefix + name).encode(): name for name in channels}
        self.buffer = memoryview(bytearray(MOST_BYTES))  # one for all: a new one for each datagram scatters what the heap holds
        self.begun = {}
        self.here = {}
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 21)
        self.socket.bind((group, port))
        try:
            self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + bytes(4))
        except OSError as error:
            raise BadUrl(f"LCM: no route for multicast ({error.strerror}): "
                         "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo") from error

    def receive(self, seconds):
        """What has come, after at most so many seconds."""
        if select.select([self.socket], [], [], seconds)[0]:
            size, (host, _) = self.socket.recvfrom_into(self.buffer)
            message = None if self.only_here and not self._is_here(host) else self._message(bytes(self.buffer[:size]))
            if message:
                yield message

    def _is_here(self, host):
        """Whether it is an address of this computer: the kernel takes those from nobody else."""
        if host not in self.here:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                try:
                    probe.bind((host, 0))
                    self.here[host] = True
                except OSError:
                    if len(self.here) > 1000:
                        self.here.clear()
                    self.here[host] = False
        return self.here[host]

    def _message(self, datagram):
        if datagram.startswith(WHOLE):
            name, end, data = datagram[8:].partition(b"\0")
            return (self.channels[name], data) if end and name in self.channels else None
        if datagram.startswith(PART) and len(datagram) > 20:
            return self._joined(*PART_HEADER.unpack_from(datagram, 4), datagram[20:])
        return None

    def _joined(self, sequence, total, offset, number, count, data):
        if total > MOST_BYTES * 4 or not 0 < count <= 8 or number >= count:
            return None
        parts = self.begun.setdefault(sequence, {})
        parts[number] = (offset, data)
        while len(self.begun) > MOST_BEGUN:
            del self.begun[next(iter(self.begun))]
        if len(parts) < count or 0 not in parts:
            return None
        self.begun.pop(sequence, None)
        name, _, first = parts[0][1].partition(b"\0")
        whole = first + b"".join(parts[k][1] for k in range(1, count))
        return (self.channels[name], whole) if name in self.channels and len(whole) == total else None

    def close(self):
        self.socket.close()
