"""A drive that goes on and on, and what a program holds meanwhile."""
import os

from at_hand import WORLDS


def rounds(folder, world, count):
    """The bundled world with its way driven several times over."""
    lines = (WORLDS / f"{world}.world").read_text(encoding="utf-8").splitlines()
    ways = [line for line in lines if line.startswith("# via")]
    path = folder / "rounds.world"
    path.write_text("\n".join(lines + ways * (count - 1)) + "\n", encoding="utf-8")
    return path


def resident_bytes(program):
    with open(f"/proc/{program.process.pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmRSS:"))


def descriptors(program):
    return len(os.listdir(f"/proc/{program.process.pid}/fd"))


def threads(program):
    return len(os.listdir(f"/proc/{program.process.pid}/task"))
