#!/usr/bin/env python3
"""The site's sources: the pages of this folder, and those that are written from the tree.

    generate.py --root . --build build --out FOLDER

messages.md comes from lib/messages/*.lcm, options.md from every program's --help, configuration.md from `ale-slamd --print-config`, story.md
from lib/README.md with its pictures.
"""
import argparse
import pathlib
import re
import shutil
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
PICTURES = {"intel.png": "tools/lab/figures/intel.png"}
STRUCT = re.compile(r"((?://[^\n]*\n)*)struct (\w+) \{\n(.*?)^\}", re.MULTILINE | re.DOTALL)


def cell(text):
    return text.replace("|", "\\|")


def fields(body):
    """(type, name, comment) of each line of a struct; a comment on a line of its own goes on the field before."""
    found = []
    for line in body.splitlines():
        code, _, comment = (part.strip() for part in line.partition("//"))
        if code:
            kind, _, names = code.rstrip(";").partition(" ")
            found.append([kind, names.strip(), comment])
        elif comment and found:
            found[-1][2] += " " + comment
    return found


def messages(root):
    """A page of all message types."""
    yield "# Messages\n\nEach type as `lib/messages` has it: LCM, SI units and radians, x forward, y left, angles counter-clockwise.\n"
    for path in sorted((root / "lib/messages").glob("*.lcm")):
        text = path.read_text(encoding="utf-8")
        package = re.search(r"^package (\w+);", text, re.MULTILINE)[1]
        yield f"\n## Package `{package}`\n"
        for comment, name, body in STRUCT.findall(text):
            said = " ".join(line.removeprefix("//").strip() for line in comment.splitlines())
            channel = re.match(r"(ALE_\w+): *(.*)", said)
            yield f"\n### {name if package == 'ale' else f'{package}.{name}'}\n"
            yield (f"\nChannel `{channel[1]}`: {channel[2]}\n" if channel else f"\n{said}\n") if said else ""
            yield "\n| field | type | what |\n|---|---|---|\n"
            yield from (f"| `{cell(names)}` | `{kind}` | {cell(comment)} |\n" for kind, names, comment in fields(body))


def programs(build):
    return sorted(path for path in (build / "bin").glob("ale-*") if not path.is_symlink())


def told(program, option):
    return subprocess.run([program, option], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True, timeout=60).stdout


def options(build):
    """A page of what every program says to --help."""
    yield "# Options\n\nWhat each program says to `--help`.\n"
    for program in programs(build):
        yield f"\n## {program.name}\n\n```text\n{told(program, '--help').rstrip()}\n```\n"


def configuration(build):
    """Keys with default and comment, section by section, of what ale-slamd prints."""
    yield "# Configuration\n\nThe keys of the file that `ale-slamd --config` reads, with their defaults, as `ale-slamd --print-config` writes them.\n"
    comment, sections = [], {}
    for line in told(build / "bin/ale-slamd", "--print-config").splitlines():
        section, pair = re.fullmatch(r"\[(\w+)\]", line), re.fullmatch(r"(?:# )?(\w+) =(.*)", line)
        if section:
            rows = sections.setdefault(section[1], [])
            comment.clear()
        elif pair:  # a remark, where it follows something else
            rows.append((pair[1], pair[2].strip(), " ".join(comment)))
            comment.clear()
        elif line.startswith("#"):
            comment.append(line.removeprefix("#").strip())
        else:
            comment.clear()
    for name, rows in sections.items():
        yield f"\n## [{name}]\n\n| key | default | what |\n|---|---|---|\n"
        yield from (f"| `{key}` | {f'`{cell(value)}`' if value else 'empty'} | {cell(said)} |\n" for key, value, said in rows)


def story(root, out):
    """lib/README.md: pictures come along, links into the tree become their words."""
    text = re.sub(r"<!--.*?-->\n?", "", (root / "lib/README.md").read_text(encoding="utf-8"), flags=re.DOTALL)

    def picture(found):
        path = (root / "lib" / found[2]).resolve()
        shutil.copyfile(path, out / path.name)
        return f"![{found[1]}]({path.name})"

    text = re.sub(r"!\[([^\]]*)\]\(([^)]+)\)", picture, text)
    return re.sub(r"(?<!!)\[([^\]]+)\]\((?!https?:)(?![\w.]+\.png\))[^)]+\)", r"\1", text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path("."))
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--out", type=pathlib.Path, required=True)
    asked = parser.parse_args()
    root, build, out = asked.root.resolve(), asked.build.resolve(), asked.out.resolve()
    shutil.rmtree(out, ignore_errors=True)
    shutil.copytree(HERE / "pages", out / "pages")
    shutil.copyfile(HERE / "mkdocs.yml", out / "mkdocs.yml")
    pages = out / "pages"
    for name, path in PICTURES.items():
        shutil.copyfile(root / path, pages / name)
    (pages / "messages.md").write_text("".join(messages(root)), encoding="utf-8")
    (pages / "options.md").write_text("".join(options(build)), encoding="utf-8")
    (pages / "configuration.md").write_text("".join(configuration(build)), encoding="utf-8")
    (pages / "story.md").write_text(story(root, pages), encoding="utf-8")


if __name__ == "__main__":
    main()
