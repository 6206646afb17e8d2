"""Cases from plain Python are the cases of the files."""

import numpy as np
import pytest
import tendril
from conftest import EXAMPLES


def fields(result):
    return np.array([result.fields[name] for name in result.fields])


def test_a_case_from_python_is_the_case_file():
    from_file = tendril.load(EXAMPLES / "helix_outer_20.toml").solve()
    case = tendril.Case(
        title="the same",
        units="dimensionless",
        rod={"axial_stiffness": 400.0, "bending_stiffness": 1.0, "torsional_stiffness": 0.75},
        tube={"side": "inside", "clearance": 0.05,
              "axis": {"kind": "helix", "radius": 0.22507907903927651, "pitch_angle": np.pi / 4, "length": 1.0}},
        start={"kind": "clamped"},
        end={"kind": "sleeve", "axial_force": -7.069032970971682, "torque": -1.0},
        path={"parameter": "end.axial_force",
              "values": np.array([-8.836291214, -14.138065942, -35.345164855, -70.69032971, -141.380659419,
                                  -190.863890216])},
    )
    result = case.solve()
    for here, there in zip(result.steps, from_file.steps):
        assert np.array_equal(fields(here), fields(there), equal_nan=True)
    assert np.array_equal(result.events, from_file.events)


def test_numbers_keep_every_bit(straight):
    """Random doubles go through the text and come back equal."""
    random = np.random.default_rng(1)
    z = np.cumsum(random.uniform(0.01, 0.02, 60))
    points = np.column_stack([0.05 * np.sin(3 * z) + 1e-5 * random.standard_normal(60), 0 * z, z - z[0]])
    straight["tube"]["axis"] = {"kind": "points", "points": points, "smoothing": 1e-3}
    straight["tube"]["clearance"] = np.float64(np.nextafter(0.004, 1))
    case = tendril.Case(straight)
    told = case.solve().to_dict()["case"]["tube"]
    assert told["clearance"] == np.nextafter(0.004, 1)
    rows = [line.strip(" [],") for line in case.text.splitlines() if line.startswith("  [")]
    assert np.array_equal(np.array([[float(v) for v in row.split(",")] for row in rows]), points)


def test_clearance_table_from_an_array(straight):
    """A constant given as a table is the constant: the same state, to the solver's tolerance."""
    straight["load"]["body_force"] = [500.0, 0.0, 0.0]  # enough for a line contact
    constant = tendril.Case(straight).solve()
    S = np.linspace(0, 1, 5)
    straight["tube"]["clearance"] = np.column_stack([S, np.full(5, 0.05)])
    table = tendril.Case(straight).solve()
    tolerance = 1e-7  # ten times that of the solve
    assert abs(table.force_max - constant.force_max) < tolerance * constant.force_max
    assert list(table.contacts.kind) == list(constant.contacts.kind)
    assert "line" in table.contacts.kind


def test_written_to_a_file_it_runs_in_the_program(tmp_path, straight, program):
    case = tendril.Case(straight, title='quotes " and ünïcödé \\')
    (tmp_path / "case.toml").write_text(case.text, encoding="utf-8")
    ran = program("run", tmp_path / "case.toml", "--quiet")
    assert ran.returncode == 0 and 'quotes " and ünïcödé \\' in ran.stdout


def test_replace_makes_another_case(straight):
    case = tendril.Case(straight)
    other = case.replace({"end.axial_force": -2.0, "load": None, "tube.axis.length": np.float64(1.5)})
    assert case.length == 1.0 and other.length == 1.5
    assert len(case.solve().contacts) == 1 and len(other.solve().contacts) == 0
    assert other.replace({"end.axial_force": 3.0}).solve().axial_force_end == pytest.approx(3.0, rel=1e-9)


def test_relative_files_start_at_the_directory(tmp_path, straight, monkeypatch):
    np.savetxt(tmp_path / "axis.csv", [[0, 0, z] for z in (0, 0.2, 0.6, 1)], delimiter=",", header="x,y,z", comments="")
    straight["tube"]["axis"] = {"kind": "points", "file": "axis.csv"}
    assert tendril.Case(straight, directory=tmp_path).length == pytest.approx(1.0)
    monkeypatch.chdir(tmp_path)
    assert tendril.Case(straight).length == pytest.approx(1.0)


def test_units_as_strings():
    case = tendril.load(EXAMPLES / "guidewire_vessel.toml")
    assert case.units == "si"
    followed = case.follow("end.axial_force", ["-1.1 N", "-0.2502 lbf"])
    pound = 0.45359237 * 9.80665  # N, by definition
    assert [s.parameter for s in followed.steps] == pytest.approx([-1.1, -0.2502 * pound], rel=1e-14)
    assert followed.units["F3"] == "N"
