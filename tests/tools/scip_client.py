"""A small SCIP client over a pseudo terminal, written from the specification and from nothing of this project."""
import os
import select
import time
import tty


def checksum(text):
    return chr((sum(text) & 0x3F) + 0x30)


def decode(text):
    value = 0
    for character in text:
        assert 0x30 <= character <= 0x6F, f"{character:#x} is no data character"
        value = value << 6 | character - 0x30
    return value


class Gone(Exception):
    """The device has hung up."""


class Scan:
    def __init__(self, echo, lines, width):
        for line in lines:
            assert line[-1:] == checksum(line[:-1]).encode(), f"sum of {line!r}"
        assert all(len(line) == 65 for line in lines[1:-1])
        self.echo = echo
        self.stamp_ms = decode(lines[0][:-1])
        data = b"".join(line[:-1] for line in lines[1:])
        assert len(data) % width == 0
        self.values = [decode(data[k:k + width]) for k in range(0, len(data), width)]


class Client:
    def __init__(self, path, raw=True):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        self.buffer = b""
        if raw:
            tty.setraw(self.fd)

    def close(self):
        os.close(self.fd)

    def send(self, command):
        os.write(self.fd, command.encode() + b"\n")

    def read_some(self, seconds):
        """Bytes as they come; empty when none came in that time."""
        ready, _, _ = select.select([self.fd], [], [], seconds)
        if not ready:
            return b""
        try:
            got = os.read(self.fd, 65536)
        except OSError as error:
            raise Gone from error
        if not got:
            raise Gone
        return got

    def reply(self, seconds=180):
        """The next reply as it stands on the line, without its empty line."""
        end = time.monotonic() + seconds
        while b"\n\n" not in self.buffer:
            assert time.monotonic() < end, f"no reply; so far {self.buffer!r}"
            self.buffer += self.read_some(0.1)
        reply, self.buffer = self.buffer.split(b"\n\n", 1)
        return reply

    def ask(self, command):
        self.send(command)
        return self.reply()

    def scan(self, seconds=180):
        """The next frame of a stream, every sum checked."""
        lines = self.reply(seconds).split(b"\n")
        echo, status = lines[0], lines[1]
        assert status == b"99b", (echo, status)
        return Scan(echo.decode(), lines[2:], 3 if echo[1:2] == b"D" else 2)
