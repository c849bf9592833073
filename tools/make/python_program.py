#!/usr/bin/env python3
"""A program of Python in one file: python_program.py OUT FOLDER INTERPRETER [PACKAGE | MODULE]...

The modules of FOLDER as package ale_NAME, whose main.main() is run, what lies beside them (*.json), the release as version.txt;
other packages whole; a MODULE (.py) that another program or package shares, among its own. The same bytes whenever it is made.
INTERPRETER: /usr/bin/python3 where Debian's packages are enough, /usr/bin/env where those of a virtual environment must be found.
"""
import pathlib
import re
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIRST_DAY = (1980, 1, 1, 0, 0, 0)
MAIN = """import sys

from {name}.main import main

if __name__ == "__main__":  # and not in a process that it starts
    sys.exit(main())
"""


def release():
    return re.search(r'ALE_VERSION "(.*)"', (ROOT / "lib/base/version.h").read_text(encoding="utf-8"))[1]


def contents(folder, packages):
    """{name in the archive: bytes}"""
    name = f"ale_{folder.name}"
    files = {f"{name}/{path.name}": path.read_bytes() for path in folder.iterdir() if path.suffix in (".py", ".json")}
    files[f"{name}/version.txt"] = release().encode()
    files["__main__.py"] = MAIN.format(name=name).encode()
    for package in packages:
        if package.suffix == ".py":
            files[f"{name}/{package.name}"] = package.read_bytes()
        files |= {f"{package.name}/{path.relative_to(package)}": path.read_bytes() for path in package.rglob("*.py")}
    return files


def main():
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    out, folder, interpreter, *packages = map(pathlib.Path, sys.argv[1:])
    with out.open("wb") as file:
        file.write(f"#!{interpreter}{' python3' if interpreter.name == 'env' else ''}\n".encode())
        with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
            for name, data in sorted(contents(folder, packages).items()):
                archive.writestr(zipfile.ZipInfo(name, FIRST_DAY), data)
    out.chmod(0o755)
    return 0


if __name__ == "__main__":
    sys.exit(main())
