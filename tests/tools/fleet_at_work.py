"""ale-fleet over short drives of a robot through one home."""
import subprocess
import sys

from at_hand import BINARIES, WORLDS

SCANS = 60
LOGS = 4


def short_drives(folder):
    """Logs d0.log, d1.log ..., and the truth of each in truths."""
    log, truth = folder / "whole", folder / "truth"
    subprocess.run([BINARIES / "ale-sim", "--world", WORLDS / "home.world", "--write-log", log, "--truth", truth], check=True, capture_output=True)
    lines = log.read_text(encoding="ascii").splitlines(keepends=True)
    head, scans = [line for line in lines if line.startswith("#")], [line for line in lines if not line.startswith("#")]
    (folder / "truths").mkdir()
    for k in range(LOGS):
        (folder / f"d{k}.log").write_text("".join(head + scans[SCANS * k:SCANS * (k + 1)]), encoding="ascii")
        (folder / "truths" / f"d{k}.tum").write_bytes(truth.read_bytes())
    return folder


def script(path, text, program="ale-replay"):
    """A program in place of this one, which it becomes at its end."""
    path.write_text(f'#!/bin/sh\n{text}\nexec "{BINARIES}/{program}" "$@"\n', encoding="utf-8")
    path.chmod(0o755)
    return path


def gated(folder):
    """One that does d0.log at once and all others when the gate is there; the gate."""
    gate = folder / "gate"
    return script(folder / "replay", f'case "$1" in *d0.log) ;; *) while [ ! -e "{gate}" ]; do sleep 0.02; done;; esac'), gate


def fleet_words(*words):
    """By the Python of the tests, which knows packages of PyPI."""
    return [sys.executable, str(BINARIES / "ale-fleet"), *map(str, words)]


def said_by(*words, code=0, **how):
    done = subprocess.run(fleet_words(*words), capture_output=True, text=True, check=False, **how)
    assert done.returncode == code, done.stderr
    return done.stderr
