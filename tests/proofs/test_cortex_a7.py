"""The cycles that `make wcet-cycles` counts are those of the pipeline and the caches that its README describes."""
import re
import subprocess

import pytest

from compilers import BUILD, ROOT, run

TURNS = 1000  # more than what the first fetch of the code costs
TURN = 10     # of an empty loop: a subtraction, and a branch that is not foreseen
MISS, SECOND = 150, 20
CALL = re.search(r"COUNTING_CALL = (\w+)", (ROOT / "tests/proofs/wcet/cortex_a7/counting.h").read_text())[1]

PROGRAM = """
    .syntax unified
    .thumb
    .global _start
    .thumb_func
    .macro told what
    movw r7, #{call}
    movs r0, #\\what
    svc #0
    .endm
_start:
    movw r4, #:lower16:room
    movt r4, #:upper16:room
    movs r2, #7
    movs r3, #3
    movs r5, #0
    {before}
    movw r6, #{turns}
    told 1
    told 0
1:  {counted}
    subs r6, r6, #1
    bne 1b
    told 0
    told 1
    movs r0, #0
    movs r7, #1
    svc #0
    .bss
    .align 12
room: .space 1048576
"""


@pytest.fixture(scope="module")
def plugin():
    run("make", "-s", "-C", ROOT, f"BUILD={BUILD}", f"{BUILD}/bench/cortex_a7.so")
    return BUILD / "bench" / "cortex_a7.so"


@pytest.fixture
def cycles_of(plugin, tmp_path):
    """Cycles of each turn of a loop, and the instructions of all turns."""
    def count(counted, before="", turns=TURNS):
        source = tmp_path / "counted.s"
        source.write_text(PROGRAM.format(call=CALL, counted=counted, before=before, turns=turns))
        run("arm-none-eabi-gcc", "-mcpu=cortex-a7", "-mfpu=neon-vfpv4", "-mfloat-abi=hard", "-nostdlib", "-static",
            source, "-o", tmp_path / "counted")
        run("qemu-arm", "-plugin", f"{plugin},out={tmp_path}/counts", tmp_path / "counted")
        cycles, instructions = map(int, (tmp_path / "counts.2").read_text().removeprefix("totals: ").split())
        return cycles // turns, instructions
    return count


@pytest.mark.parametrize("counted, cycles", [
    ("", 0),
    ("add r1, r1, r2; add r1, r1, r2", 2),                # forwarded
    ("add r1, r1, r2; add r1, r2, r1, lsl #1", 3),        # what is shifted is asked for a stage earlier
    ("add r4, r4, r5; ldr r1, [r4]", 3),                  # and an address
    ("ldr r1, [r4], #0; ldr r0, [r4]", 3),                # also one that is written back
    ("ldr r1, [r4]; add r1, r1, r2", 3),
    ("ldr r1, [r4]; add r0, r2, r2; add r1, r1, r2", 3),  # nobody waits for it meanwhile
    ("mul r1, r2, r3; add r1, r1, r2", 3),
    ("umull r0, r1, r2, r3; add r1, r1, r2", 3),
    ("sdiv r1, r2, r3", 20),
    ("ldm r4, {r0, r1, r8, r9}", 2),
    ("vadd.i32 q0, q1, q2", 4),
    ("vmul.i32 q0, q1, q2", 11),
    ("b 2f; 2:", 1),
    ("cbz r2, 2f; nop; 2:", 10),                          # not foreseen, taken or not
    ("it eq; addeq r1, r1, r2", 2),
])
def test_a_pipeline_takes_the_cycles_that_arm_has_described(cycles_of, counted, cycles):
    assert cycles_of(counted)[0] == TURN + cycles


@pytest.mark.parametrize("kib, second_time", [
    (32, 0),       # what fits is there the second time,
    (64, SECOND),  # what does not comes from the second cache
    (1024, MISS)   # or from memory again
])
def test_what_is_not_in_a_cache_is_waited_for(cycles_of, kib, second_time):
    lines = kib * 1024 // 64
    again = f"mov r8, r4; movw r9, #{lines}"
    counted = f"ldr r1, [r8], #64; subs r9, r9, #1; itt eq; moveq r8, r4; movweq r9, #{lines}"
    each = TURN + 5
    assert cycles_of(counted, again, lines)[0] == each + MISS
    assert cycles_of(counted, again, 2 * lines)[0] == each + (MISS + second_time) // 2


def test_instructions_are_counted_beside(cycles_of):
    few = cycles_of("")[1]
    assert cycles_of("add r1, r1, r2; mul r1, r2, r3")[1] == few + 2 * TURNS


def test_a_wrong_argument_is_said(plugin, tmp_path):
    (tmp_path / "nothing.s").write_text(PROGRAM.format(call=CALL, counted="", before="", turns=1))
    run("arm-none-eabi-gcc", "-mcpu=cortex-a7", "-nostdlib", "-static", tmp_path / "nothing.s", "-o", tmp_path / "nothing")
    refused = subprocess.run(["qemu-arm", "-plugin", f"{plugin},into=x", tmp_path / "nothing"], capture_output=True,
                             text=True)
    assert refused.returncode != 0 and "unknown argument into=x (out=BASE)" in refused.stderr
