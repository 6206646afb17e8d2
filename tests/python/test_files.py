"""Files for other programs, read back by the libraries those programs are made of."""

import csv
import json
import xml.etree.ElementTree as ET

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
