"""A robot in the chain with one operator who has a key."""
import os
import subprocess

from at_hand import BINARIES


class Commanded:
    """simulator: False for a robot that needs no scanner to answer. how: of the firmware (prefix)."""

    def __init__(self, chain, config="", simulator=True, **how):
        self.chain = chain
        self.key = chain.folder / "alice.key"
        self.keys = chain.folder / "robot.keys"
        self._tool("ale-keys", "alice", "--secret", self.key, "--robot", self.keys)
        if simulator:
            chain.simulator("--world", "tools/lab/worlds/home.world", "--drive")
        config = f"[commands]\nrobot = rover\n{config}"
        self.firmware = chain.firmware(config, "--keys", self.keys, **how)
        self.firmware.wait_until(lambda: chain.listener.statuses and (chain.listener.poses or not simulator), "the robot")

    def _tool(self, name, *words):
        return subprocess.run([BINARIES / name, *map(str, words)], stdin=subprocess.DEVNULL, text=True, timeout=180,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)

    def send(self, *words):
        """Whether the robot obeyed, and what it said."""
        done = self._tool("ale-send", "--keys", self.key, "--lcm-url", self.chain.url, *words)
        return done.returncode == 0, (done.stdout + done.stderr).strip()


def may_mount():
    """Whether a namespace of mounts can be had: as root, where the kernel allows it."""
    return os.geteuid() == 0 and subprocess.run(["unshare", "--mount", "true"], check=False, stderr=subprocess.DEVNULL).returncode == 0
