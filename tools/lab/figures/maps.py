#!/usr/bin/env python3
"""A page of maps: every recording through ale-replay, drawn with the points of its scans behind the lines.

    maps.py --replay build/bin/ale-replay --out build/maps LOG...

Writes a picture a log and README.md, which shows them with what ale-replay says of each. A log that cannot be read, or
holds no scan, is named there with the reason. Exit 1 when nothing could be drawn.
"""
import argparse
import pathlib
import subprocess
import sys


def draw(replay, log, picture):
    """What ale-replay says of the log, and whether there is a picture now."""
    done = subprocess.run([replay, log, "--map", picture, "--points"], capture_output=True, text=True, check=False)
    words = [line.replace(f"{log}: ", "").replace("ale-replay: ", "") for line in done.stderr.splitlines()]
    return " · ".join(words), done.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--replay", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("logs", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    page, drawn = ["# Maps of the recordings", ""], 0
    for log in options.logs:
        name = log.name.split(".")[0]
        picture = options.out / f"{name}.png"
        words, fine = draw(options.replay, log, picture)
        drawn += fine
        page += [f"## {name}", "", words, ""] + ([f"![{name}]({picture.name})", ""] if fine else [])
        print(f"{name:20} {words}", flush=True)
    (options.out / "README.md").write_text("\n".join(page))
    return 0 if drawn else 1


if __name__ == "__main__":
    sys.exit(main())
