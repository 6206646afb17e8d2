"""Shared by the tests of the Python face. ctest gives TENDRIL (the program) and TENDRIL_SOURCE_DIR."""

import os
import pathlib
import subprocess

import pytest

SOURCE = pathlib.Path(os.environ.get("TENDRIL_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("TENDRIL", str(SOURCE / "build/release/bin/tendril"))
EXAMPLES = SOURCE / "examples"


def run_program(*arguments, directory=None):
    """The program from outside; its exit code and streams."""
    environment = dict(os.environ, NO_COLOR="1")
    return subprocess.run(
        [PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=directory, env=environment, check=False
    )


@pytest.fixture
def program():
    return run_program


@pytest.fixture
def straight():
    """A rod under its own weight in a straight tube: touches the wall along a line."""
    return {
        "rod": {"bending_stiffness": 1.0, "torsional_stiffness": 0.75, "axial_stiffness": 400.0},
        "tube": {"clearance": 0.05, "axis": {"kind": "straight", "length": 1.0}},
        "start": {"kind": "clamped"},
        "end": {"kind": "sleeve", "axial_force": 1.0, "torque": 0.0},
        "load": {"body_force": [50.0, 0.0, 0.0]},
    }


@pytest.fixture
def held(straight):
    """An inextensible rod of given length, clamped at both ends of a straight tube of length 1: none is shorter than that."""
    del straight["rod"]["axial_stiffness"], straight["load"]
    straight["end"] = {"kind": "sleeve", "rod_length": 1.001, "torque": 0.0}
    return straight
