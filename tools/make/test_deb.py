#!/usr/bin/env python3
"""Installs the Debian packages, looks at what is there, removes them and purges them: test_deb.py FOLDER

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
UNITS = "/usr/lib/systemd/system"
UNIT = f"{UNITS}/ale-slamd.service"
STATE = "/var/lib/ale-slam"
PACKAGES = ("ale-slam", "ale-slam-tools", "libale-dev", "libale0")
MOST_BYTES = 20_000_000  # of all programs: without debug information it is a third of that
EXAMPLES = "/usr/share/doc/libale-dev/examples"


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
        """What the packages left behind, their own archives and the package manager's records apart."""
        kept = ("var/lib/dpkg", "var/log", "var/cache", "run", "tmp", "packages")
        found = (path.relative_to(self.upper) for path in self.upper.rglob("*ale*slam*"))
        return sorted(str(path) for path in found
                      if not str(path).startswith(kept) and os.path.lexists(self.root / path))


def packages(layer):
    return sorted(str(path.relative_to(layer.root)) for path in (layer.root / "packages").glob("*.deb"))


def one_package_of_the_release_before(layer):
    """Had everything in it; what is another package's now is given away."""
    folder = layer.root / "packages/before"
    for name in ("DEBIAN", "usr/bin", "usr/include/ale"):
        (folder / name).mkdir(parents=True)
    (folder / "DEBIAN/control").write_text("Package: ale-slam\nVersion: 0.1.0\nArchitecture: all\nMaintainer: a@b\nDescription: all\n")
    for name in ("usr/bin/ale-slamd", "usr/bin/ale-console", "usr/include/ale/ale.h"):
        (folder / name).write_text("of the release before\n")
    layer.run("dpkg-deb", "--root-owner-group", "--build", "/packages/before", "/packages/before/before.deb")
    layer.run("dpkg", "--install", "/packages/before/before.deb")


def install(layer):
    one_package_of_the_release_before(layer)
    layer.run("dpkg", "--auto-deconfigure", "--install", *packages(layer))  # as apt does
    assert "ale-slamd 0" in layer.run("ale-slamd", "--version") and "ale-console 0" in layer.run("ale-console", "--version")
    layer.run("ale-slamd", "--check-config", "--config", CONFIG)
    for older, now in (("ale-screen", "ale-watch"), ("ale-mounting", "ale-calibrate")):
        assert os.readlink(layer.root / "usr/bin" / older) == now, f"{older} is no link to {now}"
    assert layer.run("id", "-nG", "ale-slam").split() == ["ale-slam"]
    rules = layer.run("udevadm", "test", "/sys/class/tty/tty0")
    assert "60-ale-slam.rules" in rules and not any("60-ale-slam.rules:" in line for line in rules.splitlines()), rules
    for package in PACKAGES:
        listed = layer.run("dpkg", "--listfiles", package).split("\n")
        assert all(layer.has(path) for path in listed if path), f"a file of {package} is not there"


def services(layer):
    names = ("ale-slamd", "ale-console", "ale-bridge", "ale-odometry")
    complaints = layer.run("systemd-analyze", "verify", *(f"{UNITS}/{name}.service" for name in names))
    assert not any(name in complaints for name in names), complaints
    wanted = "/etc/systemd/system/multi-user.target.wants"
    assert layer.has(f"{wanted}/ale-slamd.service"), "not enabled"
    for name in names[1:]:
        assert not layer.has(f"{wanted}/{name}.service"), f"who wants {name} enables it"


def programs(layer):
    found = sorted((layer.root / "usr/bin").glob("ale-*"))
    assert len(found) > 12 and sum(path.lstat().st_size for path in found) < MOST_BYTES
    for path in found:
        if path.read_bytes().startswith(b"\x7fELF"):  # the others are Python
            sections = layer.run("readelf", "--section-headers", "--wide", f"/usr/bin/{path.name}")
            assert ".symtab" not in sections and ".debug" not in sections, f"{path.name} is not stripped"
        page = layer.run("man", "--pager=cat", path.name)
        assert "SYNOPSIS" in page and path.name in page, page


def library(layer):
    """The example, as somebody builds it who has the package."""
    layer.run("sh", "-c", f"cc {EXAMPLES}/lines.c $(pkg-config --cflags --libs libale) -lm -o /tmp/lines")
    assert "libale.so.0" in layer.run("readelf", "--dynamic", "/tmp/lines")
    assert "line beams" in layer.run("sh", "-c", f"/tmp/lines < {EXAMPLES}/room.txt")
    layer.run("python3", "-B", "-c", f"import sys; sys.path.insert(0, '{EXAMPLES}'); import ale_lines; ale_lines.Extractor()")


def documents(layer):
    for path in ("ale-slam/README.md", "ale-slam/firmware/deploy/README.md", "ale-slam-tools/tools/operator/console/README.md",
                 "ale-slam-tools/examples/ale_odometry.ino"):
        assert layer.has(f"/usr/share/doc/{path}"), path
    layer.run("ale-sim", "--world", "/usr/share/ale-slam/worlds/home.world", "--write-log", "/tmp/drive.log")
    layer.run("python3", "-B", "-c", "import sys; sys.path.insert(0, '/usr/share/ale-slam/python'); import ale; ale.pose_t().encode()")


def remove(layer):
    (layer.root / CONFIG[1:]).write_text("# mine\n", encoding="utf-8")
    (layer.root / STATE[1:]).mkdir(exist_ok=True)
    (layer.root / STATE[1:] / "kept.map").write_text("a map\n", encoding="utf-8")
    layer.run("dpkg", "--remove", *PACKAGES)
    assert not layer.has("/usr/bin/ale-slamd") and not layer.has("/usr/bin/ale-console") and not layer.has(UNIT)
    assert (layer.root / CONFIG[1:]).read_text(encoding="utf-8") == "# mine\n", "removing keeps the configuration"
    assert layer.has(f"{STATE}/kept.map"), "and the map"


def upgrade(layer):
    layer.run("dpkg", "--force-confold", "--install", *packages(layer))
    assert (layer.root / CONFIG[1:]).read_text(encoding="utf-8") == "# mine\n", "installing again keeps it too"


def purge(layer):
    layer.run("dpkg", "--purge", *PACKAGES)
    assert layer.run("getent", "passwd", "ale-slam", code=2) == ""
    assert not layer.has("/etc/systemd/system/multi-user.target.wants/ale-slamd.service")
    assert layer.traces() == [], layer.traces()


def inside(folder, archive):
    """In the mount namespace: everything below the folder is gone with it."""
    subprocess.run(["mount", "-t", "tmpfs", "tmpfs", folder], check=True)
    layer = Layer(folder)
    (layer.root / "packages").mkdir()
    for package in archive.glob("*.deb"):
        (layer.root / "packages" / package.name).write_bytes(package.read_bytes())
    for step in (install, services, programs, library, documents, remove, upgrade, purge):
        step(layer)
        print(f"{step.__name__}: as it should be", flush=True)


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "--inside":
        inside(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
        return 0
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1]).is_dir():
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
