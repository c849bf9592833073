#!/usr/bin/env python3
"""Plays a recording through the whole chain, in real time: ale-sim -> pseudo terminal -> ale-slamd -> LCM ->
ale-console and ale-watch.

    run.py [--build build] [--log LOG | --world WORLD] [--speed X]

Needs neither screen nor root. Leaves map.png, map.svg, trajectory.tum and the programs' messages in BUILD/run, and in
BUILD/run/recordings what was recorded from the page. In the end the drive is compared with ale-replay's of the same recording. A
computer that is too slow for the speed loses scans or closes loops later: then they end apart, and that is said. Exit 0 only when every
program ended well, every scan that was sent has its pose, and the computer was fast enough for a speed above 1.
"""
import argparse
import math
import pathlib
import re
import sys
from typing import NamedTuple

from programs import (ANSWER_SECONDS, START_SECONDS, Chain, Failure, Tally, ask, common_options, conclude, last_number,
                      private_lcm_url, require_programs, say)

PROGRAMS = ("ale-sim", "ale-slamd", "ale-console", "ale-watch")
REST_SECONDS = 20  # without a new pose after the last scan: no more will come
LONGEST_PAUSE_SECONDS = 30  # of a recording, as ale-sim plays it
SAME_END_M = 0.01
DEFAULT_WORLD = pathlib.Path("tools/lab/worlds/home.world")


def recording_of(world, folder, binaries):
    """The recording of a drive through a world, made once by the simulator."""
    recording = folder / f"{world.stem}.log"
    simulator = binaries / "ale-sim"
    made_from = max(path.stat().st_mtime for path in (world, simulator))
    if not recording.exists() or recording.stat().st_mtime < made_from:
        ask([simulator, "--world", world, "--write-log", recording, "--truth", recording.with_suffix(".truth.tum")])
    return recording


def write_config(recording, folder, binaries):
    """What the recording says about mounting and wheels, plus the scans for the console."""
    config = folder / "ale-slamd.ini"
    described = ask([binaries / "ale-sim", "--log", recording, "--describe"])
    config.write_text(described + "\n[lcm]\npublish_scan = true\n", encoding="utf-8")
    return config


def last_position(trajectory):
    """x and y in the last line of a TUM file."""
    return tuple(map(float, trajectory.read_text(encoding="utf-8").splitlines()[-1].split()[1:3]))


def distance_from_replay(recording, folder, binaries):
    """How far the drive ended from where ale-replay ends; None where there is no ale-replay."""
    if not (binaries / "ale-replay").exists():
        return None
    replayed = folder / "replayed.tum"
    ask([binaries / "ale-replay", recording, "--config", folder / "ale-slamd.ini", "--trajectory-live", replayed])
    return math.dist(last_position(folder / "trajectory.tum"), last_position(replayed))


def shortfall(outcome, distance):
    """What shows that the computer was too slow, in words; empty: nothing."""
    words = []
    if outcome.sent < outcome.scans:
        words.append(f"{outcome.scans - outcome.sent} of {outcome.scans} scans were not sent")
    if outcome.answered < outcome.sent:
        words.append(f"{outcome.sent - outcome.answered} of {outcome.sent} poses did not come")
    if outcome.behind:
        words.append(outcome.behind)
    if distance is not None and distance > SAME_END_M:
        words.append(f"the drive ends {distance:.3f} m from where ale-replay ends")
    return "; ".join(words)


def judge(outcome, distance, speed):
    """Says in one sentence whether the computer could follow; fails where a lower speed would help."""
    words = shortfall(outcome, distance)
    if not words:
        if distance is not None:
            say(f"the drive ends where ale-replay ends, {distance * 1000:.0f} mm apart")
        return
    if speed > 1:
        raise Failure(f"{speed:g} times the speed is too fast for this computer: {words}. Try SPEED={max(1, speed / 2):g}")
    say(f"this computer could not follow: {words}")


class Outcome(NamedTuple):
    scans: int  # that the scanner took
    sent: int
    answered: int
    behind: str  # what the firmware says of scans and corrections that it had no time for


def play(chain, recording, speed):
    """The run itself, to its end."""
    url = private_lcm_url()
    folder = chain.folder
    port = folder / "urg"
    config = write_config(recording, folder, chain.binaries)

    console = chain.start("ale-console", "--lcm-url", url, "--http", "127.0.0.1:0", "--recordings", folder / "recordings")
    watch = chain.start("ale-watch", "--lcm-url", url, "--map", folder / "map.png", "--map", folder / "map.svg",
                        "--trajectory", folder / "trajectory.tum", on_line=say)
    chain.wait_until(lambda: console.lines and "listening" in watch.said(), "start of console and watch", START_SECONDS)
    say(f"playing {recording}; watch it at {console.lines[0]}")

    sim = chain.start("ale-sim", "--log", recording, "--pty", port, "--once", "--speed", speed, "--lcm-url", url)
    chain.wait_until(port.exists, "the simulated scanner", START_SECONDS)
    slamd = chain.start("ale-slamd", "--config", config, "--port", port, "--lcm-url", url, "--time-scale", speed)

    tally = Tally(watch, LONGEST_PAUSE_SECONDS / speed)
    chain.wait_until(lambda: tally.require_progress() or not sim.running(), "the end of the recording", float("inf"))
    sim.require_success()
    scans, sent = (last_number(rf"^{word} (\d+)", sim.lines) for word in ("scans", "sent"))
    if sent is None:
        raise Failure(f"ale-sim did not say how many scans it sent, see {sim.log}")
    chain.wait_until(lambda: tally.poses >= sent or tally.rests(REST_SECONDS), "the last pose", ANSWER_SECONDS)
    for program in (slamd, watch, console):
        program.stop()
        program.require_success()
    behind = re.search(r"did not keep up: (.*)", slamd.said())
    return Outcome(scans, sent, last_number(r"^(\d+) poses", watch.lines), behind[1] if behind else "")


def results(folder):
    return [folder / name for name in ("map.png", "map.svg", "trajectory.tum")]


def run(arguments):
    binaries = arguments.build / "bin"
    folder = arguments.build / "run"
    require_programs(binaries, PROGRAMS)
    folder.mkdir(parents=True, exist_ok=True)
    for old in [*results(folder), folder / "urg"]:
        old.unlink(missing_ok=True)
    recording = arguments.log or recording_of(arguments.world, folder, binaries)
    chain = Chain(folder, binaries)
    try:
        outcome = play(chain, recording, arguments.speed)
    finally:
        chain.stop_all()
    for result in results(folder):
        if not result.exists() or result.stat().st_size == 0:
            raise Failure(f"{result} was not written")
    # A scan that never left the scanner may be noticed by the gap in the stamps, and answered too.
    too_few = outcome.answered < outcome.sent and arguments.speed <= 1
    if too_few or outcome.answered > outcome.scans:
        raise Failure(f"{outcome.sent} of {outcome.scans} scans sent, but {outcome.answered} poses came")
    say(f"{outcome.sent} scans sent, {outcome.answered} poses came; results in {', '.join(map(str, results(folder)))}")
    judge(outcome, distance_from_replay(recording, folder, binaries), arguments.speed)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    common_options(parser)
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--log", type=pathlib.Path, help="recording to play (default: made from the world)")
    source.add_argument("--world", type=pathlib.Path, default=DEFAULT_WORLD, help=f"world to drive through (default {DEFAULT_WORLD})")
    arguments = parser.parse_args()
    return conclude("run", lambda: run(arguments))


if __name__ == "__main__":
    sys.exit(main())
