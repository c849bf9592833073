"""A virtual robot PC: ale-slamd as deployed on a virtual machine, and what hangs on it.

    ale-sim ── pty ── Line ── UART of the machine (ttyS1) ── ale-slamd ── LCM ── network card ── Lan
       │               └ can be pulled                                          └ frames, read and written here
       └───── odometry (LCM) ───────────────────────────────────────────────────► Lan
"""
import os
import pathlib
import select
import socket
import struct
import subprocess
import threading

import lcm

from at_hand import BINARIES, ROOT, free_udp_port
from chain import TYPES
from priority import threads_as_hardware
from virtual_machine import Machine, initramfs, libraries

DEPLOYED = ROOT / "firmware" / "deploy" / "ale-slamd.ini"
WIRE_BYTES = 256
LCM_GROUP = "239.255.76.67"
LCM_PORT = 7667
# To the group's own address of Ethernet, from an address of the kind that anyone may give.
ROUTER = bytes.fromhex("01005e7f4c43" "020000000001" "0800")

# The first console is the machine's, with one word a line from outside; the second UART is the scanner's.
INIT = f"""#!/bin/busybox sh
/bin/busybox mkdir -p /proc /sys /dev /var/lib/ale-slam
/bin/busybox mount -t proc proc /proc
/bin/busybox mount -t sysfs sys /sys
/bin/busybox mount -t devtmpfs dev /dev
/bin/busybox insmod /e1000.ko
/bin/busybox ip link set lo up
/bin/busybox ip address add 10.0.0.2/24 dev eth0
/bin/busybox ip link set eth0 up
/bin/busybox ip route add 224.0.0.0/4 dev eth0
firmware() {{
    while :; do
        /bin/ale-slamd --config /etc/ale-slamd.ini --port /dev/ttyS1 --lcm-url 'udpm://{LCM_GROUP}:{LCM_PORT}?ttl=1' \\
            --time-scale "$1"
        echo "ale-slamd ended with $?"
    done
}}
until [ "$(/bin/busybox cat /sys/class/net/eth0/carrier)" = 1 ]; do
    /bin/busybox sleep 0.1
done
echo ready
while read -r word number; do
    case $word in
    clock) /bin/busybox date -s "@$number" ;;
    start) firmware "$number" & ;;
    kill) /bin/busybox killall -9 ale-slamd ;;
    esac
done
"""


def bare_robot(folder, kernel, lan):
    """A machine that runs from its memory, with nothing on it but ale-slamd as deployed. Its scanner's UART is folder/uart."""
    firmware = BINARIES / "ale-slamd"
    files = {"e1000.ko": (kernel.module("e1000").read_bytes(), 0o644), "etc/ale-slamd.ini": (DEPLOYED.read_bytes(), 0o644),
             "bin/ale-slamd": (firmware.read_bytes(), 0o755)}
    for library in libraries(firmware):
        files[library.lstrip("/")] = (pathlib.Path(library).read_bytes(), 0o755)
    initramfs(folder / "initramfs.gz", INIT, files)
    return Machine(folder, kernel, folder / "initramfs.gz", *scanner_socket(folder), "-serial", "chardev:scanner",
                   *network_card(lan))


def scanner_socket(folder):
    """Where Line is connected."""
    return "-chardev", f"socket,id=scanner,path={folder / 'uart'},server=on,wait=off"


def network_card(lan):
    return ("-netdev", f"dgram,id=wire,local.type=inet,local.host=127.0.0.1,local.port={lan.machine[1]},"
                       f"remote.type=inet,remote.host=127.0.0.1,remote.port={lan.port}",
            "-device", "e1000,netdev=wire,id=lan")


class Line:
    """The wire between the simulated scanner and the machine's UART. Pulled, it carries nothing either way. As a wire it holds
    next to nothing: a scanner whose bytes are not taken waits, and leaves scans away."""

    def __init__(self, pty, uart):
        self.scanner = os.open(pty, os.O_RDWR | os.O_NOCTTY)
        os.set_blocking(self.scanner, False)
        subprocess.run(["stty", "-F", pty, "raw", "-echo"], check=True)
        self.machine = socket.socket(socket.AF_UNIX)
        self.machine.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, WIRE_BYTES)
        self.machine.connect(str(uart))
        self.machine.setblocking(False)
        self.pulled = False
        self.ended = False
        self.thread = threading.Thread(target=self._carry)
        with threads_as_hardware():
            self.thread.start()

    def _carry(self):
        waiting = b""
        while not self.ended:
            ready, free, _ = select.select([self.machine] + ([] if waiting else [self.scanner]),
                                           [self.machine] if waiting else [], [], 0.05)
            try:
                if self.scanner in ready:
                    data = os.read(self.scanner, WIRE_BYTES)
                    waiting = b"" if self.pulled else data
                if free or waiting:
                    waiting = waiting[self.machine.send(waiting):]
                if self.machine in ready:
                    data = self.machine.recv(4096)
                    if data and not self.pulled:
                        os.write(self.scanner, data)
            except BlockingIOError:
                continue
            except OSError:  # one end is gone
                return

    def stop(self):
        self.ended = True
        self.thread.join()
        os.close(self.scanner)
        self.machine.close()


class Lan:
    """What the machine's network card is plugged into: frames in datagrams, LCM messages in frames. Keeps what the firmware
    publishes, and passes on the odometry that is published outside."""

    def __init__(self, url):
        self.messages = {channel: [] for channel in TYPES}
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.05)
        self.parts = {}  # of fragmented packets
        self.machine = ("127.0.0.1", free_udp_port())
        self.sequence = 0
        self.ended = False
        self.outside = lcm.LCM(url)
        self.outside.subscribe("ALE_ODOMETRY", self._pass_on)
        self.threads = [threading.Thread(target=self._listen), threading.Thread(target=self._listen_outside)]
        with threads_as_hardware():
            for thread in self.threads:
                thread.start()

    @property
    def port(self):
        return self.socket.getsockname()[1]

    def _listen_outside(self):
        while not self.ended:
            self.outside.handle_timeout(50)

    def _pass_on(self, channel, data):
        self.sequence += 1
        message = struct.pack(">4sI", b"LC02", self.sequence) + channel.encode() + b"\0" + data
        self.socket.sendto(ROUTER + packet_to_group(message), self.machine)

    def _listen(self):
        while not self.ended:
            try:
                frame = self.socket.recv(65536)
            except socket.timeout:
                continue
            if len(frame) > 34 and frame[12:14] == b"\x08\x00" and frame[14] >> 4 == 4 and frame[23] == socket.IPPROTO_UDP:
                self._take_packet(frame[14:])

    def _take_packet(self, packet):
        length, number, fragment = struct.unpack_from(">HHH", packet, 2)
        body = packet[4 * (packet[0] & 15):length]
        offset, more = 8 * (fragment & 0x1FFF), bool(fragment & 0x2000)
        if offset or more:
            parts = self.parts.setdefault(number, {})
            parts[offset] = (body, more)
            body = joined(parts)
            if body is None:
                return
            del self.parts[number]
        if struct.unpack_from(">H", body, 2)[0] == LCM_PORT and body[8:12] == b"LC02":
            channel, _, data = body[16:].partition(b"\0")
            if channel.decode() in TYPES:
                self.messages[channel.decode()].append(TYPES[channel.decode()].decode(data))

    def stop(self):
        self.ended = True
        for thread in self.threads:
            thread.join()
        self.socket.close()


def packet_to_group(message):
    """An IPv4 packet with a datagram to LCM's group, from a neighbour of the machine."""
    datagram = struct.pack(">HHHH", LCM_PORT, LCM_PORT, 8 + len(message), 0) + message
    header = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(datagram), 0, 0, 1, socket.IPPROTO_UDP, 0,
                         socket.inet_aton("10.0.0.1"), socket.inet_aton(LCM_GROUP))
    total = sum(struct.unpack(">10H", header))
    total = (total & 0xFFFF) + (total >> 16)
    return header[:10] + struct.pack(">H", ~(total + (total >> 16)) & 0xFFFF) + header[12:] + datagram


def joined(parts):
    """The body out of its fragments, or None while some are missing."""
    body, more = b"", True
    while more:
        if len(body) not in parts:
            return None
        part, more = parts[len(body)]
        body += part
    return body
