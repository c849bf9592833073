"""Instructions of the costliest scans that can be found, beside the mean of the suite `urg`.

    hardest_table.py --build build [--steps N] [--seeds 1,2,3]

Evolution finds them (hardest.cpp); valgrind counts the instructions of ale_extract_scan. Every seed finds another
kind of scan, and every scan found is counted.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools/lab/bench"))
from callgrind import instructions  # noqa: E402


def instructions_a_scan(build, log, scans):
    collected, _ = instructions("ale_extract_scan", [build / "bin/ale-replay", log, "--lines-only", "--features", os.devnull])
    return collected / scans


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--steps", type=int, default=40000)
    parser.add_argument("--seeds", default="1,2,3")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([options.build / "bench/lines", "write", folder, "--noise", "urg", "--scans", "20"], check=True)
        scans = sum(1 for line in open(folder / "truth.jsonl", encoding="utf-8") if line.strip())
        mean = instructions_a_scan(options.build, folder / "scans.log", scans)
        print(f"mean of {scans} scans of the suite urg: {mean:.0f} instructions")
        for seed in options.seeds.split(","):
            log = folder / f"{seed}.log"
            found = json.loads(subprocess.run(
                [options.build / "bench/hardest", str(options.steps), seed, log],
                check=True, capture_output=True, text=True).stdout)
            hardest = instructions_a_scan(options.build, log, found["scans"])
            print(f"seed {seed}: {hardest:.0f} instructions, {hardest / mean:.2f} times the mean")
    return 0


if __name__ == "__main__":
    sys.exit(main())
