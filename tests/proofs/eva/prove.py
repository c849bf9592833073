#!/usr/bin/env python3
"""No run-time error is possible: every harness beside this file through Frama-C's Eva.

A harness is a C file with a main, or a list of functions for WP; README.md says what its first comment holds. A property is proved
where no harness leaves it open, or where one has shown it for every argument that the function's contract allows. What is left open
must stand in the table of README.md, and nothing else may. The last line: N proved, 0 alarms, M argued.
What was proved before, of the same sources and by the same harness, is not proved again.
"""
import argparse
import concurrent.futures
import csv
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, field, replace

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
TABLE = HERE.parent / "README.md"
INCLUDES = [HERE / "model", ROOT / "lib", ROOT / "drivers", HERE]
MODELS = sorted(HERE.glob("model/*.c"))
# The arithmetic of gcc on x86-64: an int has 32 bits, and >> of a negative number keeps its sign. Whatever rests on an assumption
# that Eva makes by itself is an error: a function without a body and without a contract.
KERNEL = ["-machdep", "gcc_x86_64", "-c11", "-kernel-verbose", "0", "-kernel-warn-key", "annot:missing-spec=abort",
          "-kernel-warn-key", "typing:implicit-function-declaration=abort"]
# What z3 can prove takes it less than half a second; what it cannot, all the time that it is given.
WP = ["-wp", "-wp-prover", "z3", "-wp-timeout", "10", "-wp-verbose", "0"]
EVA = ["-eva", "-eva-verbose", "0", "-eva-precision", "1"]
LEAST_REACHED = 0.98
MOST_ARGUED = 20
PROVED = {"Valid", "Valid under hyp."}
IGNORED = {"Considered valid", "Dead", "Valid but dead", "Unknown but dead", "Invalid but dead"}
CLONE = re.compile(r"_\d+$")  # Frama-C numbers the copies of an inline function, one for each file that includes it


@dataclass(frozen=True, order=True)
class Property:
    """One thing that must hold wherever a statement runs."""
    source: str
    function: str
    kind: str
    text: str
    line: int = 0  # 0 in the table of README.md, which stands for every line of the function

    def entry(self):
        """As the table names it."""
        return replace(self, line=0)

    def __str__(self):
        return f"{self.source} {self.function}: {self.kind}: {self.text}"


@dataclass
class Result:
    """What one harness, or all of them together, have shown."""
    proved: set = field(default_factory=set)
    open: set = field(default_factory=set)
    left: set = field(default_factory=set)  # by WP, for others to prove
    settled: set = field(default_factory=set)  # proved for whatever the function's contract allows
    reached: set = field(default_factory=set)  # (source, function, place within it)
    statements: set = field(default_factory=set)
    endless: set = field(default_factory=set)  # functions and loops that never end
    broken: list = field(default_factory=list)
    seconds: float = 0

    def add(self, other):
        """Takes in what another harness has shown."""
        for name in ("proved", "open", "left", "settled", "reached", "statements", "endless"):
            getattr(self, name).update(getattr(other, name))
        self.broken += other.broken
        self.seconds += other.seconds


class Harness:
    """One C file of this folder, and what its first comment says."""

    def __init__(self, path):
        self.path = path
        self.name = path.stem
        self.text = path.read_text(encoding="utf-8")
        comment = self.text[:self.text.index("*/")].replace("\n *", "\n")
        self.proves = self._words(comment, "proves")
        self.sources = self.proves + self._words(comment, "with")
        self.settles = set(self._words(comment, "settles"))
        self.wp = self._words(comment, "wp")
        self.kernel = self._words(comment, "kernel")
        self.options = self._words(comment, "options")

    @staticmethod
    def _words(comment, key):
        """What stands behind "key:", to the next key or empty line."""
        found = re.search(rf"^ {key}:(.*(?:\n +(?!\w+:).+)*)", comment, re.MULTILINE)
        return found.group(1).split() if found else []

    def knows_everything(self):
        """A harness in which nothing is unknown proves one run alone."""
        return not self.wp and not re.search(r"\b(unknown\w*|Frama_C_\w+)\(", self.text)

    @staticmethod
    def preprocessing(tree):
        """Options of the preprocessor."""
        includes = [f"-I{tree / path.relative_to(ROOT)}" for path in INCLUDES]
        return ["-std=c11", "-D_GNU_SOURCE", *includes, "-include", str(HERE / "unknown.h")]

    def command(self, tree, report):
        """The call of Frama-C."""
        parse = ["frama-c", *KERNEL, f"-cpp-extra-args={' '.join(self.preprocessing(tree))}", *(str(tree / source) for source in self.sources), *self.kernel]
        write = ["-then", "-report-csv", str(report)]
        if self.wp:
            return [*parse, *WP, "-wp-fct", ",".join(self.wp), *self.options, *write]
        return [*parse, str(self.path), *map(str, MODELS), "-load-script", str(report.with_name(f"{self.name}_reached.ml")), "-rte", "-rte-verbose", "0",
                "-then", *EVA, *self.options, "-then", "-nonterm", *write]

    def run(self, tree, folder):
        """What it shows of the sources in a tree."""
        report, log, done = (folder / f"{self.name}.{kind}" for kind in ("csv", "log", "done"))
        state = self.state_of(tree)
        if not done.exists() or done.read_text(encoding="utf-8").split()[0] != state:
            done.unlink(missing_ok=True)
            report.unlink(missing_ok=True)
            code, seconds = self._run_frama_c(tree, folder, report, log)
            if code != 0 or not report.exists():
                last_words = log.read_text(encoding="utf-8").splitlines()[-12:]
                return Result(broken=[f"{self.name}: " + "\n".join(last_words)])
            done.write_text(f"{state} {seconds}\n", encoding="utf-8")
        result = Result(seconds=float(done.read_text(encoding="utf-8").split()[1]))
        output = log.read_text(encoding="utf-8")
        self._read_properties(report, result)
        if self.wp:  # nothing is known here of who calls a function: what WP leaves open may be shown elsewhere
            result.left = {p for p in result.open if p.function in self.wp}
            result.open = set()
        self._read_statements(output, result)
        if self.knows_everything():
            result.broken.append(f"{self.name}: nothing in it is unknown: it proves one run alone")
        return result

    def state_of(self, tree):
        """Of all that decides what Frama-C finds: the call, and every file that it reads."""
        sources = [str(tree / source) for source in self.sources] + ([] if self.wp else [str(self.path), *map(str, MODELS)])
        rules = subprocess.run(["cc", "-MM", "-MG", *self.preprocessing(tree), *sources], check=True, stdout=subprocess.PIPE).stdout.decode()
        files = sorted({word for word in rules.split() if word.startswith("/")} | {str(HERE / "reached.ml")})
        state = hashlib.sha256(repr(self.command(pathlib.Path(), pathlib.Path("report"))).encode())
        for file in files:
            state.update(pathlib.Path(file).read_bytes())
        return state.hexdigest()

    def _run_frama_c(self, tree, folder, report, log):
        """Its exit code, and how long it worked."""
        environment = {**os.environ, "PWD": str(tree), "WHY3CONFIG": str(folder / "why3.conf")}
        shutil.copy(HERE / "reached.ml", folder / f"{self.name}_reached.ml")  # Frama-C compiles it where it lies
        with log.open("w", encoding="utf-8") as out, subprocess.Popen(self.command(tree, report), stdout=out,
                                                                      stderr=subprocess.STDOUT, cwd=tree,
                                                                      env=environment) as started:
            _, status, used = os.wait4(started.pid, 0)
            started.returncode = os.waitstatus_to_exitcode(status)
        return started.returncode, used.ru_utime

    def _is_ours(self, source):
        return source.startswith(("lib/", "drivers/")) or source.endswith("/" + self.path.name)

    def _read_properties(self, report, result):
        with report.open(encoding="utf-8", newline="") as rows:
            for row in csv.DictReader(rows, delimiter="\t", quoting=csv.QUOTE_NONE):
                source = f"{row['directory']}/{row['file']}"
                # What a function asks of its callers is a property of each call, and listed there again.
                if row["status"] in IGNORED or row["property kind"] == "precondition" or not self._is_ours(source):
                    continue
                found = Property(source, CLONE.sub("", row["function"]), CLONE.sub("", row["property kind"]),
                                 " ".join(row["property"].split()), int(row["line"]))
                (result.proved if row["status"] in PROVED else result.open).add(found)
        result.proved -= result.open  # one copy of an inline function may be proved, and another one not
        result.settled = {p for p in result.proved if self.wp or p.function in self.settles}

    def _read_statements(self, output, result):
        for line in output.splitlines():
            words = line.split("\t")
            if words[0] == "STATEMENT" and words[2].startswith(("lib/", "drivers/")):
                function = CLONE.sub("", words[1])
                place = (words[2], function, int(words[3]), int(words[4]))
                result.statements.add(place)
                if words[5] == "true":
                    result.reached.add(place)
            found = re.search(r"(\S+):(\d+): Warning:\s*$", line)
            if line.startswith("[nonterm:") and found and found.group(1).startswith(("lib/", "drivers/")):
                result.endless.add(f"{found.group(1)}:{found.group(2)}: never ends")


def harnesses(words):
    """Those whose name has one of the words in it; all without words."""
    found = [Harness(path) for path in sorted(HERE.glob("*.c"))]
    return [h for h in found if not words or any(word in h.name for word in words)]


def argued():
    """The table of README.md: what is left open, and why it cannot happen."""
    rows = re.findall(r"^\| `(\S+) (\w+): ([\w ]+): (.+?)` \| (.+?) \| (.+?) \|$", TABLE.read_text(encoding="utf-8"),
                      re.MULTILINE)
    return {Property(*row[:3], row[3].replace("\\|", "|")): row[4] for row in rows}


def prove(chosen, tree, folder, jobs):
    """All results together."""
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["why3", "config", "detect"], env={**os.environ, "WHY3CONFIG": str(folder / "why3.conf")},
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
    total = Result()
    with concurrent.futures.ThreadPoolExecutor(max_workers=jobs) as pool:
        for harness, result in zip(chosen, pool.map(lambda h: h.run(tree, folder), chosen)):
            print(f"{harness.name}: {len(result.proved)} proved, {len(result.open)} open, {result.seconds:.0f} s", flush=True)
            total.add(result)
    total.open = (total.open | total.left - total.proved) - total.settled
    total.proved -= total.open
    return total


def tell_coverage(total, sources):
    """Statements of the sources under proof that Eva reached. Whether they are enough."""
    of_sources = {place for place in total.statements if place[0] in sources or place[0].endswith(".h")}
    started = {place[:2] for place in total.reached}
    missed = sorted(of_sources - total.reached)
    for source, function in sorted({place[:2] for place in missed}):
        lines = sorted({place[2] for place in missed if place[:2] == (source, function)})
        if (source, function) in started:
            print(f"not reached: {source} {function}: line{'s' if lines[1:] else ''} {', '.join(map(str, lines))}")
        elif not source.endswith(".h"):
            print(f"not reached: {source} {function}: no harness calls it")
    of_started = {place for place in of_sources if place[:2] in started or not place[0].endswith(".h")}
    share = len(of_started & total.reached) / max(len(of_started), 1)
    print(f"reached {len(of_started & total.reached)} of {len(of_started)} statements, {100 * share:.1f} %")
    return share >= LEAST_REACHED


def judge(total, sources, known, whole):
    """Prints what is wrong; whether anything is."""
    red = False
    for line in total.broken:
        print(f"broken: {line}")
    for line in sorted(total.endless):
        print(f"alarm: {line}")
    alarms = sorted(alarm for alarm in total.open if alarm.entry() not in known)
    for alarm in alarms:
        print(f"alarm: {alarm}")
    named = {alarm.entry() for alarm in total.open}
    stale = sorted(entry for entry in known if entry not in named and (whole or entry.source in sources))
    for entry in stale:
        print(f"argued in README.md, but no alarm: {entry}")
    if not tell_coverage(total, sources):
        print(f"broken: less than {100 * LEAST_REACHED:.0f} % of the statements are reached")
        red = True
    still = named & set(known)
    if len(still) > MOST_ARGUED:
        print(f"broken: more than {MOST_ARGUED} alarms are argued")
        red = True
    print(f"{len(total.proved)} proved, {len(alarms) + len(total.endless)} alarms, {len(still)} argued")
    return red or bool(total.broken or alarms or total.endless or stale)


def main():
    parser = argparse.ArgumentParser(description="Proves that no run-time error is possible, by Frama-C's Eva.")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build", help="where reports and logs go")
    parser.add_argument("--tree", type=pathlib.Path, default=ROOT, help="the sources that are proved (default: this tree)")
    parser.add_argument("--only", nargs="*", default=[], metavar="WORD", help="harnesses with a word in their name")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    given = parser.parse_args()
    chosen = harnesses(given.only)
    if not chosen:
        parser.error("no harness of that name")
    total = prove(chosen, given.tree.resolve(), given.build.resolve() / "proofs" / "eva", given.jobs)
    sources = {source for harness in chosen for source in harness.proves}
    sys.exit(1 if judge(total, sources, argued(), not given.only) else 0)


if __name__ == "__main__":
    main()
