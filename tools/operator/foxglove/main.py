"""ale-foxglove: the robot in Foxglove, live, and its recordings as MCAP and back."""
import argparse
import json
import os
import pathlib
import pkgutil
import sys

from .names import Names

USAGE = """\
usage: ale-foxglove [--lcm-url URL] [--host ADDR] [--port N] [--namespace NAME] [--record F.mcap]
                    [--keys FILE [--robots FILE] [--robot NAME]]
       ale-foxglove convert IN OUT
       ale-foxglove layout [--namespace NAME] FILE
The robot in Foxglove: a WebSocket that Foxglove opens, and recordings turned into each other.
  --lcm-url URL    where the robot is (default: LCM_DEFAULT_URL, else LCM's own default)
  --host ADDR      who may open it: 127.0.0.1, this computer (default); 0.0.0.0, all the network
  --port N         of the WebSocket (default 8765; 0: a free one)
  --namespace NAME before the names of all topics and frames, of one robot among several: /NAME/scan, NAME/map
  --record F.mcap  what is shown goes into a file, too, and what the robot said for convert; F.mcap.lcm until it ends
  --keys FILE      the operator's secret key (ale-keys makes it): /cmd_vel, /initialpose, /goal_pose and the
                   service /ale/command are signed with it, by whomever they come; without it they are refused
  --robots FILE    the robots whose word is believed (default: the file of --keys with .robots behind)
  --robot NAME     which robot is commanded; needed where more than one is heard
  --help, --version
The address is printed on stdout. Runs until Ctrl-C or SIGTERM.
convert: IN is an LCM log, a .scip recording, an MCAP, a bag of ROS 1 or ROS 2, or any log that ale-replay reads;
OUT ends in .mcap, .lcm or .scip. layout: writes a layout for Foxglove (Layouts, Import from file).
Exit status: 0 fine, 1 failed, 2 wrong use.
"""


class WrongUse(Exception):
    """The command line asks for what cannot be."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise WrongUse(message)


def live_options(words):
    parser = Parser(add_help=False, prog="ale-foxglove", allow_abbrev=False)
    for name in ("lcm-url", "namespace", "record", "keys", "robots", "robot"):
        parser.add_argument(f"--{name}", default="")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=8765)
    options = parser.parse_args(words)
    if not 0 <= options.port <= 65535:
        raise WrongUse(f"--port {options.port}: expected a whole number from 0 to 65535")
    names_of(options.namespace)
    return options


def names_of(space):
    try:
        return Names(space)
    except ValueError as error:
        raise WrongUse(f"--namespace {error}") from error


def live(words):
    options = live_options(words)
    try:
        from . import live as bridge
    except ImportError as error:
        raise RuntimeError(f"{error}: pip install foxglove-sdk") from error
    return bridge.run(options)


def convert(words):
    if len(words) != 2 or any(word.startswith("--") for word in words):
        raise WrongUse("convert IN OUT")
    from . import convert as recordings
    recordings.convert(*words)
    return 0


def layout(words):
    parser = Parser(add_help=False, prog="ale-foxglove layout", allow_abbrev=False)
    parser.add_argument("--namespace", default="")
    parser.add_argument("file")
    options = parser.parse_args(words)
    named = in_namespace(json.loads(pkgutil.get_data(__package__, "layout.json")), names_of(options.namespace))
    pathlib.Path(options.file).write_text(json.dumps(named, indent=1) + "\n", encoding="utf-8")
    return 0


def in_namespace(layout_part, names):
    """The same with every topic and frame that it names; keys are topics, too."""
    if isinstance(layout_part, dict):
        return {in_namespace(key, names): in_namespace(value, names) if key != "followTf" else names.frame(value)
                for key, value in layout_part.items()}
    if isinstance(layout_part, list):
        return [in_namespace(each, names) for each in layout_part]
    return names.topic(layout_part) if isinstance(layout_part, str) and layout_part.startswith("/") else layout_part


def version():
    return pkgutil.get_data(__package__, "version.txt").decode().strip()


def answer(text):
    """On the standard output, past its buffer: what it does not take is known here."""
    try:
        os.write(sys.stdout.fileno(), text.encode())
    except OSError as error:
        raise RuntimeError(f"standard output: {error.strerror}") from error
    return 0


def run(words):
    if "--help" in words:
        return answer(USAGE)
    if "--version" in words:
        return answer(f"ale-foxglove {version()}\n")
    command = {"convert": convert, "layout": layout}.get(words[0] if words else "")
    return command(words[1:]) if command else live(words)


def main():
    try:
        return run(sys.argv[1:])
    except WrongUse as error:
        print(f"ale-foxglove: {error} (ale-foxglove --help)", file=sys.stderr)
        return 2
    except (OSError, RuntimeError, ValueError) as error:
        print(f"ale-foxglove: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 1
