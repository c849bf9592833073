#!/usr/bin/env python3
"""The same bytes everywhere: what ale-replay writes, compared between builds, and with the digests in the tree.

    digest.py [--build build] check [--quick] [COMPILER:LEVEL | ARCHITECTURE | PROGRAM]...
    digest.py [--build build] update

check runs ale-replay twice, or builds it again with each compiler and level (gcc:-O0, clang:-O3) or for each other architecture
(aarch64, armhf, s390x: run under qemu-user; their libraries as `make cross-libraries` laid them out), or takes one that
is built (a path), holds what it writes against the ordinary build byte for byte, and then the ordinary build against
tests/digest/digests.txt: one digest a log, of features and live trajectory; --quick does so with two logs of a URG-04LX, other
machines alone with four logs.
update writes those digests anew.

Logs: the recordings in tests/digest, and those of $ALE_SHARED/data where they are at hand.
"""
import argparse
import concurrent.futures
import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile

STORED = pathlib.Path("tests/digest/digests.txt")
COMPARED = {"--features": "features.jsonl", "--poses": "poses.jsonl", "--trajectory": "final.tum",
            "--trajectory-live": "live.tum", "--save-map": "map.ale"}
IN_DIGEST = ("--features", "--trajectory-live")
SHARED_LOGS = ("urg04lx/*.dat", "urg04lx/*.scan.gz", "other/*.gz", "corrected/*.clf.gz", "intel/*.clf.gz",
               "killian/*.clf.gz")
# Emulated machines are twenty times slower: a URG-04LX, a SICK with odometry, a scanner without.
EMULATED_LOGS = ("apartment.log.gz", "exp1.dat", "malaga-one-loop.clf.gz", "loop5.log.gz")
QUICK_LOGS = ("apartment.log.gz", "exp1.dat")
ARCHITECTURES = {"aarch64": "qemu-aarch64", "armhf": "qemu-arm", "s390x": "qemu-s390x"}
COMPILERS = {"gcc": "g++", "clang": "clang++"}


def logs():
    """Name in the list of digests -> file."""
    found = {path.name: path for path in sorted(STORED.parent.glob("*.log.gz"))}
    shared = os.environ.get("ALE_SHARED")
    for pattern in SHARED_LOGS if shared else ():
        found.update((path.name, path) for path in sorted((pathlib.Path(shared) / "data").glob(pattern)))
    return found


def replay(command, log):
    """Digest of each result, and under the name `digest` that of what is kept in the tree."""
    with tempfile.TemporaryDirectory() as folder:
        out = {option: pathlib.Path(folder) / name for option, name in COMPARED.items()}
        subprocess.run([*command, log, *(str(word) for pair in out.items() for word in pair)], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        content = {option: path.read_bytes() for option, path in out.items()}
    results = {option: hashlib.sha256(data).hexdigest() for option, data in content.items()}
    results["digest"] = hashlib.sha256(b"".join(content[option] for option in IN_DIGEST)).hexdigest()
    return results


def replay_all(jobs):
    """Results of all (command, log), the largest logs first: the last processor is not left alone with one."""
    order = sorted(jobs, key=lambda job: -jobs[job][1].stat().st_size)
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        return dict(zip(order, pool.map(lambda job: replay(*jobs[job]), order)))


def built(build, spec):
    """Builds ale-replay as the spec says, unless it is a path; the command that runs it."""
    if "/" in spec:
        return [pathlib.Path(spec)]
    compiler, _, level = spec.partition(":")
    if compiler in ARCHITECTURES:
        subprocess.run(["make", "-s", "--no-print-directory", "-j2", f"BUILD={build}", f"cross-{compiler}"], check=True)
        return [ARCHITECTURES[compiler], build / "cross" / compiler / "bin/ale-replay"]
    other = build / f"same{level}-{compiler}"
    ccache = "ccache " if "ccache" in os.environ.get("CC", "") else ""
    subprocess.run(["make", "-s", "--no-print-directory", "-j2", f"BUILD={other}", f"CC={ccache}{compiler}",
                    f"CXX={ccache}{COMPILERS[compiler]}", f"OPT={level}", f"{other}/bin/ale-replay"], check=True)
    return [other / "bin/ale-replay"]


def compare(spec, found, expected):
    """Tells what differs; how many logs do."""
    wrong = {name: [option for option in COMPARED if results[option] != expected[name][option]]
             for name, results in found.items()}
    for name, options in wrong.items():
        print(f"{spec:14} {name:28} {'differs: ' + ' '.join(options) if options else 'the same bytes'}", flush=True)
    return sum(bool(options) for options in wrong.values())


def read_stored():
    pairs = (line.split() for line in STORED.read_text(encoding="utf-8").splitlines()) if STORED.exists() else ()
    return {name: digest for digest, name in pairs}


def wanted_logs(specs, quick, every):
    """Names of those that are compared: all of them unless another machine is all that is asked for, or little time."""
    if quick:
        return QUICK_LOGS
    return EMULATED_LOGS if specs and set(specs) <= set(ARCHITECTURES) else every


def check(build, specs, quick):
    at_hand = logs()
    wanted = wanted_logs(specs, quick, at_hand)
    inputs = {name: path for name, path in at_hand.items() if name in wanted}
    ordinary = [build / "bin/ale-replay"]
    # What differs from run to run differs from that of another build, too: it runs a second time only where there is no other.
    others = {spec: built(build, spec) for spec in specs} or {"a second run": ordinary}
    commands = {"first run": ordinary, **others}
    found = replay_all({(spec, name): (command, path) for spec, command in commands.items()
                        for name, path in inputs.items() if spec not in ARCHITECTURES or name in EMULATED_LOGS})
    expected = {name: found["first run", name] for name in inputs}
    differing = sum(compare(spec, {name: found[spec, name] for name in inputs if (spec, name) in found}, expected)
                    for spec in commands if spec != "first run")
    stored = read_stored()
    changed = [name for name in inputs if stored.get(name) != expected[name]["digest"]]
    for name in changed:
        print(f"tests/digest   {name:28} {'has changed' if name in stored else 'is not there'}")
    if changed:
        print("features or live trajectories are not those of tests/digest: if that is wanted, run `make digest` and commit\n"
              "the new digests by themselves, saying why they changed")
    return 1 if differing or changed else 0


def update(build):
    digests = read_stored()
    found = replay_all({name: ([build / "bin/ale-replay"], path) for name, path in logs().items()})
    digests.update((name, results["digest"]) for name, results in found.items())
    STORED.write_text("".join(f"{digest}  {name}\n" for name, digest in sorted(digests.items())), encoding="utf-8")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    actions = parser.add_subparsers(dest="action", required=True)
    one = actions.add_parser("check")
    one.add_argument("--quick", action="store_true")
    one.add_argument("specs", nargs="*", metavar="SPEC")
    actions.add_parser("update")
    args = parser.parse_args()
    return update(args.build) if args.action == "update" else check(args.build, args.specs, args.quick)


if __name__ == "__main__":
    sys.exit(main())
