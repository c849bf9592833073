"""tools/make: what the Makefile would do."""
import os
import re
import subprocess

from at_hand import ROOT

OBJECT = "obj/lib/graph/optimise/block_cholesky.cpp.o"


def make(tmp_path, target, *words):
    alone = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS", "OPT"))}
    done = subprocess.run(["make", "-C", ROOT, f"BUILD={tmp_path}", "CC=gcc", *words, f"{tmp_path}/{target}"],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True, env=alone, timeout=180)
    return done.stdout


def told(tmp_path, target, *variables):
    """How one file would be compiled."""
    return re.search(rf"^.* -c .* -o \S*{target}$", make(tmp_path, target, "-n", *variables), re.MULTILINE)[0]


def is_compiled(tmp_path, *variables):
    return "cc\tlib/extract/moments.c" in make(tmp_path, "obj/lib/extract/moments.c.o", *variables)


def prelude(tmp_path, *variables):
    """The precompiled header that one file would be compiled with."""
    return re.search(r"-include (\S+)", told(tmp_path, OBJECT, *variables))[1]


def optimisation(tmp_path, source, *variables):
    return re.findall(r" (-O\d|-funroll-loops)\b", told(tmp_path, f"obj/{source}.o", *variables))


def test_each_compiler_and_each_choice_of_flags_has_a_precompiled_header_of_its_own(tmp_path):
    """A compiler stops at one that another has made."""
    choices = [("CXX=g++",), ("CXX=clang++",), ("CXX=clang++", "OPT=-O1"), ("CXX=g++", "SANITIZE=address")]
    made = [prelude(tmp_path, *words) for words in choices]
    assert len(set(made)) == len(made)
    assert prelude(tmp_path, *choices[0]) == made[0]


def test_the_loops_of_the_extractor_are_unrolled_unless_other_flags_are_asked_for(tmp_path):
    for source in ("lib/extract/moments.c", "lib/base/fixed.c"):
        assert optimisation(tmp_path, source) == ["-O3", "-funroll-loops"]
        assert optimisation(tmp_path, source, "OPT=-O1") == ["-O1"]
    assert optimisation(tmp_path, "lib/match/association.c") == ["-O2"]


def test_objects_of_other_flags_are_compiled_again(tmp_path):
    """Who pulls has a build folder of the flags before."""
    assert is_compiled(tmp_path)
    assert not is_compiled(tmp_path)
    assert is_compiled(tmp_path, "EXTRACT_OPT=-O2")
    assert is_compiled(tmp_path)
    assert is_compiled(tmp_path, "CC=clang")
    assert not is_compiled(tmp_path, "CC=clang", "DEBUG=-g1")
    (tmp_path / "obj/flags").unlink()
    assert is_compiled(tmp_path, "CC=clang")
