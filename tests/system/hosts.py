"""Two computers on one cable: network namespaces that end with the processes that hold them. Needs root."""
import contextlib
import ctypes
import os
import socket
import subprocess

import pytest

CLONE_NEWNET = 0x40000000


class Host:
    """A computer of its own, as far as networks go: loopback, and one card once it is cabled."""

    def __init__(self, address):
        self.address = address
        self.holder = subprocess.Popen(["unshare", "--net", "sleep", "infinity"], stdin=subprocess.DEVNULL)
        self.prefix = ("nsenter", "--net", f"--target={self.holder.pid}")

    def is_there(self):
        return os.readlink(f"/proc/{self.holder.pid}/ns/net") != os.readlink("/proc/self/ns/net")

    def run(self, *words):
        return subprocess.run([*self.prefix, *words], check=True, capture_output=True, text=True).stdout

    def make_up(self):
        """Multicast has its route over the card, as on a computer that has a network."""
        for words in (("link", "set", "lo", "up"), ("address", "add", f"{self.address}/24", "dev", "card"),
                      ("link", "set", "card", "up"), ("route", "add", "default", "dev", "card")):
            self.run("ip", *words)

    def socket(self, *how):
        """A socket of this computer's."""
        with open("/proc/self/ns/net", "rb") as home, open(f"/proc/{self.holder.pid}/ns/net", "rb") as here:
            enter(here)
            try:
                return socket.socket(*how)
            finally:
                enter(home)

    def end(self):
        self.holder.kill()
        self.holder.wait()


def enter(namespace):
    """This thread, until it enters another."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.setns(namespace.fileno(), CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "setns")


def cable(one, other):
    """Between the two, a card on each end; nothing is up yet. A cable that was there before is gone when its card is deleted."""
    subprocess.run(["ip", "link", "add", "card", "netns", str(one.holder.pid), "type", "veth",
                    "peer", "name", "card", "netns", str(other.holder.pid)], check=True)


@contextlib.contextmanager
def two_separate_hosts():
    """The robot, and another computer: no cable, and nothing is up, not even the loopback."""
    if os.geteuid() != 0 or subprocess.run(["unshare", "--net", "true"], check=False, capture_output=True).returncode != 0:
        pytest.skip("network namespaces are not to be had here (root)")
    robot, other = Host("10.77.0.1"), Host("10.77.0.2")
    try:
        while not (robot.is_there() and other.is_there()):
            assert robot.holder.poll() is None and other.holder.poll() is None
        yield robot, other
    finally:
        robot.end()
        other.end()


@contextlib.contextmanager
def two_hosts():
    """The robot, and another computer on its cable."""
    with two_separate_hosts() as (robot, other):
        cable(robot, other)
        robot.make_up()
        other.make_up()
        yield robot, other
