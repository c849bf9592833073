"""Stock LCM on one machine, as before: lcm-logger and lcm-logplayer, Java's LCM (what lcm-spy reads by). PyPI's `lcm` is what all
the other tests listen and send by."""
import re
import shutil
import signal
import socket
import subprocess

import lcm
import pytest

from at_hand import WORLDS
from chain import Program
from waiting import Ear, wait_until

LCM_JAR = "/usr/share/java/lcm.jar"
LISTENER = """
import lcm.lcm.*;
public class Listener {
    public static void main(String[] words) throws Exception {
        LCM bus = new LCM(words[0]);
        bus.subscribe(".*", (l, channel, bytes) -> { System.out.println(channel); System.out.flush(); });
        bus.publish("FROM_JAVA", new byte[] {1}, 0, 1);
        Thread.sleep(600000);
    }
}
"""


def events(path):
    try:
        return [event.channel for event in lcm.EventLog(str(path), "r")]
    except (OSError, ValueError):
        return []


@pytest.fixture(name="robot")
def a_robot_that_publishes(chain):
    chain.simulator("--world", "tools/lab/worlds/home.world")
    chain.firmware("[lcm]\npublish_scan = yes\n")
    wait_until(lambda: len(chain.listener.poses) > 5, 180, "poses")
    return chain


@pytest.mark.skipif(shutil.which("lcm-logger") is None, reason="no lcm-logger here")
def test_lcm_logger_writes_it_all_and_lcm_logplayer_plays_it_to_our_tools(robot):
    log = robot.folder / "lcm.log"
    logger = subprocess.Popen(["lcm-logger", "-q", f"--lcm-url={robot.url}", log], stderr=subprocess.DEVNULL)
    try:
        wait_until(lambda: {"ALE_POSE", "ALE_FEATURES", "ALE_SCAN", "ALE_STATUS", "ALE_ODOMETRY"} <= set(events(log)), 180, "a log")
    finally:
        logger.send_signal(signal.SIGINT)
        logger.wait()
    for program in robot.programs:
        program.end()
    watch = robot.start("ale-watch", "--lcm-url", robot.url, "--until-silent", 2)
    wait_until(lambda: "listening" in watch.err(), 180, "ale-watch")
    subprocess.run(["lcm-logplayer", "-s", "4", f"--lcm-url={robot.url}", log], check=True, capture_output=True)
    assert watch.wait(180) == 0
    assert f"{events(log).count('ALE_POSE')} poses, 0 missing" in watch.out()


@pytest.mark.skipif(shutil.which("java") is None, reason="no Java here")
def test_what_lcm_spy_reads_by_hears_it_and_is_heard(robot):
    source = robot.folder / "Listener.java"
    source.write_text(LISTENER, encoding="utf-8")
    heard = []
    ear = Ear(robot.url, ["FROM_JAVA"], lambda channel, _: heard.append(channel))
    out = robot.folder / "java.out"
    with open(out, "w", encoding="utf-8") as file:
        java = subprocess.Popen(["java", "-Djava.net.preferIPv4Stack=true", "-cp", LCM_JAR, source, robot.url], stdout=file)
    try:
        wait_until(lambda: {"ALE_POSE", "ALE_FEATURES", "ALE_SCAN", "ALE_STATUS"} <= set(out.read_text().split()), 180, "its messages")
        wait_until(lambda: heard, 60, "Java's message")
    finally:
        java.kill()
        java.wait()
        ear.stop()


@pytest.mark.skipif(shutil.which("java") is None, reason="no Java here")
def test_lcm_through_a_hub_of_its_java_library(tmp_path):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    url = f"tcpq://127.0.0.1:{port}"
    running = [subprocess.Popen(["java", "-cp", LCM_JAR, "lcm.lcm.TCPService", str(port)], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL)]
    try:
        wait_until(lambda: is_open(port), 180, "the hub")
        for name, words in (("ale-sim", ("--world", WORLDS / "home.world", "--pty", tmp_path / "urg")),
                            ("ale-slamd", ("--port", tmp_path / "urg"))):
            running.append(Program(tmp_path, name, "--lcm-url", url, *words).process)
        watch = Program(tmp_path, "ale-watch", "--lcm-url", url)
        running.append(watch.process)
        wait_until(lambda: re.search(r"poses +[1-9]", watch.out()), 180, "poses through the hub")
    finally:
        for process in running:
            process.kill()
            process.wait()


def is_open(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0
