"""ale-fleet: many drives judged at once, or joined, on all cores of this machine or on many machines."""
import argparse
import os
import pathlib
import pkgutil
import shutil
import sys

from ale_fleet import distant, many_replays, merge_tree

USAGE = """\
usage: ale-fleet replay LOG... --out TABLE [--against FOLDER] [--set section.key=VALUE,VALUE]...
       ale-fleet merge LOG... --out MAP [--map PICTURE]... [--set section.key=VALUE]...
Many drives at once, on all cores of this machine or on many machines. replay: every log goes through ale-replay with
every combination of the settings: a row of the table each, in the order of the words. merge: one map of all drives
by ale-merge, as a tree of tasks. Logs and truths may lie wherever fsspec knows the way: a path, s3://, ssh://.
Of replay:
  --out TABLE           .csv, or .parquet where pyarrow is there
  --against FOLDER      truths, NAME.tum for NAME.log
  --page FOLDER         a page of maps and the table
Of merge:
  --out MAP             the map, as ale-slamd loads it
  --map F, --tiles F, --points  as of ale-merge
  --parts FOLDER        where MAP.parts is: what is read and joined on the way; all workers must reach it (default:
                        beside MAP)
Of both:
  --set NAME=V,V        settings, section.key, as in --config of these programs; may be repeated
  --scheduler ADDRESS   of a Dask scheduler, tcp://host:8786; without it the workers are processes of this machine
  --workers N           how many of those (default: as many as cores)
  --dashboard ADDR:PORT of the workers of this machine (default 127.0.0.1:0, any free port)
  --program PATH        ale-replay or ale-merge on the workers (default: as found here)
  --help, --version
What is done is kept, in TABLE.part or MAP.parts, until all is: a run that was ended goes on from there with the same
words. A worker that dies costs what it was at; that is done again elsewhere. A log that is broken is said to be.
Exit status: 0 fine, 1 failed, a log was broken or a drive is not in the map, 2 wrong use.
"""


class WrongUse(Exception):
    """The command line asks for what cannot be."""


class CommandLine(argparse.ArgumentParser):
    def error(self, message):
        raise WrongUse(message)


def found_here(program):
    """Beside this one, or on the path."""
    beside = pathlib.Path(sys.argv[0]).resolve().parent / program
    return str(beside) if beside.exists() else shutil.which(program)


def setting(word):
    name, equals, values = word.partition("=")
    if not equals or "." not in name or not values:
        raise WrongUse(f"--set {word}: not section.key=VALUE,VALUE")
    return name, values.split(",")


def refuse(options, command, names):
    """Options of another command."""
    for name in names:
        if getattr(options, name):
            raise WrongUse(f"--{name} is of {command}")


def check_replay(options):
    refuse(options, "merge", ("map", "tiles", "points", "parts"))
    if options.out.suffix not in (".csv", ".parquet"):
        raise WrongUse(f"--out {options.out}: neither .csv nor .parquet")
    options.needs = [options.against] if options.against else []


def check_merge(options):
    refuse(options, "replay", ("against", "page"))
    if any(len(values) > 1 for _, values in options.set):
        raise WrongUse("--set: one map has one value of a setting")
    if len(set(options.logs)) < len(options.logs):
        raise WrongUse("a log is named twice")
    options.set = [(name, values[0]) for name, values in options.set]
    options.outputs = [("--out", options.out), *(("--map", path) for path in options.map), *([("--tiles", options.tiles)] if options.tiles else [])]
    options.parts = distant.absolute(f"{(options.parts or str(options.out.parent)).rstrip('/')}/{options.out.name}.parts")
    options.needs = []


COMMANDS = {"replay": ("ale-replay", check_replay, many_replays.judged), "merge": ("ale-merge", check_merge, merge_tree.merged)}


def options_of(words):
    parser = CommandLine(prog="ale-fleet", add_help=False, allow_abbrev=False)
    parser.add_argument("words", nargs="*")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--against", default="")
    parser.add_argument("--page", type=pathlib.Path)
    parser.add_argument("--map", action="append", type=pathlib.Path, default=[])
    parser.add_argument("--tiles", type=pathlib.Path)
    parser.add_argument("--points", action="store_true")
    parser.add_argument("--parts")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--scheduler")
    parser.add_argument("--workers", type=int)
    parser.add_argument("--dashboard", default="127.0.0.1:0")
    parser.add_argument("--program")
    parser.add_argument("--help", action="store_true")
    parser.add_argument("--version", action="store_true")
    options, unknown = parser.parse_known_args(words)
    if unknown:
        raise WrongUse(f"unknown option {unknown[0]}")
    if not (options.help or options.version):
        check(options)
    return options


def check(options):
    command, options.logs = options.words[:1], options.words[1:]
    if not options.logs or command[0] not in COMMANDS:
        raise WrongUse("give replay LOG... or merge LOG... (see --help)")
    if not options.out:
        raise WrongUse("--out is missing")
    if options.workers is not None and options.workers < 1:
        raise WrongUse(f"--workers {options.workers}: one at least")
    program, check_more, options.work = COMMANDS[command[0]]
    options.program = options.program or found_here(program)
    if not options.program:
        raise WrongUse(f"where is {program}? (--program)")
    options.set = [setting(word) for word in options.set]
    check_more(options)


def trouble_of_files(options):
    for path in [*options.logs, *options.needs]:
        if distant.is_local(path) and not pathlib.Path(path).exists():
            return f"{path}: No such file or directory"
        if not (distant.is_local(path) or options.scheduler) and (words := distant.lacking(path)):
            return f"{path}: {words}"
    return None


def trouble(options):
    """What cannot be had, as far as this machine sees; None: nothing."""
    if words := trouble_of_files(options):
        return words
    folder = options.out.parent
    if not folder.is_dir():
        return f"{folder}: no such folder"
    if not os.access(folder, os.W_OK):
        return f"{folder}: may not be written"
    if not options.scheduler and not shutil.which(options.program):
        return f"{options.program}: no such program"
    if options.out.suffix == ".parquet":
        import pyarrow  # noqa: F401: before the work, not after it
    return None


def say(text):
    """To the standard output, to the last byte."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        print(f"ale-fleet: standard output: {error.strerror}", file=sys.stderr)
        sys.stdout = None
        return 1
    return 0


def failed(words):
    print(f"ale-fleet: {words}", file=sys.stderr)
    return 1


def version():
    return pkgutil.get_data(__package__, "version.txt").decode().strip()


def done(options):
    """The exit code of the work, or of what stood in its way."""
    try:
        missing = trouble(options)
        return failed(missing) if missing else options.work(options)
    except KeyboardInterrupt:
        return failed("ended; what is done is kept, the same words go on")
    except ImportError as error:
        return failed(f"{error.name} is not here (python3-distributed, python3-numpy; pyarrow for .parquet)")
    except OSError as error:
        return failed(f"{error.filename}: {error.strerror}" if error.filename else error)


def main():
    try:
        options = options_of(sys.argv[1:])
    except WrongUse as error:
        failed(error)
        return 2
    if options.help:
        return say(USAGE)
    if options.version:
        return say(f"ale-fleet {version()}\n")
    return done(options)
