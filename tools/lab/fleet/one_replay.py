"""One task of ale-fleet replay: a log with one choice of settings through ale-replay."""
import pathlib
import re
import tempfile

from ale_fleet import distant, program

COUNTED = {"scans": r"(\d+) scans,", "dropped": r"(\d+) dropped", "lost": r"was lost in (\d+) scans", "weak": r"its pose weak in (\d+)",
           "pieces": r"there were (\d+) maps"}
RESULTS = ("scans", "dropped", "lost", "weak", "pieces", "ate_mm", "error")


def trajectory_error_mm(found_path, true_path):
    """Root mean square after the best rigid alignment, of the poses at times that the truth covers."""
    import numpy as np
    found, true = np.loadtxt(found_path, ndmin=2), np.loadtxt(true_path, ndmin=2)
    times = found[:, 0]
    covered = (times >= true[0, 0]) & (times <= true[-1, 0])
    here = (found[:, 1] + 1j * found[:, 2])[covered]
    there = np.interp(times, true[:, 0], true[:, 1])[covered] + 1j * np.interp(times, true[:, 0], true[:, 2])[covered]
    if len(here) < 2:
        raise ValueError("no pose at a time of the truth")
    here, there = here - here.mean(), there - there.mean()
    turn = np.angle(np.sum(there * here.conj()))
    return float(1e3 * np.sqrt(np.mean(np.abs(here * np.exp(1j * turn) - there) ** 2)))


def judged(poses, truth, folder):
    """What the table has of the truth."""
    try:
        return {"ate_mm": f"{trajectory_error_mm(poses, distant.fetched(truth, folder)):.2f}"}
    except (OSError, ValueError) as error:
        return {"error": f"{truth}: {distant.words_of(error)}"}


def counts(said):
    found = {name: re.search(pattern, said) for name, pattern in COUNTED.items()}
    return {name: match.group(1) if match else "1" if name == "pieces" else "0" for name, match in found.items()}


def replayed(replay, log, truth, settings):
    """The row of the table, and the picture of the map. What is wrong with the log or its truth is in the row; what happened to the
    machine is raised."""
    row = dict.fromkeys(RESULTS, "")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        poses, picture, config = folder / "poses.tum", folder / "map.png", folder / "settings.ini"
        program.write_configuration(settings, config)
        try:
            local = distant.fetched(log, folder)
        except OSError as error:
            return {**row, "error": distant.words_of(error)}, b""
        done = program.run(replay, local, "--config", config, "--trajectory", poses, "--map", picture)
        if done.returncode > 0:
            return {**row, "error": program.complaint(done, local)}, b""
        return {**row, **counts(done.stderr), **(judged(poses, truth, folder) if truth else {})}, picture.read_bytes()
