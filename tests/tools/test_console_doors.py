"""Who is let in by ale-console, and who holds up nobody: the token and where it can be seen, TLS, a proxy, half-open requests."""
import contextlib
import json
import os
import pathlib
import random
import shutil
import socket
import ssl
import stat
import subprocess
import threading
import time
import urllib.error
import urllib.request

import ale
import pytest

import browser
from at_hand import BINARIES
from waiting import Ear, Pulse, wait_until
from watching import Console, alice, console, lcm_url, robot  # noqa: F401 (fixtures)
from web_socket import Refused, WebSocket

REQUESTS = 10000 if os.environ.get("ALE_LONG_TESTS") else 1000
REQUESTS_A_STOP = 50
STOP_S = 0.3


def status_of(url):
    try:
        return urllib.request.urlopen(url, timeout=180).status
    except urllib.error.HTTPError as refused:
        return refused.code


def test_on_the_loopback_nobody_is_let_in_without_the_token(alice):
    assert status_of(alice.address) == 403
    for origin in (None, alice.origin):
        with pytest.raises(Refused, match="403"):
            WebSocket(alice.address, origin=origin)
    WebSocket(alice.url, origin=alice.origin).wait_for("hello")


@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("setpriv"), reason="needs root to be somebody else")
def test_another_user_of_this_machine_finds_the_token_nowhere(lcm_url):
    running = Console(lcm_url)
    somebody = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
    file = pathlib.Path(running.state.name) / "ale-slam/console.token"
    os.chmod(running.state.name, 0o755)
    assert file.read_text().strip() == running.token
    assert subprocess.run([*somebody, "cat", file], capture_output=True, check=False).returncode != 0
    seen = subprocess.run([*somebody, "cat", f"/proc/{running.process.pid}/cmdline", f"/proc/{running.process.pid}/environ"],
                          capture_output=True, text=True, check=False).stdout
    assert "ale-console" in seen and running.token not in seen
    assert running.end() == 0


def test_a_token_of_the_command_line_leaves_the_list_of_processes_and_is_warned_of(lcm_url):
    running = Console(lcm_url, "127.0.0.1:0", "--token", "abcdefghijkl1")
    assert running.token == "abcdefghijkl1"
    assert b"abcdefghijkl1" not in pathlib.Path(f"/proc/{running.process.pid}/cmdline").read_bytes()
    assert running.end() == 0
    assert "--token-file" in running.said


def test_the_token_of_a_file_is_made_once_and_for_its_owner(lcm_url, tmp_path):
    file = tmp_path / "token"
    tokens = []
    for _ in range(2):
        running = Console(lcm_url, "127.0.0.1:0", "--token-file", file)
        tokens.append(running.token)
        assert running.end() == 0 and running.said == ""
    assert tokens[0] == tokens[1] == file.read_text().strip()
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    file.chmod(0o644)
    done = subprocess.run([BINARIES / "ale-console", "--lcm-url", lcm_url, "--http", "127.0.0.1:0", "--token-file", file], check=False,
                          capture_output=True, text=True, timeout=180)
    assert done.returncode == 1 and "readable by others" in done.stderr and done.stderr.count("\n") == 1


def test_a_page_that_others_reach_in_the_clear_is_warned_of(lcm_url):
    running = Console(lcm_url, "0.0.0.0:0")
    assert running.end() == 0
    assert "not encrypted" in running.said and running.said.count("\n") == 1


# ---- half-open requests

def half_open(console, count, text=b""):
    place = (console.address.split("/")[2].split(":"))
    made = []
    for _ in range(count):
        one = socket.create_connection((place[0], int(place[1])), timeout=180)
        with contextlib.suppress(OSError):
            one.sendall(text)
        made.append(one)
    return made


@pytest.mark.parametrize("text", [b"", b"GET / HTTP/1.1\r\nHost: x\r\nX: ", b"GET /?token=x HTTP/1.1\r\n"], ids=["silent", "half", "first line"])
def test_half_open_requests_hold_up_nobody(alice, text):
    held = half_open(alice, 300, text)
    for _ in range(3):
        begun = time.monotonic()
        WebSocket(alice.url).wait_for("hello")
        assert alice.get().status == 200
        assert time.monotonic() - begun < 10  # who has to wait for the end of their patience waits longer
        held += half_open(alice, 50, text)
    for one in held:
        one.close()


class Rude:
    """Requests and frames as nobody's browser makes them, also of somebody who has the token; none of them is a command."""

    def __init__(self, console):
        self.console = console
        self.random = random.Random(17)
        place = console.address.split("/")[2]
        self.place = (place.split(":")[0], int(place.split(":")[1]))
        self.upgrade = (f"GET /?token=%s HTTP/1.1\r\nHost: {place}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n")
        self.kinds = (self.noise, self.cut, self.changed, self.swollen, self.stranger, self.frames, self.frames)

    def noise(self):
        return self.random.randbytes(self.random.randrange(600))

    def asked(self):
        return (self.upgrade % self.console.token).encode()

    def cut(self):
        return self.asked()[:self.random.randrange(300)]

    def changed(self):
        data = bytearray(self.asked())
        for _ in range(self.random.choice((1, 3, 20))):
            data[self.random.randrange(len(data))] = self.random.randrange(256)
        return bytes(data)

    def swollen(self):
        name = self.random.choice((b"Cookie", b"X" * 3000, b"Content-Length", b"Host", b"\0"))
        return self.asked()[:-2] + (name + b": " + b"9" * self.random.choice((0, 20, 9000)) + b"\r\n") * self.random.choice((1, 50)) + b"\r\n"

    def stranger(self):
        return (self.upgrade % self.random.choice(("", "x" * 5000, "%00", self.console.token[:-1]))).encode() + self.frame()

    def frame(self):
        length = self.random.choice((0, 1, 125, 126, 127))
        more = self.random.randbytes({126: 2, 127: 8}.get(length, 0))
        first = self.random.choice((0x81, 0x01, 0x00, 0x80, 0x82, 0x88, 0x89, 0x8A, 0x8F, 0xF1))
        return bytes((first, length | self.random.choice((0, 0x80)))) + more + self.random.randbytes(self.random.randrange(200))

    def frames(self):
        return self.asked() + b"".join(self.frame() for _ in range(self.random.randrange(1, 5)))

    def call(self):
        with contextlib.suppress(OSError), socket.create_connection(self.place, timeout=180) as one:
            one.sendall(self.random.choice(self.kinds)())
            if self.random.randrange(8) == 0:
                one.settimeout(0.05)
                one.recv(1000)


def test_ten_thousand_hostile_requests_hold_up_no_stop(alice, robot, lcm_url):
    """A thousand of them where there is little time. In between the operator stops his robot, again and again."""
    heard = []
    ear = Ear(lcm_url, ["ALE_COMMAND"], lambda _, data: heard.append(ale.command_t.decode(data).verb))
    status = Pulse(0.5, robot.publish_status)
    rude, crossed = Rude(alice), []
    try:
        page = WebSocket(alice.url)
        wait_until(lambda: page.wait_for("status")["vouched"], 180, "the robot's word")
        for _ in range(REQUESTS // REQUESTS_A_STOP):
            for _ in range(REQUESTS_A_STOP):
                rude.call()
            before, asked = len(heard), time.monotonic()
            page.send(json.dumps({"type": "command", "words": ["stop"]}))
            wait_until(lambda so_far=before: len(heard) > so_far, 180, "the stop")
            crossed.append(time.monotonic() - asked)
            assert page.wait_for("sent")["refusal"] is None
    finally:
        status.stop()
        ear.stop()
    crossed.sort()
    print(f"{REQUESTS} hostile requests; a stop leaves in {crossed[len(crossed) // 2] * 1000:.0f} ms, at most {crossed[-1] * 1000:.0f} ms")
    assert crossed[int(0.9 * len(crossed))] < STOP_S, "a busy machine may hold up some"
    assert set(heard) == {"stop"}
    WebSocket(alice.url).wait_for("hello")


def is_closed(connection):
    connection.setblocking(False)
    try:
        return connection.recv(1000) == b""
    except BlockingIOError:
        return False
    except OSError:
        return True


def test_who_says_a_byte_now_and_then_is_hung_up_on(console):
    slow, = half_open(console, 1, b"GET / HTTP/1.1\r\nX: ")
    begun = time.monotonic()

    def hung_up():
        time.sleep(0.3)
        with contextlib.suppress(OSError):
            slow.send(b"x")
        return is_closed(slow)
    wait_until(hung_up, 60, "the end of its patience")
    assert time.monotonic() - begun > 5


def test_a_page_that_is_open_stays_while_others_knock(alice, robot):
    page = WebSocket(alice.url)
    page.wait_for("hello")
    held = half_open(alice, 400)
    robot.publish_pose()
    assert page.wait_for("pose")
    for one in held:
        one.close()


# ---- TLS

@pytest.fixture(scope="module", name="certificate")
def a_certificate(tmp_path_factory):
    if not shutil.which("openssl"):
        pytest.skip("no openssl to make a certificate with")
    folder = tmp_path_factory.mktemp("tls")
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost", "-addext",
                    "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", folder / "key.pem", "-out", folder / "cert.pem"],
                   check=True, capture_output=True, timeout=180)
    return folder / "cert.pem", folder / "key.pem"


def trusting(certificate):
    return ssl.create_default_context(cafile=certificate[0])


def test_with_a_certificate_page_and_web_socket_are_encrypted(lcm_url, certificate):
    running = Console(lcm_url, "127.0.0.1:0", "--cert", certificate[0], "--key", certificate[1])
    assert running.url.startswith("https://127.0.0.1:")
    with urllib.request.urlopen(running.url, timeout=180, context=trusting(certificate)) as page:
        assert page.status == 200 and page.read().rstrip().endswith(b"</html>")
    WebSocket(running.url, origin=running.origin, tls=trusting(certificate)).wait_for("hello")
    with pytest.raises(Refused, match="403"):
        WebSocket(running.address, origin=running.origin, tls=trusting(certificate))
    with pytest.raises(Refused, match="403"):
        WebSocket(running.url, origin=running.origin.replace("https", "http"), tls=trusting(certificate))
    with pytest.raises((OSError, Refused)):  # without TLS
        WebSocket(running.url.replace("https", "http"))
    held = half_open(running, 300)
    WebSocket(running.url, tls=trusting(certificate)).wait_for("hello")
    for one in held:
        one.close()
    assert running.end() == 0 and running.said == ""


def test_a_certificate_that_is_none_is_named(lcm_url, tmp_path):
    (tmp_path / "cert.pem").write_text("no certificate")
    (tmp_path / "key.pem").write_text("no key")
    done = subprocess.run([BINARIES / "ale-console", "--lcm-url", lcm_url, "--http", "127.0.0.1:0", "--token", "abcdefghijkl1", "--cert",
                           tmp_path / "cert.pem", "--key", tmp_path / "key.pem"], check=False, capture_output=True, text=True, timeout=180)
    assert done.returncode == 1 and "cert.pem" in done.stderr and done.stderr.count("\n") == 1


class Proxy:
    """Ends TLS and hands the bytes on, as a proxy before the console does."""

    def __init__(self, console, certificate):
        self.there = console.address.split("/")[2].split(":")
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(*certificate)
        self.listening = socket.create_server(("127.0.0.1", 0))
        self.port = self.listening.getsockname()[1]
        self.context = context
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                outer, _ = self.listening.accept()
            except OSError:
                return
            threading.Thread(target=self._serve, args=(outer,), daemon=True).start()

    def _serve(self, outer):
        with contextlib.suppress(OSError):
            outer = self.context.wrap_socket(outer, server_side=True)
            inner = socket.create_connection((self.there[0], int(self.there[1])), timeout=180)
            threading.Thread(target=self._pump, args=(inner, outer), daemon=True).start()
            self._pump(outer, inner)

    @staticmethod
    def _pump(source, sink):
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                sink.sendall(data)
        with contextlib.suppress(OSError):
            sink.shutdown(socket.SHUT_RDWR)


def test_behind_a_proxy_that_encrypts_the_page_works_at_its_address_only(lcm_url, certificate):
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    behind = Console(lcm_url, f"127.0.0.1:{port}", "--origin", "https://robot.example")
    assert behind.url == f"https://robot.example/?token={behind.token}"
    behind.address = f"http://127.0.0.1:{port}/"
    proxy = Proxy(behind, certificate)
    shown = f"https://127.0.0.1:{proxy.port}/?token={behind.token}"
    with urllib.request.urlopen(shown, timeout=180, context=trusting(certificate)) as page:
        assert page.status == 200
    WebSocket(shown, origin="https://robot.example", host="robot.example", tls=trusting(certificate)).wait_for("hello")
    for origin in ("https://evil.example", "http://robot.example"):
        with pytest.raises(Refused, match="403"):
            WebSocket(shown, origin=origin, host="robot.example", tls=trusting(certificate))
    with pytest.raises(Refused, match="403"):
        WebSocket(shown.partition("?")[0], origin="https://robot.example", tls=trusting(certificate))
    proxy.listening.close()
    assert behind.end() == 0 and behind.said == ""


@pytest.mark.skipif(bool(browser.missing()), reason=f"no browser test: {browser.missing()}")
def test_the_page_opens_its_web_socket_over_tls(lcm_url, certificate):
    running = Console(lcm_url, "127.0.0.1:0", "--cert", certificate[0], "--key", certificate[1])
    chromium = browser.Browser("--ignore-certificate-errors")
    try:
        chromium.open(running.url)
        chromium.wait_for("document.body.dataset.link === 'waiting'")
    finally:
        chromium.close()
    assert running.end() == 0
