#!/usr/bin/env python3
"""Files of every format, damaged as chance or an attacker damages them, given to the programs that read them.

    mutated_files.py [--programs build/asan/bin] [--inputs N] [--seed S] [--only FORMAT] [--keep FOLDER]

The programs are best a sanitized build. A program fails that crashes, that a sanitizer stops, that takes longer than 60 s or more
memory than 2 GB, or that ends with another code than 0, 1 and 2. What failed is kept, with the command that shows it again.
Checksums of the formats that have them are made right again in most inputs: else nothing behind them would be reached.
"""
import argparse
import bz2
import concurrent.futures
import gzip
import math
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIMIT_S = 60
MOMENT_S = "0.4"
NOBODY = "127.0.0.1:9"
SCANS = 24
NUMBERS = ["0", "-1", "1", "-0.0", "1e-9", "3.4e38", "1e308", "-1e308", "nan", "inf", "-inf", "9" * 40, "2147483647", "-2147483648",
           "2147483648", "4294967295", "4294967296", "9223372036854775807", "-9223372036854775808", "9223372036854", "-9223372036854",
           "2147.483647", "-2147.483648", "2147", "-2100", "1e12", "-1e12", "4e12", "", "x"]
WORDS = [0, 1, 0x7f, 0x80, 0xff, 0x7fff, 0x8000, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 0x7fffffffffffffff, 0x8000000000000000,
         0xffffffffffffffff, 0x4000000000000000, 0xc000000000000000]


# ---- what is damaged

def lines_at_hand():
    with gzip.open(ROOT / "tests/digest/apartment.log.gz", "rt") as log:
        return log.read().splitlines()[:SCANS + 1]


def scans():
    """(stamp, pose, ranges in metres) of a drive."""
    for words in map(str.split, lines_at_hand()[1:]):
        ranges = words[9:9 + int(words[8])]
        after = words[9 + len(ranges) + 1:]
        yield float(after[11]), [float(word) for word in after[3:6]], [float(word) for word in ranges]


def robot_laser():
    return "\n".join(lines_at_hand() + ["ODOM 0.1 0.2 0.3 0.2 0 0 1.5 host 1.5", ""]).encode()


def carmen():
    text = "PARAM robot_frontlaser_offset 0.1\n"
    for stamp, (x, y, theta), ranges in scans():
        beams = [f"{ranges[84 + k * 512 // 181]:.3f}" for k in range(181)]  # half a turn
        text += (f"ODOM {x} {y} {theta} 0.2 0 0 {stamp} host {stamp}\n"
                 f"FLASER 181 {' '.join(beams)} {x + 0.1} {y} {theta} {x} {y} {theta} {stamp} host {stamp}\n")
    return text.encode()


def millimetres(ranges, count):
    """The ranges, stretched over so many beams."""
    return [int(1000 * ranges[k * len(ranges) // count]) for k in range(count)]


def rover(header):
    lines = []
    for k, (stamp, (x, _, theta), ranges) in enumerate(scans()):
        left, right = (int((x + side * theta * 0.165) / (2 * math.pi * 0.077 / 2000)) for side in (-1, 1))
        numbers = header(int(stamp * 1e6) + k, left, right) + millimetres(ranges, 682)
        lines.append(" ".join(map(str, numbers)))
    return ("\n".join(lines) + "\n").encode()


def new_rover():
    return rover(lambda stamp, left, right: [stamp, 14710, left, right] + [3] * 21)


def old_rover():
    return rover(lambda stamp, left, right: [stamp, left, -right] + [0] * 10)


def scan_lines():
    return "".join(f"{stamp:.6f} " + " ".join(map(str, [19] * 44 + millimetres(ranges, 682))) + "\n"
                   for stamp, _, ranges in scans()).encode()


def pairs():
    return "".join(f"Odometry {x} {y} {theta}\nLaser {len(ranges)} " + " ".join(f"{r:.3f}" for r in ranges) + "\n"
                   for _, (x, y, theta), ranges in scans()).encode()


def lcm_string(text):
    return struct.pack(">i", len(text) + 1) + text + b"\0"


def lcm_log():
    sys.path.insert(0, os.environ.get("ALE_TYPES", str(ROOT / "build/python")))
    import ale  # pylint: disable=import-outside-toplevel
    out = b""
    for k, (stamp, (x, y, theta), ranges) in enumerate(scans()):
        odometry = ale.odometry_t()
        odometry.utime, odometry.x, odometry.y, odometry.theta = int(stamp * 1e6), x, y, theta
        scan = ale.scan_t()
        scan.utime, scan.range_mm = int(stamp * 1e6), millimetres(ranges, 682)
        scan.scan, scan.stamp_beam, scan.beam_time_us = k, -44, 97.656
        scan.first_bearing, scan.step, scan.range_min, scan.range_max = -2.086, math.tau / 1024, 0.02, 5.6
        scan.range_unit_mm, scan.num_ranges, scan.num_codes, scan.codes = 1, 682, 682, bytes(682)
        for channel, message in ((b"ALE_ODOMETRY", odometry), (b"ALE_SCAN", scan)):
            data = message.encode()
            out += struct.pack(">IqqII", 0xEDA1DA01, k, int(stamp * 1e6), len(channel), len(data)) + channel + data
    return out


def chunk(kind, stamp_us, payload):
    body = struct.pack("<B3xIq", kind, len(payload), stamp_us) + payload
    return b"CHNK" + body + struct.pack("<I", zlib.crc32(body))


def chunks(data):
    """[kind, stamp, payload] of each chunk of a recording."""
    found, at = [], 8
    while at + 24 <= len(data):
        kind, length, stamp = struct.unpack_from("<B3xIq", data, at + 4)
        found.append([kind, stamp, data[at + 20:at + 20 + length]])
        at += 24 + length
    return found


def rejoined(parts):
    return b"ALESCIP1" + b"".join(chunk(kind & 0xff, stamp, payload) for kind, stamp, payload in parts)


RECEIVED, SENT, ODOMETRY, COMMAND, CORRECTION, CONFIG = 1, 2, 3, 4, 5, 6


def scip_line(text):
    return text + bytes([(sum(text) & 0x3f) + 0x30]) + b"\n"


def scip_characters(value, count):
    return bytes(((value >> 6 * (count - 1 - k)) & 0x3f) + 0x30 for k in range(count))


def scip():
    """A recording as the flight recorder writes it: what the scanner says of itself, and its scans."""
    reply = b"PP\n00P\n" + b"".join(scip_line(text + b";") for text in (
        b"MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)", b"DMIN:20", b"DMAX:5600", b"ARES:1024", b"AMIN:44", b"AMAX:725", b"AFRT:384",
        b"SCAN:600")) + b"\n"
    parts = [[CONFIG, 0, b"[robot]\nwidth = 0.3\n"], [SENT, 0, b"PP\n"], [RECEIVED, 1000, reply],
             [SENT, 2000, b"MD0044072501000\n"], [RECEIVED, 3000, b"MD0044072501000\n00P\n\n"]]
    for k, (_, (x, y, theta), ranges) in enumerate(scans()):
        stamp = 100000 * (k + 1)
        sample = struct.pack("<iiIq", int(x * 1e6), int(y * 1e6), int(theta / math.tau * 2**32) & 0xffffffff, stamp)
        data = b"".join(scip_characters(value, 3) for value in millimetres(ranges, 682))
        frame = b"MD0044072501000\n99b\n" + scip_line(scip_characters(stamp // 1000, 4))
        frame += b"".join(scip_line(data[at:at + 64]) for at in range(0, len(data), 64)) + b"\n"
        parts += [[ODOMETRY, stamp, sample], [RECEIVED, stamp + 90000, frame[:900]], [RECEIVED, stamp + 99000, frame[900:]]]
        if k % 8 == 7:
            parts += [[COMMAND, stamp, b"alice drive 0.1 0: alice drives"], [CORRECTION, stamp, struct.pack("<IiiI", k, 10, 10, 0)]]
    return rejoined(parts)


# ---- how it is damaged

def damaged_bytes(rng, data):
    out = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8))):
        at = rng.randrange(len(out) + 1)
        size = min(rng.choice((1, 2, 4, 16, 200)), len(out) - at)
        how = rng.randrange(6)
        if how == 0 and at < len(out):
            out[at] ^= 1 << rng.randrange(8)
        elif how == 1:
            out[at:at + size] = rng.randbytes(size)
        elif how == 2:
            del out[at:at + size]
        elif how == 3:
            out[at:at] = out[at:at + size] * rng.choice((1, 3, 300))
        elif how == 4:
            word = struct.pack(rng.choice("<>") + rng.choice("BHIQ"), 0)
            value = rng.choice(WORDS) & ((1 << 8 * len(word)) - 1)
            out[at:at + len(word)] = value.to_bytes(len(word), rng.choice(("little", "big")))
        elif rng.random() < 0.2:
            del out[at:]
    return bytes(out)


def damaged_text(rng, data):
    """Numbers that nobody expects, words and lines that are gone, twice there or elsewhere."""
    if rng.random() < 0.3:
        return damaged_bytes(rng, data)
    lines = data.decode(errors="replace").split("\n")
    for _ in range(rng.choice((1, 1, 2, 6))):
        at = rng.randrange(len(lines))
        words = lines[at].split(" ")
        how = rng.randrange(8)
        k = rng.choice((0, 1, len(words) - 1, rng.randrange(len(words)), len(words) - 1 - rng.randrange(min(8, len(words)))))
        k = min(k, len(words) - 1)
        if how < 4:
            words[k] = rng.choice(NUMBERS)
        elif how == 4 and re.fullmatch(r"-?[0-9.e+-]+", words[k]):
            words[k] = rng.choice(("-", "")) + words[k] + rng.choice(("0", "000000", "e9", ".", "9" * 15))
        elif how == 5:
            words[k:k + 1] = words[k:k + 1] * rng.choice((0, 2, 50))
        elif how == 6:
            lines[at:at + 1] = lines[at:at + 1] * rng.choice((0, 2, 30))
            continue
        else:
            lines.insert(rng.randrange(len(lines)), lines[at])
        lines[at] = " ".join(words)
    return "\n".join(lines).encode()


def damaged_scip(rng, data):
    if rng.random() < 0.1:
        return damaged_bytes(rng, data)
    parts = chunks(data)
    for _ in range(rng.choice((1, 1, 2, 5))):
        part = rng.choice(parts)
        how = rng.randrange(6)
        if how == 0:
            part[1] = rng.choice((part[1] + rng.randrange(-10**7, 10**7), *(word - (word >> 63 << 64) for word in WORDS)))
        elif how == 1:
            part[0] = rng.randrange(12)
        elif how == 2:
            parts.insert(rng.randrange(len(parts)), list(part))
        elif how == 3 and part[0] == ODOMETRY:
            numbers = list(struct.unpack("<iiIq", part[2])) if len(part[2]) == 20 else [0, 0, 0, 0]
            for k in rng.sample(range(4), 2):
                numbers[k] = rng.choice(WORDS)
            part[2] = b"".join((n & (2**bits - 1)).to_bytes(bits // 8, "little") for n, bits in zip(numbers, (32, 32, 32, 64)))
        elif how == 4 and part[0] == RECEIVED:
            part[2] = damaged_reply(rng, part[2])
        else:
            part[2] = damaged_bytes(rng, part[2])[:65536]
    return rejoined(parts)


def damaged_reply(rng, data):
    """Lines of the scanner with other contents, and the sums that belong to them."""
    lines = data.split(b"\n")
    at = rng.randrange(len(lines))
    text = bytearray(lines[at][:-1])
    for _ in range(min(len(text), rng.choice((1, 4)))):
        text[rng.randrange(len(text))] = rng.choice(b"0oO019;:Pp~ ")
    if text:
        lines[at] = scip_line(bytes(text))[:-1]
    return b"\n".join(lines)


def damaged_map(rng, data):
    """With the sum that belongs to it."""
    if rng.random() < 0.1:
        return damaged_text(rng, data)
    text = damaged_text(rng, data[:data.rindex(b"end ")])
    counted = sum(line.startswith((b"wall ", b"corner ")) for line in text.split(b"\n"))
    if not text.endswith(b"\n"):
        text += b"\n"
    return text + b"end %d %08x\n" % (counted, zlib.crc32(text))


def packed(pack, damage):
    def damaged(rng, data):
        return damaged_bytes(rng, pack(data)) if rng.random() < 0.5 else pack(damage(rng, data))
    return damaged


# ---- who reads it

class Trial:
    """Programs, the folder of one input, and its number."""

    def __init__(self, programs, seeds, folder, number):
        self.programs = programs
        self.seeds = seeds
        self.folder = folder
        self.drawing = folder / f"out.{('svg', 'png', 'pgm', 'dxf')[number % 4]}"

    def replay(self, path, *more):
        return [[self.programs / "ale-replay", path, "--map", self.drawing, "--features", self.folder / "out.features", "--poses",
                 self.folder / "out.poses", "--trajectory", self.folder / "out.tum", *more]]

    def map_of_start(self, path):
        return self.replay(self.seeds / "carmen", "--load-map", path) + self.check("--map", path)

    def check(self, option, path):
        return [[self.programs / "ale-slamd", option, path, "--check-config"]]

    def setting(self, section, name, path):
        """A file that the configuration names."""
        config = self.folder / "naming.ini"
        config.write_text(f"[commands]\nkeys = {self.seeds / 'keys'}\n[{section}]\n{name} = {path}\n")
        return self.check("--config", config)

    def believed(self, path):
        """The robots that an operator believes are in a file beside his key, with an ending."""
        beside = self.folder / "alice.key.robots"
        shutil.copy(path, beside)
        scout = (self.seeds / "scout").read_text(encoding="ascii").strip()
        return [[self.programs / "ale-keys", "--know", scout, "--secret", beside.with_suffix("")]]

    def moment(self, name, *words):
        """Of a program that goes on until it is ended."""
        return [["timeout", "--preserve-status", MOMENT_S, self.programs / name, *words, "--lcm-url", "memq://"]]

    def operator(self, path):
        beside = self.folder / "alice.key"
        shutil.copy(path, beside)
        shutil.copy(self.seeds / "robots", f"{beside}.robots")
        return self.moment("ale-bridge", "--connect", NOBODY, "--keys", beside)

    def played(self, path):
        return self.moment("ale-sim", "--world", path, "--pty", self.folder / "urg", "--truth", self.folder / "out.tum", "--speed", "100")


FORMATS = {  # name: what is damaged, how, who reads it
    "carmen": (carmen, damaged_text, Trial.replay),
    "robot_laser": (robot_laser, damaged_text, Trial.replay),
    "new_rover": (new_rover, damaged_text, Trial.replay),
    "old_rover": (old_rover, damaged_text, Trial.replay),
    "scan_lines": (scan_lines, damaged_text, Trial.replay),
    "pairs": (pairs, damaged_text, Trial.replay),
    "lcm_log": (lcm_log, damaged_bytes, Trial.replay),
    "scip": (scip, damaged_scip, Trial.replay),
    "gzip": (carmen, packed(gzip.compress, damaged_text), Trial.replay),
    "bzip2": (carmen, packed(bz2.compress, damaged_text), Trial.replay),
    "map": (None, damaged_map, Trial.map_of_start),
    "config": (None, damaged_text, lambda trial, path: trial.check("--config", path)),
    "keys": (None, damaged_text, lambda trial, path: trial.check("--keys", path)),
    "own_key": (None, damaged_text, lambda trial, path: trial.setting("commands", "own_key", path)),
    "drive_key": (None, damaged_text, lambda trial, path: trial.setting("drive", "key", path)),
    "robots": (None, damaged_text, Trial.believed),
    "secret": (None, damaged_text, Trial.operator),
    "world": (None, damaged_text, Trial.played),
}


def write_seeds(programs, folder):
    """An intact file of each format; that the programs take it is looked at first."""
    for name, (make, _, _) in FORMATS.items():
        if make:
            (folder / name).write_bytes(make())
    (folder / "config").write_bytes(subprocess.run([programs / "ale-slamd", "--print-config"], check=True,
                                                   stdout=subprocess.PIPE).stdout)
    keys = programs / "ale-keys"
    subprocess.run([keys, "alice", "--secret", folder / "secret", "--robot", folder / "keys"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([keys, "--drive", folder / "drive_key"], check=True, stdout=subprocess.DEVNULL)
    (folder / "scout").write_bytes(subprocess.run([keys, "--own", "scout", "--robot", folder / "scouts"], check=True,
                                                  stdout=subprocess.PIPE).stdout)
    shutil.copy(folder / "keys.secret", folder / "own_key")
    shutil.copy(folder / "secret.robots", folder / "robots")
    shutil.copy(ROOT / "tools/lab/worlds/home.world", folder / "world")
    subprocess.run([programs / "ale-replay", folder / "carmen", "--save-map", folder / "map"], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def trouble(command, fine=(0, 1, 2)):
    """What is wrong with how a program ends; empty: nothing."""
    surroundings = {**os.environ, "ASAN_OPTIONS": "hard_rss_limit_mb=2000:allocator_may_return_null=1:detect_leaks=0",
                    "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1"}
    try:
        done = subprocess.run(list(map(str, command)), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              timeout=LIMIT_S, check=False, env=surroundings)
    except subprocess.TimeoutExpired:
        return f"longer than {LIMIT_S} s"
    words = done.stderr.decode(errors="replace")
    bad = re.search(r".*(runtime error|Sanitizer|rss limit).*", words)
    if bad:
        return words[bad.start():][:2000]
    return "" if done.returncode in fine else f"ended with {done.returncode}: {words[-400:]}"


def try_one(programs, seeds, name, number, keep):
    _, damage, read = FORMATS[name]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / name
        path.write_bytes(damage(random.Random(f"{name} {number}"), (seeds / name).read_bytes()))
        path.chmod(0o600)
        for command in read(Trial(programs, seeds, pathlib.Path(folder), number), path):
            wrong = trouble(command)
            if wrong:
                kept = keep / f"{name}-{number}"
                kept.write_bytes(path.read_bytes())
                shutil.copytree(seeds, keep / "intact", dirs_exist_ok=True)
                again = " ".join(map(str, command)).replace(str(path), str(kept)).replace(str(seeds), str(keep / "intact"))
                return f"{name} {number}: {wrong}\n  again: {again}"
    return ""


def try_all(args, seeds):
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        for name in [args.only] if args.only else [one for one in FORMATS if one not in args.without]:
            with tempfile.TemporaryDirectory() as folder:
                intact = [wrong for command in FORMATS[name][2](Trial(args.programs, seeds, pathlib.Path(folder), 0), seeds / name)
                          if (wrong := trouble(command, fine=(0,)))]
            numbers = range(args.seed, args.seed + args.inputs)
            wrong = intact + [text for text in pool.map(
                lambda number, name=name: try_one(args.programs, seeds, name, number, args.keep), numbers) if text]
            failed += len(wrong)
            print(f"  {'FAILED' if wrong else 'ok':6} {name:12} {args.inputs} inputs, {len(wrong)} failed", flush=True)
            print("".join(f"{text}\n" for text in wrong), end="", flush=True)
    return 1 if failed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--formats", action="store_true", help="only say which there are")
    parser.add_argument("--programs", type=pathlib.Path, default=pathlib.Path("build/asan/bin"))
    parser.add_argument("--inputs", type=int, default=2000, help="of each format")
    parser.add_argument("--seed", type=int, default=0, help="number of the first input")
    parser.add_argument("--only", choices=FORMATS)
    parser.add_argument("--without", nargs="*", choices=FORMATS, default=[], help="formats to leave out")
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("build/mutated"), help="where what failed is kept")
    args = parser.parse_args()
    if args.formats:
        print(*FORMATS)
        return 0
    args.keep.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        write_seeds(args.programs, pathlib.Path(folder))
        return try_all(args, pathlib.Path(folder))


if __name__ == "__main__":
    sys.exit(main())
