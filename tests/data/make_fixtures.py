#!/usr/bin/env python3
"""Write the centreline and survey files of this directory; the tests compare the readers with the same formulas.

tree_*.vtp    A vessel of two branches in millimetres, MaximumInscribedSphereRadius at each point, three lines that share
              the fork (point 10):
                  trunk  (line 0)  points 0..10   (0.2 k^2 / 10, 0, 3 k)                       radius 5 - 0.1 k
                  left   (line 1)  points 10..20  fork + (0.6 j, 0.25 j, 2.5 j)                radius 4 - 0.1 j
                  right  (line 2)  points 10, 21..30  fork + (0.4 j - 0.08 j^2, -0.3 j, 2.5 j) radius 4 - 0.12 j
              in every packing that VTK writes; float32 where the name says so.
cells.vtp     The same tree as cells of two points each, as some tools write it.
vmtk.vtp      Two whole lines from one inlet, as the extraction of centrelines writes them: trunk and left, trunk and right.
curve.pth     The trunk in centimetres as a SimVascular path: control points, and path points with tangents.
curve_lps.mrk.json, curve_ras.mrk.json   The trunk as Slicer curves: one place, two coordinate systems, with a radius.
survey_*.las, survey_*.xml   One survey: md = 30 k m, inc = min(2 k, 40) deg, azi = 350 + 2 k deg (through north).
"""
import base64
import json
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent


def tree():
    trunk = [(0.2 * k * k / 10, 0.0, 3.0 * k, 5 - 0.1 * k) for k in range(11)]
    x, y, z, _ = trunk[10]
    left = [(x + 0.6 * j, y + 0.25 * j, z + 2.5 * j, 4 - 0.1 * j) for j in range(1, 11)]
    right = [(x + 0.4 * j - 0.08 * j * j, y - 0.3 * j, z + 2.5 * j, 4 - 0.12 * j) for j in range(1, 11)]
    return trunk + left + right


LINES = [list(range(11)), list(range(10, 21)), [10] + list(range(21, 31))]


class Packer:
    """Text of a DataArray and, for appended data, the bytes that follow the file's XML."""

    def __init__(self, form, header="I", compressed=False, big=False, block=64):
        self.form, self.header, self.compressed, self.block = form, header, compressed, block
        self.order = ">" if big else "<"
        self.appended = b""

    def bytes_of(self, data):
        pack = lambda *sizes: struct.pack(f"{self.order}{len(sizes)}{self.header}", *sizes)  # noqa: E731
        if not self.compressed:
            return [pack(len(data)) + data]
        blocks = [data[i:i + self.block] for i in range(0, len(data), self.block)]
        packed = [zlib.compress(b) for b in blocks]
        last = len(blocks[-1]) if len(blocks[-1]) < self.block else 0
        return [pack(len(blocks), self.block, last, *(len(p) for p in packed)), b"".join(packed)]

    def array(self, name, kind, values, components=1):
        code = {"Float64": "d", "Float32": "f", "Int64": "q", "Int32": "i"}[kind]
        head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}"'
        if self.form == "ascii":
            return f'{head} format="ascii">\n{" ".join(repr(v) for v in values)}\n</DataArray>'
        parts = self.bytes_of(struct.pack(f"{self.order}{len(values)}{code}", *values))
        if self.form == "binary":
            text = "".join(base64.b64encode(part).decode() for part in parts)
            return f'{head} format="binary">\n{text}\n</DataArray>'
        offset = len(self.appended)
        self.appended += b"".join(base64.b64encode(p) for p in parts) if self.form == "base64" else b"".join(parts)
        return f'{head} format="appended" offset="{offset}"/>'


def vtp(name, points, lines, packer, real="Float64", integer="Int64", radius="MaximumInscribedSphereRadius"):
    flat = [v for p in points for v in p[:3]]
    connectivity = [i for line in lines for i in line]
    offsets, total = [], 0
    for line in lines:
        total += len(line)
        offsets.append(total)
    order = "BigEndian" if packer.order == ">" else "LittleEndian"
    header = "UInt64" if packer.header == "Q" else "UInt32"
    compressor = ' compressor="vtkZLibDataCompressor"' if packer.compressed else ""
    body = "\n".join([
        f'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="{order}" header_type="{header}"{compressor}>',
        "<PolyData>",
        f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="0" NumberOfLines="{len(lines)}" NumberOfStrips="0" '
        'NumberOfPolys="0">',
        "<PointData>",
        packer.array(radius, real, [p[3] for p in points]),
        "</PointData>",
        "<Points>",
        packer.array("Points", real, flat, 3),
        "</Points>",
        "<Lines>",
        packer.array("connectivity", integer, connectivity),
        packer.array("offsets", integer, offsets),
        "</Lines>",
        "</Piece>",
        "</PolyData>",
    ]).encode()
    if packer.appended:
        encoding = "base64" if packer.form == "base64" else "raw"
        body += f'\n<AppendedData encoding="{encoding}">\n_'.encode() + packer.appended + b"\n</AppendedData>"
    (HERE / name).write_bytes(body + b"\n</VTKFile>\n")


def vtk_files():
    points = tree()
    vtp("tree_ascii.vtp", points, LINES, Packer("ascii"))
    vtp("tree_base64.vtp", points, LINES, Packer("binary", "Q"))
    vtp("tree_base64_zlib.vtp", points, LINES, Packer("binary", "I", compressed=True))
    vtp("tree_appended_raw.vtp", points, LINES, Packer("raw", "Q"))
    vtp("tree_appended_raw_zlib.vtp", points, LINES, Packer("raw", "Q", compressed=True, block=100))
    vtp("tree_appended_base64.vtp", points, LINES, Packer("base64", "I"))
    vtp("tree_appended_base64_zlib.vtp", points, LINES, Packer("base64", "Q", compressed=True))
    vtp("tree_big_endian_float32.vtp", points, LINES, Packer("raw", "I", big=True), "Float32", "Int32", "Radius")
    vtp("cells.vtp", points, [[a, b] for line in LINES for a, b in zip(line, line[1:])], Packer("binary", "I"))
    two = points[:21] + points[:11] + points[21:]
    vtp("vmtk.vtp", two, [list(range(21)), list(range(21, 42))], Packer("ascii"))


def simvascular():
    trunk = [[v / 10 for v in p[:3]] for p in tree()[:11]]
    point = lambda tag, i, p: f'                <{tag} id="{i}" x="{p[0]!r}" y="{p[1]!r}" z="{p[2]!r}" />'  # noqa: E731
    path_points = [
        f'                <path_point id="{i}">\n    {point("pos", i, p).replace(f" id={chr(34)}{i}{chr(34)}", "")}\n'
        '                    <tangent x="0" y="0" z="1" />\n                    <rotation x="1" y="0" z="0" />\n'
        "                </path_point>" for i, p in enumerate(trunk)]
    (HERE / "curve.pth").write_text("\n".join([
        '<?xml version="1.0" encoding="UTF-8" ?>', '<format version="1.0" />',
        '<path id="1" method="0" calculation_number="100" spacing="0" reslice_size="5">', '    <timestep id="0">',
        '        <path_element method="0" calculation_number="100" spacing="0">', "            <control_points>",
        *[point("point", i, p) for i, p in enumerate(trunk[::5])], "            </control_points>",
        "            <path_points>", *path_points, "            </path_points>", "        </path_element>",
        "    </timestep>", "</path>"]) + "\n")


def slicer():
    for system, sign in (("LPS", 1), ("RAS", -1)):
        points = [{"id": str(i + 1), "label": f"C-{i + 1}", "position": [sign * p[0], sign * p[1], p[2]],
                   "positionStatus": "defined"} for i, p in enumerate(tree()[:11])]
        markup = {"type": "Curve", "coordinateSystem": system, "coordinateUnits": "mm", "controlPoints": points,
                  "measurements": [{"name": "length", "units": "mm"},
                                   {"name": "Radius", "units": "mm",
                                    "controlPointValues": [p[3] for p in tree()[:11]]}]}
        (HERE / f"curve_{system.lower()}.mrk.json").write_text(json.dumps({"markups": [markup]}, indent=1) + "\n")


def surveys():
    rows = [(30.0 * k, min(2.0 * k, 40.0), (350.0 + 2 * k) % 360) for k in range(31)]
    curves = "DEPT.M   : measured depth\nGR.GAPI  : not of interest\nINCL.DEG : inclination\nAZIM.DEG : azimuth\n"
    well = "~Well\nSTRT.M 0.0 :\nSTOP.M 900.0 :\nSTEP.M 30.0 :\nNULL. -999.25 :\n"
    data = "\n".join(f"{md:8.1f} {40 + md / 100:8.3f} {inc:8.3f} {azi:8.3f}" for md, inc, azi in rows)
    above = "   905.0  -999.25  -999.25  -999.25"  # a log row without a station
    (HERE / "survey_12.las").write_text(
        f"~Version\nVERS. 1.2 : CWLS LAS 1.2\nWRAP. NO :\n{well}# curves\n~Curve\n{curves}~A\n{data}\n{above}\n")
    wrapped = "\n".join(f"{md:.1f}\n{40 + md / 100:.3f} {inc:.3f}\n{azi:.3f}" for md, inc, azi in rows)
    (HERE / "survey_20_wrapped.las").write_text(
        f"~VERSION INFORMATION\nVERS. 2.0 : CWLS LAS 2.0\nWRAP. YES :\n{well}~CURVE INFORMATION\n{curves}~ASCII\n{wrapped}\n")
    feet = "\n".join(f"{md / 0.3048!r},{inc:.3f},{azi:.3f}" for md, inc, azi in rows)
    (HERE / "survey_30.las").write_text(
        "~Version\nVERS. 3.0 : CWLS LAS 3.0\nWRAP. NO :\nDLM. COMMA :\n~Well\nNULL. -999.25 :\n~Log_Definition\n"
        "DEPT.M : {F}\nGR.GAPI : {F}\n~Log_Data | Log_Definition\n0,40\n30,41\n~Inclinometry_Definition\n"
        f"MD.FT : measured depth {{F}}\nINCL.DEG : {{F}}\nAZIM.DEG : {{F}}\n~Inclinometry_Data | Inclinometry_Definition\n{feet}\n")
    station = lambda tag, md, inc, azi: (  # noqa: E731
        f'<{tag("trajectoryStation")} uid="{int(md)}"><{tag("typeTrajStation")}>unknown</{tag("typeTrajStation")}>'
        f'<{tag("md")} uom="m">{md}</{tag("md")}><{tag("incl")} uom="dega">{inc}</{tag("incl")}>'
        f'<{tag("azi")} uom="dega">{azi}</{tag("azi")}></{tag("trajectoryStation")}>')
    body = "\n".join(station(lambda name: name, *row) for row in rows)
    (HERE / "survey_witsml_14.xml").write_text(
        '<?xml version="1.0" encoding="UTF-8"?>\n<trajectorys xmlns="http://www.witsml.org/schemas/1series" '
        'version="1.4.1.1">\n<trajectory uidWell="w" uidWellbore="b" uid="t">\n<nameWell>Well &amp; bore</nameWell>\n'
        f"{body}\n</trajectory>\n</trajectorys>\n")
    pascal = lambda name: "witsml:" + name[0].upper() + name[1:]  # noqa: E731
    body = "\n".join(station(pascal, *row) for row in rows[::-1])
    (HERE / "survey_witsml_20.xml").write_text(
        '<?xml version="1.0" encoding="UTF-8"?>\n<witsml:Trajectory '
        'xmlns:witsml="http://www.energistics.org/energyml/data/witsmlv2" schemaVersion="2.0">\n'
        f"{body}\n</witsml:Trajectory>\n")


if __name__ == "__main__":
    vtk_files()
    simvascular()
    slicer()
    surveys()
