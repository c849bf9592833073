"""The site: what is written from the sources is whole, and every command of its pages does what the page says."""
import contextlib
import importlib.util
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

import pytest

from at_hand import BINARIES, BUILD, ROOT

sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "tools/make")]
import docs_check  # noqa: E402
from hosts import two_separate_hosts  # noqa: E402
from site_robot import SiteRobot  # noqa: E402

SITE = ROOT / "tools/library/site"
PAGES = sorted(path.name for path in (SITE / "pages").glob("*.md"))
BLOCK = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```', re.MULTILINE | re.DOTALL)
MARKS = ("", "fails", "needs a robot", "needs a network", "changes the system", "builds for minutes")


BUILDS = {  # what runs it
    "make deb": "tools/make/test_deb.py", "make run": "tests/tools/test_run.py", "make explore": "tests/tools/test_explore.py",
    "make library": "tests/tools/test_library.py", "make install-library": "tests/tools/test_library.py",
    "pip install": "tests/tools/library/python/test_python_wheel.py"}


def blocks(page, language):
    """(mark, text) of each fenced block of a language."""
    text = (SITE / "pages" / page).read_text(encoding="utf-8")
    return [(mark, code) for name, mark, code in BLOCK.findall(text) if name == language]


def run(words, **options):
    return subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=170,
                          check=False, **options)


@pytest.fixture(scope="module")
def generated(tmp_path_factory):
    out = tmp_path_factory.mktemp("site")
    done = run([sys.executable, SITE / "generate.py", "--root", ROOT, "--build", BUILD, "--out", out])
    assert done.returncode == 0, done.stdout
    return out


@pytest.fixture
def tree(tmp_path):
    """The top of the tree with a build folder of its own."""
    for path in ROOT.iterdir():
        if not path.name.startswith((".git", "build")):
            (tmp_path / path.name).symlink_to(path)
    return tmp_path


@pytest.fixture
def computer():
    """One of its own, as far as networks go: nothing is up."""
    with two_separate_hosts() as (here, _):
        yield here


@pytest.fixture
def robot(tree, computer):
    with SiteRobot(tree, computer) as standing:
        standing.network()
        yield standing


def shell(code, folder):
    """What it leaves running is ended with it."""
    path = f"{BINARIES}:{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
    process = subprocess.Popen(["sh", "-ec", code], cwd=folder, env={**os.environ, "PATH": path, "MAKEFLAGS": "", "HOME": str(folder)}, text=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    with process.stdout:
        try:
            process.wait(170)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        return process.returncode, process.stdout.read()


@pytest.mark.parametrize("page", PAGES)
def test_every_mark_is_one_that_is_known(page):
    assert {mark for mark, _ in blocks(page, "sh")} <= set(MARKS)
    assert not re.search(r"^    (ale-|make )", (SITE / "pages" / page).read_text(encoding="utf-8"), re.MULTILINE), "a command outside a block"


def run_page(page, folder, robot=None):
    """Its blocks in their order, those that need a robot where there is one; how many."""
    (folder / "build/bin").mkdir(parents=True)
    ran = 0
    for mark, code in blocks(page, "sh"):
        if mark in ("", "fails"):
            if "ale-plot" in code and run(["/usr/bin/python3", "-c", "import matplotlib"]).returncode:
                pytest.skip("matplotlib is not installed")
            if "ale-foxglove" in code and not (importlib.util.find_spec("foxglove") and importlib.util.find_spec("rosbags")):
                pytest.skip("PyPI's foxglove-sdk and rosbags are not here")
            code_of_end, said = shell(code, folder)
            assert (code_of_end != 0) == (mark == "fails"), f"{code}\n{said}"
            ran += 1
        elif mark == "needs a robot" and robot:
            robot.run(code)
            ran += 1
    return ran


@pytest.mark.parametrize("page", PAGES)
def test_every_command_of_a_page_runs(page, tree):
    assert run_page(page, tree) >= {"log.md": 8, "troubleshooting.md": 4, "bridges.md": 2}.get(page, 0)
    if page == "log.md":
        pictures_and_files_are_there(tree / "build/first")


@pytest.mark.parametrize("page", [page for page in PAGES if any(mark == "needs a robot" for mark, _ in blocks(page, "sh"))])
def test_with_a_robot_every_command_of_a_page_runs(page, tree, robot):
    assert run_page(page, tree, robot) == sum(mark in ("", "fails", "needs a robot") for mark, _ in blocks(page, "sh"))


def pictures_and_files_are_there(folder):
    for name in ("map.png", "run.png"):
        assert (folder / name).read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    for name in ("error.html", "noise.svg"):
        assert "<svg" in (folder / name).read_text(encoding="utf-8")
    assert "resolution: 0.025" in (folder / "map.yaml").read_text(encoding="utf-8")


def test_what_gives_multicast_a_way_does(tree, computer):
    code, = (code for mark, code in blocks("troubleshooting.md", "sh") if mark == "needs a network")
    with SiteRobot(tree, computer) as robot:
        before = robot.shell("ale-watch --once", robot.environment)
        assert before.returncode == 1 and "no route for multicast" in before.stdout
        done = robot.shell(code, robot.environment)
        assert done.returncode == 0, done.stdout
        robot.run("ale-watch\n")


@pytest.mark.parametrize("page", PAGES)
def test_only_what_changes_the_system_is_not_run(page):
    for mark, code in blocks(page, "sh"):
        lines = code.splitlines()
        assert (mark == "changes the system") == all(re.match(r"sudo (apt|systemctl) ", line) for line in lines), code


@pytest.mark.parametrize("page", PAGES)
def test_what_builds_for_minutes_is_run_by_a_test_of_its_own(page):
    for line in (line for mark, code in blocks(page, "sh") if mark == "builds for minutes" for line in code.splitlines()):
        assert (ROOT / BUILDS[" ".join(line.split()[:2])]).exists(), line


@pytest.mark.parametrize("page", PAGES)
def test_builds_name_targets_and_variables_that_are_there(page):
    tree = docs_check.Tree(ROOT, BUILD)
    text = "".join(f"```sh\n{code}```\n" for _, code in blocks(page, "sh"))
    assert list(docs_check.check_targets(text, None, tree)) == []
    assert list(docs_check.check_targets("```sh\nmake dinner\n```\n", None, tree)) != []


@pytest.mark.parametrize("page", PAGES)
def test_programs_and_options_are_there_also_where_a_robot_is_needed(page):
    text = "\n".join(code for _, code in blocks(page, "sh")).replace("\\\n", " ")
    for line in text.splitlines():
        for program in re.findall(r"(?<![\w./-])ale-[a-z]+(?![\w./*-])", line):
            if not (BINARIES / program).exists():
                assert "systemctl" in line and list((ROOT / "firmware/deploy").glob(f"{program}.service*")), line
                continue
            known = set(re.findall(r"--[a-z][a-z-]*", run([BINARIES / program, "--help"]).stdout))
            assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", line.partition(program)[2])) - {"--now"} <= known, line


def test_every_type_and_field_of_the_messages_is_on_their_page(generated):
    page = (generated / "pages/messages.md").read_text(encoding="utf-8")
    found = 0
    for path in (ROOT / "lib/messages").glob("*.lcm"):
        struct = package = ""
        for line in path.read_text(encoding="utf-8").splitlines():
            code = line.partition("//")[0].strip()
            if code.startswith("package "):
                package = "" if code == "package ale;" else code.split()[1].rstrip(";") + "."
            elif code.startswith("struct "):
                struct = package + code.split()[1]
                section = page.partition(f"### {struct}\n")[2].partition("\n### ")[0]
                assert section, struct
            elif code.endswith(";"):
                kind, _, names = code.rstrip(";").partition(" ")
                assert f"| `{names.strip()}` | `{kind}` |" in section, (struct, names)
                found += 1
    assert found > 150


def test_every_option_and_key_is_on_its_page(generated):
    options = (generated / "pages/options.md").read_text(encoding="utf-8")
    for program in BINARIES.glob("ale-*"):
        if not program.is_symlink():
            section = options.partition(f"\n## {program.name}\n")[2].partition("\n## ")[0]
            for option in re.findall(r"--[a-z][a-z-]*", run([program, "--help"]).stdout):
                assert option in section, (program.name, option)
    keys = re.findall(r'^    \{"(\w+)", "(\w+)",', (ROOT / "firmware/config/config_keys.c").read_text(encoding="utf-8"), re.MULTILINE)
    configuration = (generated / "pages/configuration.md").read_text(encoding="utf-8")
    assert len(keys) > 50
    for section, key in keys:
        assert f"| `{key}` |" in configuration.partition(f"## [{section}]")[2].partition("\n## ")[0], (section, key)


def test_links_and_pictures_of_the_pages_are_there(generated):
    pages = {path.name: path.read_text(encoding="utf-8") for path in (generated / "pages").glob("*.md")}
    for name, text in pages.items():
        for link in re.findall(r"\]\((?!https?:)([^)\s]+)\)", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)):
            path, _, heading = link.partition("#")
            assert (generated / "pages" / (path or name)).exists(), f"{name}: {link}"
            assert not heading or f"# {heading}\n" in pages[path or name], f"{name}: {link}"


def test_the_site_is_built_without_a_warning(generated, tmp_path):
    mkdocs = shutil.which("mkdocs", path="/usr/bin")
    if mkdocs is None:
        pytest.skip("mkdocs-material is not installed: make docs does")
    done = run([mkdocs, "build", "--strict", "--config-file", generated / "mkdocs.yml", "--site-dir", tmp_path / "html"])
    assert done.returncode == 0, done.stdout
    page = (tmp_path / "html/index.html").read_text(encoding="utf-8")
    assert "troubleshooting.html" in page
    assert not re.search(r'(?:src|href)="https?://(?!squidfunk|www.mkdocs|mkdocs)', page), "a page that needs the network"


def test_the_python_of_the_pages_runs(tmp_path, ale_package):
    code = "\n".join(code for page in PAGES for _, code in blocks(page, "python"))
    assert code
    done = run([sys.executable, "-c", code], cwd=tmp_path, env={**os.environ, **ale_package})
    assert done.returncode == 0, done.stdout
