#!/usr/bin/env python3
"""A manual page of what a program says to --help and --version: man_page.py PROGRAM SECTION > ale-NAME.1

The first lines, from "usage:" on, are the synopsis; the first sentence behind them is the program's name in a line. Lines
"  WORD   text" are a list, with what is indented further below; other indented lines stay as they are.
"""
import pathlib
import re
import subprocess
import sys

ITEM = re.compile(r"  (\S.*?)(?:   *(\S.*))?")
FURTHER = 4  # blanks before the second line of an item


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def with_bold_options(text):
    return re.sub(r"(?<![\w-])--[a-z][a-z-]*", lambda option: f"\0{option[0]}\1", text)


def line(text):
    return escaped(with_bold_options(text)).replace("\0", "\\fB").replace("\1", "\\fR")


def as_it_is(lines):
    return [".nf", *(line(text) or "\\&" for text in lines), ".fi"]


def synopsis_and_rest(lines):
    end = next((k for k, text in enumerate(lines) if k and not text.startswith(" ")), len(lines))
    return [text.removeprefix("usage:").removeprefix(" " * len("usage:")).removeprefix(" ") for text in lines[:end]], lines[end:]


def summary(lines):
    """The first sentence, to stand behind the program's name."""
    sentence = re.match(r"(.*?)(?:[.:;](?:\s|$)|$)", " ".join(" ".join(lines).split()))[1]
    return sentence[:1].lower() + sentence[1:]


def body(lines):
    page, in_list = [], False
    for text in lines:
        item = ITEM.fullmatch(text)
        if not text:
            in_list = False
            page.append(".PP")
        elif item and text[2] != " ":
            in_list = True
            page += [".TP", line(item[1]) if item[1].startswith("-") else f"\\fB{line(item[1])}\\fR"] + ([line(item[2])] if item[2] else [])
        elif in_list and text.startswith(" " * FURTHER):
            page.append(line(text.strip()))
        elif text.startswith(" "):
            page += as_it_is([text])
        else:
            page += [".PP"] * in_list + [line(text)]
            in_list = False
    return page


def page(name, section, said, version):
    synopsis, rest = synopsis_and_rest(said.rstrip("\n").split("\n"))
    while rest and not rest[0]:
        rest.pop(0)
    return "\n".join([f'.TH {name.upper()} {section} "" "{version}" "ALE\\-SLAM"', ".SH NAME", f"{escaped(name)} \\- {escaped(summary(rest))}",
                      ".SH SYNOPSIS", *as_it_is(synopsis), ".SH DESCRIPTION", *body(rest)]) + "\n"


def main():
    if len(sys.argv) != 3:
        print(__doc__.splitlines()[0], file=sys.stderr)
        return 2
    program = pathlib.Path(sys.argv[1])
    said, version = (subprocess.run([program.absolute(), option], check=True, capture_output=True, text=True).stdout
                     for option in ("--help", "--version"))
    sys.stdout.write(page(program.name, sys.argv[2], said, version.strip()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
