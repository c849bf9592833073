"""One task of ale-fleet: a log with one choice of settings through ale-replay. It travels to the worker as it is, so that nothing but
ale-replay, numpy and fsspec need be there."""
import pathlib
import re
import subprocess
import tempfile

COUNTED = {"scans": r"(\d+) scans,", "dropped": r"(\d+) dropped", "lost": r"was lost in (\d+) scans", "weak": r"its pose weak in (\d+)",
           "pieces": r"there were (\d+) maps"}
RESULTS = ("scans", "dropped", "lost", "weak", "pieces", "ate_mm", "error")


class Broken(Exception):
    """The program was ended from outside: worth another try, elsewhere."""


def fetched(path, folder):
    """A file here, from wherever fsspec knows the way."""
    import fsspec
    local = pathlib.Path(folder) / pathlib.PurePosixPath(path).name
    with fsspec.open(path, "rb") as source:
        local.write_bytes(source.read())
    return local


def configuration(settings, path):
    """The file of section.key=value words."""
    sections = {}
    for name, value in settings:
        section, key = name.split(".", 1)
        sections.setdefault(section, []).append(f"{key} = {value}")
    path.write_text("".join(f"[{section}]\n" + "\n".join(lines) + "\n" for section, lines in sections.items()), encoding="utf-8")
    return path


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


def replayed(program, log, truth, settings):
    """The row of the table, and the picture of the map. What is wrong with the log or its truth is in the row; what happened to the
    machine is raised."""
    row = dict.fromkeys(RESULTS, "")
    with tempfile.TemporaryDirectory() as folder:
        poses, picture = pathlib.Path(folder) / "poses.tum", pathlib.Path(folder) / "map.png"
        try:
            local = fetched(log, folder)
            config = configuration(settings, pathlib.Path(folder) / "settings.ini")
        except OSError as error:
            return {**row, "error": f"{log}: {error.strerror or error}"}, b""
        done = subprocess.run([program, local, "--config", config, "--trajectory", poses, "--map", picture],
                              stderr=subprocess.PIPE, text=True, errors="replace", check=False)
        if done.returncode < 0:
            raise Broken(f"{program} ended by signal {-done.returncode}")
        if done.returncode > 0:
            return {**row, "error": done.stderr.strip().splitlines()[-1].replace(f"{folder}/", "")}, b""
        for name, pattern in COUNTED.items():
            found = re.search(pattern, done.stderr)
            row[name] = found.group(1) if found else "1" if name == "pieces" else "0"
        if truth:
            try:
                row["ate_mm"] = f"{trajectory_error_mm(poses, fetched(truth, folder)):.2f}"
            except (OSError, ValueError) as error:
                row["error"] = f"{truth}: {getattr(error, 'strerror', None) or error}"
        return row, picture.read_bytes()
