"""What somebody asks of the robot from Foxglove, signed by ale-send with the bridge's key.

    orders = Orders(ale_send, ["--keys", "alice.key", ...])       # or Orders(None): all is refused
    orders.give("drive 0.2 0")                                     # (obeyed, words)

Topics that Foxglove publishes (3D panel, Teleop panel): /cmd_vel, /initialpose, /goal_pose, as JSON with the fields of ROS.
"""
import json
import math
import queue
import subprocess
import threading

REFUSED = "this bridge has no key: it only shows (ale-foxglove --keys FILE)"
ANSWER_SECONDS = 10
MOST = 2000.0


class Refused(ValueError):
    """Why it is no command."""


def number(value):
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < MOST:
        raise Refused("a number out of this world")
    return f"{value:.6f}"


def heading(turn):
    x, y, z, w = (float(turn.get(axis, 0)) for axis in "xyzw")
    if not abs(math.sqrt(x * x + y * y + z * z + w * w) - 1) < 0.05 or math.hypot(x, y) > 0.02:
        raise Refused("an orientation that is no heading")
    return 2 * math.atan2(z, w)


def pose_of(message, map_frame):
    """x, y, theta in the map."""
    frame = message.get("header", {}).get("frame_id", "").lstrip("/")
    if frame != map_frame:
        raise Refused(f'a pose in the frame "{frame[:32]}": only those in "{map_frame}" are understood')
    pose = message["pose"].get("pose", message["pose"])
    position = pose["position"]
    return number(position["x"]), number(position["y"]), number(heading(pose["orientation"]))


def drive_command(message, _map_frame):
    twist = message.get("twist", message)
    if abs(float(twist["linear"].get("y", 0))) > 0.001:
        raise Refused("this robot does not go sideways (linear.y)")
    return f"drive {number(twist['linear']['x'])} {number(twist['angular']['z'])}"


def place_command(message, map_frame):
    return " ".join(("relocate", *pose_of(message, map_frame)))


def goal_command(message, map_frame):
    """How it stands there is left to the robot."""
    return " ".join(("goto", *pose_of(message, map_frame)[:2]))


TOPICS = {"/cmd_vel": drive_command, "/initialpose": place_command, "/goal_pose": goal_command, "/move_base_simple/goal": goal_command}


def command_of(topic, data, map_frame="map"):
    """A line for ale-send. topic: one of TOPICS. Raises Refused."""
    try:
        return TOPICS[topic](json.loads(data), map_frame)
    except Refused:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise Refused("no such message as JSON") from error


class Orders:
    def __init__(self, command):
        """command: ale-send and its options; None: there is no key."""
        self.lock = threading.Lock()
        self.answers = queue.Queue()
        self.process = None
        if command:
            self.process = subprocess.Popen([*command, "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        for line in self.process.stdout:
            self.answers.put(line.rstrip("\n"))
        self.answers.put(None)

    def give(self, line):
        """(obeyed, what the robot or ale-send says)."""
        if not self.process:
            return False, REFUSED
        if not line.isprintable() or not line.isascii():
            return False, "a word with a character that no command has"
        with self.lock:
            try:
                self.process.stdin.write(line + "\n")
                self.process.stdin.flush()
                answer = self.answers.get(timeout=ANSWER_SECONDS)
            except (OSError, ValueError, queue.Empty):
                answer = None
        if answer is None:
            return False, "ale-send has ended, or does not answer"
        word, _, words = answer.partition(" ")
        return word == "obeyed", words

    def close(self):
        if self.process:
            self.process.stdin.close()
            self.process.wait()
