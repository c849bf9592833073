#!/usr/bin/env python3
"""Plays a recording through the whole chain, in real time: ale-sim -> pseudo terminal -> ale-slamd -> LCM ->
ale-console and ale-watch.

    run.py [--build build] [--log LOG | --world WORLD] [--speed X]

Needs neither screen nor root. Leaves map.png, map.svg, trajectory.tum and the programs' messages in
BUILD/run. Exit 0 only when every program ended well and every scan that was sent has its pose.
"""
import argparse
import pathlib
import sys

from programs import (ANSWER_SECONDS, START_SECONDS, Chain, Failure, Tally, ask, common_options, conclude, last_number,
                      private_lcm_url, require_programs, say)

PROGRAMS = ("ale-sim", "ale-slamd", "ale-console", "ale-watch")
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


def play(chain, recording, speed):
    """The run itself. How many scans the scanner took, how many of them it sent, and how many poses came."""
    url = private_lcm_url()
    folder = chain.folder
    port = folder / "urg"
    config = write_config(recording, folder, chain.binaries)

    console = chain.start("ale-console", "--lcm-url", url, "--http", "127.0.0.1:0")
    watch = chain.start("ale-watch", "--lcm-url", url, "--map", folder / "map.png", "--map", folder / "map.svg",
                        "--trajectory", folder / "trajectory.tum", on_line=say)
    chain.wait_until(lambda: console.lines and "listening" in watch.said(), "start of console and watch", START_SECONDS)
    say(f"playing {recording}; watch it at {console.lines[0]}")

    sim = chain.start("ale-sim", "--log", recording, "--pty", port, "--once", "--speed", speed, "--lcm-url", url)
    chain.wait_until(port.exists, "the simulated scanner", START_SECONDS)
    slamd = chain.start("ale-slamd", "--config", config, "--port", port, "--lcm-url", url, "--time-scale", speed)

    tally = Tally(watch)
    chain.wait_until(lambda: tally.require_progress() or not sim.running(), "the end of the recording", float("inf"))
    sim.require_success()
    scans, sent = (last_number(rf"^{word} (\d+)", sim.lines) for word in ("scans", "sent"))
    if sent is None:
        raise Failure(f"ale-sim did not say how many scans it sent, see {sim.log}")
    chain.wait_until(lambda: tally.poses >= sent, "the last pose", ANSWER_SECONDS)
    for program in (slamd, watch, console):
        program.stop()
        program.require_success()
    return scans, sent, last_number(r"^(\d+) poses", watch.lines)


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
        scans, sent, answered = play(chain, recording, arguments.speed)
    finally:
        chain.stop_all()
    for result in results(folder):
        if not result.exists() or result.stat().st_size == 0:
            raise Failure(f"{result} was not written")
    # A scan that never left the scanner may be noticed by the gap in the stamps, and answered too.
    if not sent <= answered <= scans:
        raise Failure(f"{sent} of {scans} scans sent, but {answered} poses came")
    say(f"{sent} scans sent, {answered} poses came; results in {', '.join(map(str, results(folder)))}")


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
