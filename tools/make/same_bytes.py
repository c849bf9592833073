#!/usr/bin/env python3
"""Builds ale-replay with other compilers and levels and compares what it writes, byte for byte.

    same_bytes.py --build build gcc:-O0 clang:-O3 ...

The reference is the ordinary build. Logs: the bundled world as the simulator writes it, and, where they
are at hand, recordings ($ALE_SHARED). Exit 0 when every digest agrees.
"""
import argparse
import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile

RESULTS = {"--features": "features.jsonl", "--poses": "poses.jsonl", "--trajectory": "final.tum",
           "--trajectory-live": "live.tum", "--save-map": "map.ale"}


def logs(build, folder):
    world = folder / "home.log"
    subprocess.run([build / "bin/ale-sim", "--world", "tools/worlds/home.world", "--seed", "1",
                    "--write-log", world], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    found = [world]
    shared = os.environ.get("ALE_SHARED")
    if shared:
        found += [pathlib.Path(shared) / "data/urg04lx/exp1.dat",
                  pathlib.Path(shared) / "data/other/malaga-one-loop.clf.gz"]
    return found


def digest(program, log, folder):
    """One digest a result file."""
    out = {option: folder / name for option, name in RESULTS.items()}
    subprocess.run([program, log, *(str(x) for pair in out.items() for x in pair)], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return {option: hashlib.sha256(path.read_bytes()).hexdigest() for option, path in out.items()}


def build_replay(build, compiler, level):
    other = build / f"same{level}-{compiler}"
    cxx = {"gcc": "g++", "clang": "clang++"}[compiler]
    program = other / "bin/ale-replay"
    subprocess.run(["make", "-s", "--no-print-directory", "-j2", f"BUILD={other}", f"CC={compiler}",
                    f"CXX={cxx}", f"OPT={level}", str(program)], check=True)
    return program


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("builds", nargs="+", metavar="COMPILER:LEVEL")
    args = parser.parse_args()
    differing = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        inputs = logs(args.build, folder)
        expected = {log: digest(args.build / "bin/ale-replay", log, folder) for log in inputs}
        again = {log: digest(args.build / "bin/ale-replay", log, folder) for log in inputs}
        programs = {spec: build_replay(args.build, *spec.split(":")) for spec in args.builds}
        runs = {"a second run": again}
        runs.update({spec: {log: digest(program, log, folder) for log in inputs}
                     for spec, program in programs.items()})
        for spec, results in runs.items():
            for log in inputs:
                wrong = [option for option in RESULTS if results[log][option] != expected[log][option]]
                print(f"{spec:14} {log.name:26} {'differs: ' + ' '.join(wrong) if wrong else 'the same bytes'}")
                differing += bool(wrong)
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
