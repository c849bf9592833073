#!/usr/bin/env python3
"""Turn files into a C++ source that holds them: embed.py OUT.cpp FILE...

The result defines `ale_page_files` and `ale_page_file_count` as declared in tools/operator/console/page.h.
"""
import pathlib
import sys


def literal(data):
    lines = (data[i:i + 20] for i in range(0, len(data), 20))
    return ",\n    ".join(", ".join(f"0x{b:02x}" for b in line) for line in lines)


def main():
    out, *files = sys.argv[1:]
    text = ['#include "operator/console/page.h"', "", "namespace", "{"]
    entries = []
    for k, name in enumerate(files):
        data = pathlib.Path(name).read_bytes()
        text.append(f"const unsigned char file_{k}[] = {{\n    {literal(data)}}};")
        entries.append(f'    {{"{pathlib.Path(name).name}", file_{k}, sizeof file_{k}}},')
    text += ["} // namespace", "", "const ale_page_file_t ale_page_files[] = {", *entries, "};",
             f"const unsigned ale_page_file_count = {len(files)};", ""]
    pathlib.Path(out).write_text("\n".join(text))


main()
