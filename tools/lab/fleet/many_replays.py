"""ale-fleet replay: a row of the table for each log with each choice of settings."""
import base64
import itertools
import json
import pathlib
import sys

from ale_fleet import cluster, distant, one_replay
from ale_fleet.table import write_page, write_table


def stem(path):
    """NAME of NAME.log, NAME.clf.gz."""
    return pathlib.PurePosixPath(path).name.split(".")[0]


class Tasks:
    """All that is to be done, in the order of the table, and what of it is done: kept in a file."""

    def __init__(self, options):
        choices = [[(name, value) for value in values] for name, values in options.set]
        self.all = [(log, f"{options.against.rstrip('/')}/{stem(log)}.tum" if options.against else "", settings)
                    for log in options.logs for settings in itertools.product(*choices)]
        self.path = pathlib.Path(f"{options.out}.part")
        self.done = {}
        if self.path.exists():
            self._read()

    def _read(self):
        text = self.path.read_text(encoding="utf-8")
        for line in text.splitlines():
            self._take(line)
        if not text.endswith("\n"):
            with self.path.open("a", encoding="utf-8") as file:
                file.write("\n")

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


def submitted(client, replay, task):
    log, truth, settings = task
    return cluster.submitted(client, one_replay.replayed, replay, distant.absolute(log), truth and distant.absolute(truth), settings)


def run(tasks, options):
    """Does what is left; whatever a worker dies of is tried again, and then a row that says so."""
    left = tasks.left()
    if not left:
        return
    with cluster.client_of(options) as client:
        cluster.announce(client, f"{len(left)} of {len(tasks.all)} are to be done")
        futures = {submitted(client, options.program, task): task for task in left}
        for future in cluster.as_done(futures):
            task = futures[future]
            if future.status == "finished":
                tasks.put(task, *future.result())
            else:
                error = future.exception()
                print(f"ale-fleet: {task[0]}: {cluster.given_up(error)}", file=sys.stderr)
                tasks.put(task, {**dict.fromkeys(one_replay.RESULTS, ""), "error": type(error).__name__}, b"")


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
        print(f"ale-fleet: {row['log']}: {row['error']}", file=sys.stderr)
    return 1 if broken else 0
