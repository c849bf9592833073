"""Runs a program as a unit's SystemCallFilter= lets it, but kills it for any other call: under_filter.py UNIT PROGRAM [ARG...]

The groups of system calls are taken from `systemd-analyze syscall-filter`. What systemd allows without being asked is @default."""
import ctypes
import os
import subprocess
import sys

ALLOW = 0x7FFF0000
KILL_PROCESS = 0x80000000


def groups():
    """The calls and groups that each group names."""
    told = subprocess.run(["systemd-analyze", "syscall-filter"], check=True, capture_output=True, text=True).stdout
    found, name = {}, None
    for line in told.splitlines():
        word = line.strip()
        if line.startswith("@"):
            name = word
            found[name] = []
        elif word and not word.startswith("#") and name and line.startswith(" "):
            found[name].append(word)
    return found


def calls(words, known):
    """The names of all system calls that these words mean."""
    found = set()
    for word in words:
        found |= calls(known[word], known) if word.startswith("@") else {word}
    return found


def allowed(lines, known):
    """What a unit's lines allow, one after the other, as systemd adds and takes away."""
    names = calls(["@default"], known)
    for line in lines:
        if line.startswith("~"):
            names -= calls(line[1:].split(), known)
        else:
            names |= calls(line.split(), known)
    return names


def lines_of(unit, key):
    with open(unit, encoding="utf-8") as file:
        return [line.split("=", 1)[1].strip() for line in file if line.startswith(f"{key}=")]


def confine(names):
    library = ctypes.CDLL("libseccomp.so.2")
    library.seccomp_init.restype = ctypes.c_void_p
    context = ctypes.c_void_p(library.seccomp_init(ctypes.c_uint32(KILL_PROCESS)))
    for name in names:
        number = library.seccomp_syscall_resolve_name(name.encode())
        if number >= 0:  # others are of other machines
            assert library.seccomp_rule_add(context, ctypes.c_uint32(ALLOW), number, 0) == 0, name
    assert library.seccomp_load(context) == 0


def main():
    unit, program = sys.argv[1], sys.argv[2:]
    confine(allowed(lines_of(unit, "SystemCallFilter"), groups()))
    os.execv(program[0], program)


if __name__ == "__main__":
    main()
