"""Builds as scikit-build-core does; an sdist also gets the C and C++ sources, which lie elsewhere in the tree."""
import pathlib
import shutil

import scikit_build_core.build
from scikit_build_core.build import *  # noqa: F401,F403 pylint: disable=wildcard-import,unused-wildcard-import

HERE = pathlib.Path(__file__).resolve().parent
TREE = HERE.parents[2]
CARRIED = ("LICENSE", "lib", "drivers/file", "drivers/store", "firmware/config/decimal.c", "firmware/config/decimal.h", "firmware/config/scanners.ini",
           "tools/common/offline", "tools/common/export/text_file.*", "tools/common/export/trajectory.*")
SUFFIXES = ("", ".c", ".h", ".cpp", ".ini")


def carried_files():
    """Relative to the top of the tree."""
    for pattern in CARRIED:
        for path in TREE.glob(pattern):
            files = path.rglob("*") if path.is_dir() else [path]
            yield from (file.relative_to(TREE) for file in files if file.is_file() and file.suffix in SUFFIXES)


def build_sdist(sdist_directory, config_settings=None):
    sources = HERE / "sources"
    if sources.exists():  # of an sdist that was unpacked: it is already whole
        return scikit_build_core.build.build_sdist(sdist_directory, config_settings)
    try:
        for file in carried_files():
            (sources / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(TREE / file, sources / file)
        return scikit_build_core.build.build_sdist(sdist_directory, config_settings)
    finally:
        shutil.rmtree(sources, ignore_errors=True)
