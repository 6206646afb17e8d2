"""The stubs say what the module has, and the package is typed throughout."""

import ast
import os
import pathlib
import subprocess
import sys

import tendril
from conftest import SOURCE
from nanobind.stubgen import StubGen


def members(text):
    """Every function and class of a stub: its place, arguments and what it returns, where that is a plain name."""
    found = {}
    for node in ast.parse(text).body:
        inside = node.body if isinstance(node, ast.ClassDef) else [node]
        for item in inside:
            if isinstance(item, ast.FunctionDef):
                returns = item.returns.id if isinstance(item.returns, ast.Name) else ""
                place = f"{node.name}.{item.name}" if item is not node else item.name
                kind = [d.id for d in item.decorator_list if isinstance(d, ast.Name)]
                found[place] = (kind, [a.arg for a in item.args.args], "" if returns in ("list", "dict") else returns)
    return found


def test_stubs_have_what_the_module_has():
    generator = StubGen(tendril._core)
    generator.put(tendril._core)
    kept = members((SOURCE / "python" / "tendril" / "_core.pyi").read_text())
    assert kept == members(generator.get()) and len(kept) > 40


def test_package_is_typed(tmp_path):
    """mypy in strict mode finds nothing in the package, and one planted mistake in code that uses it."""
    (tmp_path / "use.py").write_text("import tendril\nr = tendril.load('a').solve()\nx: float = r.x[0]\n"
                                     "y: str = r.rod_length\n")
    package = pathlib.Path(tendril.__file__).parent
    environment = dict(os.environ, MYPYPATH=str(package.parent), MYPY_CACHE_DIR=str(tmp_path))
    told = subprocess.run([sys.executable, "-m", "mypy", "--config-file", SOURCE / "pyproject.toml", "use.py", package],
                          capture_output=True, text=True, env=environment, cwd=tmp_path, check=False)
    errors = [line for line in told.stdout.splitlines() if "error:" in line]
    assert len(errors) == 1 and errors[0].startswith("use.py:4"), told.stdout + told.stderr


def test_one_version():
    """CMakeLists.txt has it; formats that cannot read it there are held to it."""
    version = tendril.__version__
    for file, line in (("CMakeLists.txt", f"project(tendril VERSION {version} "), ("CITATION.cff", f"\nversion: {version}\n"),
                       ("packaging/conda/recipe.yaml", f'\n  version: "{version}"')):
        assert line in (SOURCE / file).read_text(), file
