"""Programs of this tree: beside this one, else in the PATH."""
import pathlib
import shutil
import sys


class Missing(RuntimeError):
    """A program or a package of Python that is not here; the text says what to do."""


def program(name):
    beside = pathlib.Path(sys.argv[0]).resolve().parent / name
    found = str(beside) if beside.exists() else shutil.which(name)
    if not found:
        raise Missing(f"{name} is not here: neither beside ale-foxglove nor in the PATH")
    return found
