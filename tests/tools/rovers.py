"""Two robots on one network, told apart by prefixes, and a console that has both, and a third one that is never heard."""
import subprocess

import lcm
import pytest

import ale
from at_hand import BINARIES
from recorded import RECORDED, write_map, write_recording
from robot_double import RobotDouble
from waiting import Ear
from watching import Console

NAMES = ("rover1", "rover2", "rover3")
FIRST_SCAN = {"rover1": 0, "rover2": 1000}


class PrefixedBus:
    """liblcm knows no prefixes."""

    def __init__(self, url, prefix):
        self.bus, self.prefix = lcm.LCM(url), prefix

    def publish(self, channel, data):
        self.bus.publish(self.prefix + channel, data)


class Rover(RobotDouble):
    """A robot double that nobody takes for the other: by name, start and numbers of its scans."""

    def __init__(self, url, name, own_key):
        super().__init__(url, boot=int(name[-1]), own_key=own_key)
        self.bus, self.name, self.scan = PrefixedBus(url, f"{name}."), name, FIRST_SCAN[name]

    def step(self):
        if self.scan == FIRST_SCAN["rover2"]:
            self.publish_map()
        super().step()


class Rovers:
    def __init__(self, folder, url):
        subprocess.run([BINARIES / "ale-keys", "alice"], cwd=folder, check=True, capture_output=True, timeout=180)
        self.folder = folder
        self.one, self.two = (Rover(url, name, folder / "robot.keys.secret") for name in NAMES[:2])
        write_recording(folder / f"rover1/{RECORDED}.lcm")
        write_map(folder / "maps2/flat.map")
        options = [option for name in NAMES[1:] for option in ("--lcm-url", f"{url}&prefix={name}.")]
        for kind, names in (("--recordings", NAMES), ("--maps", ("maps1", "maps2", "maps3"))):
            options += [option for name in names for option in (kind, folder / name)]
        self.console = Console(f"{url}&prefix=rover1.", "127.0.0.1:0", "--keys", folder / "alice.key", *options)
        self.commands = []  # (robot whose channel it was, command)
        self.ear = Ear(url, [f"{name}.ALE_COMMAND" for name in NAMES], self._heard)

    def _heard(self, channel, data):
        self.commands.append((channel.split(".")[0], ale.command_t.decode(data)))

    @property
    def verbs(self):
        return [(name, command.verb) for name, command in self.commands]

    def url_of(self, name):
        return f"{self.console.url}&robot={name}"

    def step(self):
        self.one.step()
        self.two.step()

    def end(self):
        self.ear.stop()
        assert self.console.end() == 0


@pytest.fixture
def rovers(tmp_path, lcm_url):
    running = Rovers(tmp_path, lcm_url)
    yield running
    running.end()
