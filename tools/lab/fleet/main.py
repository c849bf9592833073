"""ale-fleet: many drives judged at once, on all cores of this machine or on many machines."""
import argparse
import base64
import contextlib
import csv
import html
import itertools
import json
import logging
import pathlib
import pkgutil
import shutil
import sys

from ale_fleet import one_replay

USAGE = """\
usage: ale-fleet replay LOG... --out TABLE [--against FOLDER] [--set section.key=VALUE,VALUE]...
Many drives judged at once, on all cores of this machine or on many machines. Every log goes through ale-replay
with every combination of the settings: a row of the table each, in the order of the words. Logs and the folder
of truths may lie wherever fsspec knows the way: a path, s3://, ssh://.
  --out TABLE           .csv, or .parquet where pyarrow is there
  --against FOLDER      truths, NAME.tum for NAME.log
  --set NAME=V,V        settings, section.key, as in --config of ale-replay; may be repeated
  --page FOLDER         a page of maps and the table
  --scheduler ADDRESS   of a Dask scheduler, tcp://host:8786; without it the workers are processes of this machine
  --workers N           how many of those (default: as many as cores)
  --dashboard ADDR:PORT of the workers of this machine (default 127.0.0.1:0, any free port)
  --program PATH        ale-replay on the workers (default: as found here)
  --help, --version
What is done is kept in TABLE.part until the table is written: a run that was ended goes on from there. A worker
that dies costs what it was at; that is done again elsewhere. A log that is broken is a row that says so.
Exit status: 0 fine, 1 failed or a log was broken, 2 wrong use.
"""
RETRIES = 3
BAR = 40


class WrongUse(Exception):
    """The command line asks for what cannot be."""


class CommandLine(argparse.ArgumentParser):
    def error(self, message):
        raise WrongUse(message)


def stem(path):
    """NAME of NAME.log, NAME.clf.gz."""
    return pathlib.PurePosixPath(path).name.split(".")[0]


class Tasks:
    """All that is to be done, in the order of the table, and what of it is done: kept in a file."""

    def __init__(self, options):
        choices = [[(name, value) for value in values] for name, values in options.set]
        self.names = [name for name, _ in options.set]
        self.all = [(log, f"{options.against.rstrip('/')}/{stem(log)}.tum" if options.against else "", settings)
                    for log in options.logs for settings in itertools.product(*choices)]
        self.path = pathlib.Path(f"{options.out}.part")
        self.done = {}
        if self.path.exists():
            for line in self.path.read_text(encoding="utf-8").splitlines():
                self._take(line)

    def _take(self, line):
        try:
            key, row, picture = json.loads(line)
        except ValueError:
            return  # cut short when the run was ended
        self.done[key] = row, base64.b64decode(picture)

    @staticmethod
    def key(task):
        return json.dumps(task)

    def left(self):
        return [task for task in dict.fromkeys(self.all) if self.key(task) not in self.done]

    def put(self, task, row, picture):
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps([self.key(task), row, base64.b64encode(picture).decode()]) + "\n")
        self.done[self.key(task)] = row, picture

    def rows(self):
        return [{"log": log, **dict(settings), **self.done[self.key((log, truth, settings))][0]} for log, truth, settings in self.all]

    def pictures(self):
        return [self.done[self.key(task)][1] for task in self.all]


def show(done, of):
    if sys.stderr.isatty():
        filled = done * BAR // max(of, 1)
        print(f"\r[{'#' * filled}{' ' * (BAR - filled)}] {done} of {of}", end="" if done < of else "\n", file=sys.stderr, flush=True)


@contextlib.contextmanager
def client_of(options):
    """Of the scheduler named, or of workers on this machine."""
    from distributed import Client, LocalCluster
    if options.scheduler:
        with Client(options.scheduler) as client:
            yield client
        return
    with LocalCluster(n_workers=options.workers, threads_per_worker=1, dashboard_address=options.dashboard, silence_logs=logging.CRITICAL) as cluster, \
            Client(cluster) as client:
        yield client


def run(tasks, options):
    """Does what is left; whatever a worker dies of is tried again, and then a row that says so."""
    import cloudpickle
    from distributed import as_completed
    cloudpickle.register_pickle_by_value(one_replay)
    left = tasks.left()
    if not left:
        return
    with client_of(options) as client:
        print(f"ale-fleet: {len(left)} of {len(tasks.all)} are to be done; dashboard: {client.dashboard_link}", file=sys.stderr)
        futures = {client.submit(one_replay.replayed, options.program, *task, retries=RETRIES, pure=False): task for task in left}
        for count, future in enumerate(as_completed(futures), 1):
            task = futures[future]
            if future.status == "finished":
                tasks.put(task, *future.result())
            else:
                error = future.exception()
                print(f"ale-fleet: {task[0]}: given up after {RETRIES} more tries: {error!r}", file=sys.stderr)
                tasks.put(task, {**dict.fromkeys(one_replay.RESULTS, ""), "error": type(error).__name__}, b"")
            show(count, len(left))


def write_table(path, rows):
    if path.suffix == ".parquet":
        import pyarrow
        from pyarrow import parquet
        parquet.write_table(pyarrow.Table.from_pylist(rows), path)
        return
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def write_page(folder, rows, pictures):
    folder.mkdir(parents=True, exist_ok=True)
    cells = []
    for number, (row, picture) in enumerate(zip(rows, pictures)):
        if picture:
            (folder / f"{number}.png").write_bytes(picture)
        image = f'<img src="{number}.png" width="300">' if picture else ""
        cells.append("<tr><td>" + "</td><td>".join([image, *(html.escape(str(value)) for value in row.values())]) + "</td></tr>")
    head = "<tr><th>map</th>" + "".join(f"<th>{html.escape(name)}</th>" for name in rows[0]) + "</tr>"
    (folder / "index.html").write_text(f"<!doctype html><meta charset=utf-8><title>ale-fleet</title><table>\n{head}\n" + "\n".join(cells)
                                       + "\n</table>\n", encoding="utf-8")


def setting(word):
    name, equals, values = word.partition("=")
    if not equals or "." not in name or not values:
        raise WrongUse(f"--set {word}: not section.key=VALUE,VALUE")
    return name, values.split(",")


def options_of(words):
    parser = CommandLine(prog="ale-fleet", add_help=False, allow_abbrev=False)
    parser.add_argument("words", nargs="*")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--against", default="")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--page", type=pathlib.Path)
    parser.add_argument("--scheduler")
    parser.add_argument("--workers", type=int)
    parser.add_argument("--dashboard", default="127.0.0.1:0")
    parser.add_argument("--program", default=shutil.which("ale-replay"))
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
    if command != ["replay"] or not options.logs:
        raise WrongUse("give replay LOG... (see --help)")
    if not options.out:
        raise WrongUse("--out TABLE is missing")
    if options.out.suffix not in (".csv", ".parquet"):
        raise WrongUse(f"--out {options.out}: neither .csv nor .parquet")
    if not options.program:
        raise WrongUse("where is ale-replay? (--program)")
    options.set = [setting(word) for word in options.set]


def trouble(options):
    """What cannot be had, as far as this machine sees; None: nothing."""
    for log in options.logs:
        if "://" not in log and not pathlib.Path(log).exists():
            return f"{log}: No such file or directory"
    return None if options.out.parent.is_dir() else f"{options.out.parent}: no such folder"


def judged(options):
    """All that was asked for; the exit code."""
    tasks = Tasks(options)
    run(tasks, options)
    rows = tasks.rows()
    write_table(options.out, rows)
    if options.page:
        write_page(options.page, rows, tasks.pictures())
    tasks.path.unlink(missing_ok=True)
    broken = [row for row in rows if row["error"]]
    for row in broken:
        print(f"ale-fleet: {row['error']}", file=sys.stderr)
    return 1 if broken else 0


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
    missing = trouble(options)
    if missing:
        return failed(missing)
    try:
        return judged(options)
    except KeyboardInterrupt:
        return failed("ended; what is done is kept, the same words go on")
    except ImportError as error:
        return failed(f"{error.name} is not here (python3-distributed, python3-numpy; pyarrow for .parquet)")
