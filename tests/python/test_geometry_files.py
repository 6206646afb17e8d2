"""Centreline and survey files in cases from Python; VTK's own writer gives what the program reads."""

import math

import numpy as np
import pytest
import tendril
from conftest import EXAMPLES
from vtkmodules.vtkCommonCore import VTK_DOUBLE, vtkDoubleArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

DATA = EXAMPLES.parent / "tests" / "data"


def vessel(file, **axis):
    return tendril.Case(
        units="si",
        rod={"bending_stiffness": "900 N mm^2", "poisson_ratio": 0.3, "diameter": "1 mm"},
        tube={"axis": {"kind": "points", "file": str(file), **axis}},
        start={"kind": "clamped"},
        end={"kind": "sleeve", "axial_force": -0.2, "torque": 0.0},
    )


def spiral():
    """A turn of a helix of radius 30 mm and pitch 60 mm, a vessel of 5 mm about it."""
    data, points, radius, lines = vtkPolyData(), vtkPoints(), vtkDoubleArray(), vtkCellArray()
    points.SetDataType(VTK_DOUBLE)
    radius.SetName("MaximumInscribedSphereRadius")
    count = 200
    lines.InsertNextCell(count)
    for i in range(count):
        t = 2 * math.pi * i / (count - 1)
        points.InsertNextPoint(30 * math.cos(t), 30 * math.sin(t), 60 * t / (2 * math.pi))
        radius.InsertNextValue(5 - 0.2 * math.sin(t))
        lines.InsertCellPoint(i)
    data.SetPoints(points)
    data.SetLines(lines)
    data.GetPointData().AddArray(radius)
    return data


@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended"])
@pytest.mark.parametrize("compressor", ["None", "ZLib"])
def test_what_vtk_writes_is_read(tmp_path, mode, compressor):
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(spiral())
    getattr(writer, f"SetDataModeTo{mode}")()
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    for encoded in (0, 1):
        for order in ("LittleEndian", "BigEndian"):
            for size in ("UInt32", "UInt64"):
                writer.SetEncodeAppendedData(encoded)
                getattr(writer, f"SetByteOrderTo{order}")()
                getattr(writer, f"SetHeaderTypeTo{size}")()
                writer.SetFileName(str(tmp_path / "spiral.vtp"))
                assert writer.Write() == 1
                case = vessel(tmp_path / "spiral.vtp", file_unit="mm")
                # 200 points on 2 pi: the quintic through them is off by less than 1e-9 of the length
                assert case.length == pytest.approx(1e-3 * math.hypot(2 * math.pi * 30, 60), rel=1e-8)


def test_a_branch_of_a_tree_solves_from_either_end():
    there = vessel(DATA / "tree_appended_raw_zlib.vtp", file_unit="mm", ends=np.array([0, 2]))
    back = vessel(DATA / "tree_ascii.vtp", file_unit="mm", ends=[2, 0])
    assert there.length == pytest.approx(back.length, rel=1e-12)
    a, b = there.solve(), back.solve()
    assert a.status == b.status == "converged"
    # one rod in one tube; the load is at the other end, whose force differs by little in this short stiff rod
    assert a.rod_length == pytest.approx(b.rod_length, rel=1e-3)


@pytest.mark.parametrize("file", ["survey_12.las", "survey_30.las", "survey_witsml_14.xml", "survey_witsml_20.xml"])
def test_surveys(file):
    case = tendril.load(EXAMPLES / "well_forge.toml", {"tube.axis.file": str(DATA / file), "tube.axis.from": 600.0,
                                                       "tube.axis.to": 900.0})
    assert case.length == pytest.approx(300.0, rel=1e-9)
    assert any("passes north" in note for note in case.notes)


def test_wrong_files_raise_with_their_line(tmp_path):
    (tmp_path / "bad.pth").write_text("<path><timestep><path_element><path_points><path_point><pos x='1' y='2'/>\n"
                                      "</path_point></path_points></path_element></timestep></path>")
    with pytest.raises(tendril.CaseError) as caught:
        vessel(tmp_path / "bad.pth", file_unit="cm")
    assert "attribute `z` of a point is missing" in str(caught.value)
