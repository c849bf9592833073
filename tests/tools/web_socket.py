"""A web socket client that is no browser: enough of RFC 6455 to talk to the console, with nothing but sockets."""
import base64
import json
import os
import socket
import struct
import time
import urllib.parse


class Refused(Exception):
    """The server did not switch protocols; holds its status line."""


class WebSocket:
    def __init__(self, url, origin=None, host=None, tls=None, protocol=None):
        place = urllib.parse.urlsplit(url)
        self.socket = socket.create_connection((place.hostname, place.port), timeout=180)
        if tls:
            self.socket = tls.wrap_socket(self.socket, server_hostname=place.hostname)
        self.buffer = b""
        self.received = 0
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET /{'?' + place.query if place.query else ''} HTTP/1.1", f"Host: {host or place.netloc}", "Upgrade: websocket", "Connection: Upgrade",
                 f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        if origin:
            lines.append(f"Origin: {origin}")
        if protocol:
            lines.append(f"Sec-WebSocket-Protocol: {protocol}")
        self.socket.sendall("\r\n".join([*lines, "", ""]).encode())
        head = self._until(b"\r\n\r\n").decode()
        if " 101 " not in head.splitlines()[0]:
            self.socket.close()
            raise Refused(head.splitlines()[0])

    def _fill(self):
        data = self.socket.recv(65536)
        if not data:
            raise ConnectionError("closed by the console")
        self.buffer += data

    def _until(self, mark):
        while mark not in self.buffer:
            self._fill()
        head, self.buffer = self.buffer.split(mark, 1)
        return head

    def _take(self, count):
        while len(self.buffer) < count:
            self._fill()
        data, self.buffer = self.buffer[:count], self.buffer[count:]
        return data

    def _frame(self):
        first, second = self._take(2)
        length = second & 0x7F
        if length == 126:
            length, = struct.unpack(">H", self._take(2))
        elif length == 127:
            length, = struct.unpack(">Q", self._take(8))
        return first, self._take(length)

    def next(self):
        """The next message, decoded."""
        return json.loads(self.next_bytes()[1])

    def next_bytes(self):
        """(whether it is text, the next message); pings are answered: the console hangs up on who does not."""
        text, kind = b"", 0
        while True:
            first, data = self._frame()
            opcode = first & 0x0F
            if opcode == 8:
                raise ConnectionError("closed by the console")
            if opcode == 9:
                self._send(0x8A, data)
            if opcode in (9, 10):
                continue
            text, kind = text + data, kind or opcode
            if first & 0x80:
                self.received += 1
                return kind == 1, text

    def send(self, text):
        self._send(0x81, text.encode())

    def send_bytes(self, data):
        self._send(0x82, data)

    def _send(self, kind, data):
        mask = os.urandom(4)
        head = struct.pack(">BB", kind, 0x80 | len(data)) if len(data) < 126 else struct.pack(
            ">BBH", kind, 0x80 | 126, len(data))
        self.socket.sendall(head + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(data)))

    def got(self):
        """Tells the console that all received so far has been drawn."""
        self.send(json.dumps({"type": "got", "count": self.received}))

    def wait_for(self, kind, condition=lambda message: True, seconds=180):
        """The first message of a kind that meets the condition, keeping pace with the console."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            message = self.next()
            self.got()
            if message["type"] == kind and condition(message):
                return message
        raise AssertionError(f"no such {kind} within {seconds} s")

    def close(self):
        self.socket.close()
