"""Instructions by valgrind's callgrind, counted inside one function alone."""
import re
import subprocess
import tempfile


def instructions(function, command):
    """How many, in the whole run of the command, and what it printed."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--toggle-collect={function}", f"--callgrind-out-file={folder}/out",
             *command], check=True, capture_output=True, text=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1)), done.stdout
