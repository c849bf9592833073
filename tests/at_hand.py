"""Where things are: the tree, the programs under test, and recordings that may be there or not."""
import os
import pathlib
import random
import socket

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(os.environ.get("ALE_BUILD", ROOT / "build")).resolve()
BINARIES = BUILD / "bin"
WORLDS = ROOT / "tools/lab/worlds"
LONG = pytest.mark.long  # see conftest.py


def shared(name):
    """A file beside the project; the test is skipped where it is not."""
    folder = os.environ.get("ALE_SHARED", "")
    path = pathlib.Path(folder, name)
    if not folder or not path.exists():
        pytest.skip(f"{name} is not here (ALE_SHARED)")
    return path


def free_udp_port():
    """Above those that the kernel gives to whoever asks for any."""
    while True:
        port = random.randint(61000, 65500)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
            return port


def free_tcp_port():
    """Of this computer; nobody has it at the moment."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
