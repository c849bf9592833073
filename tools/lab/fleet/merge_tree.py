"""ale-fleet merge: logs are read, each for itself; drives are joined two by two, what has become of these again; the last two are drawn.

    log  log  log  log  log        read
      \\  /      \\  /      |
     join      join      |         join
          \\     /        |
           join          |
               \\        /
                  draw                                                    """
import pathlib
import sys

from ale_fleet import cluster, distant, one_merge

PAIR = 2


def planted(client, options):
    """All tasks; the last is the root."""
    level = [cluster.submitted(client, one_merge.read, options.program, distant.absolute(log), options.set, options.parts) for log in options.logs]
    tasks = list(level)
    while len(level) > PAIR:
        level = [cluster.submitted(client, one_merge.join, options.program, level[k:k + PAIR], options.parts) for k in range(0, len(level), PAIR)]
        tasks += level
    words = ["--points"] if options.points else []
    return [*tasks, cluster.submitted(client, one_merge.draw, options.program, level, options.outputs, words)]


def grown(options):
    """What the root has made of all logs. A task that fails wherever it is tried fails all."""
    with cluster.client_of(options) as client:
        tasks = planted(client, options)
        cluster.announce(client, f"{len(tasks)} steps")
        for task in cluster.as_done(tasks):
            if task.status != "finished":
                raise cluster.GivenUp(task.exception())
        return tasks[-1].result()


def merged(options):
    """All that was asked for; the exit code."""
    try:
        written, said, is_whole = grown(options)
    except cluster.GivenUp as error:
        print(f"ale-fleet: {cluster.given_up(error.args[0])}; what is done is kept, the same words go on", file=sys.stderr)
        return 1
    for (number, name), content in written.items():
        (pathlib.Path(options.outputs[number][1]).parent / name).write_bytes(content)
    for line in said:
        print(f"ale-fleet: {line.removeprefix('ale-merge: ')}", file=sys.stderr)
    if not written:
        print(f"ale-fleet: {options.out} was not written; what is done is kept, the same words go on", file=sys.stderr)
        return 1
    distant.removed(options.parts)
    return 0 if is_whole else 1
