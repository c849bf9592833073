"""libale on its own: the installed tree with the C example, and the Python binding."""
import ctypes
import math
import os
import re
import subprocess

import pytest

import ale_lines
from at_hand import BUILD, ROOT

ROOM = ROOT / "tools/library/examples/room.txt"


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, **options)


def make(*words):
    return run("make", "-s", "-C", ROOT, f"BUILD={os.path.relpath(BUILD, ROOT)}", *words)


@pytest.fixture(scope="module")
def library():
    make("library")
    return BUILD / "libale.so"


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    prefix = tmp_path_factory.mktemp("installed")
    make("install-library", f"PREFIX={prefix}")
    return prefix


@pytest.fixture(scope="module")
def room():
    first, step, *ranges = (float(word) for word in ROOM.read_text(encoding="ascii").split())
    return {"ranges": ranges, "first_bearing": math.radians(first), "step": math.radians(step)}


def pkg_config(prefix, *words):
    environment = {**os.environ, "PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig")}
    return run("pkg-config", *words, "libale", env=environment).stdout.split()


def compiled(source, target, prefix, *more):
    flags = pkg_config(prefix, "--cflags", "--libs")
    run("cc", "-std=c11", "-Wall", "-Wextra", "-Werror", *more, source, "-o", target, *flags, "-lm")
    return target


def test_the_example_builds_against_an_installed_tree_and_prints_lines(installed, room, library, tmp_path):
    program = compiled(ROOT / "tools/library/examples/lines.c", tmp_path / "lines", installed)
    with ROOM.open() as scan:
        printed = run(program, stdin=scan, env={"LD_LIBRARY_PATH": str(installed / "lib")}).stdout
    beams = [tuple(map(int, found)) for found in re.findall(r"line beams (\d+) to (\d+)", printed)]
    expected = ale_lines.Extractor(library).extract(**room)
    assert beams == [(line.first, line.last) for line in expected.lines]
    assert len(beams) >= 3
    assert printed.count("corner at") == len(expected.corners)


def test_every_installed_header_stands_alone(installed, tmp_path):
    folder = installed / "include/ale"
    headers = sorted(path.relative_to(folder) for path in folder.rglob("*.h"))
    for header in headers:
        source = tmp_path / "alone.c"
        source.write_text(f'#include "{header}"\n#include "{header}"\nint main(void) {{ return 0; }}\n')
        run("cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", *pkg_config(installed, "--cflags"), source)
    for header in ("ale.h", "track/pipeline.h", "track/odometry_sample.h"):
        assert folder / header in (folder / path for path in headers), header


def test_the_example_says_what_is_missing(installed, tmp_path):
    program = compiled(ROOT / "tools/library/examples/lines.c", tmp_path / "lines", installed)
    done = subprocess.run([program], input="", capture_output=True, text=True, check=False,
                          env={"LD_LIBRARY_PATH": str(installed / "lib")})
    assert done.returncode == 2
    assert "missing" in done.stderr


def test_the_one_header_is_enough_for_c_plus_plus_too(installed, tmp_path):
    source = tmp_path / "use.cpp"
    source.write_text("#include <ale/ale.h>\nint main() { return ale_extractor_size() > 0 ? 0 : 1; }\n")
    flags = pkg_config(installed, "--cflags", "--libs")
    run("c++", "-std=c++17", "-Wall", "-Wextra", "-Werror", source, "-o", tmp_path / "use", *flags)
    run(tmp_path / "use", env={"LD_LIBRARY_PATH": str(installed / "lib")})


def test_the_structures_of_the_binding_lie_as_in_c(installed, tmp_path):
    lines = []
    for name, structure in ale_lines.STRUCTURES.items():
        lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
        for field, _ in structure._fields_:
            lines.append(f'printf("{name}.{field} %zu\\n", offsetof({name}, {field}));')
    source = tmp_path / "layout.c"
    source.write_text("#include <ale/ale.h>\n#include <stddef.h>\n#include <stdio.h>\nint main(void)\n{\n"
                      + "\n".join(lines) + "\nreturn 0;\n}\n")
    printed = run(compiled(source, tmp_path / "layout", installed)).stdout
    of_c = dict(line.rsplit(" ", 1) for line in printed.splitlines())
    for name, structure in ale_lines.STRUCTURES.items():
        assert int(of_c[name]) == ctypes.sizeof(structure), name
        for field, _ in structure._fields_:
            assert int(of_c[f"{name}.{field}"]) == getattr(structure, field).offset, f"{name}.{field}"


def test_three_walls_give_three_lines_and_two_corners(library):
    step = 2 * math.pi / 1024
    first = -340 * step

    def distance(bearing):
        return min(side / c for side, c in ((2.0, math.cos(bearing)), (1.5, math.sin(bearing)),
                                            (1.0, -math.sin(bearing))) if c > 1e-9)

    ranges = [distance(first + k * step) for k in range(682)]
    features = ale_lines.Extractor(library).extract(ranges, first, step)
    distances = sorted(line.rho for line in features.lines)
    assert distances == pytest.approx([1.0, 1.5, 2.0], abs=0.002)
    corners = sorted((corner.x, corner.y) for corner in features.corners)
    assert corners == [pytest.approx(c, abs=0.005) for c in ((2.0, -1.0), (2.0, 1.5))]
    assert all(corner.kind == "concave" for corner in features.corners)


def test_settings_reach_the_library_and_bad_ones_are_refused(library, room):
    few = ale_lines.Extractor(library, min_points=200).extract(**room)
    many = ale_lines.Extractor(library).extract(**room)
    assert len(few.lines) < len(many.lines)
    with pytest.raises(ValueError, match="no setting is called colour"):
        ale_lines.Extractor(library, colour=3)
    with pytest.raises(ValueError, match="out of range"):
        ale_lines.Extractor(library, smooth_span=4)


def test_too_many_beams_are_refused(library):
    with pytest.raises(ValueError, match="1082 beams"):
        ale_lines.Extractor(library).extract([1.0] * 1082, 0, 0.001)


@pytest.fixture(scope="module")
def plot():
    """The plot script, with the interpreter that has what it needs."""
    interpreter = "/usr/bin/python3"
    if subprocess.run([interpreter, "-c", "import matplotlib"], check=False, capture_output=True).returncode:
        pytest.skip("matplotlib is not installed")
    return interpreter, ROOT / "tools/library/python/plot_lines.py"


def test_the_plot_script_writes_a_picture(library, plot, tmp_path):
    picture = tmp_path / "room.png"
    run(*plot, ROOM, "--out", picture, "--library", library)
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


@pytest.mark.parametrize("scan, part", [("absent", "absent: No such file"), (__file__, "not numbers")])
def test_the_plot_script_says_in_one_line_what_is_no_scan(plot, scan, part):
    done = subprocess.run([*plot, scan], check=False, capture_output=True, text=True)
    assert done.returncode == 1
    assert part in done.stderr and done.stderr.count("\n") == 1
