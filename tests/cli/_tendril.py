"""Shared by the tests of the program: runs it and says what went wrong."""

import os
import pathlib
import subprocess

PROGRAM = os.environ["TENDRIL"]
SOURCE = pathlib.Path(os.environ["TENDRIL_SOURCE_DIR"])
EXAMPLES = SOURCE / "examples"

CASE = """schema = 1
title = "free rod"

[rod]
bending_stiffness = 1.0
torsional_stiffness = 0.75

[tube]
clearance = 0.05
[tube.axis]
kind = "straight"
length = 1.0

[start]
kind = "clamped"

[end]
kind = "sleeve"
axial_force = 1.0
torque = 0.0

[load]
body_force = [1.0, 0.0, 0.0]
"""


def run(*arguments, env=None, timeout=300, stdout=subprocess.PIPE):
    environment = dict(os.environ, **(env or {}))
    return subprocess.run([PROGRAM, *map(str, arguments)], stdout=stdout, stderr=subprocess.PIPE, text=True,
                          env=environment, timeout=timeout, check=False)


def expect(result, code, stdout=(), stderr=()):
    told = (f"{result.args}\nexit {result.returncode}, expected {code}\n"
            f"--- stdout\n{result.stdout}\n--- stderr\n{result.stderr}")
    assert result.returncode == code, told
    for text in stdout:
        assert text in result.stdout, f"stdout lacks {text!r}\n{told}"
    for text in stderr:
        assert text in result.stderr, f"stderr lacks {text!r}\n{told}"
    return result
