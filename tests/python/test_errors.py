"""What is wrong with a case is told in the same words, at the same places, by the program and by Python."""

import json
import math
import pickle
import threading

import numpy as np
import pytest
import tendril
from conftest import EXAMPLES

GOOD = """schema = 1
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
"""

WRONG = {
    "unknown key": GOOD.replace("axial_force", "axail_force"),
    "wrong type": GOOD.replace("clearance = 0.05", 'clearance = "wide"'),
    "out of bounds": GOOD.replace("bending_stiffness = 1.0", "bending_stiffness = -1.0"),
    "missing table": GOOD.replace("[start]\nkind = \"clamped\"\n", ""),
    "several at once": GOOD.replace("length = 1.0", "").replace("torque = 0.0", "torqe = 0.0\ntwist = 1"),
    "unit without si": GOOD.replace("axial_force = 1.0", 'axial_force = "12 klbf"'),
    "syntax": GOOD.replace("torque = 0.0", "torque = = 0.0"),
    "file of points": GOOD.replace('kind = "straight"\nlength = 1.0', 'kind = "points"\nfile = "none.csv"'),
    "geometry": GOOD.replace('kind = "straight"\nlength = 1.0', 'kind = "torus"\nmajor_radius = 0.04'),
    "empty": "",
}


@pytest.mark.parametrize("what", WRONG)
def test_same_as_the_program(what, tmp_path, monkeypatch, program):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wrong.toml").write_text(WRONG[what])
    told = program("check", "wrong.toml", directory=tmp_path)
    assert told.returncode in (3, 6)
    with pytest.raises(tendril.CaseError) as caught:
        tendril.load("wrong.toml")
    errors = caught.value.errors
    assert told.stderr == f"{caught.value}\n{len(errors)} error{'s' if len(errors) > 1 else ''}\n"
    for error in errors:
        at = f"{error.path}:{error.line}:{error.column}" if error.line else error.path
        assert f"{at}: error: {error.message}\n" in told.stderr and error.hint in told.stderr
    assert "".join(str(error) for error in errors).rstrip("\n") == str(caught.value)


@pytest.mark.parametrize("change", [
    {"end.axial_force": "12 klbf"},
    {"tube.clearance": -0.1},
    {"tube.clearance": [[0.0, 0.05], [0.9, 0.05]]},
    {"tube.axis.lenght": 2.0},
    {"path": {"parameter": "end.axial_froce", "values": [1.0]}},
])
def test_a_dict_is_told_what_the_same_json_is_told(change, tmp_path, straight, program):
    """Places differ, since the texts do; keys, messages, values, bounds and hints are the same."""
    model = {"schema": 1, **straight}
    for key, value in change.items():
        *tables, name = key.split(".")
        table = model
        for inner in tables:
            table = table[inner]
        table[name] = value
    file = tmp_path / "wrong.json"
    file.write_text(json.dumps(model, indent=1))
    with pytest.raises(tendril.CaseError) as from_file:
        tendril.load(file)
    with pytest.raises(tendril.CaseError) as from_dict:
        tendril.Case(model)
    assert str(from_file.value) + "\n1 error\n" == program("check", file).stderr
    strip = lambda e: (e.key, e.message, e.value, e.bound, e.hint)
    assert [strip(e) for e in from_dict.value.errors] == [strip(e) for e in from_file.value.errors]


def test_errors_of_a_case_from_python_name_the_row(straight):
    points = np.array([[0, 0, 0.0], [0, 0, 0.5], [0, np.nan, 0.7], [0, 0, 1.0]])
    straight["tube"]["axis"] = {"kind": "points", "points": points}
    with pytest.raises(tendril.CaseError) as caught:
        tendril.Case(straight)
    (error,) = caught.value.errors
    assert error.key == "tube.axis.points" and error.value == "nan" and error.path == "<case>"
    assert tendril.CaseError is type(caught.value) and "[0.0, nan, 0.7]," in str(error)


def test_keywords_are_checked_like_keys(straight):
    with pytest.raises(tendril.CaseError, match="did you mean `tube`"):
        tendril.Case(tub=straight.pop("tube"), **straight)


def test_what_no_file_can_say(straight):
    straight["rod"]["bending_stiffness"] = None
    with pytest.raises(tendril.CaseError, match="leave the key out"):
        tendril.Case(straight)
    straight["rod"]["bending_stiffness"] = object()
    with pytest.raises(tendril.CaseError, match="rod.bending_stiffness"):
        tendril.Case(straight)


def test_files(tmp_path):
    with pytest.raises(OSError, match="none.toml"):
        tendril.load(tmp_path / "none.toml")
    result = tendril.load(EXAMPLES / "s_bend.toml").solve()
    with pytest.raises(OSError):
        result.save(tmp_path / "none" / "result.json")


def test_case_error_travels(straight):
    """Process pools and notebooks pickle exceptions."""
    with pytest.raises(tendril.CaseError) as caught:
        tendril.Case(straight).replace({"rod.diameter": 1.0, "rod.x": math.inf})
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.errors == caught.value.errors


def test_a_failed_solve_says_why_and_does_not_raise(held):
    """A rod shorter than the way between its ends has no state."""
    result = tendril.Case(held).replace({"end.rod_length": 0.9}).solve()
    assert not result.converged and result.status == "not_converged"
    assert result.message and result.steps[-1].message and math.isnan(result.to_pandas()["rod_length"][0])


def test_a_path_that_runs_out_of_time_keeps_what_it_reached():
    case = tendril.load(EXAMPLES / "helix_outer_20.toml", {"path": None})
    result = case.follow("end.axial_force", -7.07 - 0.002 * np.arange(20000), max_seconds=0.5)
    assert 0 < len(result.steps) < 20000 and all(step.converged for step in result.steps[:-1])


def test_interrupt_ends_a_long_path():
    import _thread

    case = tendril.load(EXAMPLES / "helix_outer_20.toml")
    timer = threading.Timer(0.5, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        case.follow("end.axial_force", -7.07 - 0.002 * np.arange(20000))
