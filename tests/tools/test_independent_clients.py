"""ale-sim is read by clients that are not ours, through their own parsers: every scan, and every point where it belongs.
A few seconds each, a minute with ALE_LONG_TESTS. They come from PyPI into a folder of their own."""
import json
import math
import os
import pathlib
import subprocess
import sys

import pytest

from at_hand import BINARIES, BUILD, free_tcp_port
from waiting import wait_until

PACKAGES = ["lds2d==0.7.0", "pyrplidarsdk==0.1.2", "hokuyolx==0.9.0"]
SECONDS = 60 if os.environ.get("ALE_LONG_TESTS") else 3
ROOM = [(-1.5, -1, 2.5, -1), (2.5, -1, 2.5, 2), (2.5, 2, -1.5, 2), (-1.5, 2, -1.5, -1)]
HERE = pathlib.Path(__file__).parent

# sensor, client, what it is told, scans a second, points a scan, largest error of a bearing that is told (degrees)
CLIENTS = [("ld06", "lds2d", "LD06", 10, 450, 0.02), ("stl-19p", "lds2d", "STL19P", 10, 500, 0.02),
           ("rplidar-a1", "lds2d", "RPLIDAR-A1", 10, 200, 0.02), ("rplidar-c1", "lds2d", "RPLIDAR-C1", 10, 500, 0.02),
           ("rplidar-a1", "pyrplidarsdk", "115200", 10, 400, 0.08), ("rplidar-a2", "pyrplidarsdk", "115200", 10, 400, 0.08),
           ("rplidar-s2", "pyrplidarsdk", "1000000", 10, 3200, 0.08), ("ust-10lx", "hokuyolx", None, 40, 1081, 0.001)]


@pytest.fixture(scope="session")
def python(tmp_path_factory):
    """The Python that has the clients."""
    folder = BUILD / "clients"
    interpreter = folder / "bin/python"
    if not (folder / "ready").exists():
        made = subprocess.run([sys.executable, "-m", "venv", folder], capture_output=True, check=False).returncode == 0
        got = made and subprocess.run([interpreter, "-m", "pip", "install", "-q", *PACKAGES], capture_output=True, check=False)
        if not got or got.returncode != 0:
            pytest.skip(f"{', '.join(PACKAGES)} cannot be had from PyPI")
        (folder / "ready").touch()
    return interpreter


def expected_mm(degrees):
    """From the middle of the world to the wall in that direction, clockwise from straight ahead."""
    c, s = math.cos(math.radians(-degrees)), math.sin(math.radians(-degrees))
    return 1000 * min([2.5 / c if c > 0 else -1.5 / c if c < 0 else math.inf,
                       2 / s if s > 0 else -1 / s if s < 0 else math.inf])


def tolerance_mm(degrees, bearing_error):
    around = [expected_mm(degrees + k * bearing_error) for k in (-1, 1)]
    return 1.6 + abs(around[0] - around[1])


@pytest.mark.parametrize("sensor, client, told, rate, points, bearing_error", CLIENTS,
                         ids=[f"{sensor}-{client}" for sensor, client, *_ in CLIENTS])
def test_every_scan_and_every_point_arrives(python, tmp_path, sensor, client, told, rate, points, bearing_error):
    world, link = tmp_path / "room.world", tmp_path / "scanner"
    world.write_text("".join(f"{' '.join(map(str, wall))}\n" for wall in ROOM))
    port = free_tcp_port()
    line = ["--tcp", str(port)] if client == "hokuyolx" else ["--pty", str(link)]
    simulator = subprocess.Popen([BINARIES / "ale-sim", "--world", world, "--sensor", sensor, "--noise", "none", "--no-odometry",
                                  *line], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        if client != "hokuyolx":
            wait_until(link.exists, 20, "the simulated scanner")
        result = subprocess.run([python, HERE / "independent_client.py", client, told or str(port), link, str(SECONDS)],
                                capture_output=True, text=True, timeout=SECONDS + 60, check=False)
    finally:
        simulator.terminate()
        simulator.communicate()
    assert result.stdout, result.stderr
    read = json.loads(result.stdout[result.stdout.index("{"):])
    scans = read["scans"][1:-1]
    assert abs(len(scans) - rate * read["seconds"]) <= 0.03 * rate * read["seconds"] + 3, "scans are missing"
    assert {abs(len(scan) - points) <= 0.02 * points + 1 for scan in scans} == {True}, [len(scan) for scan in scans]
    wrong = [(degrees, mm) for scan in scans for degrees, mm in scan
             if mm > 0 and abs(mm - expected_mm(degrees)) > tolerance_mm(degrees, bearing_error)]
    measured = sum(mm > 0 for scan in scans for _, mm in scan)
    assert measured > 0.9 * sum(map(len, scans))
    assert not wrong, wrong[:5]
