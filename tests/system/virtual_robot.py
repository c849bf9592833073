"""A virtual robot PC: Debian's PREEMPT_RT kernel in qemu, an initramfs with ale-slamd as deployed, and what hangs on it.

    ale-sim ── pty ── Line ── UART of the machine (ttyS1) ── ale-slamd ── LCM ── network card ── Lan
       │               └ can be pulled                                          └ frames, read and written here
       └───── odometry (LCM) ───────────────────────────────────────────────────► Lan

The kernel is taken out of its Debian package, which is not installed. The machine is emulated in software, with one processor:
half of its time goes into the UART's interrupts, and the other processor of a small computer is left to who emulates the UART.
"""
import gzip
import os
import pathlib
import select
import signal
import socket
import stat
import struct
import subprocess
import threading
import time

import lcm

from at_hand import BINARIES, BUILD, ROOT, free_udp_port
from chain import TYPES
from priority import as_own_processor, threads_as_hardware
from waiting import wait_until

CACHE = BUILD / "hil-vm"
DEPLOYED = ROOT / "firmware" / "deploy" / "ale-slamd.ini"
WIRE_BYTES = 256
LCM_GROUP = "239.255.76.67"
LCM_PORT = 7667
# To the group's own address of Ethernet, from an address of the kind that anyone may give.
ROUTER = bytes.fromhex("01005e7f4c43" "020000000001" "0800")
NETWORK_CARD = "kernel/drivers/net/ethernet/intel/e1000/e1000.ko"

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


class NoMachine(Exception):
    """What this computer lacks for it."""


def fetch_kernel():
    """Kernel and network card's module of Debian's PREEMPT_RT kernel: two paths, kept in the build folder."""
    kernel, module = CACHE / "vmlinuz", CACHE / "e1000.ko"
    if kernel.exists() and module.exists():
        return kernel, module
    CACHE.mkdir(parents=True, exist_ok=True)
    depends = subprocess.run(["apt-cache", "depends", "linux-image-rt-amd64"], capture_output=True, text=True, check=False)
    package = next((line.split()[-1] for line in depends.stdout.splitlines() if "Depends: linux-image" in line), None)
    if not package or subprocess.run(["apt-get", "download", "-q", package], cwd=CACHE, capture_output=True,
                                     check=False).returncode != 0:
        raise NoMachine("Debian's package linux-image-rt-amd64 cannot be downloaded")
    archive = next(CACHE.glob(f"{package}_*.deb"))
    with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", archive], stdout=subprocess.PIPE) as files:
        subprocess.run(["tar", "-x", "--wildcards", "./boot/vmlinuz-*", f"./lib/modules/*/{NETWORK_CARD}"],
                       stdin=files.stdout, cwd=CACHE, check=True)
    next(CACHE.glob("boot/vmlinuz-*")).rename(kernel)
    next(CACHE.glob(f"lib/modules/*/{NETWORK_CARD}")).rename(module)
    archive.unlink()
    return kernel, module


def libraries(program):
    """Shared libraries of a program, the loader among them."""
    told = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    return [word for line in told.splitlines() for word in line.split() if word.startswith("/")]


def initramfs(path, module):
    """A compressed archive (cpio, newc) that the kernel unpacks as its root."""
    firmware = BINARIES / "ale-slamd"
    files = {"init": (INIT.encode(), 0o755), "e1000.ko": (module.read_bytes(), 0o644),
             "etc/ale-slamd.ini": (DEPLOYED.read_bytes(), 0o644),
             "bin/ale-slamd": (firmware.read_bytes(), 0o755),
             "bin/busybox": (pathlib.Path("/bin/busybox").read_bytes(), 0o755)}
    for library in libraries(firmware):
        files[library.lstrip("/")] = (pathlib.Path(library).read_bytes(), 0o755)
    folders = sorted({str(parent) for name in files for parent in pathlib.PurePath(name).parents} - {"."})
    with gzip.open(path, "wb", compresslevel=1) as archive:
        for name in folders:
            write_entry(archive, name, b"", stat.S_IFDIR | 0o755)
        # A console is there before anything is mounted.
        write_entry(archive, "dev", b"", stat.S_IFDIR | 0o755)
        write_entry(archive, "dev/console", b"", stat.S_IFCHR | 0o600, device=(5, 1))
        for name, (content, mode) in files.items():
            write_entry(archive, name, content, stat.S_IFREG | mode)
        write_entry(archive, "TRAILER!!!", b"", 0)


def write_entry(archive, name, content, mode, device=(0, 0)):
    encoded = name.encode() + b"\0"
    fields = (0, mode, 0, 0, 1, 0, len(content), 0, 0, *device, len(encoded), 0)
    header = b"070701" + b"".join(b"%08x" % field for field in fields)
    archive.write(header + encoded + b"\0" * (-(len(header) + len(encoded)) % 4))
    archive.write(content + b"\0" * (-len(content) % 4))


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


class Machine:
    """The virtual robot PC, running from its creation to stop()."""

    def __init__(self, folder, kernel, module, lan):
        self.log = folder / "console.log"
        self.uart = folder / "uart"
        console = folder / "console"
        initramfs(folder / "initramfs.gz", module)
        self.process = subprocess.Popen([
            "qemu-system-x86_64", "-accel", "tcg", "-smp", "1", "-m", "512", "-nodefaults", "-no-reboot", "-display", "none",
            "-kernel", kernel, "-initrd", folder / "initramfs.gz", "-append", "console=ttyS0 quiet panic=-1",
            "-chardev", f"socket,id=console,path={console},server=on,wait=off,logfile={self.log}", "-serial", "chardev:console",
            "-chardev", f"socket,id=scanner,path={self.uart},server=on,wait=off", "-serial", "chardev:scanner",
            "-netdev", f"dgram,id=lan,local.type=inet,local.host=127.0.0.1,local.port={lan.machine[1]},"
                       f"remote.type=inet,remote.host=127.0.0.1,remote.port={lan.port}",
            "-device", "e1000,netdev=lan"], stdin=subprocess.DEVNULL, preexec_fn=as_own_processor)
        wait_until(lambda: console.exists() and self.uart.exists() or not self.running(), 180, "the virtual machine")
        self.console = socket.socket(socket.AF_UNIX)
        self.console.connect(str(console))
        self.reader = threading.Thread(target=self._drain)
        self.reader.start()

    def _drain(self):
        """A console that nobody reads stops the machine when it is full; what it says is in the log."""
        while self.console.recv(4096):
            pass

    def running(self):
        return self.process.poll() is None

    def said(self):
        return self.log.read_text(encoding="utf-8", errors="replace") if self.log.exists() else ""

    def order(self, *words):
        self.console.sendall(" ".join(map(str, words)).encode() + b"\n")

    def stop(self):
        if self.running():
            self.process.send_signal(signal.SIGTERM)
        self.process.wait(timeout=180)
        self.reader.join()
        self.console.close()


def set_clock(machine):
    """Gives the machine the time of day, in the place of NTP: at the turn of a second, to some hundredths."""
    second = int(time.time()) + 2
    time.sleep(max(0, second - time.time()))
    machine.order("clock", second)


def pause(seconds):
    """Lets a fault last."""
    time.sleep(seconds)
