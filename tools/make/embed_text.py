#!/usr/bin/env python3
"""Turn a text file into a C source that holds it: embed_text.py OUT.c NAME FILE

The result defines `const char NAME[]`, whose last character is 0. Compilers take strings of 4095 characters only, so it is numbers.
"""
import pathlib
import sys


def main():
    out, name, file = sys.argv[1:]
    data = pathlib.Path(file).read_bytes() + b"\0"
    rows = (data[k:k + 20] for k in range(0, len(data), 20))
    numbers = ",\n    ".join(", ".join(map(str, row)) for row in rows)
    pathlib.Path(out).write_text(f"extern const char {name}[];\n\nconst char {name}[] = {{\n    {numbers}}};\n", encoding="ascii")


main()
