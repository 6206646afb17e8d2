"""The Python result is the program's, bit for bit: both read the same case, and every number is compared with ==."""

import json
import math

import numpy as np
import pytest
import tendril
from conftest import EXAMPLES

NAMES = sorted(path.name for path in EXAMPLES.glob("*.toml"))
assert len(NAMES) >= 10


def without_time(result):
    """Wall time is the one thing that may differ."""
    for step in result["steps"]:
        assert step["effort"].pop("wall_seconds") >= 0
    return result


def same(array, listed):
    """Equal number for number; null in the file is NaN here."""
    expected = np.array([math.nan if value is None else value for value in listed], dtype=float)
    return np.array_equal(np.asarray(array), expected, equal_nan=True)


@pytest.mark.parametrize("name", NAMES)
def test_example(name, program):
    ran = program("run", name, "--json", "-", "--fields", "--quiet", directory=EXAMPLES)
    file = without_time(json.loads(ran.stdout))
    result = tendril.load(EXAMPLES / name).solve()
    here = without_time(result.to_dict())
    here["case"]["file"] = name
    assert here == file

    # and what the arrays show is what the file says
    assert result.status == file["status"] and len(result.steps) == len(file["steps"])
    for step, told in zip(result.steps, file["steps"]):
        assert step.status == told["status"]
        for key in ("parameter", "rod_length", "axial_force_start", "axial_force_end", "torque_start", "torque_end",
                    "push", "stability", "branch", "message"):
            assert getattr(step, key) == told[key], key
        for key, value in told["certificate"].items():
            assert same([getattr(step.certificate, key)], [value]), key
        assert list(step.fields) == list(told["fields"])
        for column, values in told["fields"].items():
            assert same(step.fields[column], values), column
        assert same(step.state, told["state"])
        for table, rows in ((step.contacts, told["contacts"]), (step.segments, told["segments"])):
            assert len(table) == len(rows)
            for row, expected in zip(table, rows):
                assert list(table.dtype.names) == list(expected)
                for key, value in expected.items():
                    if key == "kind":
                        assert row[key] == value
                    else:
                        assert same(np.atleast_1d(row[key]), np.atleast_1d(np.array(value, dtype=object))), key
    for table, rows in ((result.events, file["events"]), (result.trace, file["trace"])):
        assert len(table) == len(rows)
        for row, expected in zip(table, rows):
            assert all(row[key] == value for key, value in expected.items())


def test_overrides_and_start_from_a_state(tmp_path, program):
    name = EXAMPLES / "helix_outer_20.toml"
    changes = {"path": {"parameter": "end.axial_force", "values": [-14.0, -20.0]}}
    ran = program("run", name, "--json", tmp_path / "a.json", "--quiet", "--set",
                  'path={parameter="end.axial_force", values=[-14.0, -20.0]}')
    assert ran.returncode == 0, ran.stderr
    first = tendril.load(name, changes).solve()
    assert without_time(first.to_dict(fields=False))["steps"] == without_time(
        json.loads((tmp_path / "a.json").read_text()))["steps"]

    again = program("run", name, "--json", "-", "--quiet", "--from", tmp_path / "a.json", "--set",
                    "end.axial_force=-20.0", "--set", "path=")
    assert again.returncode == 0, again.stderr
    second = tendril.load(name, {"end.axial_force": -20.0, "path": None}).solve(initial=first)
    assert "stored state" in second.branch
    assert without_time(second.to_dict(fields=False))["steps"] == without_time(json.loads(again.stdout))["steps"]


def test_follow_is_the_path_of_a_case(program):
    name = EXAMPLES / "helix_outer_20.toml"
    values = [-8.836291214, -14.138065942]
    followed = tendril.load(name, {"path": None}).follow("end.axial_force", np.array(values))
    ran = program("run", name, "--json", "-", "--quiet", "--set", f"path.values={values}")
    assert without_time(followed.to_dict(fields=False))["steps"] == without_time(json.loads(ran.stdout))["steps"]
    assert [step.parameter for step in followed.steps] == values
    assert list(followed.events.kind) == ["contact_appears"]


def test_saved_files_are_the_programs(tmp_path, program):
    name = EXAMPLES / "s_bend.toml"
    program("run", name, "--out", tmp_path / "program", "--quiet")
    tendril.load(name).solve().save(tmp_path / "python")
    files = sorted(path.name for path in (tmp_path / "program").iterdir())
    assert files == sorted(path.name for path in (tmp_path / "python").iterdir()) and "rod.vtp" in files
    for file in files:
        if file != "result.json":  # which has the wall time
            assert (tmp_path / "python" / file).read_bytes() == (tmp_path / "program" / file).read_bytes(), file
