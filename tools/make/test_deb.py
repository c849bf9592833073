#!/usr/bin/env python3
"""Installs the Debian package, looks at what is there, removes it and purges it: test_deb.py PACKAGE.deb

All of it happens in a layer over this machine's file system, in a mount namespace of its own: the machine is not
touched. Needs root, for the layer. Exit 0 when everything is as it should be, 77 where no layer can be made.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
CONFIG = "/etc/ale-slam/ale-slamd.ini"
UNIT = "/usr/lib/systemd/system/ale-slamd.service"
STATE = "/var/lib/ale-slam"


class Layer:
    """A copy of this machine that remembers what was written to it."""

    def __init__(self, folder):
        self.upper = folder / "upper"
        self.root = folder / "root"
        for path in (self.upper, folder / "work", self.root):
            path.mkdir()
        subprocess.run(["mount", "-t", "overlay", "overlay", "-o",
                        f"lowerdir=/,upperdir={self.upper},workdir={folder / 'work'}", self.root], check=True)
        # Nothing of the machine's own is mounted where it could be written to.
        subprocess.run(["mount", "-t", "proc", "proc", self.root / "proc"], check=True)
        subprocess.run(["mount", "-t", "sysfs", "-o", "ro", "sysfs", self.root / "sys"], check=True)
        subprocess.run(["mount", "-t", "tmpfs", "tmpfs", self.root / "dev"], check=True)
        subprocess.run(["mknod", "-m", "666", self.root / "dev/null", "c", "1", "3"], check=True)

    def run(self, *words, code=0):
        done = subprocess.run(["chroot", self.root, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              check=False, env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"})
        assert done.returncode == code, f"{' '.join(map(str, words))}: {done.returncode}\n{done.stdout}"
        return done.stdout

    def has(self, path):
        return os.path.lexists(self.root / path.lstrip("/"))

    def traces(self):
        """What the package left behind, its own archive and the package manager's records apart."""
        kept = ("var/lib/dpkg", "var/log", "var/cache", "run", "tmp", "package.deb")
        found = (path.relative_to(self.upper) for path in self.upper.rglob("*ale*slam*"))
        return sorted(str(path) for path in found
                      if not str(path).startswith(kept) and os.path.lexists(self.root / path))


def install(layer):
    layer.run("dpkg", "--install", "/package.deb")
    assert "ale-slamd 0" in layer.run("ale-slamd", "--version")
    layer.run("ale-slamd", "--check-config", "--config", CONFIG)
    for older, now in (("ale-screen", "ale-watch"), ("ale-mounting", "ale-calibrate")):
        assert os.readlink(layer.root / "usr/bin" / older) == now, f"{older} is no link to {now}"
    assert layer.run("id", "-nG", "ale-slam").split() == ["ale-slam"]
    complaints = layer.run("systemd-analyze", "verify", UNIT)
    assert "ale-slamd" not in complaints, complaints
    rules = layer.run("udevadm", "test", "/sys/class/tty/tty0")
    assert "60-ale-slam.rules" in rules and not any("60-ale-slam.rules:" in line for line in rules.splitlines()), rules
    assert layer.has("/etc/systemd/system/multi-user.target.wants/ale-slamd.service"), "not enabled"
    listed = layer.run("dpkg", "--listfiles", "ale-slam").split("\n")
    assert all(layer.has(path) for path in listed if path), "a file of the package is not there"


def remove(layer):
    (layer.root / CONFIG[1:]).write_text("# mine\n", encoding="utf-8")
    (layer.root / STATE[1:]).mkdir(exist_ok=True)
    (layer.root / STATE[1:] / "kept.map").write_text("a map\n", encoding="utf-8")
    layer.run("dpkg", "--remove", "ale-slam")
    assert not layer.has("/usr/bin/ale-slamd") and not layer.has(UNIT)
    assert (layer.root / CONFIG[1:]).read_text(encoding="utf-8") == "# mine\n", "removing keeps the configuration"
    assert layer.has(f"{STATE}/kept.map"), "and the map"


def upgrade(layer):
    layer.run("dpkg", "--force-confold", "--install", "/package.deb")
    assert (layer.root / CONFIG[1:]).read_text(encoding="utf-8") == "# mine\n", "installing again keeps it too"


def purge(layer):
    layer.run("dpkg", "--purge", "ale-slam")
    assert layer.run("getent", "passwd", "ale-slam", code=2) == ""
    assert not layer.has("/etc/systemd/system/multi-user.target.wants/ale-slamd.service")
    assert layer.traces() == [], layer.traces()


def inside(folder, package):
    """In the mount namespace: everything below the folder is gone with it."""
    subprocess.run(["mount", "-t", "tmpfs", "tmpfs", folder], check=True)
    layer = Layer(folder)
    (layer.root / "package.deb").write_bytes(package.read_bytes())
    for step in (install, remove, upgrade, purge):
        step(layer)
        print(f"{step.__name__}: as it should be", flush=True)


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "--inside":
        inside(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
        return 0
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1]).is_file():
        print(__doc__.splitlines()[0], file=sys.stderr)
        return 2
    if os.geteuid() != 0:
        print("not root: no layer over the file system can be made", file=sys.stderr)
        return SKIPPED
    folder = tempfile.mkdtemp(prefix="ale-deb-")
    try:
        return subprocess.run(["unshare", "--mount", "--propagation", "private", sys.executable, __file__, "--inside",
                               folder, sys.argv[1]], check=False).returncode
    finally:
        os.rmdir(folder)  # what was mounted on it went with the namespace


if __name__ == "__main__":
    sys.exit(main())
