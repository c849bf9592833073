"""LCM by a socket of its own, where a test sends what would end liblcm; in the namespace of a network, too."""
import contextlib
import re
import select
import socket
import struct

MOST = 65507


class PlainLcm:
    """What tests use of lcm.LCM. `on`: makes the sockets (hosts.py), else this machine's network is used."""

    def __init__(self, url, on=socket.socket):
        group, port, ttl = re.fullmatch(r"udpm://([\d.]+):(\d+)\?ttl=(\d+)", url).groups()
        self.to = (group, int(port))
        self.takers = {}
        self.sequence = 0
        self.out = on(socket.AF_INET, socket.SOCK_DGRAM)
        self.out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, int(ttl))
        self.bus = on(socket.AF_INET, socket.SOCK_DGRAM)
        self.bus.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.bus.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 21)
        self.bus.bind(("", int(port)))
        self.bus.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + bytes(4))

    def subscribe(self, channel, take):
        self.takers[channel.encode()] = take
        return self

    def set_queue_capacity(self, _):
        pass

    def publish(self, channel, data):
        self.send(b"LC02" + struct.pack(">I", self.sequence) + channel.encode() + b"\0" + data)
        self.sequence = (self.sequence + 1) % 2**32

    def send(self, datagram):
        self.out.sendto(datagram, self.to)

    def handle_timeout(self, milliseconds):
        if select.select([self.bus], [], [], milliseconds / 1000)[0]:
            self._take(self.bus.recv(MOST))

    def _take(self, datagram):
        channel, end, data = datagram[8:].partition(b"\0")
        if datagram.startswith(b"LC02") and end and channel in self.takers:
            with contextlib.suppress(ValueError, IndexError, struct.error):  # junk on a channel that we listen to
                self.takers[channel](channel.decode(), data)
