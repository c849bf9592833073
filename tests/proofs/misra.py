#!/usr/bin/env python3
"""MISRA C:2012 over the core: the C of lib/, by the addon that comes with cppcheck. Compares with the table of misra.md and fails where
that does not say what the tool does; prints the rows as they should be."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAGE = HERE / "misra.md"
ADDON_FOLDER = next(pathlib.Path("/usr/lib").glob("*/cppcheck/addons"), None)
COUNTED_ONE_BY_ONE = 50  # more than that is told in whole hundreds


def say(folder, *files):
    """What the addon says of a dump, or of what it has noted of all of them: rule, file, line and column."""
    told = subprocess.run([sys.executable, ADDON_FOLDER / "misra.py", "--cli", *files], cwd=folder, check=False, stdout=subprocess.PIPE)
    return {(found["errorId"].removeprefix("c2012-"), found["file"], found["linenr"], found["column"])
            for found in map(json.loads, told.stdout.splitlines()) if found.get("addon") == "misra"}


def findings(tree, folder, jobs):
    """Whatever the tool finds in a tree's lib. It notes what it must know of other files once a run: each file is one."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(tree / "lib", folder / "lib")
    sources = sorted(str(path.relative_to(folder)) for path in folder.rglob("*.c"))
    subprocess.run(["cppcheck", "--dump", "--quiet", "--std=c11", "-Ilib", "-j", str(jobs), *sources], cwd=folder, check=True)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        found = set().union(*pool.map(lambda source: say(folder, f"{source}.dump"), sources))
    return found | say(folder, *(f"{source}.ctu-info" for source in sources))


def in_order(rule):
    """Rules by number."""
    return tuple(map(int, rule.split(".")))


def counts(found):
    """Findings of each rule."""
    rules = [finding[0] for finding in found]
    return {rule: rules.count(rule) for rule in sorted(set(rules), key=in_order)}


def as_told(count):
    """A count as the page has it: small ones as they are, others up to the next hundred."""
    return str(count) if count < COUNTED_ONE_BY_ONE else f"up to {-(-count // 100) * 100}"


def table(text):
    """The page's counts by rule."""
    return dict(re.findall(r"^\| (\d+\.\d+) \| ([^|]+?) \|", text, re.MULTILINE))


def differences(found, text):
    """Where the page does not say what was found."""
    told, counted = table(text), {rule: as_told(count) for rule, count in counts(found).items()}
    return [f"misra.md: | {rule} | {told.get(rule, 'no row')} |, but found: {counted.get(rule, '0')}"
            for rule in sorted(told.keys() | counted.keys(), key=in_order) if told.get(rule) != counted.get(rule)]


def main():
    parser = argparse.ArgumentParser(description="MISRA C:2012 over the core, compared with tests/proofs/misra.md.")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build", help="where copies and dumps go")
    parser.add_argument("--tree", type=pathlib.Path, default=ROOT, help="the sources that are read (default: this tree)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--list", nargs="*", metavar="RULE", help="every finding of these rules; of all without a rule")
    given = parser.parse_args()
    if not ADDON_FOLDER:
        parser.error("cppcheck's addons are not there (Debian: cppcheck)")
    found = findings(given.tree.resolve(), given.build.resolve() / "proofs/misra", given.jobs)
    if given.list is not None:
        for rule, file, line, _ in sorted(found, key=lambda finding: (in_order(finding[0]), finding[1:])):
            if rule in given.list or not given.list:
                print(f"{file}:{line}: {rule}")
        return
    wrong = differences(found, PAGE.read_text(encoding="utf-8"))
    print("\n".join(wrong + [f"{len(found)} findings of {len(counts(found))} rules"]))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
