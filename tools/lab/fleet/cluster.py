"""Workers: of a scheduler somewhere, or processes of this machine."""
import contextlib
import importlib.util
import logging
import os
import signal
import sys

RETRIES = 3
BAR = 40
# Of workers on this machine. Dask takes a task of a kind that it has not seen for half a second, and would rather put it behind another
# than give it to an idle worker; and it would hand out all logs at once, so that at the end one worker has some left and others none.
LOCAL = {"distributed.scheduler.default-task-durations": {"replayed": "2s", "read": "2s", "join": "6s", "draw": "20s"},
         "distributed.scheduler.worker-saturation": 1.0}


class GivenUp(Exception):
    """A task failed wherever it was tried."""


@contextlib.contextmanager
def deaf_children():
    """Ctrl-C on a terminal is for all of its processes: those that are started here leave it to this one, which ends them."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def client_of(options):
    import cloudpickle
    import dask
    from distributed import Client, LocalCluster

    import ale_fleet
    from ale_fleet import one_merge, one_replay
    for module in (ale_fleet, one_merge, one_replay):  # workers know nothing of them; Dask asks for the very module of a task
        cloudpickle.register_pickle_by_value(module)
    if options.scheduler:
        with Client(options.scheduler) as client:
            yield client
        return
    os.environ.setdefault("DASK_LOGGING__DISTRIBUTED", "critical")  # of the workers, from their first word on
    with dask.config.set(LOCAL), contextlib.ExitStack() as running:
        with deaf_children():
            cluster = running.enter_context(LocalCluster(n_workers=options.workers, threads_per_worker=1, dashboard_address=options.dashboard,
                                                         silence_logs=logging.CRITICAL))
        yield running.enter_context(Client(cluster))


def announce(client, text):
    """What is going to be done, and where to look on."""
    page = client.dashboard_link
    if not importlib.util.find_spec("bokeh"):
        page = page.replace("/status", "/info/main/workers.html")  # what Dask shows without it
    print(f"ale-fleet: {text}; dashboard: {page}", file=sys.stderr)
    if not client.scheduler_info()["workers"]:
        print("ale-fleet: no worker is there yet", file=sys.stderr)


def show(done, of):
    if sys.stderr.isatty():
        filled = done * BAR // max(of, 1)
        print(f"\r[{'#' * filled}{' ' * (BAR - filled)}] {done} of {of}", end="" if done < of else "\n", file=sys.stderr, flush=True)


def submitted(client, function, *arguments):
    return client.submit(function, *arguments, retries=RETRIES, pure=False)


def as_done(futures):
    """Each as it is done, with the bar."""
    from distributed import as_completed
    show(0, len(futures))
    for count, future in enumerate(as_completed(futures), 1):
        yield future
        show(count, len(futures))


def given_up(error):
    return f"given up after {RETRIES} more tries: {error!r}"
