"""Files for other programs, read back by the libraries those programs are made of."""

import csv
import json
import xml.etree.ElementTree as ET

import h5py
import numpy as np
import pytest
import tendril
from conftest import EXAMPLES
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkTubeFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def read(file):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    data = reader.GetOutput()
    points = data.GetPointData()
    arrays = {points.GetArrayName(i): vtk_to_numpy(points.GetArray(i)) for i in range(points.GetNumberOfArrays())}
    return data, vtk_to_numpy(data.GetPoints().GetData()), arrays


@pytest.fixture(scope="module")
def helix(tmp_path_factory):
    result = tendril.load(EXAMPLES / "helix_outer_20.toml").solve()
    return result, result.save(tmp_path_factory.mktemp("files") / "helix")


@pytest.fixture(scope="module")
def wire(tmp_path_factory):
    result = tendril.load(EXAMPLES / "guidewire_vessel.toml").solve()
    return result, result.save(tmp_path_factory.mktemp("files") / "wire")


def test_vtk_reads_the_rod_bit_for_bit(wire):
    result, files = wire
    data, points, arrays = read(files / "rod.vtp")
    assert data.GetNumberOfLines() == 1 and data.GetNumberOfPoints() == len(result.S)
    assert np.array_equal(points, np.column_stack([result.x, result.y, result.z]))
    for name in ("S", "s", "gap", "F3", "M3", "kappa"):
        assert np.array_equal(arrays[name], result.fields[name]), name
    assert np.all(arrays["radius"] == 0.889e-3 / 2)
    assert np.allclose(np.linalg.norm(arrays["tangent"], axis=1), 1.0, rtol=0, atol=1e-12)  # rounding


def test_the_tube_filter_works_at_once(wire):
    """What a user of ParaView clicks: Tube, radius by the array of that name."""
    data, points, arrays = read(wire[1] / "rod.vtp")
    data.GetPointData().SetActiveScalars("radius")
    tube = vtkTubeFilter()
    tube.SetInputData(data)
    tube.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
    tube.SetNumberOfSides(12)
    tube.Update()
    surface = vtk_to_numpy(tube.GetOutput().GetPoints().GetData())
    away = [np.linalg.norm(points - p, axis=1).min() for p in surface[::50]]
    radius = arrays["radius"][0]
    assert len(away) > 20 and np.allclose(away, radius, rtol=0.05, atol=0)  # the filter works in single precision, on chords


def test_the_wall_is_where_the_rod_touches(wire):
    """At the contact the surface of the rod lies on the wall, between two of its 32 corners."""
    result, files = wire
    _, wall, arrays = read(files / "tube.vtp")
    contact = result.contacts[0]
    at = np.argmin(abs(result.S - contact["start"]))
    centre = np.array([result.x[at], result.y[at], result.z[at]])
    outward = -contact["force_vector"] / np.linalg.norm(contact["force_vector"])
    touching = centre + 0.889e-3 / 2 * outward
    distance = np.linalg.norm(wall - touching, axis=1).min()
    radius = arrays["clearance"][np.argmin(abs(arrays["S"] - contact["start"]))] + 0.889e-3 / 2
    corner = radius * np.sin(np.pi / 32)  # half the way from corner to corner; sections are closer than that
    assert distance < 1.1 * corner


def test_the_steps_of_a_path(helix):
    result, files = helix
    listed = ET.parse(files / "rod.pvd").getroot().findall(".//DataSet")
    assert [float(entry.get("timestep")) for entry in listed] == list(range(len(result.steps)))  # times must ascend
    for entry, step in zip(listed, result.steps):
        data, points, arrays = read(files / entry.get("file"))
        assert np.array_equal(points[:, 0], step.x)
        assert np.array_equal(arrays["pressure"], np.nan_to_num(step.pressure))
        assert data.GetFieldData().GetArray("TimeValue").GetValue(0) == step.parameter


def test_csv(helix, wire):
    with open(wire[1] / "fields.csv", newline="") as file:
        header, *rows = csv.reader(file)
    assert header[2:5] == ["S [m]", "s [m]", "x [m]"] and "M3 [N m]" in header and len(rows) == len(wire[0].S)
    assert [float(row[header.index("F3 [N]")]) for row in rows] == list(wire[0].fields.F3)
    with open(helix[1] / "contacts.csv", newline="") as file:
        contacts = list(csv.DictReader(file))
    last = [row for row in contacts if row["step"] == str(len(helix[0].steps))]
    assert [float(row["force"]) for row in last] == list(helix[0].contacts.force)
    assert json.loads((helix[1] / "result.json").read_text())["status"] == "converged"


def same(group, columns):
    return all(np.array_equal(group[name][()], values, equal_nan=True) for name, values in columns.items())


@pytest.mark.parametrize("name", ["helix", "wire"])
def test_hdf5_has_everything(name, request, program, tmp_path):
    result, files = request.getfixturevalue(name)
    told = program("convert", files / "result.json", "-o", tmp_path / "result.h5")
    assert told.returncode == 0, told.stderr
    with h5py.File(tmp_path / "result.h5") as file:
        assert file.attrs["tendril"] == tendril.__version__ and file.attrs["status"] == "converged"
        case = json.loads(file["case"][0])
        assert case == json.loads((files / "result.json").read_text())["case"]
        assert list(file["steps"]) == [f"{i:04d}" for i in range(1, len(result.steps) + 1)]
        for group, step in zip(file["steps"].values(), result.steps):
            assert group.attrs.get("parameter") == step.parameter and group.attrs["branch"] == step.branch
            for key in ("rod_length", "axial_force_start", "axial_force_end", "push", "torque_end"):
                assert group.attrs[key] == getattr(step, key)
            assert group["certificate"].attrs["error"] == step.certificate.error
            assert same(group["fields"], step.fields) and np.array_equal(group["state"][()], step.state)
            contacts = {c: step.contacts[c] for c in step.contacts.dtype.names if c != "kind"}
            assert set(group["contacts"]) == {"kind", *contacts} and same(group["contacts"], contacts)
            assert [k.decode() for k in group["contacts/kind"][()]] == list(step.contacts.kind)
            assert same(group["segments"], {c: step.segments[c] for c in ("start", "end")})
        assert same(file["events"], {c: result.events[c] for c in ("parameter", "S", "rod_length", "axial_force_end")})
        assert same(file["trace"], {c: result.trace[c] for c in result.trace.dtype.names})
        assert file["steps/0001/fields/F3"].attrs.get("unit", "") == result.units["F3"]
        assert file["tube/position"].shape == (len(file["tube/S"]), 3)


def test_converted_files_are_those_of_the_run(helix, wire, program, tmp_path):
    for result, files in (helix, wire):
        for format in ("csv", "vtp"):
            told = program("convert", files / "result.json", "--to", format, "-o", tmp_path / format)
            assert told.returncode == 0, told.stderr
        for name in ("contacts.csv", "fields.csv"):
            assert (tmp_path / "csv" / name).read_bytes() == (files / name).read_bytes()
        for i in range(1, len(result.steps) + 1):
            run = files / (f"rod_{i:04d}.vtp" if len(result.steps) > 1 else "rod.vtp")
            assert (tmp_path / "vtp" / f"rod_{i:04d}.vtp").read_bytes() == run.read_bytes()
    # the wall of the last, the wire: sampled elsewhere along the tube, it is the same surface
    _, ours, arrays = read(tmp_path / "vtp" / "tube.vtp")
    _, theirs, there = read(wire[1] / "tube.vtp")
    first = np.flatnonzero(arrays["S"] == arrays["S"].max()), np.flatnonzero(there["S"] == there["S"].max())
    assert np.allclose(ours[first[0]], theirs[first[1]], rtol=0, atol=1e-15)


def test_what_cannot_be_converted(wire, program, tmp_path):
    whole = wire[1] / "result.json"
    assert program("convert", whole, "-o", tmp_path / "x").returncode == 2  # h5, csv or vtp?
    assert program("convert", whole, "-o", tmp_path / "none" / "x.h5").returncode == 6
    assert program("convert", tmp_path / "none.json", "-o", tmp_path / "x.h5").returncode == 6
    broken = json.loads(whole.read_text())
    del broken["steps"][0]["push"]
    (tmp_path / "broken.json").write_text(json.dumps(broken))
    told = program("convert", tmp_path / "broken.json", "-o", tmp_path / "x.h5")
    assert told.returncode == 3 and "push" in told.stderr
    assert not list(tmp_path.glob("x.h5*"))
    thin = wire[0].save(tmp_path / "thin.json", fields=False)
    assert program("convert", thin, "--to", "vtp", "-o", tmp_path / "v").returncode == 3
    assert program("convert", thin, "--to", "csv", "-o", tmp_path / "c").returncode == 0
