"""Command line of ale-plot."""
import argparse
import pkgutil
import sys

USAGE = """usage: ale-plot RUN... [options]
Draws runs: trajectories, errors against a truth, stated uncertainty, stage times, what was dropped.
RUN: files of one run with commas between them (.tum, .jsonl of --poses, .csv of --timing), a folder that holds
trajectory.tum, poses.jsonl, timing.csv, or a log (.scip, LCM, text), which goes through ale-replay; of a log of
LCM with ALE_STATUS also what the robot counted.
NAME=RUN names it in the picture. The numbers go to the standard output.
  --out F              picture: .png, or a page: .html (default run.png)
  --truth F.tum        the true poses, by their stamps
  --align all|first|none  laid onto the truth by all poses, by the first common one, or not at all (default all)
  --only NAMES         panels, with commas between them: trajectory, error, honesty, covariance, dropped, counters, timing, table
  --title TEXT         above the picture
  --help, --version
Needs python3-matplotlib. Exit 0 fine, 1 failed, 2 wrong use.
"""
PANELS = ("trajectory", "error", "honesty", "covariance", "dropped", "counters", "timing", "table")


class WrongUse(Exception):
    """In one line."""


class CommandLine(argparse.ArgumentParser):
    def error(self, message):
        raise WrongUse(message)


def options_of(words):
    parser = CommandLine(prog="ale-plot", add_help=False, allow_abbrev=False)
    parser.add_argument("runs", nargs="*")
    parser.add_argument("--out", default="run.png")
    parser.add_argument("--truth")
    parser.add_argument("--align", default="all")
    parser.add_argument("--only", default=",".join(PANELS))
    parser.add_argument("--title", default="")
    parser.add_argument("--help", action="store_true")
    parser.add_argument("--version", action="store_true")
    options, unknown = parser.parse_known_args(words)
    if unknown:
        raise WrongUse(f"unknown option {unknown[0]}")
    if not (options.help or options.version):
        check(options)
    return options


def check(options):
    if not options.runs:
        raise WrongUse("which run? (--help)")
    if not options.out.endswith((".png", ".html")):
        raise WrongUse(f"--out {options.out}: the name must end in .png or .html")
    if options.align not in ("all", "first", "none"):
        raise WrongUse(f"--align {options.align}: there are all, first, none")
    options.only = options.only.split(",")
    for name in options.only:
        if name not in PANELS:
            raise WrongUse(f"--only {name}: there are {', '.join(PANELS)}")


def draw(options):
    """Imports what is heavy only now: --help needs none of it."""
    try:
        from . import pages, panels, runs, score  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        print(f"ale-plot: {error}: apt install python3-matplotlib", file=sys.stderr)
        return 1
    try:
        loaded = [runs.load(words) for words in options.runs]
        rows, chosen = judged(loaded, read_truth(runs, options.truth), options, (panels, runs, score))
        pages.write(options.out, chosen, rows, options.title or " | ".join(run.name for run in loaded))
    except runs.Trouble as trouble:
        print(f"ale-plot: {trouble}", file=sys.stderr)
        return 1
    return say(text_of(rows) + counted_text(loaded))


def judged(loaded, truth, options, modules):
    """The table of numbers, and the panels that are asked for."""
    panels, runs, score = modules
    shown, errors, ratios = [run.trajectory for run in loaded], [None] * len(loaded), [None] * len(loaded)
    if truth is not None:
        shown = [None if run.trajectory is None else score.aligned(run.trajectory, truth, options.align) for run in loaded]
        errors = [score.error_of(trajectory, truth) for trajectory in shown]
        ratios = [score.ratio_to_stated(run, truth, options.align) for run in loaded]
        if all(error is None for error in errors):
            raise runs.Trouble(f"{options.truth}: no run has a pose within {score.NEAREST_S} s of it")
    rows = score.table(loaded, errors)
    chosen = [panel for panel in panels.panels_of(loaded, shown, errors, truth, ratios, rows) if panel[0] in options.only]
    if not chosen:
        raise runs.Trouble(f"nothing to draw: these runs have no {', '.join(options.only)}")
    return rows, chosen


def read_truth(runs, path):
    if path is None:
        return None
    try:
        return runs.read_tum(path)
    except OSError as error:
        raise runs.Trouble(f"{path}: {error.strerror or error}") from error
    except ValueError as error:
        raise runs.Trouble(f"{path}: no trajectory: {error}") from error


def text_of(rows):
    """A table with columns of their own width."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = ["  ".join(word.ljust(width) if k == 0 else word.rjust(width) for k, (word, width) in enumerate(zip(row, widths)))
             for row in rows]
    return "".join(f"{line.rstrip()}\n" for line in lines)


def counted_text(loaded):
    """What the robots counted, one a line; empty: nothing is known of it."""
    rows = [(run.name, name, str(growth[-1])) for run in loaded if run.counted for name, growth in run.counted.grown.items()]
    return "\n" + text_of([("run", "counted", "times"), *rows]) if rows else ""


def say(text):
    """To the standard output, to the last byte."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        print(f"ale-plot: standard output: {error.strerror}", file=sys.stderr)
        sys.stdout = None
        return 1
    return 0


def version():
    return pkgutil.get_data(__package__, "version.txt").decode().strip()


def main():
    try:
        options = options_of(sys.argv[1:])
    except WrongUse as error:
        print(f"ale-plot: {error}", file=sys.stderr)
        return 2
    if options.help:
        return say(USAGE)
    if options.version:
        return say(f"ale-plot {version()}\n")
    return draw(options)
