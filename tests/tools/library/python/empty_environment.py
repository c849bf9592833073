"""A virtual environment of Python with what a user would install, and nothing of the tree."""
import os
import subprocess
import sys

import pytest


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=900,
                          **options)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


def alone(folder):
    """Without the tests' PYTHONPATH, where the messages of LCM are a package `ale`, too."""
    return {"PATH": os.environ["PATH"], "MPLBACKEND": "Agg", "HOME": str(folder)}


def environment(folder, *packages):
    """An empty one with these of PyPI; the test is skipped where they cannot be had."""
    run(sys.executable, "-m", "venv", folder)
    done = subprocess.run([folder / "bin/pip", "install", "-q", "--disable-pip-version-check", *packages], capture_output=True, text=True,
                          check=False)
    if done.returncode:
        pytest.skip(f"PyPI cannot be had here: {done.stderr.strip().splitlines()[-1]}")
    return folder / "bin/python"
