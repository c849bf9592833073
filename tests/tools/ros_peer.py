"""Somebody on DDS who is no program of this tree: PyPI's cyclonedds, on this computer alone and a domain of its own.

    peer = RosPeer(domain)
    scans = peer.reader("scan", LaserScan, BEST_EFFORT)
    message = scans.wait(lambda message: ...)              # the first that came and meets it
    peer.writer("cmd_vel", Twist).write(Twist(...))
"""
import os
import random
import subprocess
import time

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from at_hand import BINARIES

HERE = ('<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces><AllowMulticast>false'
        '</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32'
        '</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>')
RELIABLE = [Policy.Reliability.Reliable(duration(milliseconds=100))]
BEST_EFFORT = [Policy.Reliability.BestEffort]
LATCHED = [*RELIABLE, Policy.Durability.TransientLocal]
SECONDS = 120


def free_domain():
    return random.randint(1, 200)


class Heard:
    """What a reader has got, all of it."""

    def __init__(self, reader):
        self.reader = reader
        self.messages = []

    def poll(self):
        self.messages += self.reader.take(N=100)
        return self.messages

    def wait(self, condition=lambda _: True, seconds=SECONDS):
        end = time.monotonic() + seconds
        looked = 0
        while time.monotonic() < end:
            fresh = self.poll()[looked:]
            looked += len(fresh)
            for message in fresh:
                if condition(message):
                    return message
            time.sleep(0.01)
        raise AssertionError(f"none of {len(self.messages)} messages was it, within {seconds} s")


class RosPeer:
    def __init__(self, number, domain=None):
        self.number = number
        self.domain = domain or Domain(number, HERE)
        self.participant = DomainParticipant(number)

    def another(self):
        """One more participant, that comes now."""
        return RosPeer(self.number, self.domain)

    def topic(self, name, kind):
        return Topic(self.participant, f"rt/{name}", kind)

    def reader(self, name, kind, policies):
        return Heard(DataReader(self.participant, self.topic(name, kind), qos=Qos(*policies, Policy.History.KeepLast(100))))

    def writer(self, name, kind, policies=None):
        return DataWriter(self.participant, self.topic(name, kind), qos=Qos(*(policies or RELIABLE), Policy.History.KeepLast(10)))


class Bridge:
    """ale-ros2 on this computer alone."""

    def __init__(self, domain, lcm_url, *words):
        self.process = subprocess.Popen(
            [BINARIES / "ale-ros2", "--local", "--domain", str(domain), "--lcm-url", lcm_url, *map(str, words)],
            stderr=subprocess.PIPE, text=True, env={**os.environ, "ROS_DOMAIN_ID": ""})
        self.said = [self.process.stderr.readline()]

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
        self.said += self.process.communicate(timeout=SECONDS)[1].splitlines()
        return self.process.returncode
