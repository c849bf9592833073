"""A program of the tree, run by a worker."""
import subprocess


class Broken(Exception):
    """The program was ended from outside: worth another try, elsewhere."""


def run(program, *words):
    """Its end, however it came about; what it said is in stderr."""
    done = subprocess.run([program, *map(str, words)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          errors="replace", check=False)
    if done.returncode < 0:
        raise Broken(f"{program} ended by signal {-done.returncode}")
    return done


def complaint(done, file):
    """The last that it said of this file."""
    said = (done.stderr.strip().splitlines() or [f"exit {done.returncode}"])[-1]
    return said.rpartition(f"{file}: ")[2]


def write_configuration(settings, path):
    """The file of section.key, value."""
    sections = {}
    for name, value in settings:
        section, key = name.split(".", 1)
        sections.setdefault(section, []).append(f"{key} = {value}")
    path.write_text("".join(f"[{section}]\n" + "\n".join(lines) + "\n" for section, lines in sections.items()), encoding="utf-8")
