"""tendril quality and tendril check on centreline and survey files: tables, findings, refusals."""

import math
import pathlib

from _tendril import EXAMPLES, SOURCE, expect, run

DATA = SOURCE / "tests" / "data"

both = expect(run("quality", EXAMPLES / "data/synthetic_vessel.csv", EXAMPLES / "data/forge_16A_78_32.csv"), 0,
              stdout=["synthetic_vessel.csv", "forge_16A_78_32.csv", "passes north 6 times", "exact"]).stdout
row = next(line for line in both.splitlines() if "forge" in line).split()
assert row[1] == "422" and row[3] == "2609" and row[-1] == "good", row  # stations, depth in m
assert run("check", EXAMPLES / "data/forge_16A_78_32.csv").stdout.splitlines()[1].split() == row

# a tree: its ends, and the ways from the widest of them
tree = expect(run("quality", DATA / "tree_base64_zlib.vtp"), 0, stdout=["its ends: 0 at (0, 0, 0), radius 5;"]).stdout
assert tree.count(" ends = [0, ") == 2, tree
one = expect(run("quality", "-q", DATA / "tree_base64_zlib.vtp", "--ends", "2", "0"), 0).stdout
assert "findings" not in one and len(one.splitlines()) == 2, one
# from one branch into the other the way turns back at the fork
expect(run("quality", DATA / "tree_base64_zlib.vtp", "--ends", "2", "1"), 3, stdout=["the line through the points turns by"])
expect(run("quality", DATA / "vmtk.vtp", "--branch", "1"), 0)
expect(run("quality", DATA / "vmtk.vtp", "--ends", "0", "9"), 3, stderr=["two different ends of the file"])
expect(run("quality", DATA / "tree_ascii.vtp", "--smoothing", "much"), 2, stderr=["--smoothing"])
for file in sorted(DATA.glob("survey_*")):
    expect(run("check", file), 0, stdout=["782.3"])  # depth, the same from every format

# jitter is smoothed and told; a fold that smoothing cannot remove is refused with its place
zigzag = [f"{0.3 * (-1) ** i},0,{0.5 * i},4" for i in range(60)]
pathlib.Path("zigzag.csv").write_text("x_mm,y_mm,z_mm,radius_mm\n" + "\n".join(zigzag) + "\n")
expect(run("quality", "zigzag.csv"), 3, stdout=["refused", "points[1]"])
wave = [f"{0.1 * (-1) ** i},0,{0.5 * i},4" for i in range(60)]
pathlib.Path("wave.csv").write_text("x_mm,y_mm,z_mm,radius_mm\n" + "\n".join(wave) + "\n")
expect(run("check", "wave.csv"), 0, stdout=["smoothed within 0.6", "good"])
expect(run("check", "wave.csv", "-q"), 0)
expect(run("quality", "wave.csv", "--smoothing", "0"), 3, stdout=["refused", "at S = ", "allow smoothing"])
hook = [f"{3 * (1 - math.cos(a / 10))},0,{3 * math.sin(a / 10)},4" for a in range(30)]
pathlib.Path("hook.csv").write_text("x_mm,y_mm,z_mm,radius_mm\n" + "\n".join(hook) + "\n")
expect(run("quality", "hook.csv", "--smoothing", "auto"), 3, stdout=["folds", "must stay below 1"])
pathlib.Path("bad.las").write_text("~V\nVERS. 2.0:\n~C\nMD.M:\nINC.DEG:\nAZI.DEG:\n~A\n0 0 0\n30 1 400\n")
expect(run("check", "bad.las"), 3, stdout=["refused: azimuth is out of bounds"],
       stderr=["bad.las:9:1: error: azimuth is out of bounds", "found: 400 deg"])
expect(run("quality", "none.vtp"), 6, stderr=["none.vtp"])
