"""ale-slamd as a service of systemd's kind: says when it is ready, feeds the watchdog, says when it stops."""
import socket

from waiting import wait_until


class Manager:
    """Listens where systemd would."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind("")  # an abstract name that is free
        self.name = "@" + self.socket.getsockname()[1:].decode()
        self.socket.setblocking(False)
        self.heard = []

    def words(self):
        while True:
            try:
                self.heard.append(self.socket.recv(1000).decode())
            except BlockingIOError:
                return self.heard


def test_ready_fed_and_stopping_are_told(chain):
    manager = Manager()
    prefix = ["env", f"NOTIFY_SOCKET={manager.name}", "WATCHDOG_USEC=400000"]
    chain.simulator("--world", "tools/lab/worlds/home.world")
    firmware = chain.firmware(prefix=prefix)
    wait_until(lambda: manager.words().count("WATCHDOG=1") >= 5, 180, "the watchdog to be fed")
    wait_until(lambda: any(text.startswith("STATUS=") for text in manager.words()), 180, "words for the status")
    assert manager.heard.count("READY=1") == 1
    assert firmware.end() == 0
    assert "STOPPING=1" in manager.words()


def test_the_watchdog_is_fed_without_a_scanner_too(chain):
    manager = Manager()
    prefix = ["env", f"NOTIFY_SOCKET={manager.name}", "WATCHDOG_USEC=400000"]
    firmware = chain.firmware(prefix=prefix)
    wait_until(lambda: manager.words().count("WATCHDOG=1") >= 3, 180, "the watchdog to be fed")
    assert firmware.end() == 0
