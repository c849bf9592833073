"""Type hints of the package, by mypy. Long: with ALE_LONG_TESTS alone, and where PyPI can be had."""
import os
import subprocess

from at_hand import LONG, ROOT
from empty_environment import environment, run

PYTHON = ROOT / "tools/library/python"


@LONG
def test_type_hints_are_whole(tmp_path):
    python = environment(tmp_path / "venv", "mypy", "numpy", "matplotlib", "rosbags")
    assert "no issues" in run(python, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", PYTHON / "src/ale")
    use = tmp_path / "use.py"
    use.write_text("import ale\nfeatures = ale.Extractor(ale.scanner('urg-04lx')).extract([1.0] * 682)\ncount: str = features.outliers\n")
    done = subprocess.run([python, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", use], capture_output=True, text=True,
                          check=False, env={**os.environ, "MYPYPATH": str(PYTHON / "src")})
    assert 'expression has type "int", variable has type "str"' in done.stdout
