"""tools/make: what the Makefile would do."""
import os
import re
import subprocess

from at_hand import ROOT

OBJECT = "obj/lib/graph/block_cholesky.cpp.o"


def prelude(tmp_path, *variables):
    """The precompiled header that one file would be compiled with."""
    alone = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS"))}
    told = subprocess.run(["make", "-n", "-C", ROOT, f"BUILD={tmp_path}", "CC=gcc", *variables, f"{tmp_path}/{OBJECT}"],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True, env=alone, timeout=180)
    return re.search(r"-include (\S+)", told.stdout)[1]


def test_each_compiler_and_each_choice_of_flags_has_a_precompiled_header_of_its_own(tmp_path):
    """A compiler stops at one that another has made."""
    choices = [("CXX=g++",), ("CXX=clang++",), ("CXX=clang++", "OPT=-O1"), ("CXX=g++", "SANITIZE=address")]
    made = [prelude(tmp_path, *words) for words in choices]
    assert len(set(made)) == len(made)
    assert prelude(tmp_path, *choices[0]) == made[0]
