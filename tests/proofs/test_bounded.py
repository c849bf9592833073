"""What makes the estimate task bounded, proved on what is compiled; and that each proof finds the fault planted for it.

No allocation, no lock, no system call but the port's wait, no floating point, no recursion, a stack of a stated size. What is looked
at follows from the folders: whatever is in lib/, and whatever a call of the task's body can reach.
"""
import re
import signal
import subprocess

import pytest

from callgraph import INDIRECT, CallGraph
from compilers import (BUILD, CORTEX_M4, FIRMWARE, GRAPH, INCLUDES, LIB, PLANTED, ROOT, compile_all, planted_estimate,
                       run)

TASK = "ale_estimator_run"
STACK_BYTES = 16 * 1024  # of the 1 MiB that the port gives: ALE_RT_STACK_BYTES
LEAF_BYTES = 512  # what a function of the C library is taken to need

# All that lib may want of the C library.
LIBRARY_OF_LIB = {"memcpy", "memmove", "memset", "memcmp"}
# What the port does for the task: the time, without a system call, and its one wait.
PORT = {("ale_rt_now_ns", "clock_gettime"), ("ale_rt_release_wait", "syscall")}
# The one pointer to a function in lib is the hook at the end of a stage; the task's own hook.
HOOK = "end_of_stage"

FLOAT_HELPER = re.compile(r"__aeabi_(c?[fd](?!\w*iv0)\w*|u?[il]2[fd]|h2\w+)$|__\w+[shd]f[0-9]?(2|3|si|di|sf|df|hf)?$|^sqrtf?$")


# ---- the archive ----

def wanted_symbols(archive):
    """Undefined in an archive as a whole."""
    names = {"U": set(), "defined": set()}
    for line in run("nm", archive).splitlines():
        words = line.split()
        if len(words) >= 2 and len(words[-2]) == 1:
            names["U" if words[-2] == "U" else "defined"].add(words[-1])
    return names["U"] - names["defined"]


def test_libale_wants_nothing_of_a_system_but_to_copy_and_clear_memory():
    archive = BUILD / "libale.a"
    assert len(run("nm", archive).splitlines()) > 500, "the archive is there and has something in it"
    assert wanted_symbols(archive) <= LIBRARY_OF_LIB


def test_an_allocation_in_lib_is_found(tmp_path):
    archive = tmp_path / "libale.a"
    archive.write_bytes((BUILD / "libale.a").read_bytes())
    run("ar", "rs", archive, *compile_all([PLANTED / "lib_allocates.c"], tmp_path))
    assert wanted_symbols(archive) - LIBRARY_OF_LIB == {"calloc"}


# ---- soft-float Cortex-M4 ----

@pytest.fixture(scope="module")
def cortex_objects(tmp_path_factory):
    return compile_all(LIB, tmp_path_factory.mktemp("m4"), *CORTEX_M4, *GRAPH, compiler="arm-none-eabi-gcc")


def float_helpers(objects, program):
    """Helpers of the compiler for floating point in a whole program made of all of lib."""
    run("arm-none-eabi-gcc", *CORTEX_M4, "-nostartfiles", "--specs=nosys.specs", "-Wl,-e,ale_pipeline_scan", *objects,
        "-o", program)
    names = {line.split()[-1] for line in run("arm-none-eabi-nm", program).splitlines()}
    assert "ale_pipeline_scan" in names
    return {name for name in names if FLOAT_HELPER.search(name)}


def test_a_soft_float_cortex_m4_links_no_floating_point_helper(cortex_objects, tmp_path):
    program = tmp_path / "lib.elf"
    assert float_helpers(cortex_objects, program) == set()
    print(run("arm-none-eabi-size", program))


def test_floating_point_in_lib_is_found(cortex_objects, tmp_path):
    fault = compile_all([PLANTED / "lib_floats.c"], tmp_path, *CORTEX_M4, compiler="arm-none-eabi-gcc")
    found = float_helpers(cortex_objects + fault, tmp_path / "lib.elf")
    assert any("mul" in name for name in found) and any("2f" in name or "float" in name for name in found)


# ---- the call graph ----

@pytest.fixture(scope="module")
def graph_files(tmp_path_factory):
    objects = compile_all(LIB + FIRMWARE, tmp_path_factory.mktemp("x86"), *GRAPH)
    return [path.with_suffix(".ci") for path in objects]


def connect_hook(graph):
    hook = next(title for title in graph.stack if title.endswith(":" + HOOK))
    for caller in list(graph.calls):
        if INDIRECT in graph.calls[caller] and graph.source[caller].startswith("lib/"):
            graph.join(caller, hook)


@pytest.fixture(scope="module")
def graph(graph_files):
    made = CallGraph(graph_files)
    connect_hook(made)
    return made


def with_fault(graph_files, fault, folder):
    """The graph with the planted estimate.c in the place of the real one."""
    planted = planted_estimate(fault, folder, *GRAPH).with_suffix(".ci")
    made = CallGraph([path for path in graph_files if path.name != "firmware_estimate_estimate.c.ci"] + [planted])
    connect_hook(made)
    return made


def strangers(graph):
    """What the task can call that is neither ours nor allowed."""
    return {callee for caller, callee in graph.leaves(TASK)
            if callee not in LIBRARY_OF_LIB and (caller, callee) not in PORT}


def test_lib_has_one_kind_of_pointer_to_a_function():
    pointers = [(path.name, found) for path in ROOT.glob("lib/*/**/*.[ch]")
                for found in re.findall(r"\(\s*\*\s*(\w+)\s*\)\s*\(", path.read_text(encoding="utf-8"))]
    assert pointers == [("stage.h", "end_of")]


def test_all_that_the_estimate_task_can_call_is_known_and_allowed(graph):
    reached = graph.reached(TASK)
    assert {"ale_pipeline_scan", "ale_extract_scan", "ale_rt_release_wait"} <= reached and len(reached) > 100
    assert strangers(graph) == set()


@pytest.mark.parametrize("fault, callee", [("allocates", "malloc"), ("locks", "pthread_mutex_lock"),
                                           ("asks_linux", "getppid"), ("wakes_another", "syscall"),
                                           ("unknown_call", INDIRECT)])
def test_a_call_it_must_not_make_is_found(graph_files, tmp_path, fault, callee):
    assert callee in strangers(with_fault(graph_files, fault, tmp_path))


def test_nothing_in_lib_or_in_the_task_recurses(graph):
    roots = [title for title, source in graph.source.items() if source.startswith("lib/")]
    assert len(roots) > 150
    assert [cycle for cycle in map(graph.cycle, roots + [TASK]) if cycle] == []


def test_recursion_is_found(graph_files, tmp_path):
    assert with_fault(graph_files, "recurses", tmp_path).cycle(TASK)
    fault = compile_all([PLANTED / "lib_recurses.c"], tmp_path, *GRAPH)[0].with_suffix(".ci")
    assert CallGraph(graph_files + [fault]).cycle("ale_planted")


def test_the_stack_of_the_task_is_below_its_stated_size(graph):
    used, way = graph.deepest(TASK, LEAF_BYTES)
    print(f"{used} bytes by way of {' > '.join(way)}")
    assert not graph.unbounded & graph.reached(TASK)
    assert 1000 < used <= STACK_BYTES


def test_every_function_of_lib_stays_below_it_too_on_a_microcontroller(cortex_objects):
    graph = CallGraph([path.with_suffix(".ci") for path in cortex_objects])
    used, way = max(graph.deepest(title, LEAF_BYTES) for title in graph.stack)
    print(f"{used} bytes by way of {' > '.join(way)}")
    assert not graph.unbounded
    assert used <= STACK_BYTES


def test_a_stack_too_deep_or_of_unknown_size_is_found(graph_files, tmp_path):
    assert with_fault(graph_files, "deep_stack", tmp_path).deepest(TASK, LEAF_BYTES)[0] > STACK_BYTES
    variable = with_fault(graph_files, "variable_stack", tmp_path)
    assert variable.unbounded & variable.reached(TASK)


# ---- the running task ----

@pytest.fixture(scope="module")
def filtered(tmp_path_factory):
    """Makes the program that runs the estimate task under the filter, with other objects before the archives."""
    folder = tmp_path_factory.mktemp("filter")
    main = folder / "main.o"
    run("g++", "-std=c++17", "-D_GNU_SOURCE", "-O1", *INCLUDES, "-c",
        ROOT / "tests/proofs/estimate_under_filter.cpp", "-o", main)

    def build(name, *objects):
        program = folder / name
        run("g++", main, *objects, *(BUILD / f"libale{part}.a" for part in ("_firmware", "_drivers", "")), "-lseccomp",
            "-llcm", "-lserialport", "-linih", "-pthread", "-lm", "-o", program)
        done = subprocess.run([program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=180,
                              check=False)
        return done.returncode, done.stdout, done.stderr

    return build


def test_the_task_works_with_no_system_call_but_its_wait(filtered):
    assert filtered("as_it_is") == (0, "400\n", "")


@pytest.mark.parametrize("fault", ["asks_linux", "allocates", "wakes_another"])
def test_any_other_system_call_ends_it(filtered, tmp_path, fault):
    code, answered, _ = filtered(fault, planted_estimate(fault, tmp_path))
    assert (code, answered) == (-signal.SIGSYS, "")
