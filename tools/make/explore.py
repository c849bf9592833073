#!/usr/bin/env python3
"""Lets the robot explore a simulated world by itself, with all the real programs: ale-sim, which obeys ALE_DRIVE,
ale-slamd, ale-console to watch and take over, ale-watch, and one signed command, `explore on`.

    explore.py [--build build] [--world WORLD] [--speed X] [--seed N]

Leaves map.png, map.svg, trajectory.tum, truth.tum and the programs' messages in BUILD/explore. Exit 0 only when the
robot said that it has finished, hit nothing, and stands within 10 cm of its start.
"""
import argparse
import math
import pathlib
import re
import sys
import time

from programs import (ANSWER_SECONDS, START_SECONDS, STALL_SECONDS, Chain, Failure, Tally, ask, common_options, conclude,
                      last_number, positive, private_lcm_url, require_programs, say)

WORLD = pathlib.Path("tools/lab/worlds/arena.world")
FARTHEST_OFF_M = 0.10
PROGRAMS = ("ale-sim", "ale-slamd", "ale-console", "ale-watch", "ale-keys", "ale-send")
RESULTS = ("map.png", "map.svg", "trajectory.tum", "truth.tum")


def make_keys(chain):
    """One operator who may command this robot: the secret key, and the robot's list."""
    secret, listed = chain.folder / "operator.key", chain.folder / "robot.keys"
    for old in (secret, listed):
        old.unlink(missing_ok=True)
    ask([chain.binaries / "ale-keys", "operator", "--secret", secret, "--robot", listed])
    return secret, listed


def start_programs(chain, arguments, url):
    """The chain with the robot standing; simulator, watcher, and the operator's key."""
    folder, port = chain.folder, chain.folder / "urg"
    secret, listed = make_keys(chain)
    console = chain.start("ale-console", "--lcm-url", url, "--http", "127.0.0.1:0", "--keys", secret,
                          "--recordings", folder / "recordings")
    watch = chain.start("ale-watch", "--lcm-url", url, "--map", folder / "map.png", "--map", folder / "map.svg",
                        "--trajectory", folder / "trajectory.tum", on_line=say)
    chain.wait_until(lambda: console.lines and "listening" in watch.said(), "start of console and watch", START_SECONDS)
    say(f"exploring {arguments.world}; watch it, and take over, at {console.lines[0]}")
    sim = chain.start("ale-sim", "--world", arguments.world, "--drive", "--pty", port, "--speed", arguments.speed,
                      "--seed", arguments.seed, "--truth", folder / "truth.tum", "--lcm-url", url)
    chain.wait_until(port.exists, "the simulated scanner", START_SECONDS)
    config = folder / "ale-slamd.ini"
    config.write_text("[lcm]\npublish_scan = yes\n", encoding="utf-8")
    chain.start("ale-slamd", "--config", config, "--port", port, "--lcm-url", url, "--keys", listed, "--time-scale",
                arguments.speed)
    chain.wait_until(lambda: Tally(watch).poses > 0, "the first pose", START_SECONDS)
    return sim, watch, secret


def finished(watch, tally):
    """Whether the robot says so; fails when poses stop, or the way back stays closed."""
    tally.require_progress()
    recent = watch.lines[-STALL_SECONDS:]
    if len(recent) == STALL_SECONDS and all("way back is closed" in line for line in recent):
        raise Failure(f"the way back is closed; see {watch.log.parent}")
    return any(" finished: " in line for line in watch.lines[-3:])


def off_from_start(truth):
    """Metres between the first and the last true position."""
    rows = [line.split() for line in truth.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"]
    return math.dist(map(float, rows[0][1:3]), map(float, rows[-1][1:3]))


def explore(chain, arguments):
    url = private_lcm_url()
    sim, watch, secret = start_programs(chain, arguments, url)
    started = time.monotonic()
    say(ask([chain.binaries / "ale-send", "--keys", secret, "--lcm-url", url, "explore", "on"]).strip())
    tally = Tally(watch)
    chain.wait_until(lambda: finished(watch, tally), "the end of the exploration", arguments.longest / arguments.speed)
    seconds = (time.monotonic() - started) * arguments.speed
    for program in (sim, *(p for p in chain.programs if p is not sim)):
        program.stop()
        program.require_success(ANSWER_SECONDS)
    seen = re.search(r"finished: (.*?)(?:  |$)", watch.said(), re.MULTILINE)[1]
    return seconds, seen, last_number(r"^collisions (\d+)", sim.lines)


def run(arguments):
    folder = arguments.build / "explore"
    require_programs(arguments.build / "bin", PROGRAMS)
    folder.mkdir(parents=True, exist_ok=True)
    for old in [folder / name for name in (*RESULTS, "urg")]:
        old.unlink(missing_ok=True)
    chain = Chain(folder, arguments.build / "bin")
    try:
        seconds, seen, collisions = explore(chain, arguments)
    finally:
        chain.stop_all()
    off = off_from_start(folder / "truth.tum")
    say(f"finished after {seconds:.0f} s of the robot's time: {seen}, {collisions} collisions, back {off:.3f} m from its "
        f"start; results in {', '.join(str(folder / name) for name in RESULTS)}")
    if collisions != 0 or off > FARTHEST_OFF_M:
        raise Failure(f"{collisions} collisions, {off:.3f} m from its start")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    common_options(parser)
    parser.add_argument("--world", type=pathlib.Path, default=WORLD, help=f"world to explore (default {WORLD})")
    parser.add_argument("--seed", type=int, default=1, help="another run of noise, wheel errors and slip")
    parser.add_argument("--longest", type=positive, default=1800, help="seconds of the robot's time to wait")
    arguments = parser.parse_args()
    return conclude("explore", lambda: run(arguments))


if __name__ == "__main__":
    sys.exit(main())
