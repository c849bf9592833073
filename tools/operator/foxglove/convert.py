"""Recordings turned into each other: LCM logs, .scip recordings, MCAP, bags of ROS, and every log that ale-replay reads.

    convert("drive.scip", "drive.mcap")

An MCAP that is made here holds, beside what Foxglove shows, the recording that it was made of, as an attachment: turned back it
is the same, byte for byte.
"""
import contextlib
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from . import bags, lcm_log, scip_file
from .near import Missing, program

SCIP = b"ALESCIP1"
ATTACHED = "original"
SECONDS_A_GRID = 10  # a whole map each
MEDIA = {".scip": "application/x-ale-scip", ".lcm": "application/x-lcm-log"}


class CannotConvert(RuntimeError):
    """Why not."""


def kind_of(path):
    """By content: .lcm, .scip, .mcap, a bag, or another log."""
    path = pathlib.Path(path)
    if not path.exists():
        raise CannotConvert(f"{path}: no such file or folder")
    if bags.is_mcap(path):
        return ".mcap"
    if bags.is_bag(path):
        return "bag"
    if path.is_file() and bags.starts_with(path, SCIP):
        return ".scip"
    return ".lcm" if path.is_file() and lcm_log.is_log(path) else "other"


def replayed(path, out):
    """What the robot would have published, by the firmware's code: scans, odometry, poses, lines, the map."""
    done = subprocess.run([program("ale-replay"), str(path), "--lcm", str(out)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, errors="replace", check=False)
    if done.returncode != 0:
        raise CannotConvert((done.stderr.strip().splitlines() or ["ale-replay fails without a word"])[-1].removeprefix("ale-replay: "))


@contextlib.contextmanager
def readable(path):
    """What the readers of others say of a file that is damaged, in one line."""
    try:
        yield
    except (Missing, CannotConvert):
        raise
    except Exception as error:  # theirs have no class in common
        raise CannotConvert(f"{path}: {' '.join(str(error).split()) or type(error).__name__}") from error


def attachment(path):
    """(ending, bytes) of the recording that an MCAP was made of, or None."""
    with open(path, "rb") as file, readable(path):
        for each in bags.needed("mcap.reader").make_reader(file).iter_attachments():
            if each.name.startswith(ATTACHED) and pathlib.Path(each.name).suffix in MEDIA:
                return pathlib.Path(each.name).suffix, each.data
    return None


def has_poses(path):
    return any(event.channel == "ALE_POSE" for event in lcm_log.events(path))


class Recording:
    """A recording as an LCM log, whatever it is."""

    def __init__(self, path, folder):
        self.path, self.kind = pathlib.Path(path), kind_of(path)
        self.folder = pathlib.Path(folder)
        self.original = (self.kind, self.path) if self.kind in MEDIA else None
        attached = attachment(path) if self.kind == ".mcap" else None
        if attached:
            self.kind, self.path = attached[0], self.folder / f"attached{attached[0]}"
            self.path.write_bytes(attached[1])
            self.original = (self.kind, self.path)

    def as_sent(self):
        """Only what came from the robot or its sensors."""
        if self.kind == ".lcm":
            return self.path
        out = self.folder / "sent.lcm"
        if self.kind in ("bag", ".mcap"):
            with lcm_log.Writer(out) as log, readable(self.path):
                for event in bags.events(self.path):
                    log.put(*event)
            if out.stat().st_size == 0:
                raise CannotConvert(f"{self.path}: no LaserScan and no Odometry in it")
        else:
            replayed(self.path, out)
        return out

    def with_poses(self):
        """With poses, lines and the map, which are worked out where a recording has none."""
        sent = self.as_sent()
        if has_poses(sent):
            return sent
        out = self.folder / "replayed.lcm"
        replayed(sent, out)
        return out


def write_mcap(recording, out):
    try:
        import foxglove

        from .cells import Cells
        from .names import Names
        from .scene import Scene
    except ImportError as error:
        raise Missing("MCAP is written by Python's package foxglove-sdk: pip install foxglove-sdk") from error
    context = foxglove.Context()
    scene = Scene(context)
    with foxglove.open_mcap(str(out), context=context, allow_overwrite=True) as file:
        with Cells(context, Names(), SECONDS_A_GRID) as cells:
            for event in lcm_log.events(recording.with_poses()):
                scene.take(event.channel, event.data)
                cells.take(event.channel, event.data)
        if cells.failed:
            raise CannotConvert(cells.failed)
        kind, path = recording.original or (".lcm", recording.as_sent())
        now = time.time_ns()
        file.attach(log_time=now, create_time=now, name=ATTACHED + kind, media_type=MEDIA[kind], data=path.read_bytes())


def write(recording, out):
    kind = out.suffix.lower()
    if recording.original and recording.original[0] == kind:
        shutil.copyfile(recording.original[1], out)
    elif kind == ".mcap":
        write_mcap(recording, out)
    elif kind == ".scip":
        scip_file.write(lcm_log.events(recording.as_sent()), out)
    else:
        shutil.copyfile(recording.as_sent(), out)


def convert(source, out):
    """The ending of out says what it becomes: .mcap, .scip, .lcm."""
    out = pathlib.Path(out)
    if out.suffix.lower() not in (".mcap", *MEDIA):
        raise CannotConvert(f"{out}: a name that ends in .mcap, .scip or .lcm says what it is to be")
    if out.exists() and out.resolve() == pathlib.Path(source).resolve():
        raise CannotConvert(f"{out}: would take the place of what it is made of")
    begun = out.with_name(f".{out.name}.part")
    with tempfile.TemporaryDirectory(prefix="ale-foxglove-") as folder:
        try:
            part = pathlib.Path(folder) / out.name
            write(Recording(source, folder), part)
            shutil.copyfile(part, begun)
            begun.replace(out)
        finally:
            with contextlib.suppress(FileNotFoundError):
                begun.unlink()
    print(f"ale-foxglove: {out}", file=sys.stderr)
