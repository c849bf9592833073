#!/usr/bin/env python3
"""A Python package as one program: the same bytes from the same sources, whatever their times.

    zip_program.py OUT PACKAGE VERSION.h     PACKAGE/main.py has main(version)
"""
import pathlib
import re
import sys
import zipfile

OLDEST = (1980, 1, 1, 0, 0, 0)
MAIN = "import sys\nfrom {name}.main import main\n\nif __name__ == '__main__':\n    sys.exit(main({version!r}))\n"


def main():
    out, package, header = map(pathlib.Path, sys.argv[1:])
    version = re.search(r'ALE_VERSION "(.*)"', header.read_text(encoding="utf-8"))[1]
    files = {f"{package.name}/{path.name}": path.read_bytes() for path in sorted(package.glob("*.py"))}
    files["__main__.py"] = MAIN.format(name=package.name, version=version).encode()
    with out.open("wb") as file:
        file.write(b"#!/usr/bin/python3\n")
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in files.items():
                archive.writestr(zipfile.ZipInfo(name, OLDEST), content, zipfile.ZIP_DEFLATED)
    out.chmod(0o755)


if __name__ == "__main__":
    main()
