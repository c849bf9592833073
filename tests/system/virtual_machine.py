"""A virtual PC: Debian's PREEMPT_RT kernel in qemu, emulated in software.

The kernel is taken out of its Debian package, which is not installed. The machine has one processor: half of its time goes into
the scanner's line, and the other processor of a small computer is left to who emulates the scanner.
"""
import gzip
import os
import pathlib
import shutil
import signal
import socket
import stat
import subprocess
import tempfile
import threading
import time

import pytest

from at_hand import BUILD
from priority import as_own_processor
from waiting import wait_until

CACHE = BUILD / "hil-vm"
BUSYBOX = pathlib.Path("/bin/busybox")
# Of the kernel's modules: disk, network card, USB and its serial converters, and what these stand on.
MODULES = ("fs/autofs", "fs/ext4", "fs/jbd2", "fs/mbcache.ko", "lib", "crypto", "drivers/block/virtio_blk.ko", "drivers/virtio",
           "drivers/net/ethernet/intel/e1000", "drivers/usb/core", "drivers/usb/common", "drivers/usb/host", "drivers/usb/serial")


class NoMachine(Exception):
    """What this computer lacks for it."""


class Kernel:
    """What was taken out of the package."""

    def __init__(self, folder):
        self.image = next(folder.glob("boot/vmlinuz-*"))
        self.modules = next(folder.glob("lib/modules/*"))
        self.version = self.modules.name

    def module(self, name):
        return next(self.modules.rglob(f"{name}.ko"))


def fetch_kernel():
    """Debian's PREEMPT_RT kernel, kept in the build folder."""
    folder = CACHE / "kernel"
    if not folder.exists():
        depends = subprocess.run(["apt-cache", "depends", "linux-image-rt-amd64"], capture_output=True, text=True, check=False)
        package = next((line.split()[-1] for line in depends.stdout.splitlines() if "Depends: linux-image" in line), None)
        CACHE.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=CACHE) as name:
            unpack_kernel(package, pathlib.Path(name))
            (pathlib.Path(name) / "kept").rename(folder)
    return Kernel(folder)


def unpack_kernel(package, folder):
    """Into its folder `kept`; the modules are a few of thousands."""
    if not package or subprocess.run(["apt-get", "download", "-q", package], cwd=folder, capture_output=True,
                                     check=False).returncode != 0:
        raise NoMachine("Debian's package linux-image-rt-amd64 cannot be downloaded")
    (folder / "kept").mkdir()
    wanted = ["./boot/vmlinuz-*", "./lib/modules/*/modules.order", "./lib/modules/*/modules.builtin*",
              *(f"./lib/modules/*/kernel/{module}*" for module in MODULES)]
    with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", next(folder.glob("*.deb"))], stdout=subprocess.PIPE) as files:
        subprocess.run(["tar", "-x", "--wildcards", *wanted], stdin=files.stdout, cwd=folder / "kept", check=True)


def need_machine():
    """The kernel, or a test that is skipped, with the reason."""
    if not shutil.which("qemu-system-x86_64"):
        pytest.skip("no qemu-system-x86_64 here")
    try:
        return fetch_kernel()
    except NoMachine as error:
        pytest.skip(str(error))


def initramfs(path, init, files):
    """A compressed archive (cpio, newc) that the kernel unpacks as its root: the script init, busybox, and more files, each as
    where to, what, and its mode."""
    files = {"init": (init.encode(), 0o755), "bin/busybox": (BUSYBOX.read_bytes(), 0o755), **files}
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


class Machine:
    """Running from its creation to stop(), or to cut(). parts: more of qemu's words."""

    def __init__(self, folder, kernel, root, *parts, words=""):
        self.log = folder / "console.log"
        self.monitor = folder / "monitor"
        console = folder / "console"
        self.process = subprocess.Popen([
            "qemu-system-x86_64", "-accel", "tcg", "-smp", "1", "-m", "512", "-nodefaults", "-no-reboot", "-display", "none",
            "-kernel", kernel.image, "-initrd", root, "-append", f"console=ttyS0 quiet panic=-1 {words}",
            "-chardev", f"socket,id=console,path={console},server=on,wait=off,logfile={self.log}", "-serial", "chardev:console",
            "-monitor", f"unix:{self.monitor},server=on,wait=off", *map(str, parts)],
            stdin=subprocess.DEVNULL, preexec_fn=as_own_processor)
        wait_until(lambda: console.exists() and self.monitor.exists() or not self.running(), 180, "the virtual machine")
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

    def wait_for(self, words, seconds):
        wait_until(lambda: words in self.said() or not self.running(), seconds, f"{words} on the machine's console")
        assert self.running(), self.said()

    def order(self, *words):
        """Types a line."""
        self.console.sendall(" ".join(map(str, words)).encode() + b"\n")

    def rebuild(self, *words):
        """Plugs something in, or pulls it: a word to qemu's monitor."""
        with socket.socket(socket.AF_UNIX) as monitor:
            monitor.connect(str(self.monitor))
            until_prompt(monitor)
            monitor.sendall(" ".join(map(str, words)).encode() + b"\n")
            until_prompt(monitor)

    def cut(self):
        """The power goes. What the machine had not written to its disk is gone."""
        self.process.kill()
        self._gone()

    def stop(self):
        if self.running():
            self.process.send_signal(signal.SIGTERM)
        self._gone()

    def _gone(self):
        self.process.wait(timeout=180)
        self.reader.join()
        self.console.close()


def until_prompt(monitor):
    """qemu's monitor has done what it was told, or is there at all."""
    said = b""
    while not said.endswith(b"(qemu) "):
        said += monitor.recv(4096)


def set_clock(machine, order):
    """Gives the machine the time of day, in the place of NTP: at the turn of a second, to some hundredths. order: what is typed
    before the seconds."""
    second = int(time.time()) + 2
    time.sleep(max(0, second - time.time()))
    machine.order(f"{order}{second}")


def pause(seconds):
    """Lets a fault last."""
    time.sleep(seconds)


def libraries(program):
    """Shared libraries of a program, the loader among them."""
    told = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    return [word for line in told.splitlines() for word in line.split() if word.startswith("/")]
