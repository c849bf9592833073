"""The disk of a virtual robot PC: Debian with systemd, and the packages of this build installed by apt.

Made by debootstrap once and kept in the build folder; the packages are new each time. It boots into systemd, or, with the kernel's
word `init=PROGRAM`, into a program of its own.
"""
import os
import pathlib
import shutil
import subprocess
import tempfile

from at_hand import BUILD
from virtual_machine import CACHE, Machine, NoMachine, initramfs

PACKAGES = BUILD / "packages"
MOST_BYTES = "1G"
DEBIAN = CACHE / "debian"
WITH = "systemd,systemd-sysv,udev,iproute2,kmod"
FIRST = ("virtio_pci", "virtio_blk", "ext4")  # before there is a disk
INIT = """#!/bin/busybox sh
/bin/busybox mkdir -p /proc /dev /disk
/bin/busybox mount -t proc proc /proc
/bin/busybox mount -t devtmpfs dev /dev
for module in {modules}; do /bin/busybox insmod /modules/$module; done
until [ -e /dev/vda ]; do /bin/busybox sleep 0.05; done
/bin/busybox mount -t ext4 /dev/vda /disk
/bin/busybox mount --move /dev /disk/dev
next=/lib/systemd/systemd
for word in $(/bin/busybox cat /proc/cmdline); do
    case $word in init=*) next=${{word#init=}} ;; esac
done
/bin/busybox umount /proc
exec /bin/busybox switch_root /disk $next
"""


def archive_of_debian():
    """Where this computer's own Debian comes from, and its name."""
    words = ["apt-get", "indextargets", "--format", "$(REPO_URI) $(CODENAME)", "Created-By: Packages", "Component: main", "Origin: Debian"]
    found = subprocess.run(words, capture_output=True, text=True, check=False).stdout.split("\n")
    plain = [line.split() for line in found if len(line.split()) == 2 and "-" not in line.split()[1] and "security" not in line]
    if not plain:
        raise NoMachine("apt knows no archive of Debian")
    return plain[0]


def fetch_debian():
    """A small Debian in a folder, kept."""
    if os.geteuid() != 0 or not shutil.which("debootstrap"):
        raise NoMachine("a disk is laid out by root, with debootstrap")
    if not DEBIAN.exists():
        CACHE.mkdir(parents=True, exist_ok=True)
        address, name = archive_of_debian()
        with tempfile.TemporaryDirectory(dir=CACHE) as folder:
            done = subprocess.run(["debootstrap", "--variant=minbase", f"--include={WITH}", name, f"{folder}/kept", address],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            if done.returncode != 0:
                raise NoMachine(f"debootstrap: {done.stdout[-300:]}")
            pathlib.Path(f"{folder}/kept").rename(DEBIAN)
    return DEBIAN


class Disk:
    """A disk of a robot of its own, in a folder. prepare(root) lays files onto it before it is closed."""

    def __init__(self, folder, kernel, prepare):
        self.kernel = kernel
        self.path = folder / "disk"
        self.first = folder / "initramfs.gz"
        root = folder / "root"
        subprocess.run(["cp", "-a", fetch_debian(), root], check=True)
        self._install_packages(root)
        self._install_modules(root)
        prepare(root)
        subprocess.run(["mke2fs", "-q", "-t", "ext4", "-d", root, self.path, MOST_BYTES], check=True, stdout=subprocess.DEVNULL)
        shutil.rmtree(root)

    @staticmethod
    def _install_packages(root):
        """As the README says: apt install ./*.deb"""
        (root / "packages").mkdir()
        for package in PACKAGES.glob("ale-slam*.deb"):
            shutil.copy(package, root / "packages")
        run_in(root, "apt-get", "-q", "update")
        run_in(root, "sh", "-c", "apt-get install -q -y --no-install-recommends /packages/*.deb")
        run_in(root, "apt-get", "clean")

    def _install_modules(self, root):
        version = self.kernel.version
        shutil.copytree(self.kernel.modules, root / "lib/modules" / version)
        run_in(root, "depmod", version)
        wanted = run_in(root, "modprobe", "--set-version", version, "--show-depends", "--all", *FIRST)
        paths = dict.fromkeys(line.split()[1] for line in wanted.splitlines() if line.startswith("insmod"))
        files = {f"modules/{pathlib.Path(path).name}": ((root / path.lstrip("/")).read_bytes(), 0o644) for path in paths}
        initramfs(self.first, INIT.format(modules=" ".join(pathlib.Path(path).name for path in paths)), files)

    def boot(self, folder, *parts, words=""):
        """A machine that runs from this disk; its own files lie in a folder of its own."""
        folder.mkdir()
        return Machine(folder, self.kernel, self.first, "-drive", f"file={self.path},format=raw,if=virtio", *parts, words=words)


    def files(self, folder, *paths):
        """Copies of what the next start finds, by their paths below the folder: the journal of the file system is played back, on
        a copy of the disk."""
        folder.mkdir()
        copy = folder / "disk"
        subprocess.run(["cp", "--sparse=always", self.path, copy], check=True)
        repaired = subprocess.run(["e2fsck", "-p", copy], check=False, stdout=subprocess.PIPE, text=True)
        assert repaired.returncode <= 1, repaired.stdout
        for path in paths:
            parent = (folder / path.lstrip("/")).parent
            parent.mkdir(parents=True, exist_ok=True)
            subprocess.run(["debugfs", "-R", f"rdump {path} {parent}", copy], check=True, stderr=subprocess.DEVNULL)
        copy.unlink()
        return folder


def lay(root, path, text, mode=0o644):
    """A file onto a disk that is being made."""
    there = root / path.lstrip("/")
    there.parent.mkdir(parents=True, exist_ok=True)
    there.write_text(text, encoding="utf-8")
    there.chmod(mode)


def run_in(root, *words):
    """What a program of the disk says."""
    done = subprocess.run(["chroot", root, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive", "LC_ALL": "C"})
    assert done.returncode == 0, f"{' '.join(words)}: {done.returncode}\n{done.stdout}"
    return done.stdout
