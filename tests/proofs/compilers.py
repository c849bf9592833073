"""Compiles what the proofs look at: the sources of lib and firmware by rule, and one planted fault with them."""
import concurrent.futures
import os
import subprocess

from at_hand import BUILD, ROOT

PLANTED = ROOT / "tests" / "planted"
LIB = sorted(ROOT.glob("lib/*/**/*.c"))
FIRMWARE = [path for path in sorted(ROOT.glob("firmware/**/*.c"))
            if path.name != "main.c" and (not path.name.startswith("rt_") or path.name == "rt_posix.c")]
C = ["-std=c11", "-D_GNU_SOURCE", "-O2"]
INCLUDES = [f"-I{ROOT / folder}" for folder in ("lib", "drivers", "firmware", "tests")]
INCLUDES += ["-isystem", str(BUILD / "lcmtypes")]
GRAPH = ["-fcallgraph-info=su,da"]
CORTEX_M4 = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft"]


def run(*words):
    """Output of a command that must succeed, in the tree: the compiler names static functions by the file it is given."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, cwd=ROOT)
    assert done.returncode == 0, done.stdout[-4000:]
    return done.stdout


def compile_all(sources, folder, *flags, compiler="gcc"):
    """Objects of the sources, named after them, in a folder."""
    def one(source):
        name = source.relative_to(ROOT)
        target = folder / (str(name).replace("/", "_") + ".o")
        run(compiler, *C, *flags, *INCLUDES, "-c", name, "-o", target)
        return target

    folder.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        return list(pool.map(one, sources))


def planted_estimate(fault, folder, *flags):
    """firmware/estimate/estimate.c with a fault in it."""
    target = folder / f"estimate_{fault}.o"
    run("gcc", *C, *flags, *INCLUDES, "-include", PLANTED / f"{fault}.c", "-c", ROOT / "firmware/estimate/estimate.c",
        "-o", target)
    return target
