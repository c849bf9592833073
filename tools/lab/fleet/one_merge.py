"""Tasks of ale-fleet merge, each one run of ale-merge: a log is read, drives are joined, their map is drawn. Read and joined drives are
files of a folder that all workers reach, called by what they were made of: what is there is not made again.

A task hands on where its drives are, or None, and what was said of logs that are not among them."""
import hashlib
import json
import pathlib
import tempfile

from ale_fleet import distant, program


def part_of(parts, *made_of):
    return f"{parts}/{hashlib.sha256(json.dumps(made_of).encode()).hexdigest()[:32]}.drives"


def together(handed_on):
    return [part for part, _ in handed_on if part], [line for _, said in handed_on for line in said]


def read(merge, log, settings, parts):
    part = part_of(parts, log, settings)
    if distant.is_there(part):
        return part, []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        config, drives = folder / "settings.ini", folder / "read.drives"
        program.write_configuration(settings, config)
        try:
            local = distant.fetched(log, folder)
        except OSError as error:
            return None, [f"{log}: {distant.words_of(error)}"]
        done = program.run(merge, local, "--config", config, "--drives", drives)
        if done.returncode > 0:
            return None, [f"{log}: {program.complaint(done, local)}"]
        distant.stored(drives, part)
    return part, []


def join(merge, handed_on, parts):
    made_of, said = together(handed_on)
    if len(made_of) < 2:
        return made_of[0] if made_of else None, said
    part = part_of(parts, made_of)
    if not distant.is_there(part):
        with tempfile.TemporaryDirectory() as folder:
            drives = pathlib.Path(folder) / "joined.drives"
            done = program.run(merge, *(distant.fetched(other, folder) for other in made_of), "--drives", drives)
            if done.returncode > 0:
                raise RuntimeError(done.stderr.strip())
            distant.stored(drives, part)
    return part, said


def draw(merge, handed_on, outputs, words):
    """What was written for each output, an option and a path: {(its number, name): bytes}; what was said; whether all is in the map."""
    made_of, said = together(handed_on)
    if not made_of:
        return {}, [*said, "no drive is left"], False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for number, (option, path) in enumerate(outputs):
            (folder / str(number)).mkdir()
            words = [*words, option, folder / str(number) / pathlib.PurePath(path).name]
        done = program.run(merge, *(distant.fetched(part, name) for part in made_of), *words)
        written = {(number, file.name): file.read_bytes() for number in range(len(outputs)) for file in (folder / str(number)).iterdir()}
        return written, [*said, *done.stderr.splitlines()], done.returncode == 0 and not said
