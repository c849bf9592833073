"""Two hosts on one cable, which network namespaces make of one machine: a Dask scheduler on the first, a worker on each."""
import contextlib
import os
import subprocess
import sys

ADDRESSES = ("10.78.0.1", "10.78.0.2")
PORT = 8786  # nobody else is on these hosts


def why_not():
    """Why they cannot be had here, or None."""
    if os.geteuid() != 0:
        return "network namespaces want root"
    try:
        done = subprocess.run(["ip", "netns", "list"], capture_output=True, text=True, check=False)
        allowed = subprocess.run(["unshare", "--net", "true"], capture_output=True, check=False)
    except OSError as error:
        return f"no network namespaces: {error.filename} is not here"
    return None if done.returncode == 0 == allowed.returncode else "no network namespaces here"


def ip(*words):
    subprocess.run(["ip", *words], check=True)


@contextlib.contextmanager
def hosts():
    """For each what to put before a command that is to run there."""
    names = [f"fleet-{os.getpid()}-{k}" for k in range(len(ADDRESSES))]
    with contextlib.ExitStack() as made:
        for name in names:
            ip("netns", "add", name)
            made.callback(ip, "netns", "delete", name)
        ip("link", "add", "card", "netns", names[0], "type", "veth", "peer", "name", "card", "netns", names[1])
        for name, address in zip(names, ADDRESSES):
            ip("-n", name, "address", "add", f"{address}/24", "dev", "card")
            ip("-n", name, "link", "set", "card", "up")
            ip("-n", name, "link", "set", "lo", "up")
        yield [("ip", "netns", "exec", name) for name in names]


@contextlib.contextmanager
def scheduler(folder):
    """Its address, what to put before a command on its host, and the worker of each host, a process."""
    address = f"tcp://{ADDRESSES[0]}:{PORT}"
    with hosts() as there, (folder / "dask.txt").open("w", encoding="utf-8") as said, contextlib.ExitStack() as running:
        def start(host, program, *words):
            process = subprocess.Popen([*host, sys.executable, "-m", f"distributed.cli.{program}", *words], cwd=folder, stdout=said, stderr=said)
            running.callback(process.wait)
            running.callback(process.terminate)
            return process

        start(there[0], "dask_scheduler", "--host", ADDRESSES[0], "--port", str(PORT), "--no-dashboard")
        words = (address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", folder)
        yield address, there[0], [start(host, "dask_worker", *words) for host in there]
