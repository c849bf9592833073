#!/usr/bin/env python3
"""Tests the documents: what every README.md names is there, and every figure is what its command prints.

    docs_check.py [--root .] [--build build] [--all] [--no-figures]

A README has at most 120 lines. Its links and pictures exist; so do paths in backquotes, `make` targets with their variables, programs
and the options named beside them. Figures are named in a comment below the paragraph or table that holds them:

    <!-- check: make bench-slam ONLY=home
    | home | .. / {2.4} (..) |
    -->

The first line is a command, run at the top of the tree, programs first in PATH, $TMP a folder of its own, $PYTHON this interpreter. Each
further line must be printed by it, blanks aside; `..` stands for any text. A figure in braces must stand in the block above, and be what is printed,
rounded to as many digits; `{0.2 at most}` and `{98 at least}` are bounds. `check long:` marks a command of more than some seconds: it runs with
--all only. A command that names $ALE_SHARED is left out where that is not there.
"""
import argparse
import functools
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

LINES = 120
LIMIT_S = 1800
TOP = ("lib", "drivers", "firmware", "tools", "tests")
SOURCES = ("", ".h", ".c", ".hpp", ".cpp", ".py", ".mk", ".sh", ".js")
CHECK = re.compile(r"^<!-- check( long)?: (.+?)\n(.*?)-->", re.MULTILINE | re.DOTALL)
FIGURE = re.compile(r"\{(-?[\d.,]+)( at most| at least)?\}")
NUMBER = r"(-?\d[\d.,]*\d|\d)"


def readmes(root):
    """Of the tree, and not of what is built in it."""
    return sorted(path for path in root.rglob("README.md") if not {"build", ".git", "node_modules"} & set(path.relative_to(root).parts))


def visible(text):
    return re.sub(r"<!--.*?-->", lambda comment: "\n" * comment[0].count("\n"), text, flags=re.DOTALL)


def code(text):
    """What stands in backquotes or in indented or fenced blocks, piece by piece."""
    fenced = re.findall(r"^```\w*\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    blocks = [line for line in text.splitlines() if line.startswith("    ")]
    lines = [line for block in fenced for line in block.splitlines()] + blocks
    return [re.split(r" {3,}| #", line.strip())[0] for line in lines] + quoted(text)


def quoted(text):
    return [" ".join(words.split()) for words in re.findall(r"`([^`]+)`", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL))]


class Tree:
    """What is there: files, targets and variables of the Makefiles, programs and their help."""

    def __init__(self, root, build):
        self.root, self.build = root, build
        self.names = {path.name for folder in TOP for path in (root / folder).rglob("*")} | {path.name for path in root.iterdir()}
        makefiles = "\n".join(path.read_text() for path in [*root.glob("Makefile"), *root.glob("t*/**/*.mk")])
        self.targets = {word for words in re.findall(r"^([a-z][a-z0-9 -]*):", makefiles, re.MULTILINE) for word in words.split()}
        self.variables = set(re.findall(r"\b[A-Z][A-Z_]*\b", makefiles))
        programs = [path.name for path in (build / "bin").glob("ale-*")]
        self.programs = set(programs) or None

    def holds(self, path):
        """A file, a folder, a unit named without its ending, or files by a pattern."""
        if "*" in path.name:
            return any(path.parent.glob(path.name))
        return any(path.with_name(path.name + ending).exists() for ending in SOURCES)

    @functools.lru_cache(maxsize=None)
    def help(self, program):
        done = subprocess.run([self.build / "bin" / program, "--help"], capture_output=True, text=True, check=False, timeout=60)
        return set(re.findall(r"--[a-z][a-z-]*", done.stdout))

    @functools.lru_cache(maxsize=None)
    def script_options(self):
        return {option for path in self.root.glob("t*/**/*.py") for option in re.findall(r"--[a-z][a-z-]*", path.read_text())}


def check_length(text, _readme, _tree):
    count = text.count("\n")
    if count > LINES:
        yield f"{count} lines, more than {LINES}"


def check_links(text, readme, tree):
    links = re.findall(r"\]\(([^)\s]+)\)|<img[^>]* src=\"([^\"]+)\"", visible(text))
    for link in (first or second for first, second in links):
        path, _, heading = link.partition("#")
        if re.match(r"\w+:", link):
            continue
        there = readme.parent / path if path else readme
        if not there.exists():
            yield f"link to {link}: not there"
        elif heading and heading not in headings(there):
            yield f"link to {link}: no such heading"
        elif tree.root not in [there.resolve(), *there.resolve().parents]:
            yield f"link to {link}: leads out of the tree"


def headings(page):
    """As links name them."""
    titles = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE) if page.is_file() else []
    return [re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles]


def check_paths(text, readme, tree):
    for words in quoted(visible(text)):
        if not re.fullmatch(r"(?!\.\./)[\w.*+-]+(/[\w.*+-]+)*/?", words) or re.search(r"/[A-Z]{2,}(/|$)", words):
            continue
        first = words.split("/")[0]
        if first in TOP and "/" in words:
            there = tree.holds(tree.root / words) or tree.holds(readme.parent / words)
        elif "/" in words and (readme.parent / first).is_dir():
            there = tree.holds(readme.parent / words)
        elif re.fullmatch(r"[a-z][\w-]+\.(c|h|cpp|hpp|mk|sh|world|lcm)", words):
            there = words in tree.names
        else:
            continue
        if not there:
            yield f"`{words}`: not there"


def check_file_table(text, readme, _tree):
    """The first column of a table of files names files beside the page."""
    for table in re.findall(r"^\| ?(?:files?|in reading order) \|.*\n\|[-| :]+\n((?:\|.*\n)*)", visible(text), re.MULTILINE):
        for row in table.splitlines():
            for word in re.findall(r"`([\w.*/-]+)`", row.split("|")[1]):
                if not any(any(readme.parent.rglob(word.rstrip("/") + ending)) for ending in SOURCES):
                    yield f"table of files: no `{word}` here"


def check_targets(text, _readme, tree):
    for words in code(visible(text)):
        for line in re.findall(r"(?:^|[ ;(])make((?: +[\w./-]+(?:=\"[^\"]*\"|=\S*)?)*)", words):
            for word in re.sub(r'"[^"]*"', "", line).split():
                name, given, value = word.partition("=")
                if given and name not in tree.variables:
                    yield f"`make {line.strip()}`: no variable {name}"
                elif not given and re.fullmatch(r"[a-z][a-z0-9-]*", name) and name not in tree.targets:
                    yield f"`make {line.strip()}`: no target {name}"
                elif name == "T" and value and "unit" in line and not any((tree.root / "tests").rglob(f"*{pathlib.Path(value).name}*")):
                    yield f"`make {line.strip()}`: no test {value}"


def check_programs(text, _readme, tree):
    """Programs that are named, and options beside them; an option by itself is one of any program."""
    if tree.programs is None:
        return
    for words in code(visible(text)):
        for called in re.split(r" ?\| |`|, |; ", words):
            names = re.findall(r"(?<![\w./-])ale-[a-z]+(?![\w./*-])", called)
            for name in names:
                if name not in tree.programs and name != "ale-slam":
                    yield f"`{name}`: no such program"
            options = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", called))
            known = [tree.help(name) for name in names if name in tree.programs]
            if not known and re.match(r"--(?!name=)", called):
                known = [tree.help(name) for name in tree.programs] + [tree.script_options()]
            for option in sorted(options - set().union(*known) if known else ()):
                yield f"`{called.strip()}`: no option {option}"


PAGE_CHECKS = (check_length, check_links, check_paths, check_file_table, check_targets, check_programs)


class Figures:
    """Of one command on one page: the lines that it must print."""

    def __init__(self, readme, text, found):
        self.readme, self.text = readme, text
        self.long, self.command = bool(found[1]), found[2].strip()
        self.lines = [line.strip() for line in found[3].splitlines() if line.strip()]
        self.block = re.split(r"\n[ \t]*\n", visible(text[:found.start()]).rstrip())[-1]

    def not_told(self):
        """Figures that the block above does not show."""
        shown = re.findall(NUMBER, self.block)
        for value, _ in (figure for line in self.lines for figure in FIGURE.findall(line)):
            if value in shown:
                shown.remove(value)
            else:
                yield f"{self.command}: {value} does not stand in the block above its check"
        if not any(FIGURE.search(line) for line in self.lines):
            yield f"{self.command}: no figure is checked"
        programs = re.findall(r"make [\w-]+(?![\w/-])|ale-\w+|[\w-]+\.py|build/[\w/]+", self.command)
        if not any(name in " ".join(visible(self.text).split()) for name in programs):
            yield f"{self.command}: gives figures and is not named on the page"

    def wrong(self, output):
        printed = [" ".join(line.split()) for line in output.splitlines()]
        for line in self.lines:
            if not any(agrees(line, words) for words in printed):
                yield f"{self.command}: does not print: {line}{nearest(line, printed)}"


def pattern(line):
    """A line of a check as an expression, each of its figures a group."""
    parts = re.split(r"(\{[^}]*\}|\.\.(?!\.))", " ".join(line.split()))
    return "".join(NUMBER if FIGURE.fullmatch(part) else ".*?" if part == ".." else re.escape(part) for part in parts)


def agrees(line, words):
    found = re.search(rf"(?<![\w.]){pattern(line)}(?![\w])", words)
    return bool(found) and all(close(value, bound, printed) for (value, bound), printed in zip(FIGURE.findall(line), found.groups()))


def close(value, bound, printed):
    wanted, is_one = (float(text.replace(",", "")) for text in (value, printed))
    if bound:
        return is_one <= wanted if bound == " at most" else is_one >= wanted
    return abs(is_one - wanted) <= 0.5 * 10 ** -len(value.partition(".")[2]) + 1e-12


def nearest(line, printed):
    same = [words for words in printed if re.search(pattern(line), words)]
    return f" (but: {same[0]})" if same else ""


def figures_of(root):
    for readme in readmes(root):
        text = readme.read_text(encoding="utf-8")
        yield from (Figures(readme, text, found) for found in CHECK.finditer(text))


def run(command, root, build):
    """What a command prints, errors too, and whether it ended well."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS"))}
        variables = os.environ.get("MAKEFLAGS", "").partition("-- ")[2]
        environment |= {"PATH": f"{build / 'bin'}:{os.environ['PATH']}", "TMP": folder, "BUILD": str(build), "PYTHON": sys.executable,
                        "MAKEFLAGS": f"s -- {variables}", "ALE_RESULTS": f"{folder}/results"}
        done = subprocess.run(["sh", "-ec", command], cwd=root, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False, timeout=LIMIT_S)
    return done.stdout, done.returncode == 0


def reason_to_skip(figures, every):
    if "$ALE_SHARED" in figures[0].command and not os.environ.get("ALE_SHARED"):
        return "ALE_SHARED names no shared data"
    return "long: ALL=1 runs it" if figures[0].long and not every else ""


def page_faults(root, build):
    """What pages name and is not there; figures that stand nowhere, or twice."""
    tree, told = Tree(root, build), {}
    for readme in readmes(root):
        text = readme.read_text(encoding="utf-8")
        yield from ((readme, fault) for check in PAGE_CHECKS for fault in check(text, readme, tree))
    for figures in figures_of(root):
        yield from ((figures.readme, fault) for fault in figures.not_told())
        for line in figures.lines:
            before = told.setdefault((figures.command, line), figures.readme)
            if before is not figures.readme:
                yield figures.readme, f"{figures.command}: stands in {before.relative_to(root)}, too: {line}"


def figure_faults(root, build, every):
    """Every command once, and what it does not print."""
    commands = {}
    for figures in figures_of(root):
        commands.setdefault(figures.command, []).append(figures)
    for command, all_figures in commands.items():
        skipped = reason_to_skip(all_figures, every)
        if skipped:
            print(f"  skipped {command} ({skipped})", flush=True)
            continue
        started = time.monotonic()
        output, fine = run(command, root, build)
        faults = [(figures.readme, fault) for figures in all_figures for fault in figures.wrong(output)]
        faults += [] if fine else [(all_figures[0].readme, f"{command}: failed: {output[-400:]}")]
        print(f"  {'FAILED' if faults else 'ok':7} {command} ({time.monotonic() - started:.1f} s)", flush=True)
        yield from faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path("."))
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--all", action="store_true", help="run the long commands, too")
    parser.add_argument("--no-figures", action="store_true", help="run no command")
    options = parser.parse_args()
    root, build = options.root.resolve(), options.build.resolve()
    faults = list(page_faults(root, build))
    faults += [] if options.no_figures else figure_faults(root, build, options.all)
    for readme, fault in faults:
        print(f"{readme.relative_to(root)}: {fault}")
    print(f"{len(readmes(root))} pages, {sum(len(figures.lines) for figures in figures_of(root))} checked lines, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
