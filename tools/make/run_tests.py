#!/usr/bin/env python3
"""Runs tests of one kind and adds up what they say.

    run_tests.py unit PROGRAM...          GoogleTest programs, two at a time
    run_tests.py system PYTHON [ARG...]   pytest over tests/, three a processor: they mostly wait
    run_tests.py fuzz --seconds N [--inputs N] PROGRAM...   one a processor
    run_tests.py command NAME CMD...      one command that passes or fails
    run_tests.py part CMD...              a command whose tests count themselves; one more failure where it ends before the last of them
    run_tests.py phase NAME               a heading, and how long it is since `run_tests.py begin`
    run_tests.py sum                      the closing line over all that ran since `run_tests.py begin`

Every kind appends its counts to one file ($ALE_RESULTS, else build/test-results.txt), and what failed by name to one beside it;
`sum` names what failed, prints `N passed, N failed, N skipped` and fails when anything did.
"""
import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree

BUILD = pathlib.Path(os.environ.get("ALE_BUILD", "build"))
RESULTS = pathlib.Path(os.environ.get("ALE_RESULTS", BUILD / "test-results.txt"))


BEGUN = RESULTS.with_suffix(".begun")
FAILED = RESULTS.with_suffix(".failed")
LIMIT_S = 1800  # of one step: what hangs is a failure, not a wait


def record(kind, passed, failed, skipped, names=()):
    """Adds counts, and the names of what failed where they are known, to those of this run: 1 when anything failed, else 0."""
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    with RESULTS.open("a", encoding="utf-8") as results:
        results.write(f"{kind} {passed} {failed} {skipped}\n")
    if failed:
        with FAILED.open("a", encoding="utf-8") as file:
            file.writelines(f"{kind}: {name}\n" for name in names or ["no test said which"])
    return 1 if failed else 0


def counts(report):
    """passed, the names of what failed, skipped: of a JUnit or GoogleTest XML report."""
    passed = skipped = 0
    failed = []
    for case in ElementTree.parse(report).iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed.append(f"{case.get('classname')}.{case.get('name')}")
        elif case.find("skipped") is not None or case.get("status") == "notrun":
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


def run_limited(words, **how):
    """A command's exit code and output, where it is caught. One that hangs is ended, and has failed."""
    try:
        done = subprocess.run(words, check=False, timeout=LIMIT_S, stdin=subprocess.DEVNULL, **how)
        return done.returncode, done.stdout or b""
    except subprocess.TimeoutExpired as error:
        print(f"ended after {LIMIT_S} s: {words}", flush=True)
        return 1, error.stdout or b""


def run_gtest(program):
    """One GoogleTest program: its exit code, counts, and what it printed."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.xml"
        code, output = run_limited([program, f"--gtest_output=xml:{report}", "--gtest_brief=1"],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        found = counts(report) if report.exists() else (0, [], 0)
    return code, found, output.decode(errors="replace")


def run_unit_program(program):
    """One GoogleTest program: its name, passed, names of what failed, skipped, seconds, and what it printed."""
    started = time.monotonic()
    code, (passed, failed, skipped), output = run_gtest(program)
    if code != 0 and not failed:
        failed = [f"{program} ended with {code}"]
    return program, passed, failed, skipped, time.monotonic() - started, output


def unit(programs):
    total, names = [0, 0, 0], []
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        for program, passed, failed, skipped, seconds, output in pool.map(run_unit_program, programs):
            name = program.split("/tests/", 1)[-1]
            mark = "FAILED" if failed else "ok"
            print(f"  {mark:6} {name:44} {passed:4} passed {skipped:3} skipped {seconds:6.1f} s", flush=True)
            if failed:
                print(output, f"\n  again: {program}", flush=True)
            elif len(programs) == 1:
                print(output, end="", flush=True)  # what it measured
            names += failed
            for k, n in enumerate((passed, len(failed), skipped)):
                total[k] += n
    return record("unit", *total, names)


def system(python, arguments):
    where = [] if any(word.startswith("tests/") for word in arguments) else ["tests"]
    path = os.pathsep.join([str(BUILD / "python"), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "pytest.xml"
        code, _ = run_limited([python, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={report}",
                               "-n", str(3 * (os.cpu_count() or 1)), "--dist", "loadfile", "--reruns", "1", "-rR", *arguments, *where],
                              env={**os.environ, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"})
        passed, failed, skipped = counts(report) if report.exists() else (0, [], 0)
    if code not in (0, 5) and not failed:
        failed = [f"pytest ended with {code}"]
    return record("system", passed, len(failed), skipped, failed)


def run_fuzzer(program, seconds, inputs):
    """One libFuzzer program: its name, inputs tried, and its output when it found something."""
    name = pathlib.Path(program).name
    corpus = BUILD / "fuzz" / "corpus" / name
    corpus.mkdir(parents=True, exist_ok=True)
    seeds = pathlib.Path("tests/fuzz/seeds") / name
    done = subprocess.run([program, str(corpus), *([str(seeds)] if seeds.is_dir() else []),
                           f"-max_total_time={seconds}", f"-runs={inputs}", "-timeout=10", "-rss_limit_mb=4096",
                           "-print_final_stats=1", f"-artifact_prefix={BUILD}/fuzz/"],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    text = done.stdout.decode(errors="replace")
    runs = [line.split()[-1] for line in text.splitlines() if "number_of_executed_units" in line]
    return name, runs[0] if runs else "?", text[-4000:] if done.returncode else ""


def fuzz(programs, seconds, inputs):
    failed = []
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        for name, tried, trouble in pool.map(lambda program: run_fuzzer(program, seconds, inputs), programs):
            print(f"  {'FAILED' if trouble else 'ok':6} {name:40} {tried} inputs", flush=True)
            if trouble:
                print(trouble)
                failed.append(name)
    return record("fuzz", len(programs) - len(failed), len(failed), 0, failed)


def command(name, words):
    started = time.monotonic()
    code, output = run_limited(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(f"  {'FAILED' if code else 'ok':6} {name:44} {time.monotonic() - started:6.1f} s", flush=True)
    if code:
        print(output.decode(errors="replace")[-6000:], flush=True)
    return record(name.replace(" ", "-"), int(code == 0), int(code != 0), 0, [f"exit {code}"])


def part(words):
    code = subprocess.run(words, check=False).returncode
    return record("part", 0, 1, 0, [f"{words[-1]} ended early"]) if code else 0


def begin():
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    RESULTS.write_text("", encoding="utf-8")
    FAILED.unlink(missing_ok=True)
    BEGUN.touch()
    return 0


def phase(name):
    seconds = int(time.time() - BEGUN.stat().st_mtime) if BEGUN.exists() else 0
    print(f"== {seconds // 60}:{seconds % 60:02} {name}", flush=True)
    return 0


def summary():
    total = [0, 0, 0]
    for line in RESULTS.read_text(encoding="utf-8").splitlines():
        for k, n in enumerate(line.split()[1:]):
            total[k] += int(n)
    if FAILED.exists():
        print("".join(f"failed: {line}\n" for line in FAILED.read_text(encoding="utf-8").splitlines()), end="")
    print(f"{total[0]} passed, {total[1]} failed, {total[2]} skipped")
    return 1 if total[1] or not total[0] else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(dest="kind", required=True)
    kinds.add_parser("begin")
    kinds.add_parser("phase").add_argument("name")
    kinds.add_parser("sum")
    kinds.add_parser("unit").add_argument("programs", nargs="+")
    kinds.add_parser("part").add_argument("words", nargs=argparse.REMAINDER)
    one = kinds.add_parser("system")
    one.add_argument("python")
    one.add_argument("arguments", nargs=argparse.REMAINDER)
    one = kinds.add_parser("fuzz")
    one.add_argument("--seconds", type=int, default=600)
    one.add_argument("--inputs", type=int, default=-1, help="fewer seconds when so many have been tried")
    one.add_argument("programs", nargs="+")
    one = kinds.add_parser("command")
    one.add_argument("name")
    one.add_argument("words", nargs=argparse.REMAINDER)
    args = parser.parse_args()
    if args.kind == "begin":
        return begin()
    if args.kind == "phase":
        return phase(args.name)
    if args.kind == "sum":
        return summary()
    if args.kind == "part":
        return part(args.words)
    if args.kind == "unit":
        return unit(args.programs)
    if args.kind == "system":
        return system(args.python, args.arguments)
    if args.kind == "fuzz":
        return fuzz(args.programs, args.seconds, args.inputs)
    return command(args.name, args.words)


if __name__ == "__main__":
    sys.exit(main())
