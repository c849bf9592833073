#!/usr/bin/env python3
"""LCM on this machine: is there a way for multicast, and a port that nobody else uses.

    lcm_url.py            prints a free LCM URL; makes multicast work on the loopback if nothing else does
    lcm_url.py --check    only says whether multicast works (exit 0) or not (exit 1)

As a module: ensure_multicast() and free_lcm_url(). Python standard library only.
"""
import errno
import os
import random
import socket
import subprocess
import sys

GROUP = "239.255.76.67"
LOOPBACK = (["ip", "link", "set", "lo", "up", "multicast", "on"], ["ip", "route", "add", "224.0.0.0/4", "dev", "lo"])


class NoMulticast(Exception):
    """There is no way for multicast; the text says what to do."""


def has_multicast():
    """True when a datagram to LCM's group has somewhere to go: what LCM itself asks first."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((GROUP, 7667))
        except OSError as error:
            if error.errno == errno.ENETUNREACH:
                return False
            raise
    return True


def ensure_multicast():
    """Gives the loopback a multicast route where nothing has one. True when it had to; raises NoMulticast."""
    if has_multicast():
        return False
    command = " && ".join(map(" ".join, LOOPBACK))
    if os.geteuid() != 0:
        raise NoMulticast(f"no route for multicast; please run once: sudo sh -c '{command}'")
    for words in LOOPBACK:
        done = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise NoMulticast(f"no route for multicast, and `{' '.join(words)}` fails: {done.stderr.strip()}")
    return True


HELD = []  # sockets that keep ports for this process, so that nobody else is given them before its programs listen


def free_lcm_url():
    """LCM on a multicast port of its own, so that several runs do not hear each other; it stays on this computer."""
    while True:
        port = random.randint(20000, 60000)
        holder = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            holder.bind(("127.0.0.1", port))  # of LCM's datagrams nothing comes here
        except OSError:
            holder.close()
            continue
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # as LCM's own sockets: they may join
        HELD.append(holder)
        return f"udpm://{GROUP}:{port}?ttl=0"


def main():
    if sys.argv[1:] == ["--check"]:
        return 0 if has_multicast() else 1
    if sys.argv[1:]:
        print(__doc__, file=sys.stderr)
        return 0 if sys.argv[1:] == ["--help"] else 2
    try:
        if ensure_multicast():
            print("no route for multicast here: using the loopback", file=sys.stderr)
    except NoMulticast as error:
        print(error, file=sys.stderr)
        return 1
    print(free_lcm_url())
    return 0


if __name__ == "__main__":
    sys.exit(main())
